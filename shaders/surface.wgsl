// The surface from indexed vertices, and faces of it that are pointed out.

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) color: vec4f) -> Lit {
    return lit_vertex(position, normal, color);
}

@fragment
fn fragment(in: Lit, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return shade(in, front);
}

// A little nearer to the eye than the same faces of the surface.
@vertex
fn flaw_vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) color: vec4f) -> Lit {
    var lit = lit_vertex(position, normal, color);
    lit.clip.z = depth_toward_eye(lit.view, 1.0 * view_per_px(lit.view)) * lit.clip.w;
    return lit;
}

// Stripes the other way than those of the selection, light and dark: no ramp has them, and no eye needs their hue.
fn warning(in: Lit, front: bool) -> vec3f {
    let across = fract((in.clip.x - in.clip.y) / (7.0 * picture.viewport.z));
    let stripe = smoothstep(0.18, 0.32, abs(across - 0.5));
    let eye = toward_eye(in.view);
    let leaning = max(dot(shading_normal(in, eye, front), eye), 0.0);
    return picture.flaw.rgb * mix(0.08, 1.0, stripe) * (0.55 + 0.45 * leaning);
}

@fragment
fn flaw(in: Lit, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(srgb_from_linear(warning(in, front)), 1.0);
}

// Behind the surface: faintly, so that what is inside can be found.
@fragment
fn flaw_hidden(in: Lit, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(srgb_from_linear(warning(in, front)), 0.35);
}
