//! What lies between poses.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_solver::VertexId;

use super::{Kind, Plan, Segment, between, numbered};
use crate::document::{Group, GroupColor, GroupId, GroupKind, KeptPose, PoseId};

fn about(pivot: DVec3, axis: DVec3, degrees: f64) -> DAffine3 {
    let turn = DQuat::from_axis_angle(axis.normalize(), degrees.to_radians());
    DAffine3::from_rotation_translation(turn, pivot - turn * pivot)
}

fn assert_near(got: DAffine3, expected: DAffine3, what: &str) {
    // Some dozens of roundings of numbers up to 10.
    assert!(got.abs_diff_eq(expected, 1e-12), "{what}: got {got:?}, expected {expected:?}");
}

#[test]
fn half_of_a_quarter_turn_is_an_eighth_about_the_same_pivot_wherever_that_is() {
    let center = DVec3::new(1.0, -2.0, 0.5);
    for pivot in [center, DVec3::ZERO, DVec3::new(-4.0, 1.0, 3.0)] {
        let axis = DVec3::new(1.0, 2.0, -1.0);
        let whole = about(pivot, axis, 90.0);
        assert_near(between(&DAffine3::IDENTITY, &whole, center, 0.5), about(pivot, axis, 45.0), "half");
        assert_near(between(&DAffine3::IDENTITY, &whole, center, 1.0 / 3.0), about(pivot, axis, 30.0), "a third");
        assert_eq!(between(&DAffine3::IDENTITY, &whole, center, 0.0), DAffine3::IDENTITY);
        assert_eq!(between(&DAffine3::IDENTITY, &whole, center, 1.0), whole);
    }
}

#[test]
fn stretches_change_by_equal_factors_and_ways_without_a_turn_are_straight() {
    let grown = DAffine3::from_scale(DVec3::new(4.0, 9.0, 1.0));
    let half = between(&DAffine3::IDENTITY, &grown, DVec3::ZERO, 0.5);
    assert_near(half, DAffine3::from_scale(DVec3::new(2.0, 3.0, 1.0)), "half grown");
    let away = DAffine3::from_translation(DVec3::new(3.0, 0.0, -6.0));
    let third = between(&DAffine3::IDENTITY, &away, DVec3::X, 1.0 / 3.0);
    assert_near(third, DAffine3::from_translation(DVec3::new(1.0, 0.0, -2.0)), "a third of the way");
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let flat = between(&DAffine3::IDENTITY, &mirror, DVec3::ZERO, 0.5);
    assert_near(flat, DAffine3::from_scale(DVec3::new(0.0, 1.0, 1.0)), "mirrored");
}

fn group(id: u32, vertices: &[u32], rest: &[DVec3], motion: DAffine3) -> Group {
    Group {
        id: GroupId(id),
        name: format!("group {id}"),
        kind: GroupKind::Handle,
        color: GroupColor::Yellow,
        dots: true,
        vertices: vertices.iter().map(|&v| VertexId(v)).collect(),
        base: vertices.iter().map(|&v| rest[v as usize]).collect(),
        motion,
    }
}

fn kept(id: u32, groups: Vec<Group>, positions: &[DVec3]) -> KeptPose {
    KeptPose { id: PoseId(id), name: format!("Pose {id}"), groups: groups.into(), positions: positions.into() }
}

fn place(groups: &Arc<[Group]>, v: u32) -> DVec3 {
    let group = groups.iter().find(|group| group.holds(VertexId(v))).expect("a held vertex");
    let at = group.vertices.binary_search(&VertexId(v)).expect("it holds it");
    group.targets().nth(at).expect("a target")
}

#[test]
fn what_only_one_pose_holds_goes_to_where_the_other_has_it() {
    let rest: Vec<DVec3> = (0..6).map(|k| DVec3::new(f64::from(k), f64::from(k % 2), 0.0)).collect();
    let bent: Vec<DVec3> = rest.iter().map(|p| *p + DVec3::new(0.0, 0.0, p.x)).collect();
    let shared = |motion| group(1, &[0, 1], &rest, motion);
    let turned = about(DVec3::ZERO, DVec3::Z, 90.0);
    let first = kept(1, vec![shared(DAffine3::IDENTITY), group(2, &[4, 5], &rest, DAffine3::IDENTITY)], &rest);
    let second = kept(2, vec![shared(turned), group(3, &[2, 3], &bent, DAffine3::IDENTITY)], &bent);
    let segment = Segment::new(&first, &second);
    let (begin, end) = (segment.groups(0.0), segment.groups(1.0));
    for v in 0..6_u32 {
        let in_first = if v < 2 { rest[v as usize] } else { first.positions[v as usize] };
        let in_second = if v < 2 { turned.transform_point3(rest[v as usize]) } else { bent[v as usize] };
        assert!(place(&begin, v).distance(in_first) < 1e-12, "vertex {v} begins at {}", place(&begin, v));
        assert!(place(&end, v).distance(in_second) < 1e-12, "vertex {v} ends at {}", place(&end, v));
    }
    let half = place(&segment.groups(0.5), 1);
    let expected = about(DVec3::ZERO, DVec3::Z, 45.0).transform_point3(rest[1]);
    assert!(half.distance(expected) < 1e-12, "{half}, expected {expected}");
}

