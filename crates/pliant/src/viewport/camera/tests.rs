//! What the camera promises, for scenes from 1e-6 to 1e6 in size.

use super::*;

const SIZE: Vec2 = Vec2::new(1020.0, 775.0);
const SCENES: [f32; 5] = [1e-6, 1e-3, 1.0, 1e3, 1e6];
/// A few roundings of f32 in numbers of a thousand pixels: 1000 · 2⁻²³ · 64.
const PX_TOLERANCE: f32 = 0.01;

/// Cameras of every kind around a box of this size: both projections, odd angles, poles, before and after pan and zoom.
fn cameras(scale: f32) -> Vec<Camera> {
    let mut cameras = Vec::new();
    for projection in [Projection::Perspective, Projection::Orthographic] {
        for (yaw, pitch) in [(0.0, 0.0), (0.6, -0.4), (2.9, 1.2), (-1.0, FRAC_PI_2), (0.3, -FRAC_PI_2)] {
            let mut camera = Camera::framing(Vec3::splat(-scale), Vec3::new(2.0, 1.0, 0.5) * scale);
            camera.projection = projection;
            camera.orientation = turntable(yaw, pitch);
            camera.frame(Vec3::splat(-scale), Vec3::new(2.0, 1.0, 0.5) * scale);
            cameras.push(camera);
            camera.pan(Vec2::new(120.0, -45.0), SIZE);
            camera.zoom(3.0, Vec2::new(300.0, 700.0), SIZE);
            cameras.push(camera);
        }
    }
    cameras
}

fn check_px(camera: &Camera, what: &str, got: Vec2, expected: Vec2) {
    assert!(got.distance(expected) < PX_TOLERANCE, "{what}: got {got}, expected {expected}, {camera:?}");
}

#[test]
fn ray_and_project_are_inverses() {
    for camera in SCENES.into_iter().flat_map(cameras) {
        for px in [Vec2::ZERO, SIZE * 0.5, SIZE, Vec2::new(17.0, 600.0), Vec2::new(-40.0, 900.0)] {
            let ray = camera.ray(px, SIZE);
            assert!((ray.direction.length() - 1.0).abs() < 1e-5, "direction {:?}", ray.direction);
            let start = (camera.eye() - ray.origin).dot(ray.direction);
            for along in [0.2, 1.0, 3.0] {
                let point = ray.origin + ray.direction * (start + camera.distance * along);
                let (back, depth) = camera.project(point, SIZE).expect("in front of the eye");
                // The orthographic ray starts 200 distances away: its origin is rounded that much more coarsely.
                let slack = if camera.projection == Projection::Orthographic { 20.0 } else { 1.0 };
                assert!(back.distance(px) < PX_TOLERANCE * slack, "got {back}, expected {px}, {camera:?}");
                assert!(depth > 0.0);
            }
        }
    }
}

#[test]
fn rays_start_where_the_picture_begins() {
    for camera in SCENES.into_iter().flat_map(cameras) {
        // A model so large, against the distance, that the picture cannot hold all of it: one has zoomed in.
        let half = camera.distance * 1e3;
        let clip = camera.clip_from_world(SIZE, (camera.target - half, camera.target + half));
        for px in [SIZE * 0.5, Vec2::new(17.0, 600.0), SIZE] {
            let ray = camera.ray(px, SIZE);
            // In camera depths; a thousandth is far more than the rounding of a ray from 200 distances away.
            let step = (ray.origin - camera.eye()).dot(camera.forward()).abs() * 1e-3;
            let depth = |along: f32| clip.project_point3(ray.origin + ray.direction * along).z;
            assert!(depth(2.0 * step) <= 1.0, "the ray starts too early: {} at {px}, {camera:?}", depth(2.0 * step));
            assert!(depth(-2.0 * step) > 1.0, "the ray starts too late: {} at {px}, {camera:?}", depth(-2.0 * step));
        }
    }
}

#[test]
fn a_model_nearer_than_the_orthographic_view_leaves_a_depth_range() {
    let mut camera = Camera::framing(Vec3::NEG_ONE, Vec3::ONE);
    camera.projection = Projection::Orthographic;
    camera.target += camera.forward() * camera.distance * 1e4;
    assert!(camera.clip_from_world(SIZE, (Vec3::NEG_ONE, Vec3::ONE)).is_finite(), "{camera:?}");
}

