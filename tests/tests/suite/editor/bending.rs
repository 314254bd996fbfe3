//! Handles, anchors, undo: what happens to the pose.

use super::*;

#[test]
fn dragging_a_handle_bends_the_surface_and_holds_the_anchor() {
    let mut session = session_with(sheet(20));
    let rest = document(&session).model().mesh.positions().to_vec();
    session.take_tool(ToolKind::Anchor);
    let at = on_screen(&session, middle(2));
    click(&mut session, at);
    session.take_tool(ToolKind::Handle);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(60.0, -40.0));
    settle(&mut session);
    let document = document(&session);
    assert_eq!(document.scene().groups.len(), 2);
    let now = &document.pose().positions;
    for (group, moved) in document.scene().groups.iter().zip([false, true]) {
        for (v, target) in group.vertices.iter().zip(group.targets()) {
            assert_eq!(now[v.index()], target, "vertex {} is not exactly where {} holds it", v.0, group.name);
            assert_eq!(target != rest[v.index()], moved, "vertex {} of {}", v.0, group.name);
        }
    }
    let follower = middle(10) as usize;
    assert!(now[follower].distance(rest[follower]) > 1e-3, "the middle of the sheet did not follow");
    assert!(now.iter().all(|p| p.is_finite()));
}

#[test]
fn a_press_without_a_move_places_a_handle_in_one_step() {
    let mut session = session_with(sheet(20));
    let at = on_screen(&session, middle(10));
    click(&mut session, at);
    let document = document(&session);
    assert_eq!(document.scene().groups.len(), 1);
    assert_eq!(document.history().len(), 1);
    let group = &document.scene().groups[0];
    assert!(group.vertices.contains(&VertexId(middle(10))), "{:?}", group.vertices);
    // Two rings of a six-connected grid around the center.
    assert_eq!(group.vertices.len(), 19);
}

#[test]
fn undoing_everything_gives_back_the_start_bit_for_bit() {
    let mut session = session_with(sheet(20));
    let start = document(&session).snapshot();
    place_two_handles(&mut session);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(80.0, -30.0));
    settle(&mut session);
    session.take_tool(ToolKind::Brush);
    let from = on_screen(&session, middle(9));
    drag(&mut session, from, from + Vec2::new(30.0, 0.0));
    settle(&mut session);
    session.take_tool(ToolKind::Fill);
    session.choose_rigidity(3);
    click(&mut session, from);
    session.take_tool(ToolKind::Select);
    drag(&mut session, Vec2::new(300.0, 200.0), Vec2::new(500.0, 400.0));
    session.apply(Command::FillAll(2));
    session.apply(Command::ResetPose);
    settle(&mut session);
    let end = document(&session).snapshot();
    let steps = document(&session).history().len();
    assert!(steps >= 7, "only {steps} steps were kept");
    for _ in 0..steps {
        session.undo();
    }
    settle(&mut session);
    let undone = document(&session);
    assert_eq!(undone.pose().positions, start.pose.positions, "positions differ from the start");
    assert_eq!(undone.scene().rigidity, start.scene.rigidity);
    assert_eq!(undone.scene().groups, start.scene.groups);
    assert_eq!(undone.scene().selection, start.scene.selection);
    for _ in 0..steps {
        session.redo();
    }
    assert_eq!(document(&session).scene().rigidity, end.scene.rigidity);
    assert_eq!(document(&session).scene().groups, end.scene.groups);
    assert!(!document(&session).history().is_empty());
}

#[test]
fn escape_takes_back_the_drag_under_way() {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    settle(&mut session);
    let before = document(&session).snapshot();
    let from = on_screen(&session, middle(17));
    press_and_move(&mut session, from, from + Vec2::new(90.0, 50.0));
    assert_ne!(document(&session).scene().groups, before.scene.groups);
    session.input(Input::Key(ToolKey::Escape));
    session.input(Input::Release(pointer(from)));
    settle(&mut session);
    assert_eq!(document(&session).scene().groups, before.scene.groups);
    assert_eq!(document(&session).pose().positions, before.pose.positions, "the surface is not where it was");
    assert_eq!(document(&session).history().len(), 2, "the canceled drag left a step");
}

