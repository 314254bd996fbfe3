//! What the renderer promises whatever it is given.

use super::*;

#[test]
fn tiny_and_huge_models_look_the_same() {
    let marked = |scale: f32| {
        let dots: Arc<[Dot]> =
            [Dot { position: Vec3::new(-0.3, 0.2, 0.93) * scale, color: YELLOW, radius_px: 5.0 }].into();
        let mut scene = ViewScene { dots, ..ball(16, scale) };
        scene.camera.orbit(Vec2::new(40.0, 30.0));
        scene
    };
    for shading in [Shading::Smooth, Shading::Flat] {
        let expected = draw(&ViewScene { shading, ..marked(1.0) });
        for scale in [1e-6, 1e-3, 1e3, 1e6] {
            let got = draw(&ViewScene { shading, ..marked(scale) });
            let differing = differing(&got, &expected, 4);
            // A pixel at an edge may fall to the other side by rounding.
            assert!(differing <= 30, "{shading:?}, scale {scale}: {differing} pixels differ");
        }
    }
}

#[test]
fn nothing_and_nonsense_draw_the_background() {
    let empty = ViewScene {
        triangles: Arc::new([]),
        frame: Arc::default(),
        rigidity: Arc::new([]),
        grid: true,
        ..ball(8, 1.0)
    };
    let nan = Vec3::splat(f32::NAN);
    let nowhere = ViewScene { bounds: (nan, nan), wireframe: true, ..empty.clone() };
    for scene in [empty, nowhere] {
        let picture = draw(&scene);
        assert!(difference(pixel(&picture, 4, 4), pixel(&picture, 150, 4)) <= 1.0);
    }
}

#[test]
fn a_renderer_draws_only_what_changed() {
    let Headless { device, queue, .. } = headless();
    let mut renderer = Renderer::new(device, queue, 1);
    let scene = ball(16, 1.0);
    let first = renderer.render(&scene, SIZE).1;
    let picture = renderer.read_pixels();
    assert_eq!(renderer.render(&scene.clone(), SIZE).1, first, "the same view");
    assert_eq!(renderer.read_pixels(), picture);

    let higher: Vec<Vec3> = scene.frame.positions.iter().map(|p| *p + Vec3::Y * 0.5).collect();
    let frame = Arc::new(SurfaceFrame { positions: higher, normals: scene.frame.normals.clone() });
    let moved = ViewScene { frame, ..scene.clone() };
    assert_eq!(renderer.render(&moved, SIZE).1, first, "new positions need no new view");
    let top = Vec3::Y * 1.4;
    let streamed = renderer.read_pixels();
    assert!(difference(at(&streamed, &scene, top), at(&picture, &scene, top)) > 30.0, "the surface followed");

    assert_ne!(renderer.render(&moved, [99, 98]).1, first, "a new size needs a new view");
    assert_eq!(renderer.read_pixels().dimensions(), (99, 98));
    renderer.render(&scene, SIZE);
    assert_eq!(differing(&renderer.read_pixels(), &picture, 0), 0, "and back");
}

#[test]
fn a_renderer_changes_to_another_mesh() {
    let Headless { device, queue, .. } = headless();
    let mut renderer = Renderer::new(device, queue, 4);
    for (steps, wireframe) in [(8, false), (40, true), (3, true), (16, false)] {
        let scene = ViewScene { wireframe, ..ball(steps, 1.0) };
        renderer.render(&scene, SIZE);
        assert_eq!(differing(&renderer.read_pixels(), &draw(&scene), 0), 0, "{steps} steps, wireframe {wireframe}");
    }
}

#[test]
fn four_samples_smooth_the_outline() {
    let Headless { device, queue, .. } = headless();
    let scene = ViewScene { color_opacity: 1.0, ..ball(32, 1.0) };
    let empty = ViewScene { triangles: Arc::new([]), ..scene.clone() };
    let mut renderer = Renderer::new(device, queue, 1);
    let mut blended = |samples: u32| {
        renderer.set_samples(samples);
        renderer.render(&empty, SIZE);
        let background = renderer.read_pixels();
        renderer.render(&scene, SIZE);
        let picture = renderer.read_pixels();
        // On the rows across the middle: pixels that are neither background nor full surface.
        (60..90)
            .flat_map(|y| (0..60).map(move |x| (x, y)))
            .filter(|(x, y)| {
                let apart = difference(pixel(&picture, *x, *y), pixel(&background, *x, *y));
                apart > 8.0 && apart < 50.0
            })
            .count()
    };
    let (one, four) = (blended(1), blended(4));
    assert!(four > one + 5, "blended pixels: {one} with one sample, {four} with four");
}

#[test]
fn one_picture_opens_its_own_device() {
    let scene = ball(8, 1.0);
    let picture =
        picture(&scene, [64, 48]).unwrap_or_else(|error| panic!("image tests need a graphics adapter. {error}"));
    assert_eq!(picture.dimensions(), (64, 48));
}
