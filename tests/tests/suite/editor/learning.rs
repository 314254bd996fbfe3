//! Rigidity learned from poses, as the panel does it.

use std::path::{Path, PathBuf};

use pliant::document::Command;
use pliant::editor::{Job, LearningView, Omega, Sample, Session, Settings, Shown};
use pliant::learning::sources::Source;
use pliant_solver::VertexId;

use super::{document, session_with, sheet, wait_until};

fn open_sample(sample: Sample) -> Session {
    let mut session = Session::new(|| {}).expect("a solver thread");
    session.start(Job::OpenSample(sample));
    wait_until(&mut session, "the sample is open", |session| session.document().is_some());
    session
}

/// Starts to learn and waits for what the panel then asks or shows.
fn learn(session: &mut Session) {
    session.start_learning();
    let start = std::time::Instant::now();
    while is_gathering(session) {
        assert!(start.elapsed() < std::time::Duration::from_secs(60), "the poses are never read");
        session.poll();
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
}

fn is_gathering(session: &mut Session) -> bool {
    let learning = session.learning.as_mut().expect("the panel is open");
    matches!(learning.view(), LearningView::Gathering { .. })
}

fn trial(session: &mut Session) -> &mut pliant::editor::Trial {
    match session.learning.as_mut().expect("the panel is open").view() {
        LearningView::Looking { trial, .. } => trial,
        _ => panic!("there is no result to look at"),
    }
}

/// The rest shape of an open mesh as an OBJ, each vertex moved.
fn write_pose(session: &Session, path: &Path, moved: impl Fn(glam::DVec3) -> glam::DVec3) {
    let mesh = &document(session).model().mesh;
    let mut text = String::new();
    for p in mesh.positions() {
        let p = moved(*p);
        text += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for [a, b, c] in mesh.triangles() {
        text += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
    }
    std::fs::write(path, text).expect("a writable folder");
}

#[test]
fn the_poses_of_a_sample_become_rigidity_by_one_step_that_can_be_undone() {
    let mut session = open_sample(Sample::JointedBar);
    session.open_learning();
    let before = document(&session).scene().rigidity.clone();
    learn(&mut session);
    assert_eq!(trial(&mut session).reading().poses.len(), 12);
    assert_eq!(trial(&mut session).reading().broken, Vec::<String>::new());
    let learned = trial(&mut session).rigidity().clone();
    assert!(learned.min() <= 2 && learned.max() >= 5, "joints and bones: {} to {}", learned.min(), learned.max());
    assert_eq!(document(&session).scene().rigidity, before, "a result is only looked at");
    assert_eq!(session.shown_rigidity(), Some(&learned));
    trial(&mut session).shown = Shown::Now;
    assert_eq!(session.shown_rigidity(), Some(&before));
    session.apply_learned();
    assert!(session.learning.is_none());
    assert_eq!(document(&session).scene().rigidity, learned);
    assert_eq!(document(&session).history().undo_name(), Some("Learn rigidity"));
    session.undo();
    assert_eq!(document(&session).scene().rigidity, before);
}

#[test]
fn sliders_change_the_result_and_auto_brings_it_back() {
    let mut session = open_sample(Sample::JointedBar);
    session.open_learning();
    learn(&mut session);
    let trial = trial(&mut session);
    let (automatic, settings) = (trial.rigidity().clone(), trial.settings());
    assert_eq!(trial.histogram().iter().sum::<usize>(), automatic.as_slice().len());
    trial.set(Settings { omega: Omega::Absolute(1e9), ..settings.clone() });
    assert_eq!(trial.rigidity().min(), 6, "stiffness is worth everything");
    trial.set(Settings { omega: Omega::Absolute(0.0), range: 2..=4, smoothing: 2 });
    assert!(trial.rigidity().min() >= 2 && trial.rigidity().max() <= 4);
    trial.set(settings);
    assert_eq!(trial.rigidity(), &automatic);
}

#[test]
fn a_broken_pose_is_named_and_the_others_serve_if_the_user_agrees() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(12));
    let [good, broken, other]: [PathBuf; 3] =
        ["good.obj", "broken.obj", "other.obj"].map(|name| folder.path().join(name));
    write_pose(&session, &good, |p| glam::DVec3::new(p.x, p.y, p.x * p.x));
    std::fs::write(&broken, "v 1 2\nf 1 2 3\n").expect("a writable folder");
    write_pose(&session_with(sheet(5)), &other, |p| p);
    session.open_learning();
    let revision = document(&session).revision();
    let learning = session.learning.as_mut().expect("open");
    learning.add_files([good.clone(), broken, other]);
    assert_eq!(learning.sources().len(), 3);
    learn(&mut session);
    let learning = session.learning.as_mut().expect("open");
    let LearningView::Asking(reading) = learning.view() else { panic!("two files are broken") };
    assert_eq!(reading.poses.len(), 1);
    assert!(reading.broken[0].contains("broken.obj") && reading.broken[1].contains("other.obj"), "{reading:?}");
    learning.accept();
    assert_eq!(trial(&mut session).reading().poses.len(), 1);
    assert_eq!(document(&session).revision(), revision, "nothing has been applied");

    let learning = session.learning.as_mut().expect("open");
    learning.choose();
    while let Some(place) = learning.sources().iter().position(|source| *source == Source::File(good.clone())) {
        learning.remove(place);
    }
    learn(&mut session);
    let learning = session.learning.as_mut().expect("open");
    assert!(matches!(learning.view(), LearningView::Choosing));
    let trouble = learning.trouble.clone().expect("no file can be used");
    assert!(trouble.contains("broken.obj"), "{trouble}");
}

