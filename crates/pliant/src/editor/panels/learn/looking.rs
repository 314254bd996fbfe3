//! A result on trial: its sliders, its histogram, and the check by poses left out.

use std::time::Duration;

use egui::{Color32, DragValue, RichText, Slider, Ui};

use super::{WIDTH, at_right, bar, shortened};
use crate::editor::learning::{Omega, Settings, Shown, Trial};
use crate::editor::theme;
use crate::learning::leave_one_out::Report;
use crate::viewport::rigidity_color;

/// The paper's own value, and the slider's upper end at least.
const PAPERS_OMEGA: f64 = 0.3;
/// The slider reaches so many times below and above the automatic ω: far enough for soft everywhere and stiff
/// everywhere on all sets tried.
const OMEGA_REACH: f64 = 30.0;
/// Rounds of smoothing: more change nothing on the sets tried.
const MOST_ROUNDS: usize = 10;

/// What was asked for while looking at a result.
pub(super) enum Asked {
    Check,
    StopCheck,
    Choose,
    Apply,
    Close,
}

/// Shows a result with its settings, and the check of it: how far that is, with the time left, or what it said and whether
/// of these settings.
pub(super) fn looking(
    ui: &mut Ui,
    trial: &mut Trial,
    checking: Option<(f64, Option<Duration>)>,
    report: Option<(&Report, bool)>,
    asked: &mut Option<Asked>,
) {
    result(ui, trial, asked);
    ui.separator();
    check(ui, checking, report, asked);
    ui.separator();
    end(ui, asked);
}

fn result(ui: &mut Ui, trial: &mut Trial, asked: &mut Option<Asked>) {
    let reading = trial.reading();
    let n_poses = reading.poses.len();
    ui.horizontal(|ui| {
        let text = if n_poses == 1 { "from 1 pose".into() } else { format!("from {n_poses} poses") };
        ui.label(text).on_hover_ui(|ui| {
            shortened(&reading.poses).for_each(|name| {
                ui.label(name);
            });
        });
        if ui.small_button("other poses…").on_hover_text("Choose poses anew, and learn again").clicked() {
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
        let from = ui.label("r from");
        let value = ui.add(DragValue::new(&mut low).range(*known.start()..=high).speed(0.05));
        value.labelled_by(from.id).on_hover_text("The smallest rigidity that is learned");
        let to = ui.label("to");
        let value = ui.add(DragValue::new(&mut high).range(low..=*known.end()).speed(0.05));
        value.labelled_by(to.id).on_hover_text("The largest rigidity that is learned");
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
        if ui.button("Cancel the check").on_hover_text("Stop checking; what was learned stays").clicked() {
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
