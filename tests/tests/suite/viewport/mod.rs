//! What the picture promises, measured on pixels drawn by whatever adapter there is, the software one included.

mod overlays;
mod renderer;
mod surface;
mod uploads;
mod views;

use glam::{Vec2, Vec3};
use image::RgbaImage;
use pliant::viewport::*;
use std::f32::consts::{PI, TAU};
use std::sync::{Arc, LazyLock, Mutex};

/// Odd on purpose: rows are no multiple of the alignment copies need.
const SIZE: [u32; 2] = [201, 151];
const YELLOW: [u8; 4] = [255, 210, 40, 255];

/// One device for all tests; its error says how to get an adapter.
fn headless() -> &'static Headless {
    static HEADLESS: LazyLock<Result<Headless, GpuError>> = LazyLock::new(Headless::new);
    match &*HEADLESS {
        Ok(headless) => headless,
        Err(error) => panic!("image tests need a graphics adapter. {error}"),
    }
}

/// A picture with four samples. All tests share one renderer: compiling its programs takes longer than drawing.
fn draw(scene: &ViewScene) -> RgbaImage {
    static RENDERER: LazyLock<Mutex<Renderer>> =
        LazyLock::new(|| Mutex::new(Renderer::new(&headless().device, &headless().queue, 4)));
    let mut renderer = RENDERER.lock().expect("no test failed while drawing");
    renderer.render(scene, SIZE);
    let picture = renderer.try_read_pixels().expect("the picture can be read");
    assert_eq!(picture.dimensions(), (SIZE[0], SIZE[1]));
    picture
}

/// A ball of radius 1 times `scale` seen from the front, without grid.
fn ball(steps: u32, scale: f32) -> ViewScene {
    let around = 2 * steps;
    let point = |ring: u32, step: u32| {
        let (down, turn) = (PI * ring as f32 / steps as f32, TAU * step as f32 / around as f32);
        Vec3::new(down.sin() * turn.sin(), down.cos(), down.sin() * turn.cos())
    };
    let normals: Vec<Vec3> = (0..=steps).flat_map(|ring| (0..around).map(move |step| point(ring, step))).collect();
    let corner = |ring: u32, step: u32| ring * around + step % around;
    let quads = (0..steps).flat_map(|ring| (0..around).map(move |step| (ring, step)));
    let triangles: Vec<[u32; 3]> = quads
        .flat_map(|(ring, step)| {
            let [a, b] = [corner(ring, step), corner(ring, step + 1)];
            let [c, d] = [corner(ring + 1, step), corner(ring + 1, step + 1)];
            [[a, c, d], [a, d, b]]
        })
        .collect();
    let positions: Vec<Vec3> = normals.iter().map(|normal| *normal * scale).collect();
    let bounds = (Vec3::splat(-scale), Vec3::splat(scale));
    let mut camera = Camera::framing(bounds.0, bounds.1);
    camera.look_along(Axis::Front);
    let frame = Arc::new(SurfaceFrame { positions, normals });
    ViewScene::plain(triangles.into(), frame, camera, bounds)
}

/// Color of the pixel that shows this world point.
fn at(picture: &RgbaImage, scene: &ViewScene, world: Vec3) -> [f32; 3] {
    let size = Vec2::new(SIZE[0] as f32, SIZE[1] as f32);
    let (px, _) = scene.camera.project(world, size).expect("the point is in front of the eye");
    pixel(picture, px.x as u32, px.y as u32)
}

fn pixel(picture: &RgbaImage, x: u32, y: u32) -> [f32; 3] {
    let [r, g, b, alpha] = picture.get_pixel(x, y).0.map(f32::from);
    assert_eq!(alpha, 255.0, "the picture is opaque at {x}, {y}");
    [r, g, b]
}

fn brightness([r, g, b]: [f32; 3]) -> f32 {
    (r + g + b) / 3.0
}

/// Largest difference of a channel.
fn difference(a: [f32; 3], b: [f32; 3]) -> f32 {
    a.into_iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// Pixels whose channels differ by more than `levels`.
fn differing(a: &RgbaImage, b: &RgbaImage, levels: u8) -> usize {
    let differs =
        |(a, b): &(&image::Rgba<u8>, &image::Rgba<u8>)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > levels);
    a.pixels().zip(b.pixels()).filter(differs).count()
}
