// Outlined discs of constant size on screen. Drawn twice: dimmed over everything, then in full where the surface does not hide them.

// Outline in points.
const OUTLINE = 1.5;
const DIMMED = 0.3;

struct Vertex {
    @builtin(position) clip: vec4f,
    @location(0) offset_px: vec2f,
    @location(1) color: vec4f,
    @location(2) radius_px: f32,
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) position: vec3f,
    @location(1) radius: f32,
    @location(2) color: vec4f,
) -> Vertex {
    let density = picture.viewport.z;
    let radius_px = radius * density;
    let offset = (vec2f(f32(index & 1u), f32(index >> 1u)) * 2.0 - 1.0) * (radius_px + OUTLINE * density + 1.0);
    let view = view_from_world(position);
    let clip = clip_from_view(view);
    // Lifted by twice the radius, the disc clears a surface that leans away by up to 60 degrees.
    let depth = depth_toward_eye(view, 2.0 * (radius_px + OUTLINE * density) * view_per_px(view));
    let xy = clip.xy + offset * 2.0 / picture.viewport.xy * clip.w;
    return Vertex(vec4f(xy, depth * clip.w, clip.w), offset, color, radius_px);
}

fn disc(in: Vertex) -> vec4f {
    let outline = OUTLINE * picture.viewport.z;
    let away = length(in.offset_px);
    let inside = clamp(in.radius_px - away + 0.5, 0.0, 1.0);
    let cover = clamp(in.radius_px + outline - away + 0.5, 0.0, 1.0);
    // A light dot gets a dark outline, a dark one a light outline.
    let brightness = dot(in.color.rgb, vec3f(0.3, 0.6, 0.1));
    let rim = select(vec3f(0.95), vec3f(0.06, 0.06, 0.08), brightness > 0.4);
    return vec4f(mix(rim, in.color.rgb, inside), in.color.a * cover);
}

@fragment
fn visible(in: Vertex) -> @location(0) vec4f {
    return disc(in);
}

@fragment
fn hidden(in: Vertex) -> @location(0) vec4f {
    let color = disc(in);
    return vec4f(color.rgb, color.a * DIMMED);
}
