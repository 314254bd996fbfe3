// One triangle over everything: a quiet vertical gradient, dithered so that eight bits show no bands.

struct Vertex {
    @builtin(position) clip: vec4f,
    @location(0) down: f32,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Vertex {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return Vertex(vec4f(corner * 2.0 - 1.0, 0.0, 1.0), 1.0 - corner.y);
}

// A fixed pattern of differences of at most half a step of eight bits (ordered, 4 x 4).
fn dither(px: vec2f) -> f32 {
    let x = u32(px.x) & 3u;
    let y = u32(px.y) & 3u;
    let z = x ^ y;
    let rank = ((z & 1u) << 3u) | ((y & 1u) << 2u) | ((z & 2u)) | ((y & 2u) >> 1u);
    return (f32(rank) - 7.5) / 16.0 / 255.0;
}

@fragment
fn fragment(in: Vertex) -> @location(0) vec4f {
    let t = smoothstep(0.0, 1.0, in.down);
    let color = mix(picture.background_top.rgb, picture.background_bottom.rgb, t);
    return vec4f(color + dither(in.clip.xy), 1.0);
}
