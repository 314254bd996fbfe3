//! Two lines at the bottom: what is happening, and what the mouse does now.

use egui::{Color32, RichText, Ui};

use crate::editor::{Session, theme};
use crate::solving::SolveState;

/// Shows both lines.
pub(in crate::editor) fn status(ui: &mut Ui, session: &mut Session, is_software: bool) {
    let quiet = theme::palette(session.look.theme).quiet;
    ui.horizontal(|ui| {
        state(ui, session);
        opening(ui, session);
        if let Some(document) = session.document() {
            let mesh = &document.model().mesh;
            ui.separator();
            ui.label(RichText::new(format!("{} vertices", grouped(mesh.n_vertices()))).color(quiet));
        }
        let report = session.status.report.as_ref().filter(|report| !report.energies.is_empty());
        if let Some(report) = report {
            ui.separator();
            let kind = session.method().unwrap_or_default().kind;
            let energy = format!("{} {}", kind.energy_name(), scientific(report.energy));
            ui.label(RichText::new(energy).color(quiet).monospace()).on_hover_text(kind.description());
            ui.label(RichText::new(format!("iteration {:>5}", report.iteration)).color(quiet).monospace());
            let change = format!("change {}", scientific(report.relative_decrease));
            ui.label(RichText::new(change).color(quiet).monospace())
                .on_hover_text("How much the last iteration lowered the energy, relative to it");
            ui.label(RichText::new(format!("{:>5.2} ms", report.iteration_ms)).color(quiet).monospace())
                .on_hover_text("Median time of an iteration");
            if report.state == SolveState::Iterating {
                let rate = format!("{:>3.0} surfaces/s", session.status.surfaces_per_second);
                ui.label(RichText::new(rate).color(quiet).monospace());
            }
        }
        for remark in session.status.report.iter().flat_map(|report| &report.remarks) {
            ui.separator();
            ui.label(RichText::new(remark).color(theme::ACCENT)).on_hover_text(
                "Separate parts of the mesh: choose in the inspector (Solver) whether they stay or follow",
            );
        }
        if is_software {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.label(RichText::new("software rendering").color(theme::ACCENT).small())
                    .on_hover_text("No graphics card was found: pictures are made by the processor and cost more time");
            });
        }
    });
    let hint = session.with_tool(|tool, context| tool.hint(context)).unwrap_or_else(|| "Open a mesh".into());
    ui.horizontal(|ui| {
        if let Some(aside) = session.aside() {
            let label = ui.label(RichText::new(aside).color(theme::ACCENT));
            // Read out to those who do not see it.
            ui.ctx().accesskit_node_builder(label.id, |node| node.set_live(egui::accesskit::Live::Polite));
        } else {
            ui.label(RichText::new(hint).color(quiet));
            if let Some(why) = session.idle_painting() {
                ui.label(RichText::new(why).color(theme::ACCENT));
            }
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let camera = "Middle or right drag: turn · Shift: move · wheel: zoom";
            ui.label(RichText::new(camera).color(quiet).small());
        });
    });
}

fn state(ui: &mut Ui, session: &Session) {
    let (color, text) = match (session.running_job(), session.status.report.as_ref().map(|report| &report.state)) {
        (Some(job), _) => (theme::ACCENT, job.to_owned()),
        (None, None) if session.document().is_some() => (theme::ACCENT, "Preparing".to_owned()),
        (None, None) => (Color32::GRAY, "Nothing open".to_owned()),
        (None, Some(SolveState::Resting)) => (Color32::GRAY, "No handles yet".to_owned()),
        (None, Some(SolveState::Preparing { progress })) => (theme::ACCENT, preparing(*progress)),
        (None, Some(SolveState::Iterating)) => (theme::ACCENT, "Iterating".to_owned()),
        (None, Some(SolveState::Settled)) => (Color32::from_rgb(92, 180, 110), "Settled".to_owned()),
        (None, Some(SolveState::Failed(why))) => (Color32::from_rgb(226, 92, 80), format!("Cannot solve: {why}")),
    };
    let (rect, _) = ui.allocate_exact_size(egui::vec2(10.0, 16.0), egui::Sense::hover());
    ui.painter().circle_filled(rect.center(), 4.0, color);
    ui.label(text);
}

/// How far a mesh is that is being opened, and a way to stop it.
fn opening(ui: &mut Ui, session: &mut Session) {
    let Some(fraction) = session.opening() else { return };
    ui.add(egui::ProgressBar::new(fraction as f32).desired_width(140.0).show_percentage());
    if ui.small_button("Cancel").on_hover_text("Stop opening: the mesh on screen stays").clicked() {
        session.cancel_opening();
    }
}

/// Without a number where there is none to tell yet.
fn preparing(progress: f64) -> String {
    if progress > 0.0 { format!("Preparing {:>2.0} %", (progress * 100.0).floor()) } else { "Preparing".to_owned() }
}

/// 12345 as `12 345`.
pub(super) fn grouped(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::with_capacity(digits.len() + digits.len() / 3);
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

/// Three digits and an exponent, always equally wide.
fn scientific(value: f64) -> String {
    format!("{value:>8.2e}")
}

#[cfg(test)]
mod tests {
    use super::{grouped, preparing};

    #[test]
    fn preparing_tells_whole_percents_once_there_are_some() {
        for (progress, expected) in [(0.0, "Preparing"), (0.079, "Preparing  7 %"), (0.5, "Preparing 50 %")] {
            assert_eq!(preparing(progress), expected);
        }
    }

    #[test]
    fn large_numbers_are_grouped_by_thousands() {
        for (n, expected) in [(0, "0"), (999, "999"), (1000, "1 000"), (12345, "12 345"), (1234567, "1 234 567")] {
            assert_eq!(grouped(n), expected);
        }
    }
}
