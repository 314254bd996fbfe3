//! Handles in the window: angles typed over the gizmo and in the inspector, names and colors in the list.

use super::*;
use egui::Key;
use glam::{DMat3, DVec3};
use pliant::document::{Group, GroupColor};
use pliant::tools::{Gizmo, GizmoPart, View};

/// A handle at each end of the bar; the far one is worked on.
fn two_handles(window: &mut Window) {
    press(window, Key::H);
    for fraction in [0.05, 0.95] {
        let v = front_vertex(window, fraction);
        let at = place(window, v);
        click(window, at);
    }
    window.run_steps(2);
}

fn far_handle(window: &mut Window) -> Group {
    document(window.state_mut().session()).scene().groups[1].clone()
}

/// Where a part of the gizmo is taken, in the window.
fn part_at(window: &mut Window, part: GizmoPart) -> egui::Pos2 {
    let corner = window.get_by_label("viewport").rect().min;
    let session = window.state_mut().session();
    let (size, settings) = (session.viewport_size(), session.options.gizmo);
    let open = session.open().expect("open");
    let (view, scene) = (View { camera: open.camera, size }, open.document.scene());
    let at = open.document.model().to_view(settings.place(scene).expect("a gizmo"));
    let gizmo = Gizmo::new(at, settings.axes(scene, &view), settings.shown, &view);
    let center = open.camera.project(at, size).expect("in front of the eye").0;
    let steps = || (-60..=60).map(|k| 2.0 * k as f32);
    let mut places = steps().flat_map(|y| steps().map(move |x| center + Vec2::new(x, y)));
    let px = places.find(|&px| gizmo.hit(px, &view) == Some(part)).unwrap_or_else(|| panic!("no {part:?}"));
    corner + egui::vec2(px.x, px.y)
}

fn assert_turned(held: &Group, start: &Group, turn: DMat3) {
    let center = start.center();
    for (got, before) in held.targets().zip(start.targets()) {
        let expected = center + turn * (before - center);
        assert!(got.distance(expected) < 1e-12 * before.distance(center).max(1e-3), "{got}, expected {expected}");
    }
}

#[test]
fn an_angle_typed_over_a_ring_or_in_the_inspector_turns_the_patch_exactly() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    two_handles(&mut window);
    let (start, r) = (far_handle(&mut window), window.state_mut().session().options.rigidity);

    let ring = part_at(&mut window, GizmoPart::Rotate(0));
    click(&mut window, ring);
    for key in [Key::Num4, Key::Num5, Key::Enter] {
        press(&mut window, key);
    }
    let turned = far_handle(&mut window);
    assert_turned(&turned, &start, DMat3::from_rotation_x(45_f64.to_radians()));
    assert_eq!(window.state_mut().session().options.rigidity, r, "the digits were taken for a rigidity");
    settle(&mut window);
    let pose = document(window.state_mut().session()).pose().positions.clone();
    for (v, target) in turned.vertices.iter().zip(turned.targets()) {
        assert_eq!(pose[v.index()], target, "vertex {} is not where the handle holds it", v.0);
    }

    window.get_by_label("Turn x").click();
    window.run_steps(2);
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text("-90".into()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    assert_turned(&far_handle(&mut window), &start, DMat3::from_rotation_x(-90_f64.to_radians()));
    // Two steps, and leaving a field without a change is none.
    window.get_by_label("Move y").click();
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(2);
    let session = window.state_mut().session();
    session.undo();
    session.undo();
    assert_eq!(document(session).scene().groups[1].motion, start.motion);
    assert_eq!(document(session).history().len(), 2, "more steps than edits");
}

#[test]
fn the_list_chooses_several_renames_colors_and_finds_among_many() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    for k in 0..200 {
        let vertices = vec![pliant_solver::VertexId(k)];
        let hold = pliant::document::Command::Hold { kind: GroupKind::Anchor, vertices };
        window.state_mut().session().apply(hold);
    }
    window.run_steps(3);
    assert!(window.query_by_label("Anchor 200").is_none(), "rows out of sight were made");
    window.get_by_label("Find handles by name").click();
    window.run_steps(2);
    window.event(egui::Event::Text("anchor 17".into()));
    window.run_steps(3);
    for label in ["Anchor 17", "Anchor 170", "Anchor 173"] {
        assert!(window.query_by_label(label).is_some(), "{label} is not found");
    }
    window.get_by_label("Anchor 170").click();
    window.run_steps(2);
    window.get_by_label("Anchor 171").click_modifiers(egui::Modifiers::SHIFT);
    window.run_steps(2);
    assert_eq!(document(window.state_mut().session()).scene().active.len(), 2);
    window.get_by_label("Merge").click();
    window.run_steps(3);
    let scene = document(window.state_mut().session()).scene();
    assert_eq!((scene.groups.len(), scene.active_group().map(|group| group.vertices.len())), (199, Some(2)));

    window.get_by_label("Color of Anchor 171").click();
    window.run_steps(3);
    window.get_by_label("sky").click();
    window.run_steps(3);
    assert_eq!(document(window.state_mut().session()).scene().active_group().map(|g| g.color), Some(GroupColor::Sky));

    let at = window.get_by_label("Anchor 173").rect().center();
    window.hover_at(at);
    window.step();
    // Both clicks within a frame: frames of this harness are farther apart than a double click.
    for pressed in [true, false, true, false] {
        let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
        let event = egui::Event::PointerButton { pos: at, button, pressed, modifiers };
        window.input_mut().events.push(event);
    }
    window.run_steps(2);
    window.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    window.event(egui::Event::Text("Ear 173".into()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
    let names = document(window.state_mut().session()).scene().groups.clone();
    assert!(names.iter().any(|group| group.name == "Ear 173"), "the name was not taken over");
    assert!(names.iter().all(|group| group.motion.translation == DVec3::ZERO));
}
