use super::*;
use crate::viewport::{Axis, Camera};

fn view() -> View {
    View { camera: Camera::framing(Vec3::splat(-1.0), Vec3::splat(1.0)), size: Vec2::new(800.0, 600.0) }
}

fn gizmo(axes: DMat3, view: &View) -> Gizmo {
    Gizmo::new(Vec3::ZERO, axes, GizmoShown::All, view)
}

fn screen(p: Vec3, view: &View) -> Vec2 {
    view.camera.project(p, view.size).expect("in front of the eye").0
}

fn tilted() -> DMat3 {
    DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 0.4)
}

#[test]
fn dragging_an_arrow_moves_along_its_axis_by_what_the_pointer_covers() {
    let view = view();
    for axes in [DMat3::IDENTITY, tilted()] {
        let gizmo = gizmo(axes, &view);
        for axis in 0..3 {
            let unit = axes.col(axis).as_vec3();
            let (from, to) = (screen(unit * 0.1, &view), screen(unit * 0.4, &view));
            let part = GizmoPart::Move(axis);
            let change = gizmo.change(part, gizmo.measure(part, from, to, &view).expect("a way"));
            let expected = axes.col(axis) * 0.3;
            // Single precision rays over a scene of size 2.
            assert!(change.way.distance(expected) < 1e-4, "axis {axis}: {change:?}, expected {expected}");
        }
    }
}

#[test]
fn dragging_a_square_moves_in_its_plane_under_the_pointer() {
    let view = view();
    let gizmo = gizmo(tilted(), &view);
    for normal in 0..3 {
        let (u, v) = (tilted().col((normal + 1) % 3), tilted().col((normal + 2) % 3));
        let (start, end) = (u * 0.1 + v * 0.1, u * 0.3 - v * 0.2);
        let part = GizmoPart::MovePlane(normal);
        let (from, to) = (screen(start.as_vec3(), &view), screen(end.as_vec3(), &view));
        let change = gizmo.change(part, gizmo.measure(part, from, to, &view).expect("a way"));
        assert!(change.way.distance(end - start) < 1e-4, "normal {normal}: {change:?}, expected {}", end - start);
        assert!(change.way.dot(tilted().col(normal)).abs() < 1e-12, "normal {normal}: it left the plane");
    }
}

#[test]
fn turning_a_ring_a_quarter_turns_a_quarter() {
    let view = view();
    for axes in [DMat3::IDENTITY, tilted()] {
        let gizmo = gizmo(axes, &view);
        for axis in 0..3 {
            let (u, v) = (axes.col((axis + 1) % 3), axes.col((axis + 2) % 3));
            let (from, to) = (screen(u.as_vec3() * 0.2, &view), screen(v.as_vec3() * 0.2, &view));
            let part = GizmoPart::Rotate(axis);
            let change = gizmo.change(part, gizmo.measure(part, from, to, &view).expect("an angle"));
            let got = change.linear * u;
            assert!(got.distance(v) < 1e-3, "axis {axis}: {u} went to {got}, expected {v}");
        }
    }
}

#[test]
fn the_outer_ring_turns_as_the_pointer_does_on_screen() {
    let view = view();
    let gizmo = gizmo(tilted(), &view);
    let (right, up) = (view.camera.right(), view.camera.up());
    let (from, to) = (screen(right * 0.3, &view), screen(up * 0.3, &view));
    let angle = gizmo.measure(GizmoPart::RotateView, from, to, &view).expect("an angle").x;
    assert!((angle - std::f64::consts::FRAC_PI_2).abs() < 1e-4, "{angle}");
    let got = gizmo.change(GizmoPart::RotateView, DVec2::new(angle, 0.0)).linear * right.as_dvec3();
    assert!(got.distance(up.as_dvec3()) < 1e-4, "{right} went to {got}, expected {up}");
}

