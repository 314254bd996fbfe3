//! Projects, autosave and history, driven by what a window would do.

use pliant::document::Snapshot;
use pliant::editor::{JobEvent, leftovers};
use pliant::project::{Mesh, MeshChoice};
use pliant::tools::Pivot;

use super::*;

const MINUTE: Duration = Duration::from_secs(61);

fn saved(session: &mut Session, to: &Path, mesh: Mesh) -> Snapshot {
    let snapshot = document(session).snapshot();
    session.save_project(to.to_owned(), mesh);
    wait_until(session, "the project is saved", |session| session.running_job().is_none());
    assert!(to.is_file(), "not written: {:?}", session.notices.list());
    snapshot
}

fn opened(path: &Path) -> Session {
    let mut session = Session::new(|| {}).expect("a solver thread");
    session.start(Job::Open(path.to_owned()));
    wait_until(&mut session, "the project is open", |session| session.document().is_some());
    session
}

/// A bent, painted sheet with two handles.
fn bent() -> Session {
    let mut session = session_with(sheet(20));
    place_two_handles(&mut session);
    let from = on_screen(&session, middle(17));
    drag(&mut session, from, from + Vec2::new(60.0, 30.0));
    session.apply(Command::Fill { vertices: (100..200).map(VertexId).collect(), r: 7 });
    session.apply(Command::Select((3..9).map(VertexId).collect(), SelectMode::Replace));
    settle(&mut session);
    session
}

#[test]
fn a_project_opens_as_it_was_left_and_is_not_taken_for_changed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("bend.pliant");
    let mut session = bent();
    session.take_tool(ToolKind::Brush);
    session.options.brush_radius_px = 77.0;
    let pivot = Pivot::Point(DVec3::new(0.25, -1.0 / 3.0, 0.125));
    session.options.gizmo.pivot = pivot;
    let camera = {
        let open = session.open_mut().expect("open");
        open.camera.orbit(Vec2::new(30.0, 40.0));
        open.camera
    };
    let snapshot = saved(&mut session, &to, Mesh::Packed);
    assert!(!document(&session).is_modified(), "still marked as modified");
    let mut again = opened(&to);
    let open = again.open().expect("open");
    assert_eq!((open.camera, open.name().as_str()), (camera, "bend"));
    assert_eq!(open.project.as_ref().map(|project| project.path.as_path()), Some(to.as_path()));
    assert_eq!(document(&again).scene(), &snapshot.scene);
    assert_eq!((again.tool_kind(), again.options.brush_radius_px), (ToolKind::Brush, 77.0));
    assert_eq!(again.options.gizmo.pivot, pivot);
    assert_eq!(document(&again).pose(), &snapshot.pose, "it opens elsewhere than it was left");
    settle(&mut again);
    assert!(!document(&again).is_modified(), "settling again counts as a change");
    let largest = document(&again).pose().positions.iter().zip(snapshot.pose.positions.iter());
    let largest = largest.map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // A tenth of a cell: the iteration goes on a little, with nothing learned from the steps before.
    assert!(largest < 5e-3, "settling again moved the surface by {largest}");
    // Where another mesh was on screen, too.
    let mut other = session_with(sheet(4));
    other.start(Job::Open(to));
    wait_until(&mut other, "the project is open", |session| document(session).model().mesh.n_vertices() == 441);
    settle(&mut other);
    // Placing goes on with fresh names, and can be undone to what was opened, not beyond.
    again.apply(Command::Hold { kind: GroupKind::Anchor, vertices: vec![VertexId(0)] });
    assert_eq!(document(&again).scene().groups.last().expect("placed").name, "Anchor 3");
    assert!(document(&again).is_modified());
    again.undo();
    again.undo();
    assert_eq!(document(&again).scene(), &snapshot.scene);
}

