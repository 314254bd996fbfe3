//! The comparison of methods in the whole window.

use egui_kittest::kittest::Queryable;
use pliant::document::MethodKind;
use pliant::editor::NoticeKind;

use crate::editor_window::{click, front_vertex, place, press, settle, step_until, window};

#[test]
fn methods_are_compared_one_is_used_and_all_are_saved_in_one_picture() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press(&mut window, egui::Key::H);
    for fraction in [0.05, 0.95] {
        let v = front_vertex(&mut window, fraction);
        let at = place(&mut window, v);
        click(&mut window, at);
    }
    settle(&mut window);

    press(&mut window, egui::Key::C);
    step_until(&mut window, "all panes settle", |session| {
        session.compare().is_some_and(|compare| compare.is_settled())
    });
    window.run_steps(2);

    // A drag in a pane turns all of them.
    let camera = window.state_mut().session().open().expect("open").camera;
    let pane = window.get_by_label("picture: ARAP").rect().center();
    window.drag_at(pane);
    window.step();
    window.hover_at(pane + egui::vec2(30.0, 10.0));
    window.step();
    window.drop_at(pane + egui::vec2(30.0, 10.0));
    window.step();
    assert_ne!(window.state_mut().session().open().expect("open").camera, camera);

    window.get_by_label("Save picture…").click();
    window.run_steps(2);
    window.get_by_label("Save").click();
    step_until(&mut window, "the picture is written", |session| {
        session.notices.list().iter().any(|notice| notice.kind == NoticeKind::Done)
    });
    let picture = image::open(folder.path().join("bar-methods.png")).expect("a picture").to_rgba8();
    let (width, height) = picture.dimensions();
    assert!(width > 600 && height > 400, "{width} by {height}");
    let first = picture.get_pixel(width / 2, height / 4);
    assert!(picture.pixels().any(|pixel| pixel != first), "it is empty");

    window.get_by_label_contains("Use SR-ARAP").click();
    window.run_steps(2);
    let method = window.state_mut().session().method().expect("open");
    assert_eq!(method.kind, MethodKind::SrArap);
    press(&mut window, egui::Key::Escape);
    assert!(window.state_mut().session().compare().is_none());
    settle(&mut window);
}
