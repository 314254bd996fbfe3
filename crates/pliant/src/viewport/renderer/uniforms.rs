//! What is the same for every vertex and pixel of one picture: the camera's matrices, sizes, and the theme's light.

use super::super::camera::sphere;
use super::super::ramp::linear;
use super::super::{Coloring, Matcap, Projection, Shading, Theme, ViewScene};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3};

/// Half width of wireframe lines in points (by eye).
const WIRE_HALF_WIDTH: f32 = 0.55;
/// The ground reaches this many radii of the bounds from their center; the camera's depth range holds it.
const GRID_RADII: f32 = 4.0;
/// The ground lies this part of the radius under the floor, so that flat bottoms do not flicker.
const GRID_DROP: f32 = 0.003;
/// Every this many lines a stronger one.
const MAJOR: f32 = 10.0;
/// Smallest distance in front of the eye, in distances to the target: marks behind it are not drawn.
const NEAREST: f32 = 1e-3;
/// How much a surface that is seen through hides where one looks straight at it (by eye).
const THROUGH: f32 = 0.16;

/// The uniforms as the shaders read them (`Picture` in common.wgsl, with the meaning of each number).
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct Picture {
    view_from_world: [f32; 16],
    clip_from_view: [f32; 16],
    viewport: [f32; 4],
    modes: [f32; 4],
    look: [f32; 4],
    light: Light,
    grid: [f32; 4],
    grid_extent: [f32; 4],
}

/// A theme's colors and lamps.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Light {
    background_top: [f32; 4],
    background_bottom: [f32; 4],
    back_tint: [f32; 4],
    accent: [f32; 4],
    key: [f32; 4],
    fill: [f32; 4],
    sky: [f32; 4],
    ground: [f32; 4],
    rim: [f32; 4],
    flaw: [f32; 4],
    wire: [f32; 4],
    grid_color: [f32; 4],
}

impl Picture {
    /// The uniforms of a scene drawn at this size in physical pixels, with the ground under the box `ground`.
    pub(super) fn new(scene: &ViewScene, size_px: [u32; 2], ground: (Vec3, Vec3)) -> Picture {
        let camera = &scene.camera;
        let size = Vec2::new(size_px[0] as f32, size_px[1] as f32);
        let density = if scene.pixels_per_point > 0.0 { scene.pixels_per_point } else { 1.0 };
        // View space is measured in distances to the target, see common.wgsl.
        let to_unit = Mat4::from_scale(Vec3::splat(camera.distance.recip()));
        let from_unit = Mat4::from_scale(Vec3::splat(camera.distance));
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let has_normals = scene.frame.normals.len() == scene.frame.positions.len();
        let reach = (scene.bounds.0.min(ground.0), scene.bounds.1.max(ground.1));
        let (grid, grid_extent) = grid(ground);
        Picture {
            view_from_world: (to_unit * camera.view_from_world()).to_cols_array(),
            clip_from_view: (camera.clip_from_view(size, reach) * from_unit).to_cols_array(),
            viewport: [size.x, size.y, density, camera.focal_px(size)],
            modes: [
                flag(camera.projection == Projection::Orthographic),
                flag(scene.shading == Shading::Flat || !has_normals),
                WIRE_HALF_WIDTH * density,
                NEAREST,
            ],
            look: [
                if scene.see_through { THROUGH } else { 1.0 },
                matcap(scene.shading),
                if scene.coloring == Coloring::Plain { 0.0 } else { scene.color_opacity.clamp(0.0, 1.0) },
                0.0,
            ],
            light: light(scene.theme),
            grid,
            grid_extent,
        }
    }
}

/// The number of a painted ball in the shaders; 0 for lamps.
fn matcap(shading: Shading) -> f32 {
    match shading {
        Shading::Smooth | Shading::Flat => 0.0,
        Shading::Matcap(Matcap::Clay) => 1.0,
        Shading::Matcap(Matcap::Porcelain) => 2.0,
        Shading::Matcap(Matcap::Metal) => 3.0,
        Shading::Matcap(Matcap::Stripes) => 4.0,
    }
}

/// Center and cell size, then reach and phase of the ground grid. Cells are 1, 2 or 5 times a power of ten; lines stay where they
/// are in the world while the bounds move.
fn grid(bounds: (Vec3, Vec3)) -> ([f32; 4], [f32; 4]) {
    let (center, radius) = sphere(bounds.0, bounds.1);
    let floor = if bounds.0.y.is_finite() { bounds.0.y } else { center.y - radius } - radius * GRID_DROP;
    let wanted = radius * 0.2;
    let power = 10_f32.powf(wanted.log10().floor());
    let cell = [5.0, 2.0, 1.0].into_iter().map(|step| step * power).find(|cell| *cell <= wanted).unwrap_or(power);
    let phase = |along: f32| (along / cell).rem_euclid(MAJOR);
    ([center.x, floor, center.z, cell], [radius * GRID_RADII, phase(center.x), phase(center.z), 0.0])
}

/// Colors and lamps of a theme. All by eye; selection is green, which neither ramp contains.
fn light(theme: Theme) -> Light {
    let encoded =
        |[r, g, b]: [u8; 3], alpha: f32| [f32::from(r) / 255.0, f32::from(g) / 255.0, f32::from(b) / 255.0, alpha];
    let lit = |srgb: [u8; 3], strength: f32| linear(srgb).extend(strength).to_array();
    let lamp = |srgb: [u8; 3], strength: f32| (linear(srgb) * strength).extend(1.0).to_array();
    match theme {
        Theme::Dark => Light {
            background_top: encoded([58, 62, 70], 1.0),
            background_bottom: encoded([25, 27, 31], 1.0),
            back_tint: lit([150, 84, 64], 0.7),
            accent: lit([52, 222, 160], 0.75),
            key: lamp([255, 246, 234], 0.98),
            fill: lamp([176, 202, 255], 0.17),
            sky: lamp([222, 232, 255], 0.20),
            ground: lamp([168, 142, 126], 0.16),
            rim: lamp([214, 226, 255], 0.50),
            flaw: lit([255, 48, 150], 1.0),
            wire: encoded([14, 16, 20], 0.55),
            grid_color: encoded([220, 228, 240], 0.16),
        },
        Theme::Light => Light {
            background_top: encoded([246, 248, 250], 1.0),
            background_bottom: encoded([208, 213, 221], 1.0),
            back_tint: lit([176, 104, 82], 0.7),
            accent: lit([20, 186, 130], 0.75),
            key: lamp([255, 248, 238], 0.96),
            fill: lamp([190, 208, 250], 0.17),
            sky: lamp([226, 234, 255], 0.24),
            ground: lamp([178, 158, 146], 0.20),
            rim: lamp([235, 242, 255], 0.18),
            flaw: lit([255, 20, 130], 1.0),
            wire: encoded([28, 32, 40], 0.55),
            grid_color: encoded([40, 48, 62], 0.20),
        },
    }
}
