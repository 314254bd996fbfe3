//! Kept poses: kept, shown, arranged and taken back.

use super::*;
use glam::DAffine3;
use pliant::document::{KeptPose, PoseChange, PoseId};
use pliant::posing::{Kind, Plan, Repeat};

fn names(session: &Session) -> Vec<&str> {
    session.poses().iter().map(|kept| kept.name.as_str()).collect()
}

fn kept(session: &Session, place: usize) -> KeptPose {
    session.poses()[place].clone()
}

/// Two handles; the second lifted by `height`, and the surface at rest there.
fn lift(session: &mut Session, height: f64) {
    if document(session).scene().groups.is_empty() {
        place_two_handles(session);
    }
    let id = document(session).scene().groups[1].id;
    session.apply(Command::Move { group: id, motion: DAffine3::from_translation(DVec3::Z * height) });
    settle(session);
}

/// A session with a pose for each of these heights.
pub(super) fn with_poses(heights: &[f64]) -> Session {
    let mut session = session_with(sheet(20));
    for &height in heights {
        lift(&mut session, height);
        session.keep_pose();
    }
    session
}

#[test]
fn a_shown_pose_brings_back_handles_and_surface_to_the_bit_in_one_step() {
    let mut session = with_poses(&[0.1, 0.4]);
    assert!(session.strip_is_open(), "keeping a pose brings the strip up");
    let (first, second) = (kept(&session, 0), kept(&session, 1));
    let steps = document(&session).history().len();
    session.show_pose(first.id);
    assert_eq!(document(&session).history().len(), steps + 1);
    assert_eq!(document(&session).pose().positions, first.positions);
    assert_eq!(document(&session).scene().groups, first.groups);
    assert_eq!(document(&session).scene().pose_shown().map(|kept| kept.id), Some(first.id));
    session.undo();
    assert_eq!(document(&session).pose().positions, second.positions);
    assert_eq!(document(&session).scene().groups, second.groups);
    session.redo();
    settle(&mut session);
    let largest = document(&session).pose().positions.iter().zip(&*first.positions);
    let largest = largest.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // What was settled moves on by less than an iteration did when it was called settled.
    assert!(largest < 1e-3, "a shown pose drifts by {largest}");
}

#[test]
fn the_strip_is_arranged_by_steps_that_can_be_taken_back() {
    let mut session = with_poses(&[0.1, 0.2, 0.3]);
    assert_eq!(names(&session), ["Pose 1", "Pose 2", "Pose 3"]);
    let ids: Vec<PoseId> = session.poses().iter().map(|kept| kept.id).collect();
    let before: Vec<KeptPose> = session.poses().to_vec();
    session.apply(Command::Poses(PoseChange::Place(ids[2], 0)));
    assert_eq!(names(&session), ["Pose 3", "Pose 1", "Pose 2"]);
    session.apply(Command::Poses(PoseChange::Rename(ids[0], " Wave ".into())));
    session.apply(Command::Poses(PoseChange::Rename(ids[1], "   ".into())));
    assert_eq!(names(&session), ["Pose 3", "Wave", "Pose 2"], "a name of nothing is none");
    session.apply(Command::Poses(PoseChange::Delete(ids[1])));
    assert_eq!(names(&session), ["Pose 3", "Wave"]);
    lift(&mut session, 0.5);
    session.apply(Command::Poses(PoseChange::Update(ids[0])));
    let updated = session.poses().iter().find(|kept| kept.id == ids[0]).expect("it stays");
    assert_eq!(updated.positions, document(&session).pose().positions);
    session.keep_pose();
    assert_eq!(names(&session), ["Pose 3", "Wave", "Pose 4"], "no name comes twice");
    for _ in 0..6 {
        session.undo();
    }
    assert_eq!(session.poses(), before);
    session.apply(Command::Poses(PoseChange::Delete(PoseId(99))));
    let notice = session.notices.list().last().expect("a notice").text.clone();
    assert!(notice.contains("does not exist"), "{notice}");
    assert_eq!(session.poses(), before);
}

#[test]
fn a_pose_is_shown_after_its_handles_were_deleted() {
    let mut session = with_poses(&[0.3]);
    let first = kept(&session, 0);
    let ids = document(&session).scene().groups.iter().map(|group| group.id).collect();
    session.apply(Command::Release(ids));
    session.apply(Command::ResetPose);
    assert!(document(&session).scene().groups.is_empty());
    session.show_pose(first.id);
    assert_eq!(document(&session).scene().groups, first.groups);
    assert_eq!(document(&session).pose().positions, first.positions);
    settle(&mut session);
}

