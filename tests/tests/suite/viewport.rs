//! What the picture promises, measured on pixels drawn by whatever adapter there is, the software one included.

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
    ViewScene {
        triangles: triangles.into(),
        rigidity: vec![1; positions.len()].into(),
        frame: Arc::new(SurfaceFrame { positions, normals }),
        values: None,
        selected: None,
        base_colors: None,
        dots: Arc::new([]),
        lines: Arc::new([]),
        coloring: Coloring::Plain,
        ramp_max: 6,
        color_opacity: 1.0,
        shading: Shading::Smooth,
        wireframe: false,
        grid: false,
        theme: Theme::Dark,
        camera,
        bounds,
        pixels_per_point: 1.0,
    }
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

#[test]
fn a_ball_has_a_bright_and_a_dark_side() {
    for theme in [Theme::Dark, Theme::Light] {
        let scene = ViewScene { theme, ..ball(32, 1.0) };
        let picture = draw(&scene);
        let lit = brightness(at(&picture, &scene, Vec3::new(-0.4, 0.5, 0.77)));
        let shaded = brightness(at(&picture, &scene, Vec3::new(0.4, -0.7, 0.59)));
        assert!(lit > shaded + 60.0, "{theme:?}: lit {lit}, shaded {shaded}");
        assert!(lit < 254.0 && shaded > 20.0, "{theme:?}: neither burnt out nor black: lit {lit}, shaded {shaded}");
    }
}

#[test]
fn the_surface_stands_out_from_the_background() {
    for theme in [Theme::Dark, Theme::Light] {
        let scene = ViewScene { theme, ..ball(32, 1.0) };
        let picture = draw(&scene);
        let lit = at(&picture, &scene, Vec3::new(-0.4, 0.5, 0.77));
        let beside = pixel(&picture, 5, SIZE[1] / 2);
        assert!(difference(lit, beside) > 15.0, "{theme:?}: surface {lit:?}, background {beside:?}");
    }
}

#[test]
fn the_background_is_a_quiet_vertical_gradient() {
    let mut means = Vec::new();
    for theme in [Theme::Dark, Theme::Light] {
        let picture = draw(&ViewScene { theme, ..ball(8, 1.0) });
        let column: Vec<f32> = (0..SIZE[1]).map(|y| brightness(pixel(&picture, 3, y))).collect();
        let (top, bottom) = (column[0], column[column.len() - 1]);
        assert!(top > bottom + 10.0, "{theme:?}: from {top} to {bottom}");
        for (y, pair) in column.windows(2).enumerate() {
            assert!((pair[0] - pair[1]).abs() <= 2.0, "{theme:?}: a step at row {y}: {pair:?}");
        }
        let (left, right) = (pixel(&picture, 0, 40), pixel(&picture, SIZE[0] - 1, 40));
        assert!(difference(left, right) <= 1.0, "{theme:?}: rows are even: {left:?}, {right:?}");
        means.push(column.iter().sum::<f32>() / column.len() as f32);
    }
    assert!(means[0] < 80.0 && means[1] > 190.0, "dark {}, light {}", means[0], means[1]);
}

#[test]
fn facets_show_only_in_flat_shading() {
    let smooth = ball(8, 1.0);
    let flat = ViewScene { shading: Shading::Flat, ..smooth.clone() };
    let (smooth_picture, flat_picture) = (draw(&smooth), draw(&flat));
    let changed = differing(&smooth_picture, &flat_picture, 6);
    assert!(changed > 2000, "{changed} pixels differ");
    // Across the edge between two quads below the equator: light jumps between facets, and does not on the smooth ball.
    let jump = |picture: &RgbaImage| {
        let row: Vec<f32> = (78..122).map(|x| brightness(pixel(picture, x, 90))).collect();
        row.windows(2).map(|pair| (pair[0] - pair[1]).abs()).fold(0.0, f32::max)
    };
    let (smooth_jump, flat_jump) = (jump(&smooth_picture), jump(&flat_picture));
    assert!(flat_jump > 8.0 && smooth_jump < 6.0, "largest step: flat {flat_jump}, smooth {smooth_jump}");
}

#[test]
fn missing_normals_mean_flat_shading() {
    let mut scene = ball(8, 1.0);
    let flat = draw(&ViewScene { shading: Shading::Flat, ..scene.clone() });
    scene.frame = Arc::new(SurfaceFrame { positions: scene.frame.positions.clone(), normals: Vec::new() });
    assert_eq!(differing(&draw(&scene), &flat, 1), 0);
}

