//! Marks of selecting and inspecting.

use super::*;
use pliant::tools::SelectShape;

/// The tint of the selection.
const SELECTED: [u8; 3] = [52, 222, 160];

#[test]
fn a_box_is_drawn_while_it_is_dragged_and_what_it_took_is_marked() {
    let mut stage = Stage::new(egui::Key::S);
    let (from, to) = (stage.at(-2.5, -1.5), stage.at(1.5, 1.5));
    stage.press_at(from);
    stage.draw_to(from, to);
    let picture = stage.picture();
    let corners = [from, egui::pos2(to.x, from.y), to, egui::pos2(from.x, to.y), from];
    for side in corners.windows(2) {
        picture.assert_line(side[0], side[1], ACCENT, "a side of the box");
    }
    assert_eq!(stage.cursor(), CursorIcon::Crosshair);
    stage.drop_at(to);
    let picture = stage.without_pointer();
    for (column, row) in (-2..=1).flat_map(|column| (-1..=1).map(move |row| (column, row))) {
        let at = stage.at(column as f32, row as f32);
        picture.assert_dot(at, SELECTED, "a selected vertex");
    }
    let outside = stage.at(2.0, 0.0);
    assert!(picture.distance(outside, SELECTED) > 60.0, "a vertex outside of the box is marked");
    picture_has_no_outline(&picture, &corners);
}

fn picture_has_no_outline(picture: &Picture, corners: &[Pos2]) {
    let at = corners[0].lerp(corners[1], 0.4);
    assert!(picture.distance(at, ACCENT) > NEAR, "the box is still drawn");
}

#[test]
fn a_lasso_is_drawn_closed_while_it_is_dragged() {
    let mut stage = Stage::new(egui::Key::S);
    stage.session().options.select_shape = SelectShape::Lasso;
    let path = [(-2.4, -1.4), (1.6, -1.2), (2.2, 1.3), (-0.6, 1.7)].map(|(right, up)| stage.at(right, up));
    stage.press_at(path[0]);
    path.windows(2).for_each(|side| stage.draw_to(side[0], side[1]));
    let picture = stage.picture();
    for k in 0..path.len() {
        picture.assert_line(path[k], path[(k + 1) % path.len()], ACCENT, "a side of the lasso");
    }
}

#[test]
fn the_brush_of_the_selection_is_a_ring_and_many_vertices_are_tinted() {
    let mut stage = Stage::new(egui::Key::S);
    stage.session().options.select_shape = SelectShape::Brush;
    stage.session().options.brush_radius_px = 60.0;
    let without = stage.without_pointer();
    let center = stage.at(0.3, 0.2);
    stage.hover(center);
    stage.picture().assert_ring(center, 60.0, &without, "the brush");
    stage.session().select_all(true);
    let tinted = stage.without_pointer();
    let place = stage.at(0.4, 0.3);
    let green = |picture: &Picture| picture.around(place)[4][1] - picture.around(place)[4][0];
    let (before, after) = (green(&without), green(&tinted));
    assert!(after > before + 25.0, "green over red: {after}, {before} without a selection");
}

#[test]
fn the_vertex_that_a_click_would_select_is_marked() {
    let mut stage = Stage::new(egui::Key::S);
    let without = stage.without_pointer();
    let (pointer, vertex) = (stage.at(0.2, 0.15), stage.at(0.0, 0.0));
    stage.hover(pointer);
    let gain = stage.picture().brighter(vertex, &without);
    assert!(gain > 60.0, "only {gain} levels brighter than without");
}

#[test]
fn inspecting_shows_a_card_pins_and_the_way_between_them() {
    let mut stage = Stage::new(egui::Key::Q);
    let without = stage.without_pointer();
    let [from, to] = [(-2.0, -1.0), (2.0, 1.0)].map(|(right, up)| stage.at(right, up));
    stage.hover(from);
    let hovering = stage.picture();
    let neighbor = from + vec2(0.5 * CELL, 0.0);
    assert!(hovering.brighter(neighbor, &without) > 25.0, "edges around the vertex are not drawn");
    let card = stage.window.get_by_label("Edges at").rect().center();
    assert!(hovering.differs(card, &without), "the card is not drawn");
    assert_eq!(stage.cursor(), CursorIcon::Crosshair);
    for at in [from, to] {
        click(&mut stage.window, at);
    }
    let picture = stage.without_pointer();
    for at in [from, to] {
        picture.assert_dot(at, WHITE, "a pin");
    }
    for k in 1..10 {
        let at = from.lerp(to, k as f32 / 10.0);
        let gain = picture.brighter(at, &without);
        assert!(gain > 25.0, "the straight way is not drawn at {at}: {gain} levels brighter");
    }
}
