//! The whole window on the software adapter: real events in, state and pixels out.

mod handles;
mod marks;
mod poses;
mod projects;

use std::time::{Duration, Instant};

use egui_kittest::kittest::Queryable;
use egui_kittest::{Harness, HarnessBuilder};
use glam::Vec2;
use pliant::document::{Document, GroupKind};
use pliant::editor::{EditorApp, NoticeKind, Session};
use pliant::solving::SolveState;
use pliant::tools::ToolKind;
use pliant_tests::shapes;

const NO_ADAPTER: &str = "no graphics adapter: install one, for instance `apt-get install libvulkan1 mesa-vulkan-drivers`, \
                          or run `cargo xtask test`, which does";

pub(crate) type Window = Harness<'static, EditorApp>;

/// The window with the paper's bar (1154 vertices) opened from a file.
pub(crate) fn window(folder: &std::path::Path) -> Window {
    let mut window = open_bar(folder, Harness::builder().with_size([1100.0, 720.0]));
    window.run_steps(3);
    window
}

/// The bar in a window of another size or other pixels, as soon as the file is open.
pub(crate) fn open_bar(folder: &std::path::Path, builder: HarnessBuilder<EditorApp>) -> Window {
    let path = folder.join("bar.obj");
    std::fs::write(&path, shapes::paper_bar().obj()).expect("the sample is written");
    let mut window: Window = builder
        .wgpu()
        .build_eframe(move |cc| EditorApp::new(cc, vec![path]).unwrap_or_else(|error| panic!("{error}: {NO_ADAPTER}")));
    step_until(&mut window, "the file is open", |session| session.document().is_some());
    window
}

