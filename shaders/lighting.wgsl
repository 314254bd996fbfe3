// Light on the surface. Three soft lights move with the camera, so that form reads from every side: a key from the upper left,
// a fill from the right, a rim from behind; sky and ground of the world tell up from down.

const KEY_DIRECTION = vec3f(-0.466, 0.621, 0.630);
const FILL_DIRECTION = vec3f(0.844, 0.074, 0.531);
const RIM_DIRECTION = vec3f(0.348, 0.753, -0.557);
// Key light reaches this far (as a cosine) past the terminator: a large, soft lamp.
const KEY_WRAP = 0.28;
const SPECULAR = 0.16;

struct Lit {
    @invariant @builtin(position) clip: vec4f,
    @location(0) view: vec3f,
    @location(1) normal: vec3f,
    // linear color; alpha: how much selected
    @location(2) color: vec4f,
}

fn lit_vertex(position: vec3f, normal: vec3f, color: vec4f) -> Lit {
    let view = view_from_world(position);
    let turned = picture.view_from_world * vec4f(normal, 0.0);
    // Colors arrive as square roots of linear light: eight bits suffice, and decoding is a product.
    return Lit(clip_from_view(view), view, turned.xyz, vec4f(color.rgb * color.rgb, color.a));
}

// Toward the eye, unit length.
fn toward_eye(view: vec3f) -> vec3f {
    return select(normalize(-view), vec3f(0.0, 0.0, 1.0), picture.modes.x > 0.5);
}

// The unit normal on the side one looks at: of the vertices, or of the triangle where facets are asked for. A vertex without a
// normal (all its triangles have no area) counts as facing the eye.
fn shading_normal(in: Lit, eye: vec3f, front: bool) -> vec3f {
    if picture.modes.y > 0.5 {
        let facet = cross(dpdx(in.view), dpdy(in.view));
        let unit = facet * inverseSqrt(max(dot(facet, facet), 1e-37));
        return unit * select(-1.0, 1.0, dot(unit, eye) >= 0.0);
    }
    let size = dot(in.normal, in.normal);
    let unit = in.normal * (inverseSqrt(max(size, 1e-30)) * select(-1.0, 1.0, front));
    return select(eye, unit, size > 1e-30);
}

fn wrapped(cosine: f32, wrap: f32) -> f32 {
    let soft = max((cosine + wrap) / (1.0 + wrap), 0.0);
    return soft * soft * (1.0 - wrap) + soft * wrap;
}

// Soft diagonal stripes, 0.3..=1: selection shows over any ramp, and the ramp through the selection.
fn hatching(px: vec2f) -> f32 {
    let across = fract((px.x + px.y) / (9.0 * picture.viewport.z));
    return 0.3 + 0.7 * smoothstep(0.17, 0.33, abs(across - 0.5));
}

// Sharpness of the highlight, by squaring five times.
fn power_32(x: f32) -> f32 {
    let x2 = x * x;
    let x4 = x2 * x2;
    let x8 = x4 * x4;
    let x16 = x8 * x8;
    return x16 * x16;
}

// Color of the surface itself, linear: what the vertices say, selection over it, and the tint of the inside.
fn albedo(in: Lit, front: bool) -> vec3f {
    let selected = mix(in.color.rgb, picture.accent.rgb, in.color.a * picture.accent.a * hatching(in.clip.xy));
    return select(mix(selected, picture.back_tint.rgb, picture.back_tint.a), selected, front);
}

// Light of the lamps leaving the surface toward the eye, linear.
fn lamps(albedo: vec3f, normal: vec3f, eye: vec3f, front: bool) -> vec3f {
    let world_up = normalize(picture.view_from_world[1].xyz);
    let up = 0.5 + 0.5 * dot(normal, world_up);
    var light = mix(picture.ground.rgb, picture.sky.rgb, up);
    light += picture.key.rgb * wrapped(dot(normal, KEY_DIRECTION), KEY_WRAP);
    light += picture.fill.rgb * max(dot(normal, FILL_DIRECTION), 0.0);

    let grazing = 1.0 - max(dot(normal, eye), 0.0);
    let rim = picture.rim.rgb * grazing * grazing * grazing * smoothstep(-0.3, 0.6, dot(normal, RIM_DIRECTION));
    let halfway = normalize(eye + KEY_DIRECTION);
    let gloss = select(0.3, 1.0, front) * SPECULAR * power_32(max(dot(normal, halfway), 0.0));
    return albedo * light + rim + picture.key.rgb * gloss;
}

// What leaves the surface toward the eye: sRGB, and how much it hides what is behind. A see-through surface hides more where
// one looks along it, so that its outline stays.
fn shade_as(color: vec3f, in: Lit, front: bool) -> vec4f {
    let eye = toward_eye(in.view);
    let normal = shading_normal(in, eye, front);
    var light = vec3f(0.0);
    if picture.look.y > 0.5 {
        light = matcap(color, normal, eye);
    } else {
        light = lamps(color, normal, eye, front);
    }
    let grazing = 1.0 - max(dot(normal, eye), 0.0);
    let opacity = mix(picture.look.x, 1.0, 0.7 * grazing * grazing * grazing);
    return vec4f(srgb_from_linear(light), select(opacity, 1.0, picture.look.x >= 1.0));
}

fn shade(in: Lit, front: bool) -> vec4f {
    return shade_as(albedo(in, front), in, front);
}
