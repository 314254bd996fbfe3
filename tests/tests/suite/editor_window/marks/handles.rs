//! Marks of handles, anchors and the gizmo.

use super::*;
use pliant::document::{Command, GroupColor};
use pliant::tools::GizmoShown;

const RED: [u8; 3] = [235, 84, 84];
const GREEN: [u8; 3] = [122, 196, 72];
const BLUE: [u8; 3] = [84, 142, 240];
const GRAY: [u8; 3] = [225, 225, 225];
/// A part of the gizmo under the pointer.
const HOT: [u8; 3] = [255, 214, 92];
/// Points from the gizmo's middle to the tips of its arrows.
const ARROW: f32 = 78.0;

/// A handle of the vertex in the middle and those around, worked on.
fn with_handle(shown: GizmoShown) -> Stage {
    let mut stage = Stage::new(egui::Key::H);
    stage.session().options.patch_rings = 1;
    stage.session().options.gizmo.shown = shown;
    let at = stage.at(0.0, 0.0);
    click(&mut stage.window, at);
    settle(&mut stage.window);
    stage
}

/// The middle of the first group, in the window.
fn center(stage: &mut Stage) -> Pos2 {
    let corner = stage.window.get_by_label("viewport").rect().min;
    let session = stage.session();
    let open = session.open().expect("open");
    let center = open.document.model().to_view(open.document.scene().groups[0].center());
    let (px, _) = open.camera.project(center, session.viewport_size()).expect("in front of the eye");
    corner + vec2(px.x, px.y)
}

#[test]
fn what_a_click_would_hold_is_marked_and_then_has_dots_of_its_kind() {
    for (key, kind) in [(egui::Key::H, GroupKind::Handle), (egui::Key::A, GroupKind::Anchor)] {
        let mut stage = Stage::new(key);
        stage.session().options.patch_rings = 1;
        stage.session().options.show_gizmo = false;
        let without = stage.without_pointer();
        let at = stage.at(0.0, 0.0);
        stage.hover(at);
        assert_eq!(stage.cursor(), CursorIcon::Crosshair);
        let picture = stage.picture();
        let neighbors = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, y)| stage.at(x, y));
        for vertex in neighbors {
            let gain = picture.brighter(vertex, &without);
            assert!(gain > 40.0, "{kind:?}: a vertex to hold is only {gain} levels brighter");
        }
        assert!(!picture.differs(stage.at(2.0, 0.0), &without), "{kind:?}: a vertex beyond the patch is marked");
        click(&mut stage.window, at);
        settle(&mut stage.window);
        let picture = stage.without_pointer();
        let color = GroupColor::of_kind(kind).rgb();
        for vertex in neighbors {
            picture.assert_dot(vertex, color, "a vertex that is held");
        }
        stage.hover(neighbors[0]);
        assert_eq!(stage.cursor(), CursorIcon::Grab, "{kind:?}");
        assert!(stage.picture().brighter(neighbors[1], &picture) > 20.0, "{kind:?}: the group is not marked");
    }
}

#[test]
fn a_group_has_its_own_color() {
    let mut stage = with_handle(GizmoShown::All);
    stage.session().options.show_gizmo = false;
    let id = document(stage.session()).scene().groups[0].id;
    for color in [GroupColor::Yellow, GroupColor::Purple] {
        stage.session().apply(Command::SetColor(id, color));
        let at = center(&mut stage);
        let picture = stage.without_pointer();
        // The dot in the middle is the larger one.
        for way in [vec2(0.0, 0.0), vec2(5.0, 0.0), vec2(0.0, -5.0)] {
            picture.assert_dot(at + way, color.rgb(), color.name());
        }
    }
}