/// Steps the window until `done` says so. A minute is an eternity here: a failure, not a slow machine.
pub(crate) fn step_until(window: &mut Window, what: &str, done: impl Fn(&Session) -> bool) {
    let start = Instant::now();
    loop {
        window.step();
        if done(window.state_mut().session()) {
            return;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "waited in vain until {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

pub(crate) fn settle(window: &mut Window) {
    step_until(window, "the surface settles", |session| {
        let revision = document(session).revision();
        session.status.report.as_ref().is_some_and(|report| {
            report.revision == revision && matches!(report.state, SolveState::Settled | SolveState::Resting)
        })
    });
}

fn document(session: &Session) -> &Document {
    session.document().expect("an open document")
}

/// Where a vertex is in the window, in points.
pub(crate) fn place(window: &mut Window, v: u32) -> egui::Pos2 {
    let corner = window.get_by_label("viewport").rect().min;
    let session = window.state_mut().session();
    let open = session.open().expect("open");
    let position = open.surface.frame().positions[v as usize];
    let px: Vec2 = open.camera.project(position, session.viewport_size()).expect("in front of the eye").0;
    corner + egui::vec2(px.x, px.y)
}

/// The vertex nearest to the eye at the end (`true`) or start of the bar.
pub(crate) fn front_vertex(window: &mut Window, fraction: f64) -> u32 {
    let session = window.state_mut().session();
    let open = session.open().expect("open");
    let (lo, hi) = open.bounds();
    let x = lo.x + (hi.x - lo.x) * fraction as f32;
    let eye = open.camera.eye();
    let near = |p: &glam::Vec3| (p.x - x).abs() * 10.0 + p.distance(eye);
    let positions = &open.surface.frame().positions;
    (0..positions.len() as u32)
        .min_by(|&a, &b| near(&positions[a as usize]).total_cmp(&near(&positions[b as usize])))
        .expect("a vertex")
}

pub(crate) fn click(window: &mut Window, at: egui::Pos2) {
    window.hover_at(at);
    window.step();
    window.drag_at(at);
    window.step();
    window.drop_at(at);
    window.step();
}

fn drag(window: &mut Window, from: egui::Pos2, way: egui::Vec2) {
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    for k in 1..=6 {
        window.hover_at(from + way * (k as f32 / 6.0));
        window.step();
    }
    window.drop_at(from + way);
    window.step();
}

pub(crate) fn press(window: &mut Window, key: egui::Key) {
    window.key_press(key);
    window.step();
}

#[test]
fn two_patches_a_drag_paint_fill_undo_export_and_reopen_in_the_window() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    let start = document(window.state_mut().session()).snapshot();

    // Two clicks hold the ends; a drag bends.
    press(&mut window, egui::Key::H);
    for fraction in [0.05, 0.95] {
        let v = front_vertex(&mut window, fraction);
        let at = place(&mut window, v);
        click(&mut window, at);
    }
    assert_eq!(document(window.state_mut().session()).scene().groups.len(), 2);
    let far = front_vertex(&mut window, 0.95);
    let from = place(&mut window, far);
    drag(&mut window, from, egui::vec2(-40.0, -110.0));
    settle(&mut window);
    let bent = document(window.state_mut().session()).pose().positions.clone();
    let largest = bent.iter().zip(start.pose.positions.iter()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(largest > 0.3, "the drag moved nothing farther than {largest}");

    // A stroke of the brush and a fill change r.
    press(&mut window, egui::Key::B);
    press(&mut window, egui::Key::Num4);
    let middle = front_vertex(&mut window, 0.5);
    let from = place(&mut window, middle);
    drag(&mut window, from, egui::vec2(30.0, 0.0));
    assert_eq!(document(window.state_mut().session()).scene().rigidity.max(), 4);
    press(&mut window, egui::Key::G);
    press(&mut window, egui::Key::Num2);
    let start_of_bar = front_vertex(&mut window, 0.12);
    let at = place(&mut window, start_of_bar);
    click(&mut window, at);
    assert_eq!(document(window.state_mut().session()).scene().rigidity.min(), 2);
    settle(&mut window);

    // Exporting by the dialog's path field.
    let saved = document(window.state_mut().session()).snapshot();
    let target = folder.path().join("bent.glb");
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::E);
    window.run_steps(3);
    window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
    window.event(egui::Event::Text(target.display().to_string()));
    window.run_steps(2);
    window.key_press(egui::Key::Enter);
    window.run_steps(2);
    step_until(&mut window, "the file is written", |session| {
        session.notices.list().iter().any(|notice| notice.kind == NoticeKind::Done)
    });
    let again = pliant::document::Model::open(&target).expect("opens again");
    assert_eq!(again.rigidity, saved.scene.rigidity);
    for (v, (got, expected)) in again.mesh.positions().iter().zip(saved.pose.positions.iter()).enumerate() {
        // Single precision: half a unit in the last place of a coordinate below 8.
        assert!(got.distance(*expected) < 1e-6, "vertex {v} is at {got}, expected {expected}");
    }

    // Undo until nothing is left.
    for _ in 0..10 {
        window.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Z);
        window.step();
    }
    settle(&mut window);
    let undone = document(window.state_mut().session());
    assert!(undone.history().is_empty());
    assert_eq!(undone.pose().positions, start.pose.positions, "positions differ from the start");
    assert_eq!(undone.scene().rigidity, start.scene.rigidity);
    assert!(undone.scene().groups.is_empty());
}

#[test]
fn escape_in_the_middle_of_a_drag_restores_what_was() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    for fraction in [0.05, 0.95] {
        let v = front_vertex(&mut window, fraction);
        let at = place(&mut window, v);
        click(&mut window, at);
    }
    settle(&mut window);
    let before = document(window.state_mut().session()).scene().groups.clone();
    let far = front_vertex(&mut window, 0.95);
    let from = place(&mut window, far);
    window.hover_at(from);
    window.step();
    window.drag_at(from);
    window.step();
    window.hover_at(from + egui::vec2(50.0, 60.0));
    window.step();
    assert_ne!(document(window.state_mut().session()).scene().groups, before);
    press(&mut window, egui::Key::Escape);
    window.drop_at(from);
    window.step();
    assert_eq!(document(window.state_mut().session()).scene().groups, before);
}

#[test]
fn the_rail_the_keys_and_the_hint_line_agree_on_the_tool() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    for (key, kind) in [
        (egui::Key::A, ToolKind::Anchor),
        (egui::Key::S, ToolKind::Select),
        (egui::Key::B, ToolKind::Brush),
        (egui::Key::G, ToolKind::Fill),
        (egui::Key::H, ToolKind::Handle),
    ] {
        press(&mut window, key);
        assert_eq!(window.state_mut().session().tool_kind(), kind);
    }
    window.get_by_role_and_label(egui::Role::Button, "Brush").click();
    window.run_steps(2);
    assert_eq!(window.state_mut().session().tool_kind(), ToolKind::Brush);
    assert!(window.query_by_label_contains("paint rigidity").is_some(), "no hint about painting");
}

#[test]
fn two_digits_typed_quickly_are_one_rigidity() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press(&mut window, egui::Key::Num1);
    assert_eq!(window.state_mut().session().options.rigidity, 1);
    press(&mut window, egui::Key::Num5);
    assert_eq!(window.state_mut().session().options.rigidity, 15);
}

