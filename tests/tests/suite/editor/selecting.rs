//! Selecting: shapes, regions, stored sets, and the region that bends.

use std::collections::BTreeSet;

use super::*;
use pliant::document::{Alike, SetChange};
use pliant_meshfile::Part;

/// A ball and, beside it, an uneven sheet with a border and two parts; in all three components and three parts.
pub(super) fn several() -> MeshFile {
    let mut file = super::painting::ball();
    let (mut positions, mut triangles) = (std::mem::take(&mut file.positions), std::mem::take(&mut file.triangles));
    let mut parts = vec![part("ball", 0, triangles.len())];
    for (name, x, n) in [("left", 2.5, 7), ("right", 4.5, 4)] {
        let sheet = sheet(n);
        let first = positions.len() as u32;
        let begin = triangles.len();
        let bent = |p: &DVec3| DVec3::new(p.x * (1.3 + p.y) + x, p.y * (1.0 + p.x * p.x), 0.2 * p.x * p.y);
        positions.extend(sheet.positions.iter().map(bent));
        triangles.extend(sheet.triangles.iter().map(|t| t.map(|v| v + first)));
        parts.push(part(name, begin, triangles.len()));
    }
    let mut file = MeshFile::from_triangles("several", positions, triangles);
    file.parts = parts;
    file
}

fn part(name: &str, begin: usize, end: usize) -> Part {
    Part { name: name.into(), triangles: begin..end, base_color: [0.8, 0.8, 0.8, 1.0] }
}

fn selected(session: &Session) -> BTreeSet<u32> {
    document(session).scene().selection.vertices().iter().map(|v| v.0).collect()
}

fn select(session: &mut Session, vertices: impl IntoIterator<Item = u32>) {
    session.apply(Command::Select(vertices.into_iter().map(VertexId).collect(), SelectMode::Replace));
}

/// Both ends of every side of every triangle, both ways.
fn sides(session: &Session) -> Vec<(u32, u32)> {
    let triangles = document(session).model().mesh.triangles().to_vec();
    triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a), (b, a), (c, b), (a, c)]).collect()
}

#[test]
fn growing_shrinking_and_linked_follow_the_edges_of_the_mesh() {
    let mut session = session_with(several());
    let n = document(&session).model().mesh.n_vertices() as u32;
    let sides = sides(&session);
    for seeds in [vec![0, 5, n - 1], (0..n).filter(|v| v % 3 != 0).collect(), (0..n).collect(), vec![n - 20]] {
        let seeds: BTreeSet<u32> = seeds.into_iter().collect();
        let beside = |set: &BTreeSet<u32>| -> BTreeSet<u32> {
            sides.iter().filter(|(a, _)| set.contains(a)).map(|&(_, b)| b).collect()
        };
        select(&mut session, seeds.clone());
        session.grow_selection();
        assert_eq!(selected(&session), &seeds | &beside(&seeds), "grown");

        select(&mut session, seeds.clone());
        session.shrink_selection();
        let outside: BTreeSet<u32> = (0..n).filter(|v| !seeds.contains(v)).collect();
        assert_eq!(selected(&session), &seeds - &beside(&outside), "shrunk");

        select(&mut session, seeds.clone());
        session.invert_selection();
        assert_eq!(selected(&session), outside, "inverted");

        select(&mut session, seeds.clone());
        session.select_alike(Alike::Linked);
        let mut reached = seeds.clone();
        loop {
            let more = &reached | &beside(&reached);
            if more.len() == reached.len() {
                break;
            }
            reached = more;
        }
        assert_eq!(selected(&session), reached, "linked");
    }
}

#[test]
fn borders_parts_rigidity_and_the_active_handle_can_be_selected() {
    let mut session = session_with(several());
    let n = document(&session).model().mesh.n_vertices() as u32;
    let sides = sides(&session);
    let rare = |v: u32| sides.iter().any(|&(a, b)| a == v && sides.iter().filter(|&&side| side == (a, b)).count() == 1);
    session.select_border();
    assert_eq!(selected(&session), (0..n).filter(|&v| rare(v)).collect(), "borders");

    session.select_part("left", SelectMode::Replace);
    let left = selected(&session);
    assert_eq!(left.len(), 64, "the sheet of 7 by 7 cells");
    session.select_part("right", SelectMode::Add);
    assert_eq!(selected(&session).len(), 64 + 25);
    session.select_part("left", SelectMode::Remove);
    assert_eq!(selected(&session).len(), 25);
    let one = *left.first().expect("not empty");
    select(&mut session, [one]);
    session.select_alike(Alike::Part);
    assert_eq!(selected(&session), left, "the part of a vertex");

    session.apply(Command::Paint { values: (0..n).map(|v| (VertexId(v), (v % 5 + 1) as u16)).collect() });
    session.select_rigidity(2..=3, SelectMode::Replace);
    assert_eq!(selected(&session), (0..n).filter(|v| [1, 2].contains(&(v % 5))).collect(), "r of 2 and 3");
    select(&mut session, [4, 8]);
    session.select_alike(Alike::Rigidity);
    assert_eq!(selected(&session), (0..n).filter(|v| [4, 3].contains(&(v % 5))).collect(), "r of 4 and 5");

    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: [7, 3, 9].map(VertexId).to_vec() });
    select(&mut session, []);
    session.select_active_group();
    assert_eq!(selected(&session), [3, 7, 9].into());
}