#[test]
fn a_ring_seen_edge_on_follows_the_pointer_from_every_side() {
    for look in [Axis::Front, Axis::Back, Axis::Right, Axis::Left, Axis::Top, Axis::Bottom] {
        for pitch_px in [-6.0, 0.0, 6.0] {
            let mut view = view();
            view.camera.look_along(look);
            view.camera.orbit(Vec2::new(0.0, pitch_px));
            let gizmo = gizmo(DMat3::IDENTITY, &view);
            for axis in 0..3 {
                let unit = Vec3::AXES[axis];
                let near = -view.camera.forward();
                if near.dot(unit).abs() > 0.15 {
                    continue;
                }
                let start = gizmo.on_ring((near - unit * near.dot(unit)).normalize());
                let end = glam::Quat::from_axis_angle(unit, 0.2) * start;
                let angle = gizmo.turn(unit, screen(start, &view), screen(end, &view), &view).expect("an angle");
                // The arc of 0.2 radians and its sine, and perspective over a ring that is small on screen.
                assert!((angle - 0.2).abs() < 0.04, "{look:?}, pitch {pitch_px}, axis {axis}: {angle}");
            }
        }
    }
}

#[test]
fn every_part_that_is_shown_can_be_taken_from_every_side_and_no_other() {
    let sides = [Vec2::ZERO, Vec2::new(200.0, 90.0), Vec2::new(-130.0, -170.0)];
    for (orbit, shown) in sides.into_iter().flat_map(|orbit| {
        [GizmoShown::All, GizmoShown::Move, GizmoShown::Turn, GizmoShown::Scale].map(|shown| (orbit, shown))
    }) {
        let mut view = view();
        view.camera.orbit(orbit);
        for axes in [DMat3::IDENTITY, tilted(), settings::view_axes(&view)] {
            let gizmo = Gizmo::new(Vec3::ZERO, axes, shown, &view);
            let parts = gizmo.parts(&view);
            assert!(!parts.is_empty());
            for part in parts {
                let middles = gizmo.strokes(part, &view).into_iter().map(|s| screen((s.a + s.b) * 0.5, &view));
                let is_taken = |px: Vec2| gizmo.hit(px, &view) == Some(part);
                assert!(middles.into_iter().any(is_taken), "{part:?} of {shown:?} cannot be taken, orbit {orbit}");
                let others = |other: GizmoPart| match shown {
                    GizmoShown::All => false,
                    GizmoShown::Move => other.turns() || other.scales(),
                    GizmoShown::Turn => !other.turns(),
                    GizmoShown::Scale => !other.scales(),
                };
                assert!(!others(part), "{part:?} is not part of {shown:?}");
            }
            assert_eq!(gizmo.hit(Vec2::new(5.0, 5.0), &view), None);
            assert_eq!(gizmo.hit(screen(Vec3::ZERO, &view), &view), None, "the middle is left to the handle");
        }
    }
}

#[test]
fn what_is_typed_is_exact_and_what_is_snapped_is_on_the_grid() {
    let view = view();
    let gizmo = gizmo(DMat3::IDENTITY, &view);
    let turned = gizmo.change(GizmoPart::Rotate(2), Gizmo::typed(GizmoPart::Rotate(2), 90.0, None));
    assert!((turned.linear * DVec3::X).distance(DVec3::Y) < 1e-15, "{turned:?}");
    let moved = gizmo.change(GizmoPart::Move(1), Gizmo::typed(GizmoPart::Move(1), -0.25, Some(DVec2::new(9.0, 0.0))));
    assert_eq!(moved.way, DVec3::new(0.0, -0.25, 0.0));
    let scaled = gizmo.change(GizmoPart::ScaleAxis(0), Gizmo::typed(GizmoPart::ScaleAxis(0), 2.0, None));
    assert_eq!(scaled.linear * DVec3::ONE, DVec3::new(2.0, 1.0, 1.0));
    let flat = gizmo.change(GizmoPart::Scale, Gizmo::typed(GizmoPart::Scale, 0.0, None));
    assert!(flat.linear.determinant() > 0.0, "a factor of 0 pressed everything flat");
    // In a free drag, along the way so far.
    let free = Gizmo::typed(GizmoPart::Free, 2.0, Some(DVec2::new(0.3, -0.4)));
    assert!(free.distance(DVec2::new(1.2, -1.6)) < 1e-15, "{free}");

    let snapped = Gizmo::snap(GizmoPart::Rotate(0), DVec2::new(0.5, 0.0), 0.1).x.to_degrees();
    assert!((snapped - 30.0).abs() < 1e-12, "{snapped}");
    assert_eq!(Gizmo::snap(GizmoPart::MovePlane(0), DVec2::new(0.26, -0.6), 0.25), DVec2::new(0.25, -0.5));
    assert_eq!(Gizmo::snap(GizmoPart::Scale, DVec2::new(0.01, 0.0), 0.25).x, 0.1);
}
