// Shared head of every program: what one picture fixes, and a few conversions.
// View space is the camera's (x right, y up, looking along -z) in units of the distance to the target, so that tiny and
// huge models compute with the same magnitudes. Depth is reversed: 1 near, 0 far.

struct Picture {
    view_from_world: mat4x4f,
    clip_from_view: mat4x4f,
    // width px, height px, physical px in a point, focal length px
    viewport: vec4f,
    // 1 = orthographic, 1 = flat shading, wire half width px, smallest distance in front of the eye
    modes: vec4f,
    // opacity where one looks straight at the surface, number of the matcap (0 = lamps), how much the ramp covers a texture, unused
    look: vec4f,
    // sRGB
    background_top: vec4f,
    background_bottom: vec4f,
    // linear; alpha: strength
    back_tint: vec4f,
    accent: vec4f,
    key: vec4f,
    fill: vec4f,
    sky: vec4f,
    ground: vec4f,
    rim: vec4f,
    // faces that pass through others
    flaw: vec4f,
    // sRGB; alpha: opacity
    wire: vec4f,
    grid_color: vec4f,
    // center x, floor y, center z, cell size (world)
    grid: vec4f,
    // reach (world), offset of the center from a major line x, z (cells), unused
    grid_extent: vec4f,
}

@group(0) @binding(0) var<uniform> picture: Picture;

fn view_from_world(world: vec3f) -> vec3f {
    return (picture.view_from_world * vec4f(world, 1.0)).xyz;
}

fn clip_from_view(view: vec3f) -> vec4f {
    return picture.clip_from_view * vec4f(view, 1.0);
}

// Length in view space of one physical pixel at this point.
fn view_per_px(view: vec3f) -> f32 {
    let depth = select(max(-view.z, picture.modes.w), 1.0, picture.modes.x > 0.5);
    return depth / picture.viewport.w;
}

// Depth value (0..=1) of a point moved toward the eye: marks on the surface win against the surface under them.
fn depth_toward_eye(view: vec3f, lift: f32) -> f32 {
    var lifted = view;
    if picture.modes.x > 0.5 {
        lifted.z += lift;
    } else {
        lifted.z = min(lifted.z + lift, -picture.modes.w);
    }
    let clip = clip_from_view(lifted);
    return clamp(clip.z / clip.w, 0.0, 1.0);
}

// Roots instead of powers: fitted to the sRGB curve, off by at most 1.4 of 255 levels, and cheap where the processor draws.
fn srgb_from_linear(linear: vec3f) -> vec3f {
    let c = clamp(linear, vec3f(0.0), vec3f(1.0));
    let root = sqrt(c);
    return root * (1.6402 + 0.2247 * c) - 0.1931 * sqrt(root) - 0.6772 * c;
}