#[test]
fn undo_in_the_middle_of_a_drag_takes_back_the_drag_and_nothing_more() {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    let before = document(&session).scene().groups.clone();
    let from = on_screen(&session, middle(17));
    press_and_move(&mut session, from, from + Vec2::new(50.0, 0.0));
    session.undo();
    assert_eq!(document(&session).scene().groups, before);
    assert_eq!(document(&session).history().len(), 2);
}

#[test]
fn resetting_the_pose_during_a_drag_ends_at_rest_whatever_the_solver_still_reports() {
    let mut session = session_with(sheet(20));
    let rest = document(&session).pose().positions.clone();
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..21).map(VertexId).collect() });
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(middle(18))] });
    let group = document(&session).scene().groups[1].id;
    for round in 0..20_u32 {
        let way = DVec3::new(0.0, 0.0, 0.1 + 0.01 * f64::from(round));
        session.apply(Command::Move { group, motion: glam::DAffine3::from_translation(way) });
        std::thread::sleep(Duration::from_millis(round.into()));
        session.apply(Command::ResetPose);
        settle(&mut session);
        assert_eq!(document(&session).pose().positions, rest, "round {round}");
    }
}

#[test]
fn choosing_and_naming_things_does_not_disturb_the_solver() {
    let mut session = session_with(sheet(20));
    let at = on_screen(&session, middle(10));
    click(&mut session, at);
    settle(&mut session);
    let revision = document(&session).revision();
    let group = document(&session).scene().groups[0].id;
    session.apply(Command::Select(vec![VertexId(3)], SelectMode::Replace));
    session.apply(Command::Rename(group, "Ear".into()));
    session.apply(Command::Activate(None));
    assert_eq!(document(&session).revision(), revision);
    assert_eq!(document(&session).scene().groups[0].name, "Ear");
}

#[test]
fn holding_everything_else_leaves_only_the_selection_free() {
    let mut session = session_with(sheet(20));
    session.apply(Command::Select((100..200).map(VertexId).collect(), SelectMode::Replace));
    session.hold_everything_else();
    let group = &document(&session).scene().groups[0];
    assert_eq!((group.kind, group.vertices.len()), (GroupKind::Anchor, 441 - 100));
}

#[test]
fn a_vertex_is_never_held_by_two_groups() {
    let mut session = session_with(sheet(20));
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: (0..50).map(VertexId).collect() });
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (40..90).map(VertexId).collect() });
    session.apply(Command::Hold { kind: GroupKind::Anchor, vertices: (0..10).map(VertexId).collect() });
    let sizes: Vec<_> = document(&session).scene().groups.iter().map(|group| group.vertices.len()).collect();
    assert_eq!(sizes, [30, 50, 10]);
    settle(&mut session);
    assert_eq!(state(&session), Some(SolveState::Settled));
}

#[test]
fn refused_commands_become_notices_and_change_nothing() {
    let mut session = session_with(sheet(4));
    let before = document(&session).snapshot().scene;
    session.apply(Command::FillAll(0));
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(9000)] });
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: Vec::new() });
    assert_eq!(document(&session).scene(), &before);
    assert!(document(&session).history().is_empty());
    let errors = session.notices.list().iter().filter(|notice| notice.kind == NoticeKind::Error).count();
    assert_eq!(errors, 3, "{:?}", session.notices.list());
}

#[test]
fn deleting_all_handles_and_placing_new_ones_keeps_the_pose() {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(80.0, -30.0));
    settle(&mut session);
    let bent = document(&session).pose().positions.clone();
    let groups: Vec<_> = document(&session).scene().groups.iter().map(|group| group.id).collect();
    session.apply(Command::Release(groups));
    settle(&mut session);
    assert_eq!(state(&session), Some(SolveState::Resting));
    assert_eq!(document(&session).pose().positions, bent, "letting go moved the surface");
    session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(middle(17))] });
    assert_eq!(document(&session).scene().groups[0].base[0], bent[middle(17) as usize]);
}