#[test]
fn the_matrix_agrees_with_project() {
    for camera in SCENES.into_iter().flat_map(cameras) {
        let scale = camera.distance;
        let bounds = (camera.target - scale * 0.3, camera.target + scale * 0.3);
        for offset in [Vec3::ZERO, Vec3::new(0.1, 0.2, -0.1), Vec3::new(-0.3, 0.1, 0.2)] {
            let world = camera.target + offset * scale;
            let ndc = camera.clip_from_world(SIZE, bounds).project_point3(world);
            let px = (Vec2::new(ndc.x, -ndc.y) * 0.5 + 0.5) * SIZE;
            check_px(&camera, "matrix", px, camera.project(world, SIZE).expect("in front").0);
            assert!((0.0..=1.0).contains(&ndc.z), "depth {} of {world} outside the range, {camera:?}", ndc.z);
        }
    }
}

#[test]
fn nearer_has_the_greater_depth_value() {
    for camera in SCENES.into_iter().flat_map(cameras) {
        let bounds = (camera.target - camera.distance * 0.3, camera.target + camera.distance * 0.3);
        let clip = camera.clip_from_world(SIZE, bounds);
        let depth = |along: f32| clip.project_point3(camera.target + camera.forward() * along * camera.distance).z;
        assert!(depth(-0.001) > depth(0.0) && depth(0.0) > depth(0.001), "{camera:?}");
    }
}

#[test]
fn zoom_keeps_the_point_under_the_pointer() {
    for mut camera in SCENES.into_iter().flat_map(cameras) {
        for (factor, px) in
            [(1.25, Vec2::new(80.0, 60.0)), (0.5, Vec2::new(900.0, 400.0)), (7.0, Vec2::new(500.0, 770.0))]
        {
            let world = camera.target + camera.drag_in_view_plane(camera.target, px - SIZE * 0.5, SIZE);
            let before = camera.distance;
            camera.zoom(factor, px, SIZE);
            assert!((camera.distance * factor / before - 1.0).abs() < 1e-5);
            check_px(&camera, "zoom", camera.project(world, SIZE).expect("in front").0, px);
        }
    }
}

#[test]
fn zoom_survives_nonsense() {
    let mut camera = Camera::framing(Vec3::NEG_ONE, Vec3::ONE);
    let before = camera;
    for factor in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        camera.zoom(factor, SIZE * 0.3, SIZE);
        assert_eq!(camera, before, "factor {factor}");
    }
    for _ in 0..1000 {
        camera.zoom(10.0, SIZE * 0.5, SIZE);
    }
    for _ in 0..2000 {
        camera.zoom(0.1, SIZE * 0.5, SIZE);
    }
    assert!(camera.distance.is_finite() && camera.target.is_finite(), "{camera:?}");
}

#[test]
fn pan_keeps_the_point_at_target_depth_under_the_pointer() {
    for mut camera in SCENES.into_iter().flat_map(cameras) {
        let (from, to) = (Vec2::new(400.0, 300.0), Vec2::new(555.0, 211.0));
        let world = camera.target + camera.drag_in_view_plane(camera.target, from - SIZE * 0.5, SIZE);
        camera.pan(to - from, SIZE);
        check_px(&camera, "pan", camera.project(world, SIZE).expect("in front").0, to);
    }
}

#[test]
fn a_dragged_point_follows_the_pointer_at_its_own_depth() {
    for camera in SCENES.into_iter().flat_map(cameras) {
        let point = camera.target + (camera.forward() * 0.3 + camera.right() * 0.1) * camera.distance;
        let delta = Vec2::new(-33.0, 71.0);
        let from = camera.project(point, SIZE).expect("in front").0;
        let to = camera.project(point + camera.drag_in_view_plane(point, delta, SIZE), SIZE).expect("in front").0;
        check_px(&camera, "drag", to, from + delta);
    }
}

#[test]
fn framing_shows_the_whole_box_with_margin() {
    let boxes = [Vec3::ONE, Vec3::new(7.5, 1.0, 1.0), Vec3::new(0.0, 3.0, 0.0), Vec3::new(2.0, 0.0, 1.0)];
    for scale in SCENES {
        for half in boxes {
            for (index, mut camera) in cameras(scale).into_iter().enumerate() {
                let center = Vec3::new(0.3, -0.2, 0.5) * scale;
                camera.frame(center - half * scale, center + half * scale);
                for size in [SIZE, Vec2::new(300.0, 900.0)] {
                    let mut widest: f32 = 0.0;
                    for corner in corners(half * scale) {
                        let (px, _) = camera.project(center + corner, size).expect("in front");
                        let from_center = (px - size * 0.5).abs() / size;
                        widest = widest.max((px - size * 0.5).abs().max_element() / size.min_element());
                        assert!(
                            from_center.max_element() <= 0.5 * (1.0 - MARGIN) + 1e-3,
                            "camera {index}, box {half}, corner at {px}"
                        );
                    }
                    let seen_end_on = half.min_element() == 0.0;
                    assert!(
                        seen_end_on || widest > 0.2,
                        "camera {index}: the box {half} takes only {widest} of the view"
                    );
                }
            }
        }
    }
}

