// The ground: thin lines on a square, every tenth a little stronger, fading out toward its rim.

struct Vertex {
    @builtin(position) clip: vec4f,
    // cells from the square's center
    @location(0) cells: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Vertex {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0;
    let offset = corner * picture.grid_extent.x;
    let world = picture.grid.xyz + vec3f(offset.x, 0.0, offset.y);
    return Vertex(clip_from_view(view_from_world(world)), offset / picture.grid.w);
}

// Coverage of lines one point wide at whole numbers; where lines come closer than a few pixels their mean would be a haze: they fade.
fn lines(at: vec2f, per_px: vec2f) -> f32 {
    let width = picture.viewport.z;
    let px = abs(fract(at - 0.5) - 0.5) / per_px;
    let cover = clamp(vec2f(0.5 * width + 0.5) - px, vec2f(0.0), vec2f(1.0)) * (1.0 - smoothstep(vec2f(0.08), vec2f(0.3), per_px * width));
    return max(cover.x, cover.y);
}

@fragment
fn fragment(in: Vertex) -> @location(0) vec4f {
    let cells = in.cells + picture.grid_extent.yz;
    let per_px = max(vec2f(
        length(vec2f(dpdx(in.cells.x), dpdy(in.cells.x))),
        length(vec2f(dpdx(in.cells.y), dpdy(in.cells.y))),
    ), vec2f(1e-9));
    let strength = max(0.45 * lines(cells, per_px), lines(cells * 0.1, per_px * 0.1));
    let away = length(in.cells) * picture.grid.w / picture.grid_extent.x;
    let fade = 1.0 - smoothstep(0.15, 0.95, away);
    return vec4f(picture.grid_color.rgb, picture.grid_color.a * strength * fade);
}
