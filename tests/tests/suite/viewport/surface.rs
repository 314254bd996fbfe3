//! How the surface is shaded and colored.

use super::*;

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
