// Materials lit by a painted ball instead of lamps: light depends only on how the surface leans away from the eye. The balls are
// formulas, made here by eye: no pictures.

// Seen from the eye: x to the right, y up, both -1..=1 at the outline; perspective does not shift them across the picture.
fn on_ball(normal: vec3f, eye: vec3f) -> vec2f {
    let right = normalize(cross(vec3f(0.0, 1.0, 0.0), eye) + vec3f(1e-6, 0.0, 0.0));
    let up = cross(eye, right);
    return vec2f(dot(normal, right), dot(normal, up));
}

// A soft round lamp at a place on the ball.
fn lamp_at(at: vec2f, place: vec2f, radius: f32) -> f32 {
    let away = length(at - place) / radius;
    return 1.0 - smoothstep(0.35, 1.0, away);
}

// Warm modelling clay: broad light from the upper left, soft shadow, a dark outline.
fn clay(color: vec3f, at: vec2f) -> vec3f {
    let lit = 0.5 + 0.5 * dot(at, vec2f(-0.48, 0.64));
    let out = dot(at, at);
    let shadow = mix(vec3f(0.20, 0.13, 0.12), vec3f(1.12, 1.04, 0.96), smoothstep(0.05, 0.95, lit));
    return color * shadow * (1.0 - 0.45 * out * out * out) + vec3f(0.05) * lamp_at(at, vec2f(-0.35, 0.45), 0.45);
}

// Glazed porcelain: bright all over, two sharp windows reflected.
fn porcelain(color: vec3f, at: vec2f) -> vec3f {
    let lit = 0.5 + 0.5 * dot(at, vec2f(-0.36, 0.72));
    let body = color * mix(0.42, 1.02, smoothstep(0.0, 1.0, lit));
    let windows = lamp_at(at, vec2f(-0.42, 0.52), 0.20) + 0.45 * lamp_at(at, vec2f(0.52, -0.30), 0.14);
    let out = dot(at, at);
    return body + vec3f(0.85) * windows + vec3f(0.10, 0.12, 0.15) * out * out;
}

// Brushed metal: sky above, dark horizon, warm ground below, all tinted by the surface.
fn metal(color: vec3f, at: vec2f) -> vec3f {
    let sky = mix(vec3f(0.55, 0.60, 0.68), vec3f(1.30, 1.32, 1.35), smoothstep(0.05, 0.75, at.y));
    let ground = mix(vec3f(0.34, 0.31, 0.29), vec3f(0.62, 0.56, 0.50), smoothstep(0.0, 0.9, -at.y));
    let horizon = smoothstep(-0.06, 0.10, at.y);
    let dark = 1.0 - 0.72 * (1.0 - smoothstep(0.0, 0.22, abs(at.y + 0.03)));
    return color * mix(ground, sky, horizon) * dark + vec3f(0.5) * lamp_at(at, vec2f(-0.30, 0.62), 0.35);
}

// Stripes reflected all around, as of a row of tubes: a surface that is smooth bends them smoothly.
fn stripes(color: vec3f, at: vec2f) -> vec3f {
    let angle = asin(clamp(at.x, -1.0, 1.0)) * 7.0 + asin(clamp(at.y, -1.0, 1.0)) * 2.0;
    let wave = sin(2.0 * angle);
    // As sharp as the picture can show.
    let stripe = smoothstep(-1.0, 1.0, wave / max(fwidth(wave), 0.05));
    let lit = 0.75 + 0.25 * dot(at, vec2f(-0.4, 0.6));
    return color * mix(0.10, 1.05, stripe) * lit;
}

fn matcap(color: vec3f, normal: vec3f, eye: vec3f) -> vec3f {
    let at = on_ball(normal, eye);
    switch u32(picture.look.y + 0.5) {
        case 1u: { return clay(color, at); }
        case 2u: { return porcelain(color, at); }
        case 3u: { return metal(color, at); }
        default: { return stripes(color, at); }
    }
}
