// The surface from indexed vertices.

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) color: vec4f) -> Lit {
    return lit_vertex(position, normal, color);
}

@fragment
fn fragment(in: Lit, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    return vec4f(srgb_from_linear(shade(in, front)), 1.0);
}