/// A file let go over the window.
#[derive(Debug)]
struct Dropped(std::path::PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn opening_a_sample_asks_before_painted_work_is_lost() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    window.state_mut().session().apply(pliant::document::Command::FillAll(4));
    window.get_by_label("File").click();
    window.run_steps(3);
    window.get_by_label_contains("Open sample").click();
    window.run_steps(3);
    window.get_by_label("cactus").click();
    window.run_steps(3);
    assert!(window.query_by_label("Save your changes?").is_some(), "no question before the work is lost");
    window.get_by_label("Cancel").click();
    window.run_steps(3);
    let kept = document(window.state_mut().session());
    assert_eq!((kept.model().mesh.n_vertices(), kept.scene().rigidity.max()), (1154, 4));
}

#[test]
fn a_click_on_the_legend_chooses_a_rigidity_and_does_nothing_to_the_surface() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press(&mut window, egui::Key::G);
    // Bring the surface behind the legend.
    if let Some(open) = window.state_mut().session().open_mut() {
        open.camera.distance *= 0.1;
    }
    window.run_steps(2);
    let swatch = window.get_by_label("Rigidity 3").rect().center();
    click(&mut window, swatch);
    let session = window.state_mut().session();
    assert_eq!(session.options.rigidity, 3);
    assert!(document(session).history().is_empty(), "the click filled the surface behind the legend");
}

#[test]
fn a_bad_file_dropped_on_the_window_becomes_a_notice_that_can_be_dismissed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    let bad = folder.path().join("bad.obj");
    std::fs::write(&bad, "f 1 2 3\n").expect("written");
    window.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(bad)));
    window.step();
    step_until(&mut window, "the job ends", |session| session.running_job().is_none());
    window.run_steps(2);
    let session = window.state_mut().session();
    assert_eq!(session.notices.list().last().map(|notice| notice.kind), Some(NoticeKind::Error));
    assert_eq!(document(session).model().mesh.n_vertices(), 1154, "the document was replaced");
    window.get_by_label("Dismiss message").click();
    window.run_steps(2);
    assert!(window.state_mut().session().notices.list().is_empty());
}

#[test]
fn the_picture_shows_the_bar_and_changes_when_it_is_painted() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    let before = window.render().unwrap_or_else(|error| panic!("{error}: {NO_ADAPTER}"));
    window.state_mut().session().apply(pliant::document::Command::FillAll(6));
    window.run_steps(2);
    let after = window.render().unwrap_or_else(|error| panic!("{error}: {NO_ADAPTER}"));
    let changed = before.pixels().zip(after.pixels()).filter(|(a, b)| a != b).count();
    // The bar covers a good part of the 740 × 640 points of the viewport.
    assert!(changed > 10_000, "painting everything changed only {changed} pixels");
}

#[test]
fn an_anchor_made_by_a_click_is_listed_and_can_be_let_go_from_the_list() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press(&mut window, egui::Key::A);
    let v = front_vertex(&mut window, 0.3);
    let at = place(&mut window, v);
    click(&mut window, at);
    window.run_steps(2);
    assert_eq!(document(window.state_mut().session()).scene().groups[0].kind, GroupKind::Anchor);
    assert!(window.query_by_label("Anchor 1").is_some(), "the anchor is not listed");
    window.get_by_label("Let go of Anchor 1").click();
    window.run_steps(2);
    assert!(document(window.state_mut().session()).scene().groups.is_empty());
}

#[test]
fn a_lasso_selects_what_it_encloses_and_the_card_of_a_vertex_can_be_read() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press(&mut window, egui::Key::S);
    window.get_by_label("Lasso").click();
    window.run_steps(2);
    let v = front_vertex(&mut window, 0.5);
    let at = place(&mut window, v);
    let side = 24.0;
    let corners = [egui::vec2(-side, -side), egui::vec2(side, -side), egui::vec2(side, side), egui::vec2(-side, side)];
    window.hover_at(at + corners[0]);
    window.step();
    window.drag_at(at + corners[0]);
    window.step();
    for corner in &corners[1..] {
        window.hover_at(at + *corner);
        window.step();
    }
    window.drop_at(at + corners[3]);
    window.step();
    let n = document(window.state_mut().session()).model().mesh.n_vertices() as u32;
    let inside: Vec<u32> = (0..n).filter(|&v| (place(&mut window, v) - at).abs().max_elem() < side).collect();
    let selected = &document(window.state_mut().session()).scene().selection;
    let selected: Vec<u32> = selected.vertices().iter().map(|v| v.0).collect();
    assert!(inside.len() > 5);
    assert_eq!(selected, inside);

    press(&mut window, egui::Key::Q);
    window.hover_at(at);
    window.run_steps(3);
    assert!(window.query_by_label("Edges at").is_some(), "no card beside the pointer");
}
