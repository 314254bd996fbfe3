//! The window in which rigidity is learned from poses: choose them, look at what follows, apply it.

mod looking;

use std::path::PathBuf;
use std::time::Duration;

use egui::{Align, Button, DragValue, Key, Layout, ProgressBar, RichText, ScrollArea, TextEdit, Ui};
use pliant_solver::Rigidity;

use crate::editor::learning::{Learning, View};
use crate::editor::{Job, Session};
use crate::learning::gather::Reading;
use crate::learning::sources::Source;
use looking::{Asked, looking};

/// Of the window.
const WIDTH: f32 = 300.0;
/// Names in a list or a tooltip: more are only counted.
const MOST_NAMES: usize = 40;
const SAME_VERTICES: &str = "They have as many vertices: take them for the same ones in the same order";
const LONGEST_LIST: f32 = 150.0;

/// What was asked for; carried out once nothing of the panel is borrowed.
enum Wanted {
    Browse,
    Learn,
    Apply,
    Close,
}

/// Shows the window if it is open.
pub(in crate::editor) fn learn(ui: &mut Ui, viewport: egui::Rect, session: &mut Session) {
    let Some(learning) = &mut session.learning else { return };
    let (mut is_open, mut wanted) = (true, None);
    egui::Window::new("Learn rigidity from poses")
        .open(&mut is_open)
        .default_pos(viewport.left_top() + egui::vec2(12.0, 12.0))
        .constrain_to(viewport)
        .default_width(WIDTH)
        .resizable(false)
        .show(ui.ctx(), |ui| {
            ui.set_width(WIDTH);
            wanted = stage(ui, learning);
        });
    match wanted {
        Some(Wanted::Browse) => browse(session),
        Some(Wanted::Learn) => session.start_learning(),
        Some(Wanted::Apply) => session.apply_learned(),
        Some(Wanted::Close) => session.learning = None,
        None if !is_open => session.learning = None,
        None => {}
    }
}

fn browse(session: &mut Session) {
    if let Some(model) = session.document().map(|document| document.model().clone()) {
        session.start(Job::BrowsePoses(model));
    }
}

fn stage(ui: &mut Ui, learning: &mut Learning) -> Option<Wanted> {
    let (trouble, has_new_files) = (learning.trouble.clone(), learning.has_new_files);
    if let Some(why) = &trouble {
        ui.colored_label(ui.visuals().error_fg_color, why);
        if learning.can_use_faces && ui.button("Use the faces of this mesh").on_hover_text(SAME_VERTICES).clicked() {
            learning.use_reference_faces();
            return None;
        }
        ui.add_space(4.0);
    }
    match learning.view() {
        View::Choosing => choosing(ui, learning),
        View::Gathering { done, left } => {
            ui.label("Reading the poses…");
            bar(ui, done, left);
            if ui.button("Cancel").on_hover_text("Stop reading, and choose other poses").clicked() {
                learning.choose();
            }
            None
        }
        View::Asking(reading) => {
            let wish = asking(ui, reading);
            answer(learning, wish);
            None
        }
        View::Looking { trial, checking, report } => {
            let mut asked = None;
            if has_new_files {
                ui.label(RichText::new("Files were added: choose \"other poses…\" to learn again.").weak());
            }
            looking(ui, trial, checking, report, &mut asked);
            match asked? {
                Asked::Check => learning.check(),
                Asked::StopCheck => learning.stop_check(),
                Asked::Choose => learning.choose(),
                Asked::Apply => return Some(Wanted::Apply),
                Asked::Close => return Some(Wanted::Close),
            }
            None
        }
    }
}

fn bar(ui: &mut Ui, done: f64, left: Option<Duration>) {
    let percent = format!("{:.0} %", 100.0 * done);
    let text = left.map_or(percent.clone(), |left| format!("{percent} · {} left", seconds(left)));
    ui.add(ProgressBar::new(done as f32).text(text));
    ui.ctx().request_repaint_after(Duration::from_millis(100));
}

fn seconds(time: Duration) -> String {
    let whole = time.as_secs() + 1;
    if whole < 100 { format!("{whole} s") } else { format!("{} min", whole.div_ceil(60)) }
}

fn choosing(ui: &mut Ui, learning: &mut Learning) -> Option<Wanted> {
    ui.label("Show a few poses of this mesh: bones become stiff, joints stay soft.");
    ui.add_space(4.0);
    let mut wanted = None;
    sources(ui, learning);
    ui.horizontal(|ui| {
        if ui.button("Add files…").on_hover_text("Meshes with the same faces, or glTF with poses of its own").clicked()
        {
            wanted = Some(Wanted::Browse);
        }
        let is_missing = learning.n_own > 0 && !learning.sources().contains(&Source::Reference);
        let tip = "The morph targets and animations that this mesh came with";
        if is_missing && ui.button("Add its own poses").on_hover_text(tip).clicked() {
            learning.add_own();
        }
    });
    path_field(ui, learning);
    ui.add_space(4.0);
    options(ui, learning);
    ui.add_space(6.0);
    at_right(ui, |ui| {
        let can = !learning.sources().is_empty();
        let button = ui.add_enabled(can, Button::new(RichText::new("Learn").strong()));
        let button = button.on_hover_text("Find out from these poses where the mesh is stiff");
        if button.on_disabled_hover_text("Add poses first").clicked() {
            wanted = Some(Wanted::Learn);
        }
        if ui.button("Close").on_hover_text("Leave everything as it was").clicked() {
            wanted = Some(Wanted::Close);
        }
    });
    wanted
}

