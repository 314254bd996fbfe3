//! Groups of handles and anchors: what belongs to them, and how they are moved.

use super::*;
use glam::{DAffine3, DQuat};
use pliant::document::{Group, GroupColor, GroupId};

fn groups(session: &Session) -> &[Group] {
    &document(session).scene().groups
}

fn ids(session: &Session) -> Vec<GroupId> {
    groups(session).iter().map(|group| group.id).collect()
}

fn hold(session: &mut Session, kind: GroupKind, vertices: std::ops::Range<u32>) -> GroupId {
    session.apply(Command::Hold { kind, vertices: vertices.map(VertexId).collect() });
    *ids(session).last().expect("a group")
}

/// No vertex in two groups, no empty group, sorted lists, as many positions as vertices, no active group that is gone.
fn assert_sound(session: &Session) {
    let mut seen = std::collections::HashSet::new();
    for group in groups(session) {
        assert!(!group.vertices.is_empty() && group.vertices.is_sorted(), "{}", group.name);
        assert_eq!(group.vertices.len(), group.base.len(), "{}", group.name);
        for v in group.vertices.iter() {
            assert!(seen.insert(*v), "vertex {} is in two groups, one of them {}", v.0, group.name);
        }
    }
    let scene = document(session).scene();
    assert!(scene.active.ids().iter().all(|&id| scene.group(id).is_some()), "an active group is gone");
}

fn target_of(session: &Session, v: u32) -> DVec3 {
    let (vertices, targets) = held_by(groups(session));
    targets[vertices.iter().position(|&held| held == VertexId(v)).expect("a held vertex")]
}

#[test]
fn merging_adding_and_removing_move_nothing_and_keep_every_vertex_in_one_group() {
    let mut session = session_with(sheet(20));
    let a = hold(&mut session, GroupKind::Handle, 0..30);
    let b = hold(&mut session, GroupKind::Handle, 100..120);
    let c = hold(&mut session, GroupKind::Anchor, 200..210);
    let turned = DAffine3::from_rotation_translation(DQuat::from_rotation_y(0.7), DVec3::new(0.1, 0.2, 0.3));
    session.apply(Command::MoveSeveral(vec![(a, DAffine3::from_translation(DVec3::Z)), (b, turned)]));
    settle(&mut session);
    let before: Vec<DVec3> = (0..30).chain(100..120).map(|v| target_of(&session, v)).collect();
    session.apply(Command::Merge(vec![a, b]));
    assert_sound(&session);
    assert_eq!(ids(&session), [b, c], "the last one stays");
    assert_eq!(groups(&session)[0].vertices.len(), 50);
    assert_eq!(groups(&session)[0].motion, turned, "what was moved can still be read");
    for (v, expected) in (0..30).chain(100..120).zip(before) {
        let got = target_of(&session, v);
        // There and back again through a rotation: a few roundings of coordinates near 1.
        assert!(got.distance(expected) < 1e-14, "vertex {v} is held at {got}, expected {expected}");
    }

    // Taken from an anchor, added to a handle that has moved: where the surface is now.
    let now = document(&session).pose().positions.clone();
    session.apply(Command::AddToGroup(b, (195..205).map(VertexId).collect()));
    assert_sound(&session);
    assert_eq!(groups(&session).iter().map(|group| group.vertices.len()).collect::<Vec<_>>(), [60, 5]);
    for v in 195..205_u32 {
        let (got, expected) = (target_of(&session, v), now[v as usize]);
        assert!(got.distance(expected) < 1e-14, "vertex {v} is held at {got}, expected {expected}");
    }
    session.apply(Command::RemoveFromGroup(b, (0..200).map(VertexId).collect()));
    assert_sound(&session);
    assert_eq!(groups(&session)[0].vertices.len(), 5);
    session.apply(Command::RemoveFromGroup(b, (0..300).map(VertexId).collect()));
    assert_sound(&session);
    assert_eq!(ids(&session), [c], "a group without vertices goes");
    for _ in 0..document(&session).history().len() {
        session.undo();
        assert_sound(&session);
    }
    assert!(groups(&session).is_empty());
}

#[test]
fn a_group_flattened_to_nothing_can_still_be_merged() {
    let mut session = session_with(sheet(20));
    let a = hold(&mut session, GroupKind::Handle, 0..5);
    let b = hold(&mut session, GroupKind::Handle, 50..55);
    session.apply(Command::Move { group: b, motion: DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)) });
    session.apply(Command::Merge(vec![a, b]));
    assert_sound(&session);
    assert_eq!(groups(&session)[0].vertices.len(), 10);
    assert!(groups(&session)[0].targets().all(|target| target.is_finite()));
}

#[test]
fn several_groups_are_active_in_the_order_of_choosing_and_none_that_is_gone() {
    let mut session = session_with(sheet(20));
    let made: Vec<_> = (0..4).map(|k| hold(&mut session, GroupKind::Handle, 10 * k..10 * k + 5)).collect();
    let steps = document(&session).history().len();
    session.apply(Command::ActivateSeveral(vec![made[2], made[0], made[2], made[3]]));
    let active = &document(&session).scene().active;
    assert_eq!(active.ids(), [made[0], made[2], made[3]]);
    assert_eq!(active.lead(), Some(made[3]));
    assert_eq!(active.toggled(made[3]), [made[0], made[2]]);
    assert_eq!(active.toggled(made[1]), [made[0], made[2], made[3], made[1]]);
    assert_eq!(document(&session).history().len(), steps, "choosing is no step");
    session.apply(Command::Release(vec![made[3]]));
    assert_sound(&session);
    assert_eq!(document(&session).scene().active.lead(), Some(made[2]));
    session.apply(Command::Merge(vec![made[2], made[0]]));
    assert_sound(&session);
    session.apply(Command::Merge(vec![made[2]]));
    let errors = |session: &Session| session.notices.list().len();
    assert_eq!(errors(&session), 1, "merging a group that is gone must be refused");
}

#[test]
fn colors_follow_the_kind_until_one_is_chosen_and_do_not_disturb_the_solver() {
    let mut session = session_with(sheet(20));
    let id = hold(&mut session, GroupKind::Handle, 0..5);
    let color = |session: &Session| groups(session)[0].color;
    assert_eq!(color(&session), GroupColor::Yellow);
    session.apply(Command::SetKind(id, GroupKind::Anchor));
    assert_eq!(color(&session), GroupColor::Dark);
    let revision = document(&session).revision();
    session.apply(Command::SetColor(id, GroupColor::Sky));
    session.apply(Command::ShowDots(id, false));
    assert_eq!(document(&session).revision(), revision);
    session.apply(Command::SetKind(id, GroupKind::Handle));
    assert_eq!(color(&session), GroupColor::Sky);
    assert!(!groups(&session)[0].dots);
    session.undo();
    session.undo();
    assert!(groups(&session)[0].dots);
}