#[test]
fn framing_nothing_still_looks_somewhere() {
    let nan = Vec3::splat(f32::NAN);
    let empty = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    for (min, max) in [(Vec3::ZERO, Vec3::ZERO), (Vec3::splat(5.0), Vec3::splat(5.0)), (nan, nan), empty] {
        let camera = Camera::framing(min, max);
        assert!(
            camera.distance > 0.0 && camera.distance.is_finite() && camera.target.is_finite(),
            "{min} {max}: {camera:?}"
        );
        assert!(camera.clip_from_world(SIZE, (min, max)).is_finite());
        assert!(camera.clip_from_world(Vec2::ZERO, (min, max)).is_finite(), "a viewport without a size");
    }
}

#[test]
fn orbit_never_rolls_and_stops_at_the_poles() {
    let mut camera = Camera::framing(Vec3::NEG_ONE, Vec3::ONE);
    for step in 0..5000 {
        let turn = Vec2::new((step as f32 * 0.7).sin() * 40.0, (step as f32 * 0.11).cos() * 60.0);
        camera.orbit(turn);
        assert!(camera.right().y.abs() < 1e-5, "step {step}: rolled by {}", camera.right().y);
        assert!(camera.up().y > -1e-5, "step {step}: upside down");
        assert!((camera.orientation.length() - 1.0).abs() < 1e-5);
        assert!(camera.orientation.is_finite());
    }
    camera.orbit(Vec2::new(0.0, 1e5));
    assert!((camera.forward() - Vec3::NEG_Y).length() < 1e-3, "top view, got {}", camera.forward());
    let (top, yaw) = (camera.right(), Vec2::new(225.0, 0.0));
    camera.orbit(yaw);
    assert!(camera.right().dot(top).abs() < 1e-3, "a quarter turn at the pole turns the picture");
}

#[test]
fn dragging_right_turns_the_near_side_right() {
    let mut camera = Camera::framing(Vec3::NEG_ONE, Vec3::ONE);
    camera.look_along(Axis::Front);
    let near_side = Vec3::Z * 0.5;
    let before = camera.project(near_side, SIZE).expect("in front").0;
    camera.orbit(Vec2::new(20.0, 20.0));
    let after = camera.project(near_side, SIZE).expect("in front").0;
    assert!(after.x > before.x && after.y > before.y, "from {before} to {after}");
}

#[test]
fn axis_views_look_at_the_named_side() {
    let mut camera = Camera::framing(Vec3::NEG_ONE, Vec3::ONE);
    let sides = [
        (Axis::Front, Vec3::Z, Vec3::Y),
        (Axis::Back, Vec3::NEG_Z, Vec3::Y),
        (Axis::Right, Vec3::X, Vec3::Y),
        (Axis::Left, Vec3::NEG_X, Vec3::Y),
        (Axis::Top, Vec3::Y, Vec3::NEG_Z),
        (Axis::Bottom, Vec3::NEG_Y, Vec3::Z),
    ];
    for (axis, toward_eye, up) in sides {
        camera.look_along(axis);
        assert!((camera.forward() + toward_eye).length() < 1e-5, "{axis:?}: forward {}", camera.forward());
        assert!((camera.up() - up).length() < 1e-5, "{axis:?}: up {}", camera.up());
    }
}

#[test]
fn switching_projection_keeps_the_size_at_the_target() {
    for mut camera in SCENES.into_iter().flat_map(cameras) {
        let point = camera.target + (camera.right() * 0.2 - camera.up() * 0.1) * camera.distance;
        let before = camera.project(point, SIZE).expect("in front").0;
        camera.projection = match camera.projection {
            Projection::Perspective => Projection::Orthographic,
            Projection::Orthographic => Projection::Perspective,
        };
        check_px(&camera, "projection", camera.project(point, SIZE).expect("in front").0, before);
    }
}