#[test]
fn a_project_whose_mesh_is_gone_asks_for_it_and_opens_with_the_one_that_is_chosen() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mesh, moved) = (folder.path().join("m.obj"), folder.path().join("moved.obj"));
    std::fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let to = folder.path().join("a.pliant");
    let mut session = opened(&mesh);
    session.apply(Command::FillAll(3));
    saved(&mut session, &to, Mesh::Linked);
    std::fs::rename(&mesh, &moved).expect("moved");
    let mut again = Session::new(|| {}).expect("a solver thread");
    again.start(Job::Open(to.clone()));
    let start = Instant::now();
    let mut events = Vec::new();
    while events.is_empty() {
        assert!(start.elapsed() < Duration::from_secs(60), "nobody asked");
        events = again.poll();
    }
    assert!(matches!(&events[..], [JobEvent::MeshWanted { mesh, .. }] if mesh.ends_with("m.obj")));
    again.start(Job::OpenProject { path: to, choice: MeshChoice::Chosen(moved), leftover: None });
    wait_until(&mut again, "the project is open", |session| session.document().is_some());
    assert_eq!(document(&again).scene().rigidity.max(), 3);
}

#[test]
fn exporting_the_mesh_does_not_count_as_saving_the_project() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = session_with(sheet(4));
    session.apply(Command::FillAll(5));
    let to = folder.path().join("out.glb");
    session.export(to.clone());
    wait_until(&mut session, "the mesh is exported", |session| session.running_job().is_none());
    assert!(document(&session).is_modified());
    let open = session.open().expect("open");
    assert_eq!((open.is_exported(), &open.project), (Some(&to), &None));
    session.apply(Command::FillAll(6));
    assert_eq!(session.open().expect("open").is_exported(), None, "what is in the file is older");
}

/// A session that keeps its things in `folder`, with the sheet open.
fn remembering(folder: &Path) -> Session {
    let mut session = session_with(sheet(20));
    session.remember_in(folder);
    wait_until(&mut session, "leftovers are looked for", |session| session.running_job().is_none());
    session
}

fn wait_for_autosave(session: &mut Session) {
    let path = session.autosave_path().expect("an autosave").to_owned();
    wait_until(session, "the autosave is written", |_| pliant::project::summary(&path).is_ok());
}

#[test]
fn unsaved_work_is_written_after_a_minute_and_not_while_a_gesture_is_under_way() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut session = remembering(folder.path());
    let path = session.autosave_path().expect("an autosave").to_owned();
    let now = Instant::now();
    session.tick(now + MINUTE);
    assert!(session.due_in(now).is_none_or(|wait| wait < Duration::from_secs(3)), "nothing to autosave, yet it waits");
    session.apply(Command::FillAll(5));
    session.tick(now);
    session.tick(now + Duration::from_secs(59));
    assert_eq!(session.due_in(now + Duration::from_secs(59)).map(|wait| wait.as_secs() <= 1), Some(true));
    assert!(!path.exists(), "written too early");
    let from = on_screen(&session, middle(10));
    press_and_move(&mut session, from, from + Vec2::new(40.0, 0.0));
    session.tick(now + MINUTE);
    assert!(!path.exists(), "written in the middle of a drag");
    session.input(Input::Key(ToolKey::Escape));
    session.tick(now + MINUTE);
    wait_for_autosave(&mut session);
    // Saving makes it needless.
    saved(&mut session, &folder.path().join("a.pliant"), Mesh::Packed);
    wait_until(&mut session, "the autosave is removed", |_| !path.exists());
}