#[test]
fn the_gizmo_has_arrows_and_squares_that_light_up() {
    let mut stage = with_handle(GizmoShown::Move);
    let middle = center(&mut stage);
    let picture = stage.without_pointer();
    let along_x = [middle + vec2(0.3 * ARROW, 0.0), middle + vec2(0.9 * ARROW, 0.0)];
    picture.assert_line(along_x[0], along_x[1], RED, "the arrow along x");
    picture.assert_line(middle - vec2(0.0, 0.3 * ARROW), middle - vec2(0.0, 0.9 * ARROW), GREEN, "the arrow along y");
    let square = middle + vec2(0.38, -0.38) * ARROW;
    picture.assert_dot(square, BLUE, "the square across z");
    stage.hover(middle + vec2(0.6 * ARROW, 0.0));
    assert_eq!(stage.cursor(), CursorIcon::Grab);
    stage.picture().assert_line(along_x[0], along_x[1], HOT, "the arrow under the pointer");
}

#[test]
fn a_drag_shows_how_far_it_went_and_the_axis_it_is_locked_to() {
    let mut stage = with_handle(GizmoShown::Move);
    let from = center(&mut stage) + vec2(0.6 * ARROW, 0.0);
    let before = stage.without_pointer();
    stage.press_at(from);
    stage.draw_to(from, from + vec2(CELL, 0.0));
    assert_eq!(stage.cursor(), CursorIcon::Grabbing);
    press(&mut stage.window, egui::Key::X);
    settle(&mut stage.window);
    let picture = stage.picture();
    let middle = center(&mut stage);
    picture.assert_line(middle + vec2(0.3 * ARROW, 0.0), middle + vec2(0.9 * ARROW, 0.0), HOT, "the arrow");
    // The axis goes on beyond the arrow and to the other side. It is half transparent.
    for x in [-2.0, -1.5, 1.6, 2.0] {
        let at = middle + vec2(x * ARROW, 0.0);
        let redder = picture.around(at).map(|[r, _, b]| r - b).into_iter().fold(f32::MIN, f32::max)
            - before.around(at).map(|[r, _, b]| r - b).into_iter().fold(f32::MIN, f32::max);
        assert!(redder > 40.0, "the axis is not drawn {x} arrows from the middle: {redder} levels redder");
    }
    // Words stand right below the pointer.
    let words = from + vec2(CELL, 0.0) + vec2(18.0, 18.0);
    let places = (0..60).map(|k| words + vec2(k as f32 % 20.0 * 2.0, (k / 20) as f32 * 5.0));
    let count = places.filter(|&at| picture.differs(at, &before)).count();
    assert!(count > 30, "the way is not told beside the pointer: {count} of 60 places differ");
}

#[test]
fn the_gizmo_has_rings_that_light_up() {
    let mut stage = with_handle(GizmoShown::Turn);
    let middle = center(&mut stage);
    let ring = |radius: f32| {
        let angles = (0..16).map(|k| k as f32 * std::f32::consts::FRAC_PI_8 + 0.2);
        angles.map(move |angle| middle + radius * ARROW * egui::Vec2::angled(angle))
    };
    let picture = stage.without_pointer();
    for at in ring(0.72) {
        assert!(picture.distance(at, BLUE) < NEAR, "the ring about z is not drawn at {at}");
    }
    let first = ring(0.72).next().expect("a place");
    stage.hover(first);
    assert_eq!(stage.cursor(), CursorIcon::Grab);
    let picture = stage.picture();
    for at in ring(0.72) {
        assert!(picture.distance(at, HOT) < NEAR, "the ring under the pointer is not lit at {at}");
    }
    let lit = ring(1.36).filter(|&at| picture.distance(at, HOT) < NEAR).count();
    assert_eq!(lit, 0, "the outer ring is lit as well");
}

#[test]
fn the_gizmo_has_knobs_that_light_up() {
    let mut stage = with_handle(GizmoShown::Scale);
    let middle = center(&mut stage);
    let (x, y) = (middle + vec2(1.18 * ARROW, 0.0), middle - vec2(0.0, 1.18 * ARROW));
    let both = middle + vec2(1.0, -1.0).normalized() * 1.36 * ARROW;
    let picture = stage.without_pointer();
    for (at, color) in [(x, RED), (y, GREEN), (both, GRAY)] {
        picture.assert_dot(at, color, "a knob");
    }
    stage.hover(both);
    assert_eq!(stage.cursor(), CursorIcon::Grab);
    let picture = stage.picture();
    picture.assert_dot(both, HOT, "the knob under the pointer");
    picture.assert_dot(x, RED, "another knob");
}