#[test]
fn a_click_takes_a_vertex_and_a_double_click_all_that_is_linked_to_it() {
    let mut session = session_with(several());
    session.take_tool(ToolKind::Select);
    let n = document(&session).model().mesh.n_vertices() as u32;
    let (v, other) = (n - 13, n - 25 - 30);
    let at = on_screen(&session, v);
    click(&mut session, at);
    assert_eq!(selected(&session), [v].into());
    session.input(Input::DoubleClick(pointer(at)));
    assert_eq!(selected(&session), (n - 25..n).collect(), "the sheet on the right");
    let shift = Modifiers { shift: true, ctrl: false, alt: false };
    let at_other = on_screen(&session, other);
    session.input(Input::DoubleClick(Pointer { px: at_other, modifiers: shift }));
    assert_eq!(selected(&session), (n - 89..n).collect(), "both sheets");
    let ctrl = Modifiers { shift: false, ctrl: true, alt: false };
    session.input(Input::DoubleClick(Pointer { px: at, modifiers: ctrl }));
    assert_eq!(selected(&session), (n - 89..n - 25).collect(), "the sheet on the left remains");
    session.input(Input::Hover(pointer(at)));
    session.select_alike(Alike::Linked);
    assert_eq!(selected(&session), (n - 89..n).collect(), "what is under the pointer is added");
}

#[test]
fn a_stroke_of_the_selecting_brush_is_one_step_that_shift_adds_and_ctrl_removes() {
    let mut session = session_with(sheet(20));
    session.take_tool(ToolKind::Select);
    session.options.select_shape = SelectShape::Brush;
    session.options.brush_radius_px = 30.0;
    let (low, high) = (on_screen(&session, middle(4)), on_screen(&session, middle(16)));
    let side = Vec2::new(50.0, 0.0);
    drag(&mut session, low, low + side);
    let first = selected(&session);
    assert!(first.contains(&middle(4)) && !first.contains(&middle(16)), "{first:?}");
    assert_eq!(document(&session).history().len(), 1, "one stroke, one step");
    drag(&mut session, high, high + side);
    let second = selected(&session);
    assert!(!second.contains(&middle(4)), "a stroke without keys begins anew");

    let with = |session: &mut Session, at: Vec2, modifiers: Modifiers| {
        session.input(Input::Press(Pointer { px: at, modifiers }));
        session.input(Input::Drag(Pointer { px: at + side, modifiers }));
        session.input(Input::Release(Pointer { px: at + side, modifiers }));
    };
    with(&mut session, low, Modifiers { shift: true, ctrl: false, alt: false });
    assert_eq!(selected(&session), &first | &second, "Shift adds");
    with(&mut session, low, Modifiers { shift: false, ctrl: true, alt: false });
    assert_eq!(selected(&session), &second - &first, "Ctrl removes");

    press_and_move(&mut session, low, low + side);
    assert_ne!(selected(&session), second);
    session.input(Input::Key(ToolKey::Escape));
    assert_eq!(selected(&session), second, "Esc takes the stroke back");
}

#[test]
fn the_selecting_brush_does_not_reach_around_the_edge_of_what_is_seen() {
    let mut session = session_with(super::painting::ball());
    session.take_tool(ToolKind::Select);
    session.options.select_shape = SelectShape::Brush;
    // Larger than the ball is on screen.
    session.options.brush_radius_px = 390.0;
    click(&mut session, Vec2::new(400.0, 300.0));
    let open = session.open().expect("open");
    let (forward, positions) = (open.camera.forward(), &open.surface.frame().positions);
    let got = selected(&session);
    for (v, position) in (0..).zip(positions) {
        let depth = position.dot(forward);
        assert!(depth < 0.1 || !got.contains(&v), "vertex {v} on the far side, at depth {depth}, was selected");
        assert!(depth > -0.7 || got.contains(&v), "vertex {v} in front, at depth {depth}, was not");
    }
}