#[test]
fn soft_is_blue_and_stiff_is_red() {
    let mut scene = ball(32, 1.0);
    scene.coloring = Coloring::Rigidity;
    scene.rigidity = scene.frame.positions.iter().map(|p| if p.x > 0.0 { 6 } else { 1 }).collect();
    let (left, right) = (Vec3::new(-0.5, 0.3, 0.81), Vec3::new(0.5, 0.3, 0.81));
    let picture = draw(&scene);
    let ([soft_r, _, soft_b], [stiff_r, _, stiff_b]) = (at(&picture, &scene, left), at(&picture, &scene, right));
    assert!(soft_b > soft_r + 60.0, "soft: red {soft_r}, blue {soft_b}");
    assert!(stiff_r > stiff_b + 60.0, "stiff: red {stiff_r}, blue {stiff_b}");

    scene.color_opacity = 0.0;
    let plain = draw(&ViewScene { coloring: Coloring::Plain, ..scene.clone() });
    assert_eq!(differing(&draw(&scene), &plain, 1), 0, "a transparent ramp is the plain surface");
}

#[test]
fn energy_goes_from_dark_to_light() {
    let mut scene = ball(32, 1.0);
    scene.coloring = Coloring::Energy;
    scene.values = Some(scene.frame.positions.iter().map(|p| if p.x > 0.0 { 1.0 } else { 0.0 }).collect());
    let picture = draw(&scene);
    let [calm, loud] = [-0.3, 0.3].map(|x| brightness(at(&picture, &scene, Vec3::new(x, 0.3, 0.9))));
    assert!(loud > calm + 60.0, "energy 0: {calm}, energy 1: {loud}");
}

#[test]
fn selected_vertices_are_tinted_in_stripes() {
    let mut scene = ball(32, 1.0);
    let plain = draw(&scene);
    scene.selected = Some(scene.frame.positions.iter().map(|p| p.x > 0.0).collect());
    let picture = draw(&scene);
    let outside = Vec3::new(-0.4, 0.3, 0.87);
    assert_eq!(at(&picture, &scene, outside), at(&plain, &scene, outside));
    // Across a patch of the selected half: green everywhere, more and less.
    let greenness = |x| {
        let [r, g, b] = pixel(&picture, x, 62);
        g - 0.5 * (r + b)
    };
    let (least, most) =
        (108..132).map(greenness).fold((f32::MAX, f32::MIN), |(least, most), g| (least.min(g), most.max(g)));
    assert!(least > 5.0 && most > least + 25.0, "greenness between {least} and {most}");
}

#[test]
fn an_inside_out_surface_looks_different() {
    let mut scene = ball(32, 1.0);
    let [r, _, b] = at(&draw(&scene), &scene, Vec3::Z);
    assert!((r - b).abs() < 25.0, "outside: red {r}, blue {b}");
    scene.triangles = scene.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    let normals = scene.frame.normals.iter().map(|normal| -*normal).collect();
    scene.frame = Arc::new(SurfaceFrame { positions: scene.frame.positions.clone(), normals });
    let [r, _, b] = at(&draw(&scene), &scene, Vec3::Z);
    assert!(r > b + 25.0, "inside: red {r}, blue {b}");
}

#[test]
fn dots_are_full_in_front_and_dimmed_behind() {
    let plain = ball(32, 1.0);
    // Not exactly opposite, so that they are apart on screen.
    let (front, back) = (Vec3::new(-0.3, 0.2, 0.93), Vec3::new(0.3, -0.2, -0.93));
    let dots: Arc<[Dot]> = [front, back].map(|position| Dot { position, color: YELLOW, radius_px: 5.0 }).into();
    let scene = ViewScene { dots, ..plain.clone() };
    let (without, with) = (draw(&plain), draw(&scene));
    let yellow = [255.0, 210.0, 40.0];
    let seen = at(&with, &scene, front);
    assert!(difference(seen, yellow) <= 2.0, "in front: {seen:?}");
    let (under, dimmed) = (at(&without, &scene, back), at(&with, &scene, back));
    for channel in 0..3 {
        let expected = under[channel] + 0.3 * (yellow[channel] - under[channel]);
        assert!(
            (dimmed[channel] - expected).abs() <= 3.0,
            "behind, channel {channel}: {}, expected {expected}",
            dimmed[channel]
        );
    }
}

#[test]
fn dots_keep_their_size_on_screen_and_follow_pixel_density() {
    let count = |scene: &ViewScene| draw(scene).pixels().filter(|px| px.0[0] > 200 && px.0[2] < 90).count();
    let dot = |position| -> Arc<[Dot]> { [Dot { position, color: YELLOW, radius_px: 6.0 }].into() };
    let near = ViewScene { dots: dot(Vec3::new(0.0, 0.0, 1.0)), ..ball(32, 1.0) };
    let far = ViewScene { dots: dot(Vec3::new(2.3, 0.0, -3.0)), ..ball(32, 1.0) };
    let dense = ViewScene { pixels_per_point: 2.0, ..near.clone() };
    let (near, far, dense) = (count(&near), count(&far), count(&dense));
    // A disc of radius 6 covers π·36 = 113 pixels, one of radius 12 four times as many; edge pixels are blended.
    assert!((85..=125).contains(&near), "near: {near} pixels");
    assert!(near.abs_diff(far) <= 8, "near {near}, far {far} pixels");
    assert!((400..=470).contains(&dense), "at twice the density: {dense} pixels");
}