#[test]
fn what_a_window_that_stopped_left_behind_is_offered_once_and_recovered_whole() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut lost = remembering(folder.path());
    place_two_handles(&mut lost);
    lost.apply(Command::FillAll(5));
    let scene = document(&lost).scene().clone();
    let now = Instant::now();
    lost.tick(now);
    lost.tick(now + MINUTE);
    wait_for_autosave(&mut lost);
    let autosaves = folder.path().join("autosave");
    assert!(leftovers(&autosaves).is_empty(), "the autosave of a living window is offered");
    let left = lost.autosave_path().expect("an autosave").to_owned();
    // Without `end`, as after a crash; the lock goes with it.
    drop(lost);
    let mut next = remembering(folder.path());
    assert_eq!(next.recovery.len(), 1);
    assert_eq!(next.recovery[0].summary.as_ref().map(|summary| summary.name.as_str()), Ok("untitled"));
    assert!(leftovers(&autosaves).is_empty(), "a second window offers it too");
    next.recover(&left);
    wait_until(&mut next, "it is recovered", |session| session.recovery.is_empty());
    assert_eq!(document(&next).scene(), &scene);
    assert!(document(&next).is_modified() && next.open().expect("open").project.is_none(), "it counts as saved");
    // It is written anew before the old one goes.
    wait_for_autosave(&mut next);
    wait_until(&mut next, "the old autosave is removed", |_| !left.exists());
    next.end();
    let rest: Vec<_> = std::fs::read_dir(&autosaves).expect("a folder").flatten().map(|entry| entry.path()).collect();
    assert!(rest.is_empty(), "left behind after closing in order: {rest:?}");
}

#[test]
fn a_broken_autosave_is_told_and_can_be_discarded() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let autosaves = folder.path().join("autosave");
    std::fs::create_dir_all(&autosaves).expect("a folder");
    std::fs::write(autosaves.join("1-0.pliant"), b"\x89Pliant\nbroken").expect("written");
    let mut session = remembering(folder.path());
    let leftover = session.recovery[0].clone();
    assert!(leftover.summary.as_ref().is_err_and(|why| why.contains("damaged")), "{:?}", leftover.summary);
    session.recover(&leftover.file);
    wait_until(&mut session, "the job ends", |session| session.running_job().is_none());
    assert_eq!(document(&session).model().mesh.n_vertices(), 441, "the document was replaced");
    session.discard_leftover(&leftover);
    assert!(session.recovery.is_empty() && !leftover.file.exists());
}

#[test]
fn settings_and_recent_files_are_there_at_the_next_start() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let to = folder.path().join("a.pliant");
    let mut session = remembering(folder.path());
    session.options.brush_radius_px = 99.0;
    session.set_history_budget(1 << 30);
    saved(&mut session, &to, Mesh::Packed);
    session.end();
    let mut next = remembering(folder.path());
    assert_eq!((next.options.brush_radius_px, next.history_budget()), (99.0, 1 << 30));
    assert_eq!(next.recent.paths().collect::<Vec<_>>(), [to.as_path()]);
    next.want(to.clone());
    assert_eq!(next.take_wanted(), Some(to.clone()));
    std::fs::remove_file(&to).expect("removed");
    next.want(to);
    assert_eq!((next.take_wanted(), next.recent.paths().len()), (None, 0), "a file that is gone stays on the list");
}

#[test]
fn a_jump_through_the_history_leads_where_single_steps_lead() {
    let mut session = session_with(sheet(20));
    let mut states = vec![document(&session).snapshot()];
    for r in 2..=9 {
        session.apply(Command::Fill { vertices: (0..u32::from(r)).map(VertexId).collect(), r });
        if r % 3 == 0 {
            session.apply(Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(u32::from(r) * 7)] });
        }
        while states.len() <= document(&session).history().len() {
            states.push(document(&session).snapshot());
        }
    }
    let names: Vec<&str> = document(&session).history().names().collect();
    for to in [3, 9, 0, 5, 5, 11, 2, 100] {
        session.jump(to);
        let to = to.min(names.len());
        let now = document(&session);
        assert_eq!(now.history().len(), to);
        assert_eq!(now.scene().rigidity, states[to].scene.rigidity, "after a jump to step {to}");
        assert_eq!(now.pose(), &states[0].pose, "nothing was moved");
        assert_eq!(now.history().names().collect::<Vec<_>>(), names, "steps were lost on the way to {to}");
    }
    // The same by single steps.
    session.jump(2);
    let jumped = document(&session).snapshot();
    session.jump(names.len());
    while document(&session).history().len() > 2 {
        session.undo();
    }
    assert_eq!(document(&session).scene(), &jumped.scene);
}
