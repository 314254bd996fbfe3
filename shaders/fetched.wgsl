// The surface with its edges, with its textures, or with both. Vertices are fetched by number, so every triangle has corners of
// its own: the fragment knows how far each edge is (crisp lines of constant width without a second pass or depth tricks), and
// a vertex has as many texture coordinates as it has corners, without being stored as often.

@group(1) @binding(0) var<storage, read> positions: array<f32>;
@group(1) @binding(1) var<storage, read> normals: array<f32>;
@group(1) @binding(2) var<storage, read> colors: array<u32>;
@group(1) @binding(3) var<storage, read> corners: array<u32>;
// Four bits a triangle: bit k is set where no line is drawn on the edge across from corner k.
@group(1) @binding(4) var<storage, read> unmarked: array<u32>;
// Two numbers a corner, origin at the lower left, and the color of each vertex under its texture. Empty without textures.
@group(1) @binding(5) var<storage, read> uvs: array<f32>;
@group(1) @binding(6) var<storage, read> bases: array<u32>;

@group(2) @binding(0) var image: texture_2d<f32>;
@group(2) @binding(1) var image_sampler: sampler;

struct Fetched {
    @invariant @builtin(position) clip: vec4f,
    @location(0) view: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec4f,
    @location(3) barycentric: vec3f,
    @location(4) uv: vec2f,
    @location(5) base: vec3f,
}

// Distance from the three edges, 1 at the corner across. Where no line belongs it is never near 0: what counts is how it changes.
fn from_edges(corner: u32) -> vec3f {
    let which = corner % 3u;
    let triangle = corner / 3u;
    let from_edge = vec3f(f32(which == 0u), f32(which == 1u), f32(which == 2u));
    let bits = unmarked[triangle / 8u] >> (4u * (triangle % 8u));
    return from_edge + vec3f(f32(bits & 1u), f32((bits >> 1u) & 1u), f32((bits >> 2u) & 1u));
}

@vertex
fn vertex(@builtin(vertex_index) corner: u32) -> Fetched {
    let v = corners[corner];
    let position = vec3f(positions[3u * v], positions[3u * v + 1u], positions[3u * v + 2u]);
    let normal = vec3f(normals[3u * v], normals[3u * v + 1u], normals[3u * v + 2u]);
    let lit = lit_vertex(position, normal, unpack4x8unorm(colors[v]));
    var uv = vec2f(0.0);
    if 2u * corner + 1u < arrayLength(&uvs) {
        uv = vec2f(uvs[2u * corner], 1.0 - uvs[2u * corner + 1u]);
    }
    var base = vec3f(1.0);
    if v < arrayLength(&bases) {
        let roots = unpack4x8unorm(bases[v]).rgb;
        base = roots * roots;
    }
    return Fetched(lit.clip, lit.view, lit.normal, lit.color, from_edges(corner), uv, base);
}

fn lit(in: Fetched) -> Lit {
    return Lit(in.clip, in.view, in.normal, in.color);
}

// The texture under the ramp; nothing where it is cut out. Takes derivatives: to be called by every fragment.
fn textured_lit(in: Fetched) -> Lit {
    let texel = textureSample(image, image_sampler, in.uv);
    if texel.a < 0.5 {
        discard;
    }
    let under = in.base * texel.rgb;
    return Lit(in.clip, in.view, in.normal, vec4f(mix(under, in.color.rgb, picture.look.z), in.color.a));
}

// Edges over what is there already.
fn with_edges(surface: vec4f, in: Fetched) -> vec4f {
    let per_px = vec3f(
        length(vec2f(dpdx(in.barycentric.x), dpdy(in.barycentric.x))),
        length(vec2f(dpdx(in.barycentric.y), dpdy(in.barycentric.y))),
        length(vec2f(dpdx(in.barycentric.z), dpdy(in.barycentric.z))),
    );
    let px = in.barycentric / max(per_px, vec3f(1e-12));
    let nearest = min(px.x, min(px.y, px.z));
    let half_width = picture.modes.z;
    let line = 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, nearest);
    // Triangles of a few pixels would drown in lines: those fade with the height of the triangle.
    let height = 1.0 / max(per_px.x, max(per_px.y, per_px.z));
    let sparse = smoothstep(2.0 * half_width, 14.0 * half_width, height);
    let cover = line * picture.wire.a * (0.25 + 0.75 * sparse);
    return vec4f(mix(surface.rgb, picture.wire.rgb, cover), max(surface.a, cover));
}

@fragment
fn wired(in: Fetched, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return with_edges(shade(lit(in), front), in);
}

@fragment
fn textured(in: Fetched, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shade(textured_lit(in), front);
}

@fragment
fn textured_wired(in: Fetched, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return with_edges(shade(textured_lit(in), front), in);
}