#[test]
fn canceled_learning_leaves_everything_as_it_was() {
    let mut session = open_sample(Sample::Gecko);
    session.open_learning();
    let revision = document(&session).revision();
    session.start_learning();
    session.learning.as_mut().expect("open").choose();
    assert!(matches!(session.learning.as_mut().expect("open").view(), LearningView::Choosing));
    session.poll();
    assert!(session.learning.as_ref().expect("open").trial().is_none());
    session.learning = None;
    assert_eq!(document(&session).revision(), revision);
    assert!(!document(&session).is_modified());
    assert_eq!(session.shown_rigidity(), Some(&document(&session).scene().rigidity));
}

#[test]
fn a_check_compares_what_was_learned_with_the_same_rigidity_everywhere() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(12));
    session.open_learning();
    for (name, angle) in [("a.obj", 0.5), ("b.obj", 1.0)] {
        let path = folder.path().join(name);
        // Folded over a line in the middle: two stiff halves.
        write_pose(&session, &path, |p| if p.x > 0.0 { glam::DQuat::from_rotation_y(angle) * p } else { p });
        session.learning.as_mut().expect("open").add_files([path]);
    }
    learn(&mut session);
    session.learning.as_mut().expect("open").check();
    let start = std::time::Instant::now();
    loop {
        session.poll();
        let learning = session.learning.as_mut().expect("open");
        assert_eq!(learning.trouble, None);
        if let LearningView::Looking { report: Some((report, is_current)), .. } = learning.view() {
            assert_eq!(report.predictions.len(), 2);
            assert_eq!(report.uniform().iter().map(|&(r, _)| r).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
            assert!(is_current);
            break;
        }
        assert!(start.elapsed() < std::time::Duration::from_secs(60), "the check never ends");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let trial = trial(&mut session);
    trial.set(Settings { smoothing: 1, ..trial.settings() });
    let LearningView::Looking { report: Some((_, is_current)), .. } = session.learning.as_mut().expect("open").view()
    else {
        panic!("the report is gone");
    };
    assert!(!is_current, "a check says nothing of other settings");
}

#[test]
fn files_that_come_late_and_painting_take_no_result_away() {
    let mut session = open_sample(Sample::JointedBar);
    session.open_learning();
    learn(&mut session);
    let learned = trial(&mut session).rigidity().clone();
    let learning = session.learning.as_mut().expect("open");
    learning.add_files([PathBuf::from("late.obj")]);
    assert!(learning.has_new_files && learning.sources().len() == 2);
    assert_eq!(trial(&mut session).rigidity(), &learned);
    session.apply(Command::Paint { values: vec![(VertexId(0), 5)] });
    assert_eq!(trial(&mut session).shown, Shown::Now, "what is painted must be seen");
    assert_eq!(session.shown_rigidity(), Some(&document(&session).scene().rigidity));
    session.apply_learned();
    session.undo();
    assert_eq!(document(&session).scene().rigidity.as_slice()[0], 5);
}