#[test]
fn playing_shows_the_poses_and_what_lies_between_without_touching_the_document() {
    let mut session = with_poses(&[0.1, 0.4]);
    let (revision, steps) = (document(&session).revision(), document(&session).history().len());
    let before = document(&session).pose().positions.clone();
    session.toggle_play();
    let all =
        |session: &Session| session.player().is_some_and(|player| player.frames().n_solved() == player.frames().len());
    wait_until(&mut session, "all surfaces are solved", all);
    let handle = kept(&session, 1).groups[1].vertices[0].index();
    let height = |session: &Session| session.played().expect("a surface").positions[handle].z;
    for (place, expected) in [(0.0, 0.1), (0.5, 0.25), (1.0, 0.4)] {
        session.seek(place);
        let got = height(&session);
        // Handles are where they are put, in single precision of coordinates below 1.
        assert!((got - expected).abs() < 1e-6, "at {place} the handle is at height {got}, expected {expected}");
    }
    session.toggle_play();
    assert!(session.advance_play(0.3), "it goes on");
    assert_eq!(document(&session).revision(), revision);
    assert_eq!(document(&session).history().len(), steps);
    assert_eq!(document(&session).pose().positions, before, "the document stays as it is");
    let somewhere = pointer(Vec2::new(400.0, 300.0));
    session.input(Input::Press(somewhere));
    assert!(session.player().is_none(), "a press ends it");
    session.input(Input::Release(somewhere));
    assert_eq!(document(&session).history().len(), steps, "and does nothing else");
    session.toggle_play();
    lift(&mut session, 0.2);
    assert!(session.player().is_none(), "an edit ends it");
}

#[test]
fn a_loop_goes_on_from_the_last_pose_to_the_first_and_a_play_can_be_told_to_stop_there() {
    let mut session = with_poses(&[0.1, 0.4, 0.2]);
    let all =
        |session: &Session| session.player().is_some_and(|player| player.frames().n_solved() == player.frames().len());
    let handle = kept(&session, 1).groups[1].vertices[0].index();
    session.toggle_play();
    wait_until(&mut session, "all surfaces are solved", all);
    assert_eq!(session.last_place(), 3.0);
    for (place, expected) in [(2.0, 0.2), (2.5, 0.15), (3.0, 0.1), (9.0, 0.1)] {
        session.seek(place);
        let got = session.played().expect("a surface").positions[handle].z;
        // Single precision of coordinates below 1.
        assert!((got - expected).abs() < 1e-6, "at {place} the handle is at height {got}, expected {expected}");
    }
    session.seek(2.75);
    session.toggle_play();
    session.advance_play(0.5);
    let position = |session: &Session| session.player().expect("a play").position();
    assert!((position(&session) - 0.25).abs() < 1e-9, "behind the last pose it is at {}", position(&session));
    session.set_pace(Repeat::Once, 1.0);
    assert_eq!((session.last_place(), position(&session)), (2.0, 0.25), "another pace loses the place");
    session.advance_play(5.0);
    assert_eq!(position(&session), 2.0);
    session.set_pace(Repeat::Restart, 1.0);
    session.seek(9.0);
    assert_eq!(position(&session), 2.0);
}

#[test]
fn a_looped_animation_ends_with_the_pose_it_began_with() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = with_poses(&[0.1, 0.4]);
    let to = folder.path().join("poses.glb");
    exported(&mut session, Plan { closed: true, ..plan(Kind::Animation, to.clone(), 1) });
    let theirs = gltf::Gltf::open(&to).expect("the gltf crate reads it");
    let blob = theirs.blob.clone().expect("a chunk");
    let animation = theirs.animations().next().expect("an animation");
    let reader = animation.channels().next().expect("a channel").reader(|_| Some(&blob));
    let times: Vec<f32> = reader.read_inputs().expect("times").collect();
    assert_eq!(times, [0.0, 0.25, 0.5, 0.75, 1.0]);
    let Some(gltf::animation::util::ReadOutputs::MorphTargetWeights(weights)) = reader.read_outputs() else {
        panic!("the channel is not one of weights");
    };
    let weights: Vec<f32> = weights.into_f32().collect();
    assert_eq!(weights.len(), 5 * 4, "four shapes, five keys");
    assert_eq!(weights[..4], [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(weights[16..], weights[..4]);
    assert_eq!(weights[12..16], [0.0, 0.0, 0.0, 1.0], "half way back");
}

#[test]
fn closing_the_window_stops_an_export_and_leaves_nothing_of_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = with_poses(&[0.1, 0.4]);
    for kind in [Kind::Meshes, Kind::Animation] {
        let ending = if kind == Kind::Meshes { "ply" } else { "glb" };
        session.export_poses(plan(kind, folder.path().join(format!("walk.{ending}")), 1000), None);
        std::thread::sleep(Duration::from_millis(30));
        session.end();
        assert!(names_in(folder.path()).is_empty(), "left behind: {:?}", names_in(folder.path()));
    }
}

