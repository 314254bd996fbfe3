//! Marks of brush and fill.

use super::*;
use pliant::document::Command;
use pliant::tools::{BrushMode, MirrorKind};
use pliant_solver::VertexId;

#[test]
fn the_brush_is_a_ring_and_a_mirrored_one_has_a_second() {
    let mut stage = Stage::new(egui::Key::B);
    stage.session().options.brush_radius_px = 32.0;
    let without = stage.without_pointer();
    let [here, across] = [(0.0, 1.0), (0.0, -1.0)].map(|(right, up)| stage.at(right, up));
    stage.hover(here);
    let alone = stage.picture();
    alone.assert_ring(here, 32.0, &without, "the brush");
    assert!(!alone.differs(across + vec2(32.0, 0.0), &without), "a second ring without a mirror");
    assert_eq!(stage.cursor(), CursorIcon::Crosshair);
    let mirror = &mut stage.session().options.paint.mirror;
    (mirror.kind, mirror.axis) = (MirrorKind::Plane, 1);
    step_until(&mut stage.window, "the other side is found", |session| session.mirror().is_some());
    stage.hover(here);
    let both = stage.picture();
    both.assert_ring(here, 32.0, &without, "the brush");
    both.assert_ring(across, 32.0, &without, "the mirrored brush");
}

#[test]
fn what_a_stroke_locks_is_hatched_and_the_rest_is_not() {
    let mut stage = Stage::new(egui::Key::B);
    let options = &mut stage.session().options;
    (options.brush_mode, options.brush_radius_px) = (BrushMode::Lock, 50.0);
    let without = stage.without_pointer();
    let at = stage.at(-1.0, 0.0);
    click(&mut stage.window, at);
    let locked = stage.without_pointer();
    // Over a disc well within the dab, and one beyond it.
    let changed = |center: Pos2| {
        let places = (0..64).map(|k| center + egui::vec2((k % 8) as f32 - 3.5, (k / 8) as f32 - 3.5) * 6.0);
        places.filter(|&place| locked.differs(place, &without)).count()
    };
    let (inside, outside) = (changed(at), changed(at + vec2(3.5 * CELL, 0.0)));
    assert!(inside > 20 && outside == 0, "{inside} of 64 places changed under the brush, {outside} elsewhere");
}

#[test]
fn a_fill_shows_the_region_under_the_pointer() {
    let mut stage = Stage::new(egui::Key::G);
    let n = document(stage.session()).model().mesh.n_vertices();
    let is_right = |session: &Session, v: usize| session.open().expect("open").surface.frame().positions[v].x > 0.0;
    let right = (0..n).filter(|&v| is_right(stage.session(), v)).map(|v| (VertexId(v as u32), 3)).collect();
    stage.session().apply(Command::Paint { values: right });
    settle(&mut stage.window);
    let without = stage.without_pointer();
    let (left, right) = (stage.at(-2.5, 0.4), stage.at(2.5, 0.4));
    stage.hover(left);
    assert_eq!(stage.cursor(), CursorIcon::Crosshair);
    let picture = stage.picture();
    let changed = |center: Pos2| {
        let places = (0..64).map(|k| center + egui::vec2((k % 8) as f32 - 3.5, (k / 8) as f32 - 3.5) * 6.0);
        places.filter(|&place| picture.differs(place, &without)).count()
    };
    let (inside, outside) = (changed(left), changed(right));
    assert!(inside > 32 && outside == 0, "{inside} of 64 places changed in the region, {outside} beyond");
}

#[test]
fn a_fill_that_spreads_shows_its_front() {
    let mut stage = Stage::new(egui::Key::G);
    // The front is as bright as it can be; what it has filled is a color of the ramp.
    let from = stage.at(0.0, 0.0);
    let radius = 80.0;
    stage.press_at(from);
    stage.draw_to(from, from + vec2(radius, 0.0));
    step_until(&mut stage.window, "the front has come there", |session| !session.tool_is_behind());
    let picture = stage.picture();
    let mut missing = Vec::new();
    for k in 0..24 {
        let way = egui::Vec2::angled(k as f32 * 0.2618 + 0.1);
        // Distances along the mesh may be 2 % off.
        let reach = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|off| picture.distance(from + (radius + off) * way, WHITE));
        missing.extend(reach.into_iter().reduce(f32::min).filter(|&far| far > NEAR));
    }
    assert!(missing.is_empty(), "the front is not drawn: {missing:?} levels off white");
    let inside = picture.distance(from + 0.5 * radius * egui::Vec2::angled(0.7), WHITE);
    assert!(inside > NEAR, "something white lies within the front");
}
