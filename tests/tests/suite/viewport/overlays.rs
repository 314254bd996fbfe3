//! What is drawn over and under the surface, and how large.

use super::*;

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