fn plan(kind: Kind, to: std::path::PathBuf, between: usize) -> Plan {
    Plan { kind, to, between, seconds: 0.5, stepped: false, closed: false, size: [64, 48] }
}

fn exported(session: &mut Session, plan: Plan) {
    session.export_poses(plan, None);
    wait_until(session, "the export is over", |session| session.exporting_poses().is_none());
}

fn names_in(folder: &Path) -> Vec<String> {
    let listed = std::fs::read_dir(folder).expect("the folder");
    let mut names: Vec<String> =
        listed.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn an_animation_holds_every_pose_and_what_was_solved_between() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = with_poses(&[0.1, 0.4]);
    let to = folder.path().join("poses.glb");
    exported(&mut session, plan(Kind::Animation, to.clone(), 1));
    let said = session.notices.list().iter().map(|notice| notice.text.clone()).collect::<Vec<_>>().join("\n");
    assert!(said.contains("Saved"), "{said}");
    let theirs = gltf::Gltf::open(&to).expect("the gltf crate reads it");
    let blob = theirs.blob.clone().expect("a chunk");
    let mesh = theirs.meshes().next().expect("a mesh");
    assert_eq!(mesh.weights().map(<[f32]>::len), Some(3));
    let primitive = mesh.primitives().next().expect("a primitive");
    let reader = primitive.reader(|_| Some(&blob));
    let base: Vec<[f32; 3]> = reader.read_positions().expect("positions").collect();
    let targets: Vec<Vec<[f32; 3]>> =
        reader.read_morph_targets().map(|(moved, _, _)| moved.expect("displacements").collect()).collect();
    for (target, place) in [(0, 0), (2, 1)] {
        for (v, expected) in kept(&session, place).positions.iter().enumerate() {
            let at = |k: usize| f64::from(base[v][k]) + f64::from(targets[target][v][k]);
            let got = DVec3::new(at(0), at(1), at(2));
            // Single precision twice, at coordinates below 1.
            assert!(got.distance(*expected) < 1e-6, "pose {place}, vertex {v}: {got}, expected {expected}");
        }
    }
    let handle = kept(&session, 1).groups[1].vertices[0].index();
    assert!((base[handle][2] + targets[1][handle][2] - 0.25).abs() < 1e-6, "half way between the poses");
    let animation = theirs.animations().next().expect("an animation");
    let channel = animation.channels().next().expect("a channel");
    let times: Vec<f32> = channel.reader(|_| Some(&blob)).read_inputs().expect("times").collect();
    assert_eq!(times, [0.0, 0.25, 0.5]);
}

#[test]
fn a_sequence_is_numbered_and_a_canceled_one_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = with_poses(&[0.1, 0.4]);
    exported(&mut session, plan(Kind::Meshes, folder.path().join("walk.obj"), 2));
    assert_eq!(names_in(folder.path()), ["walk.0001.obj", "walk.0002.obj", "walk.0003.obj", "walk.0004.obj"]);
    let last = pliant_meshfile::open(&folder.path().join("walk.0004.obj")).expect("opens");
    let kept = kept(&session, 1);
    for (got, expected) in last.points().iter().zip(kept.positions.iter()) {
        assert!(got.distance(*expected) < 1e-6, "{got}, expected {expected}");
    }
    let other = tempfile::tempdir().expect("a temporary folder");
    session.export_poses(plan(Kind::Meshes, other.path().join("walk.ply"), 1000), None);
    session.cancel_exporting_poses();
    let start = Instant::now();
    while !names_in(other.path()).is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "left behind: {:?}", names_in(other.path()));
        std::thread::sleep(Duration::from_millis(2));
    }
    exported(&mut session, plan(Kind::Meshes, other.path().join("walk.xyz"), 0));
    let said = session.notices.list().last().expect("a notice").text.clone();
    assert!(said.contains("not exported"), "{said}");
}
