//! Projects, recovery and the history in the window.

use super::*;

/// A window that keeps its things in `folder`, with the paper's bar open.
fn remembering(folder: &std::path::Path) -> Window {
    let path = folder.join("bar.obj");
    std::fs::write(&path, shapes::paper_bar().obj()).expect("the sample is written");
    let data = folder.join("data");
    let mut window: Window = Harness::builder().with_size([1100.0, 720.0]).wgpu().build_eframe(move |cc| {
        EditorApp::remembering(cc, vec![path], Some(&data)).unwrap_or_else(|error| panic!("{error}: {NO_ADAPTER}"))
    });
    step_until(&mut window, "the file is open", |session| {
        session.running_job().is_none() && session.document().is_some()
    });
    window.run_steps(3);
    window
}

#[test]
fn ctrl_s_asks_once_and_then_saves_the_project_in_place() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    window.state_mut().session().apply(pliant::document::Command::FillAll(4));
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::S);
    window.run_steps(3);
    assert!(window.query_by_label("Save the project").is_some(), "nobody asked where");
    // What is proposed lies beside the mesh.
    window.get_by_label("Save").click();
    window.run_steps(2);
    let target = folder.path().join("bar.pliant");
    step_until(&mut window, "the project is saved", |session| {
        session.notices.list().iter().any(|notice| notice.kind == NoticeKind::Done)
    });
    assert!(target.is_file() && !document(window.state_mut().session()).is_modified());
    let first = std::fs::read(&target).expect("read");
    window.state_mut().session().apply(pliant::document::Command::FillAll(5));
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::S);
    step_until(&mut window, "it is saved again", |session| !document(session).is_modified());
    assert_ne!(std::fs::read(&target).expect("read"), first);
}

#[test]
fn unsaved_work_of_a_window_that_stopped_is_offered_and_comes_back_by_one_click() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut lost = remembering(folder.path());
    lost.state_mut().session().apply(pliant::document::Command::FillAll(4));
    let now = Instant::now();
    lost.state_mut().session().tick(now);
    lost.state_mut().session().tick(now + Duration::from_secs(61));
    let path = lost.state_mut().session().autosave_path().expect("an autosave").to_owned();
    step_until(&mut lost, "the autosave is written", |_| pliant::project::summary(&path).is_ok());
    drop(lost);
    let mut next = remembering(folder.path());
    next.run_steps(3);
    assert!(next.query_by_label("Recover unsaved work?").is_some(), "nothing is offered");
    next.get_by_label("Recover").click();
    next.run_steps(2);
    step_until(&mut next, "it is recovered", |session| document(session).scene().rigidity.max() == 4);
    next.run_steps(2);
    assert!(next.query_by_label("Recover unsaved work?").is_none(), "it is offered twice");
}

#[test]
fn a_click_in_the_history_goes_to_that_step() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    for r in [2, 3, 4] {
        window.state_mut().session().apply(pliant::document::Command::FillAll(r));
    }
    window.get_by_label("History").scroll_to_me();
    window.run_steps(20);
    window.get_by_label("History").click();
    window.run_steps(20);
    window.get_by_label("Start").scroll_to_me();
    window.run_steps(20);
    window.get_by_label("Start").click();
    window.run_steps(2);
    let now = document(window.state_mut().session());
    assert_eq!((now.history().len(), now.scene().rigidity.max()), (0, 1));
    assert_eq!(now.history().names().len(), 3, "steps were lost");
}
