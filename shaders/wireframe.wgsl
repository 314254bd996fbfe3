// The surface together with its edges. Vertices are fetched by number, so every triangle has corners of its own and the
// fragment knows how far each edge is: crisp lines of constant width without a second pass or depth tricks.

@group(1) @binding(0) var<storage, read> positions: array<f32>;
@group(1) @binding(1) var<storage, read> normals: array<f32>;
@group(1) @binding(2) var<storage, read> colors: array<u32>;
@group(1) @binding(3) var<storage, read> corners: array<u32>;

struct Wired {
    @builtin(position) clip: vec4f,
    @location(0) view: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) barycentric: vec3f,
}

@vertex
fn vertex(@builtin(vertex_index) corner: u32) -> Wired {
    let v = corners[corner];
    let position = vec3f(positions[3u * v], positions[3u * v + 1u], positions[3u * v + 2u]);
    let normal = vec3f(normals[3u * v], normals[3u * v + 1u], normals[3u * v + 2u]);
    let lit = lit_vertex(position, normal, unpack4x8unorm(colors[v]));
    let which = corner % 3u;
    let barycentric = vec3f(f32(which == 0u), f32(which == 1u), f32(which == 2u));
    return Wired(lit.clip, lit.view, lit.normal, lit.color, barycentric);
}

@fragment
fn fragment(in: Wired, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let per_px = vec3f(
        length(vec2f(dpdx(in.barycentric.x), dpdy(in.barycentric.x))),
        length(vec2f(dpdx(in.barycentric.y), dpdy(in.barycentric.y))),
        length(vec2f(dpdx(in.barycentric.z), dpdy(in.barycentric.z))),
    );
    let surface = srgb_from_linear(shade(Lit(in.clip, in.view, in.normal, in.color), front));

    let px = in.barycentric / max(per_px, vec3f(1e-12));
    let nearest = min(px.x, min(px.y, px.z));
    let half_width = picture.modes.z;
    let line = 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, nearest);
    // Triangles of a few pixels would drown in lines: those fade with the height of the triangle.
    let height = 1.0 / max(per_px.x, max(per_px.y, per_px.z));
    let sparse = smoothstep(2.0 * half_width, 14.0 * half_width, height);
    return vec4f(mix(surface, picture.wire.rgb, line * picture.wire.a * (0.25 + 0.75 * sparse)), 1.0);
}