#[test]
fn of_many_vertices_the_visible_ones_are_those_that_rays_reach() {
    use pliant::tools::View;
    use pliant::viewport::Projection;
    // Two sheets of 6,561 vertices, one behind the other, the near one with a fold.
    let (mut near, far) = (sheet(80), sheet(80));
    near.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x * 0.8, p.y * 0.8, 0.3 + 0.3 * (p.x * 20.0).sin()));
    let triangles = near.triangles.iter().copied().chain(far.triangles.iter().map(|t| t.map(|v| v + 6561)));
    let positions = near.positions.iter().chain(&far.positions).copied().collect();
    let mut session = session_with(MeshFile::from_triangles("sheets", positions, triangles.collect()));
    for projection in [Projection::Perspective, Projection::Orthographic] {
        session.open_mut().expect("open").camera.projection = projection;
        session.options.select_through = false;
        session.take_tool(ToolKind::Select);
        drag(&mut session, Vec2::new(0.5, 0.5), Vec2::new(799.5, 599.5));
        let got = selected(&session);
        let size = session.viewport_size();
        let open = session.open_mut().expect("open");
        let view = View { camera: open.camera, size };
        let expected: BTreeSet<u32> = (0..13122).filter(|&v| open.surface.is_visible(VertexId(v), &view)).collect();
        let (missing, excess) = (&expected - &got, &got - &expected);
        assert!(expected.len() > 3000 && expected.len() < 10000, "{} can be seen", expected.len());
        // Within a pixel of an outline, a picture and a ray may differ.
        let limit = expected.len() / 100;
        assert!(
            missing.len() < limit && excess.len() < limit,
            "{projection:?}: {missing:?} missing, {excess:?} too many"
        );
    }
}

#[test]
fn stored_sets_are_recalled_renamed_updated_and_forgotten_and_each_can_be_undone() {
    let mut session = session_with(sheet(20));
    let set = |session: &Session, k: usize| document(session).scene().sets[k].clone();
    let change = |session: &mut Session, change| session.apply(Command::Sets(change));
    select(&mut session, 0..10);
    session.store_selection();
    select(&mut session, 5..20);
    session.store_selection();
    let (a, b) = (set(&session, 0).id, set(&session, 1).id);
    assert_eq!([0, 1].map(|k| set(&session, k).name), ["Set 1", "Set 2"]);
    for (id, mode, expected) in
        [(a, SelectMode::Replace, 0..10), (b, SelectMode::Add, 0..20), (a, SelectMode::Remove, 10..20)]
    {
        change(&mut session, SetChange::Recall(id, mode));
        assert_eq!(selected(&session), expected.collect(), "{mode:?}");
    }
    change(&mut session, SetChange::Rename(a, "  Left arm ".into()));
    change(&mut session, SetChange::Rename(b, "  ".into()));
    assert_eq!([0, 1].map(|k| set(&session, k).name), ["Left arm", "Set 2"]);
    change(&mut session, SetChange::Update(a));
    assert_eq!(set(&session, 0).vertices.vertices(), (10..20).map(VertexId).collect::<Vec<_>>());
    change(&mut session, SetChange::Delete(a));
    assert_eq!(document(&session).scene().sets.len(), 1);
    session.store_selection();
    assert_eq!(set(&session, 1).name, "Set 1", "a name that is free again");
    session.undo();
    session.undo();
    assert_eq!(set(&session, 0).name, "Left arm");
    session.undo();
    assert_eq!(set(&session, 0).vertices.len(), 10);
    assert!(session.notices.list().is_empty());
    select(&mut session, []);
    session.store_selection();
    assert_eq!(session.notices.list().len(), 1, "an empty selection is not stored in silence");
}

#[test]
fn everything_outside_the_region_of_interest_is_held_and_the_region_can_move() {
    let mut session = session_with(sheet(20));
    let held = |session: &Session| -> BTreeSet<u32> {
        let scene = document(session).scene();
        let rest = scene.groups.iter().filter(|group| group.kind == GroupKind::Anchor);
        rest.flat_map(|group| group.vertices.iter().map(|v| v.0)).collect()
    };
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(middle(10))] });
    for region in [100..300, 150..441, 0..230] {
        let steps = document(&session).history().len();
        select(&mut session, region.clone());
        session.hold_everything_else();
        assert_eq!(held(&session), (0..441).filter(|v| !region.contains(v) && *v != middle(10)).collect());
        let groups = &document(&session).scene().groups;
        assert_eq!(groups.len(), 2, "the handle in the region and one anchor");
        assert_eq!(document(&session).history().len(), steps + 2, "the selection and the holding are a step each");
    }
    let steps = document(&session).history().len();
    session.hold_everything_else();
    assert_eq!(document(&session).history().len(), steps, "done again with the same selection, nothing changes");
    session.release_everything();
    assert!(document(&session).scene().groups.is_empty());
    session.undo();
    assert_eq!(document(&session).scene().groups.len(), 2, "letting go is one step");
    session.select_all(true);
    session.release_everything();
    session.hold_everything_else();
    assert_eq!(session.notices.list().len(), 1, "with everything selected there is nothing else to hold");
}