#[test]
fn wireframe_draws_lines_and_leaves_the_rest() {
    for theme in [Theme::Dark, Theme::Light] {
        let plain = ViewScene { theme, ..ball(8, 1.0) };
        let wired = ViewScene { wireframe: true, ..plain.clone() };
        let (without, with) = (draw(&plain), draw(&wired));
        let changed = differing(&without, &with, 12);
        let disc = differing(&without, &draw(&ViewScene { triangles: Arc::new([]), ..plain.clone() }), 12);
        assert!(changed * 20 > disc && changed * 2 < disc, "{theme:?}: {changed} of {disc} pixels changed");
        let darker = without.pixels().zip(with.pixels()).all(|(a, b)| b.0[1] <= a.0[1].saturating_add(2));
        assert!(darker, "{theme:?}: lines only darken");
    }
}

#[test]
fn lines_on_top_show_through_the_surface() {
    let red = [230, 40, 40, 255];
    let line = |y: f32, on_top| Line {
        a: Vec3::new(-0.5, y, 0.0),
        b: Vec3::new(0.5, y, 0.0),
        color: red,
        width_px: 5.0,
        on_top,
    };
    let scene = ViewScene { lines: [line(0.3, true), line(-0.3, false)].into(), ..ball(32, 1.0) };
    let picture = draw(&scene);
    let (shown, hidden) = (at(&picture, &scene, Vec3::Y * 0.3), at(&picture, &scene, Vec3::Y * -0.3));
    assert!(difference(shown, [230.0, 40.0, 40.0]) <= 2.0, "on top: {shown:?}");
    assert!((hidden[0] - hidden[2]).abs() < 30.0, "inside the ball: {hidden:?}");
}

#[test]
fn lines_reach_from_before_to_behind_the_eye() {
    let mut scene = ball(32, 1.0);
    let below = scene.camera.eye() - Vec3::Y * 0.2;
    scene.lines =
        [Line { a: below - Vec3::Z * 3.0, b: below + Vec3::Z * 50.0, color: YELLOW, width_px: 3.0, on_top: true }]
            .into();
    let picture = draw(&scene);
    let [r, _, b] = pixel(&picture, SIZE[0] / 2, SIZE[1] - 2);
    assert!(r > 240.0 && b < 60.0, "the line leaves the picture below: red {r}, blue {b}");
    let [r, _, b] = pixel(&picture, SIZE[0] / 2, 2);
    assert!(r - b < 30.0, "and does not come back from above: red {r}, blue {b}");
}

#[test]
fn orthographic_size_does_not_depend_on_depth() {
    let bar = |z: f32| -> Arc<[Line]> {
        [Line { a: Vec3::new(-0.4, 0.0, z), b: Vec3::new(0.4, 0.0, z), color: YELLOW, width_px: 2.0, on_top: true }]
            .into()
    };
    let width = |projection, z| {
        let mut scene = ViewScene { lines: bar(z), ..ball(8, 1.0) };
        scene.camera.projection = projection;
        draw(&scene).pixels().filter(|px| px.0[0] > 240 && px.0[2] < 60).count()
    };
    let [near, far] = [1.0, -3.0].map(|z| width(Projection::Orthographic, z));
    assert!(near > 25 && near.abs_diff(far) <= 2, "orthographic: near {near}, far {far} pixels");
    let [near, far] = [1.0, -3.0].map(|z| width(Projection::Perspective, z));
    assert!(near * 10 > far * 13, "perspective: near {near}, far {far} pixels");
}

#[test]
fn the_grid_lies_on_the_ground_and_fades_out() {
    let mut bare = ball(32, 1.0);
    bare.camera.orbit(Vec2::new(60.0, 60.0));
    let grid = ViewScene { grid: true, ..bare.clone() };
    let (without, with) = (draw(&bare), draw(&grid));
    let changed = differing(&without, &with, 3);
    assert!(changed > 300, "{changed} pixels show lines");
    let ball_center = bare.bounds.1 * Vec3::Y * 0.5;
    assert_eq!(at(&with, &grid, ball_center), at(&without, &grid, ball_center), "the surface hides the ground");
    assert_eq!(pixel(&with, 2, 2), pixel(&without, 2, 2), "nothing in the distance");
}

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
