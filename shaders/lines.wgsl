// Lines of constant width on screen with round ends. Both ends are divided by depth here, so everything is straight in pixels.

struct Vertex {
    @builtin(position) clip: vec4f,
    // px along the line from its first end, and across
    @location(0) at_px: vec2f,
    @location(1) color: vec4f,
    // length px, half width px
    @location(2) measure: vec2f,
}

// The end of a segment, brought before the eye if it lies behind.
fn before_eye(end: vec3f, other: vec3f) -> vec3f {
    let limit = -picture.modes.w;
    if picture.modes.x > 0.5 || end.z <= limit {
        return end;
    }
    return mix(end, other, clamp((limit - end.z) / min(other.z - end.z, -1e-12), 0.0, 1.0));
}

@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @location(0) a: vec3f,
    @location(1) b: vec3f,
    @location(2) width: f32,
    @location(3) color: vec4f,
) -> Vertex {
    let half_width = 0.5 * width * picture.viewport.z;
    let view_a = view_from_world(a);
    let view_b = view_from_world(b);
    let from_view = before_eye(view_a, view_b);
    let to_view = before_eye(view_b, view_a);
    let from_clip = clip_from_view(from_view);
    let to_clip = clip_from_view(to_view);
    let px_per_ndc = 0.5 * picture.viewport.xy;
    let from_px = from_clip.xy / from_clip.w * px_per_ndc;
    let to_px = to_clip.xy / to_clip.w * px_per_ndc;
    let span = to_px - from_px;
    let length_px = length(span);
    let along = select(vec2f(1.0, 0.0), span / max(length_px, 1e-6), length_px > 1e-6);
    let across = vec2f(-along.y, along.x);

    let reach = half_width + 1.0;
    let at_end = (index & 1u) == 1u;
    let side = select(-reach, reach, index >= 2u);
    let view = select(from_view, to_view, at_end);
    let px = select(from_px - along * reach, to_px + along * reach, at_end) + across * side;
    let depth = depth_toward_eye(view, (4.0 * half_width + 2.0) * view_per_px(view));
    // Both ends behind the eye: nothing.
    let gone = picture.modes.x < 0.5 && view_a.z > -picture.modes.w && view_b.z > -picture.modes.w;
    let clip = vec4f(px / px_per_ndc, select(depth, 2.0, gone), 1.0);
    return Vertex(clip, vec2f(select(-reach, length_px + reach, at_end), side), color, vec2f(length_px, half_width));
}

@fragment
fn fragment(in: Vertex) -> @location(0) vec4f {
    let beyond = in.at_px.x - clamp(in.at_px.x, 0.0, in.measure.x);
    let away = length(vec2f(beyond, in.at_px.y));
    return vec4f(in.color.rgb, in.color.a * clamp(in.measure.y - away + 0.5, 0.0, 1.0));
}