/// A row of buttons at the right, and no higher than they are.
fn at_right(ui: &mut Ui, buttons: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| ui.with_layout(Layout::right_to_left(Align::Center), buttons));
}

fn sources(ui: &mut Ui, learning: &mut Learning) {
    if learning.sources().is_empty() {
        ui.label(RichText::new("No poses yet. Add files, or drop them on the window.").weak());
        return;
    }
    let mut gone = None;
    ScrollArea::vertical().max_height(LONGEST_LIST).show(ui, |ui| {
        for (place, source) in learning.sources().iter().enumerate() {
            ui.horizontal(|ui| {
                let button = ui.small_button("×").on_hover_text("Take off the list");
                super::name(ui, &button, &format!("Take {} off the list", source.name()));
                if button.clicked() {
                    gone = Some(place);
                }
                match source {
                    Source::File(path) => {
                        ui.label(source.name()).on_hover_text(path.display().to_string());
                    }
                    Source::Reference => {
                        ui.label(format!("{} ({})", source.name(), learning.n_own));
                    }
                }
            });
        }
    });
    if let Some(place) = gone {
        learning.remove(place);
    }
}

/// For those who have the path at hand, or no file dialog.
fn path_field(ui: &mut Ui, learning: &mut Learning) {
    let id = ui.make_persistent_id("pose path");
    let mut path = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_default();
    let field =
        ui.add(TextEdit::singleline(&mut path).hint_text("or type a path, then Enter").desired_width(WIDTH - 12.0));
    let field = field.on_hover_text("A file with poses of this mesh");
    super::name(ui, &field, "Path of a file with poses");
    let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if is_entered && !path.trim().is_empty() {
        learning.add_files([PathBuf::from(path.trim())]);
        path.clear();
        field.request_focus();
    }
    ui.data_mut(|data| data.insert_temp(id, path));
}

fn options(ui: &mut Ui, learning: &mut Learning) {
    ui.horizontal(|ui| {
        let tip = "r from 1 to this one is tried at every vertex (r_max in the paper)";
        let value = DragValue::new(&mut learning.r_max).range(2..=Rigidity::MAX.min(20)).speed(0.05);
        let value = ui.add(value).on_hover_text(tip);
        value.labelled_by(ui.label("largest rigidity").on_hover_text(tip).id);
    });
    ui.horizontal(|ui| {
        let value = DragValue::new(&mut learning.options.frames).range(1..=1000).speed(0.2);
        let value =
            ui.add(value).on_hover_text("Poses that are taken from each animation, evenly spread over its time");
        value.labelled_by(ui.label("frames of each animation").id);
    });
    ui.checkbox(&mut learning.options.match_scale, "poses may be in another unit")
        .on_hover_text("The scale of each file is found and divided out");
    ui.checkbox(&mut learning.options.reference_faces, "use the faces of this mesh")
        .on_hover_text("For files with as many vertices in the same order, whose faces differ");
}

fn asking(ui: &mut Ui, reading: &Reading) -> Option<Answer> {
    let (n_good, n_bad) = (reading.poses.len(), reading.broken.len());
    ui.label(RichText::new(format!("{n_bad} of {} cannot be used:", n_good + n_bad)).strong());
    ScrollArea::vertical().max_height(LONGEST_LIST).show(ui, |ui| {
        for line in shortened(&reading.broken) {
            ui.label(line);
        }
    });
    ui.add_space(6.0);
    let mut wish = None;
    ui.horizontal_wrapped(|ui| {
        let label =
            if n_good == 1 { "Go on with the other one".into() } else { format!("Go on with the other {n_good}") };
        if ui.button(label).on_hover_text("Go on with the poses that can be used").clicked() {
            wish = Some(Answer::GoOn);
        }
        if reading.only_faces_differ && ui.button("Use the faces of this mesh").on_hover_text(SAME_VERTICES).clicked() {
            wish = Some(Answer::UseFaces);
        }
        if ui.button("Back").on_hover_text("Choose other poses").clicked() {
            wish = Some(Answer::Back);
        }
    });
    wish
}

enum Answer {
    GoOn,
    UseFaces,
    Back,
}

fn answer(learning: &mut Learning, wish: Option<Answer>) {
    match wish {
        Some(Answer::GoOn) => learning.accept(),
        Some(Answer::UseFaces) => learning.use_reference_faces(),
        Some(Answer::Back) => learning.choose(),
        None => {}
    }
}

/// The first names, and how many more there are.
fn shortened(names: &[String]) -> impl Iterator<Item = String> {
    let more = names.len().saturating_sub(MOST_NAMES);
    let rest = (more > 0).then(|| format!("and {more} more"));
    names.iter().take(MOST_NAMES).cloned().chain(rest)
}
