//! The strip of poses in the window, and what closing does to an export.

use super::*;
use egui::{Key, Modifiers};
use pliant::document::Command;
use pliant::posing::{Kind, Plan};

/// A window with a handle and three poses of it.
fn with_poses(folder: &std::path::Path) -> Window {
    let mut window = window(folder);
    let hold = Command::Hold { kind: GroupKind::Handle, vertices: (0..9).map(pliant_solver::VertexId).collect() };
    window.state_mut().session().apply(hold);
    let id = document(window.state_mut().session()).scene().groups[0].id;
    for height in [0.0, 0.2, 0.4] {
        let motion = glam::DAffine3::from_translation(glam::DVec3::Z * height);
        window.state_mut().session().apply(Command::Move { group: id, motion });
        settle(&mut window);
        window.state_mut().session().keep_pose();
    }
    window.run_steps(4);
    window
}

fn names(window: &mut Window) -> Vec<String> {
    window.state_mut().session().poses().iter().map(|kept| kept.name.clone()).collect()
}

fn focused(window: &Window) -> Option<String> {
    let is_focused =
        |name: &&&str| window.query_by_label(&format!("Show {name}")).is_some_and(|card| card.is_focused());
    ["Pose 1", "Pose 2", "Pose 3", "Wave"].iter().find(is_focused).map(|name| (*name).to_owned())
}

#[test]
fn the_strip_is_worked_by_keys_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = with_poses(folder.path());
    window.get_by_label("Show Pose 3").focus();
    window.run_steps(2);
    for (key, expected) in [
        (Key::ArrowLeft, "Pose 2"),
        (Key::ArrowLeft, "Pose 1"),
        (Key::ArrowLeft, "Pose 1"),
        (Key::End, "Pose 3"),
        (Key::Home, "Pose 1"),
        (Key::ArrowRight, "Pose 2"),
    ] {
        press(&mut window, key);
        window.run_steps(2);
        assert_eq!(focused(&window).as_deref(), Some(expected), "after {key:?}");
    }
    assert_eq!(
        document(window.state_mut().session()).scene().pose_shown().map(|kept| kept.name.as_str()),
        Some("Pose 3")
    );
    press(&mut window, Key::Enter);
    window.run_steps(2);
    assert_eq!(
        document(window.state_mut().session()).scene().pose_shown().map(|kept| kept.name.as_str()),
        Some("Pose 2")
    );
    window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowLeft);
    window.run_steps(3);
    assert_eq!(names(&mut window), ["Pose 2", "Pose 1", "Pose 3"]);
    assert_eq!(focused(&window).as_deref(), Some("Pose 2"), "the card that was moved keeps the keys");
    press(&mut window, Key::F2);
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text("Wave".into()));
    window.run_steps(2);
    press(&mut window, Key::Enter);
    window.run_steps(3);
    assert_eq!(names(&mut window), ["Wave", "Pose 1", "Pose 3"]);
    assert_eq!(focused(&window).as_deref(), Some("Wave"));
    press(&mut window, Key::Delete);
    window.run_steps(3);
    assert_eq!(names(&mut window), ["Pose 1", "Pose 3"]);
    assert_eq!(focused(&window).as_deref(), Some("Pose 1"));
    assert_eq!(document(window.state_mut().session()).scene().groups.len(), 1, "the handle was deleted as well");
}

#[test]
fn closing_asks_before_it_stops_an_export() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = with_poses(folder.path());
    let session = window.state_mut().session();
    session.save_project(folder.path().join("bar.pliant"), pliant::project::Mesh::Packed);
    step_until(&mut window, "the project is saved", |session| session.running_job().is_none());
    let to = folder.path().join("walk.obj");
    let plan =
        Plan { kind: Kind::Meshes, to, between: 1000, seconds: 1.0, stepped: false, closed: false, size: [64, 64] };
    window.state_mut().session().export_poses(plan, None);
    let id = egui::ViewportId::ROOT;
    window.input_mut().viewports.entry(id).or_default().events.push(egui::ViewportEvent::Close);
    window.run_steps(3);
    assert!(window.query_by_label("Stop the export?").is_some(), "nobody asked");
    window.get_by_label("Stay open").click();
    window.run_steps(3);
    assert!(window.state_mut().session().exporting_poses().is_some(), "it was stopped");
    window.state_mut().session().cancel_exporting_poses();
}
