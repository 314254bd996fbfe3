// Edges as plain lines, for devices whose vertex programs cannot fetch by number.

@vertex
fn vertex(@location(0) position: vec3f) -> @builtin(position) vec4f {
    let view = view_from_world(position);
    let clip = clip_from_view(view);
    return vec4f(clip.xy, depth_toward_eye(view, 1.5 * view_per_px(view)) * clip.w, clip.w);
}

@fragment
fn fragment() -> @location(0) vec4f {
    return picture.wire;
}
