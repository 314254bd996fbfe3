//! The window in which rigidity is learned from poses: choose them, look at what follows, apply it.

use std::path::PathBuf;
use std::time::Duration;

use egui::{Align, Button, Color32, DragValue, Key, Layout, ProgressBar, RichText, ScrollArea, Slider, TextEdit, Ui};
use pliant_solver::Rigidity;

use crate::editor::learning::{Learning, Omega, Settings, Shown, Trial, View};
use crate::editor::{Job, Session, theme};
use crate::learning::gather::Reading;
use crate::learning::leave_one_out::Report;
use crate::learning::sources::Source;
use crate::viewport::rigidity_color;

const WIDTH: f32 = 300.0;
/// The paper's own value, and the slider's upper end at least.
const PAPERS_OMEGA: f64 = 0.3;
/// The slider reaches so many times below and above the automatic ω: far enough for soft everywhere and stiff
/// everywhere on all sets tried.
const OMEGA_REACH: f64 = 30.0;
/// Names in a list or a tooltip: more are only counted.
const MOST_NAMES: usize = 40;
const SAME_VERTICES: &str = "They have as many vertices: take them for the same ones in the same order";
/// Rounds of smoothing: more change nothing on the sets tried.
const MOST_ROUNDS: usize = 10;
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
            if ui.button("Cancel").clicked() {
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
            looking(ui, trial, &mut asked);
            ui.separator();
            check(ui, checking, report, &mut asked);
            ui.separator();
            end(ui, &mut asked);
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
        if button.on_disabled_hover_text("Add poses first").clicked() {
            wanted = Some(Wanted::Learn);
        }
        if ui.button("Close").clicked() {
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
                if ui.small_button("×").on_hover_text("Take off the list").clicked() {
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
        ui.add(DragValue::new(&mut learning.r_max).range(2..=Rigidity::MAX.min(20)).speed(0.05));
        ui.label("largest rigidity")
            .on_hover_text("r from 1 to this one is tried at every vertex (r_max in the paper)");
    });
    ui.horizontal(|ui| {
        ui.add(DragValue::new(&mut learning.options.frames).range(1..=1000).speed(0.2));
        ui.label("frames of each animation");
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
        if ui.button(label).clicked() {
            wish = Some(Answer::GoOn);
        }
        if reading.only_faces_differ && ui.button("Use the faces of this mesh").on_hover_text(SAME_VERTICES).clicked() {
            wish = Some(Answer::UseFaces);
        }
        if ui.button("Back").clicked() {
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

/// What was asked for while looking at a result.
enum Asked {
    Check,
    StopCheck,
    Choose,
    Apply,
    Close,
}

fn looking(ui: &mut Ui, trial: &mut Trial, asked: &mut Option<Asked>) {
    let reading = trial.reading();
    let n_poses = reading.poses.len();
    ui.horizontal(|ui| {
        let text = if n_poses == 1 { "from 1 pose".into() } else { format!("from {n_poses} poses") };
        ui.label(text).on_hover_ui(|ui| {
            shortened(&reading.poses).for_each(|name| {
                ui.label(name);
            });
        });
        if ui.small_button("other poses…").clicked() {
            *asked = Some(Asked::Choose);
        }
    });
    for note in &reading.notes {
        ui.label(RichText::new(note).weak());
    }
    ui.add_space(4.0);
    sliders(ui, trial);
    ui.add_space(4.0);
    histogram(ui, trial);
    ui.horizontal(|ui| {
        ui.label("Show");
        for (shown, label, tip) in [
            (Shown::Learned, "learned", "The rigidity that was learned"),
            (Shown::Confidence, "confidence", "How much worse the second best rigidity is: bright is sure"),
            (Shown::Now, "as it is", "The rigidity before learning"),
        ] {
            ui.selectable_value(&mut trial.shown, shown, label).on_hover_text(tip);
        }
    });
}

fn sliders(ui: &mut Ui, trial: &mut Trial) {
    let Settings { mut omega, range, mut smoothing } = trial.settings();
    let mut value = trial.omega_value();
    let (mut low, mut high) = range.into_inner();
    let known = trial.known_range();
    ui.horizontal(|ui| {
        let auto = trial.auto_omega().max(f64::MIN_POSITIVE);
        let reach = auto / OMEGA_REACH..=(auto * OMEGA_REACH).max(PAPERS_OMEGA);
        let slider = Slider::new(&mut value, reach).logarithmic(true).clamping(egui::SliderClamping::Never);
        let tip = "What one more ring of rigidity is worth against the energy of bending (ω in the paper, 3.4)";
        let slider = ui.add(slider.custom_formatter(|omega, _| format!("{omega:.3e}"))).on_hover_text(tip);
        if slider.changed() {
            omega = Omega::Absolute(value);
        }
        ui.label("stiffness");
        let tip = "Choose it from the poses";
        if ui.selectable_label(omega == Omega::Auto, "auto").on_hover_text(tip).clicked() {
            omega = Omega::Auto;
        }
    });
    ui.horizontal(|ui| {
        ui.label("r from");
        ui.add(DragValue::new(&mut low).range(*known.start()..=high).speed(0.05));
        ui.label("to");
        ui.add(DragValue::new(&mut high).range(low..=*known.end()).speed(0.05));
    });
    ui.horizontal(|ui| {
        let tip = "Single vertices take the rigidity that most of their neighbors have, so many times";
        ui.add(Slider::new(&mut smoothing, 0..=MOST_ROUNDS)).on_hover_text(tip);
        ui.label("smoothing");
    });
    trial.set(Settings { omega, range: low..=high, smoothing });
}

/// A bar for each r, in its color.
fn histogram(ui: &mut Ui, trial: &Trial) {
    let counts = trial.histogram();
    let (rect, response) = ui.allocate_exact_size(egui::vec2(WIDTH, 84.0), egui::Sense::hover());
    let most = counts.iter().copied().max().unwrap_or(0).max(1) as f32;
    let total = counts.iter().sum::<usize>().max(1) as f64;
    let (first, last) = trial.known_range().into_inner();
    let width = rect.width() / counts.len() as f32;
    let painter = ui.painter();
    let font = egui::FontId::proportional(11.0);
    for (place, &count) in counts.iter().enumerate() {
        let r = first + place as u16;
        let left = rect.left() + place as f32 * width;
        let column = egui::Rect::from_min_size(egui::pos2(left, rect.top()), egui::vec2(width, rect.height()));
        let base = column.bottom() - 16.0;
        let height = (base - column.top() - 16.0) * count as f32 / most;
        let [red, green, blue] = rigidity_color(r, last.max(6));
        let filled =
            egui::Rect::from_min_max(egui::pos2(left + 3.0, base - height), egui::pos2(left + width - 3.0, base));
        painter.rect_filled(filled, 2.0, Color32::from_rgb(red, green, blue));
        let share = format!("{:.0} %", 100.0 * count as f64 / total);
        let above = egui::pos2(filled.center().x, base - height - 2.0);
        painter.text(above, egui::Align2::CENTER_BOTTOM, share, font.clone(), ui.visuals().weak_text_color());
        let below = egui::pos2(filled.center().x, column.bottom());
        painter.text(below, egui::Align2::CENTER_BOTTOM, r, font.clone(), ui.visuals().text_color());
    }
    response.on_hover_text("How many of the vertices have each rigidity");
}

fn check(
    ui: &mut Ui,
    checking: Option<(f64, Option<Duration>)>,
    report: Option<(&Report, bool)>,
    asked: &mut Option<Asked>,
) {
    if let Some((done, left)) = checking {
        ui.label("Predicting each pose from the others…");
        bar(ui, done, left);
        if ui.button("Cancel the check").clicked() {
            *asked = Some(Asked::StopCheck);
        }
        return;
    }
    let tip = "Leaves out one pose after the other, learns from the rest, holds 25 patches and lets the solver find the others";
    let label = if report.is_some() { "Check again" } else { "Check by leaving poses out" };
    if ui.button(label).on_hover_text(tip).clicked() {
        *asked = Some(Asked::Check);
    }
    if let Some((report, is_current)) = report {
        errors(ui, report, is_current);
    }
}

/// Mean errors, the smallest in bold.
fn errors(ui: &mut Ui, report: &Report, is_current: bool) {
    let uniform = report.uniform();
    let mut rows = vec![("learned".to_owned(), report.learned())];
    let name = |r: u16| if r == 1 { "r = 1 (ARAP)".to_owned() } else { format!("r = {r} everywhere") };
    rows.extend(uniform.iter().map(|&(r, error)| (name(r), error)));
    let least = rows.iter().map(|row| row.1).fold(f64::INFINITY, f64::min);
    egui::Grid::new("errors").num_columns(2).spacing([16.0, 1.0]).show(ui, |ui| {
        for (name, error) in rows {
            let text = format!("{:.3} %", 100.0 * error);
            let color = if error == least { theme::ACCENT } else { ui.visuals().text_color() };
            let strong = |text: String| RichText::new(text).color(color);
            ui.label(strong(name));
            ui.label(strong(text))
                .on_hover_text("Mean distance of a vertex from where the pose has it, of the diagonal");
            ui.end_row();
        }
    });
    let n_poses = report.predictions.len();
    if !is_current {
        ui.label(RichText::new("Of other settings than these: check again.").weak());
    } else if report.learned() <= least {
        ui.colored_label(theme::ACCENT, format!("Learned rigidity predicts these {n_poses} poses best."));
    } else {
        let text = format!(
            "The same rigidity everywhere predicts these {n_poses} poses better: try another stiffness, more poses, or a \
             finer mesh."
        );
        ui.colored_label(ui.visuals().warn_fg_color, text);
    }
}

fn end(ui: &mut Ui, asked: &mut Option<Asked>) {
    at_right(ui, |ui| {
        let tip = "Make it the rigidity of the mesh; then retouch it with the brush";
        if ui.button(RichText::new("Apply").strong()).on_hover_text(tip).clicked() {
            *asked = Some(Asked::Apply);
        }
        if ui.button("Cancel").on_hover_text("Leave everything as it was").clicked() {
            *asked = Some(Asked::Close);
        }
    });
}