#[test]
fn a_group_placed_anew_still_turns_as_one_piece() {
    // In a plane: the covariance of its points is singular.
    let rest: Vec<DVec3> = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0)).into();
    let turn = about(DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.3, 1.0, 0.2), 80.0);
    let there: Vec<DVec3> = rest.iter().map(|&p| turn.transform_point3(p)).collect();
    let first = kept(1, vec![group(1, &[0, 1, 2, 3], &rest, DAffine3::IDENTITY)], &rest);
    let second = kept(2, vec![group(1, &[0, 1, 2, 3], &there, DAffine3::IDENTITY)], &there);
    let half = Segment::new(&first, &second).groups(0.5);
    let expected = about(DVec3::new(1.0, 0.5, 0.0), DVec3::new(0.3, 1.0, 0.2), 40.0);
    for v in 0..4_u32 {
        let expected = expected.transform_point3(rest[v as usize]);
        assert!(place(&half, v).distance(expected) < 1e-9, "vertex {v}: {}, expected {expected}", place(&half, v));
    }
    assert!(DMat3::IDENTITY.is_finite());
}

fn plan(kind: Kind, to: &str, between: usize) -> Plan {
    Plan { kind, to: PathBuf::from(to), between, seconds: 0.5, stepped: false, closed: false, size: [64, 48] }
}

#[test]
fn files_of_a_sequence_are_numbered_before_their_ending() {
    assert_eq!(numbered(Path::new("a/walk.obj"), 7, 120), Path::new("a/walk.0007.obj"));
    assert_eq!(numbered(Path::new("walk.v2.png"), 12345, 20000), Path::new("walk.v2.12345.png"));
    let files = plan(Kind::Meshes, "walk.ply", 2).files(3);
    assert_eq!(files.len(), 7);
    assert_eq!(files[6], Path::new("walk.0007.ply"));
    let times: Vec<f64> = plan(Kind::Animation, "walk.glb", 1).times(3).collect();
    assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
}

#[test]
fn a_loop_has_a_way_back_to_the_first_pose_which_is_no_further_file() {
    let looped = |n_poses| {
        let plan = Plan { closed: true, ..plan(Kind::Animation, "walk.glb", 1) };
        let next: Vec<Option<usize>> = (0..n_poses).map(|pose| plan.next(pose, n_poses)).collect();
        (plan.n_frames(n_poses), plan.times(n_poses).count(), next)
    };
    assert_eq!(looped(3), (6, 7, vec![Some(1), Some(2), Some(0)]));
    assert_eq!(looped(2), (4, 5, vec![Some(1), Some(0)]));
    assert_eq!(looped(1), (1, 1, vec![None]), "a single pose has nowhere to go");
    assert_eq!(looped(0), (0, 0, vec![]));
    assert_eq!(plan(Kind::Animation, "walk.glb", 1).next(2, 3), None);
}

#[test]
fn what_cannot_be_written_is_said() {
    for (kind, to, n_poses, expected) in [
        (Kind::Animation, "a.glb", 0, "Keep a pose"),
        (Kind::Animation, "a.obj", 2, ".glb or .gltf"),
        (Kind::Meshes, "a.png", 2, ".obj"),
        (Kind::Pictures, "a.obj", 2, ".png"),
        (Kind::Pictures, "no/such/folder/a.png", 2, "folder"),
    ] {
        let said = plan(kind, to, 0).obstacle(n_poses, None).unwrap_or_default();
        assert!(said.contains(expected), "{kind:?} {to}: {said}");
    }
    assert_eq!(plan(Kind::Meshes, "a.obj", 0).obstacle(2, None), None);
    let said = plan(Kind::Meshes, "a.obj", 0).obstacle(2, Some(Path::new("a.0001.obj"))).unwrap_or_default();
    assert!(said.contains("overwrite"), "{said}");
}
