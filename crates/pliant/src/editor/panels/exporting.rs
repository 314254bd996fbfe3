//! The question before the window closes while poses are being written.

use egui::{ProgressBar, Ui};

use super::dialogs::{DialogOutcome, Loss};
use crate::editor::Session;

/// Shows it; once the export is over the window closes, as was wished.
pub(super) fn question(ui: &mut Ui, session: &mut Session, close: &mut bool) -> Option<DialogOutcome> {
    let Some(done) = session.exporting_poses() else { return Some(DialogOutcome::Lose(Loss::Close)) };
    let mut outcome = None;
    ui.heading("Stop the export?");
    ui.label("Poses are still being written. The window closes when they are, or at once: then no file is written.");
    ui.add_space(6.0);
    ui.add(ProgressBar::new(done as f32).show_percentage());
    ui.add_space(10.0);
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        if ui.button("Stop and close").on_hover_text("Write nothing, and close the window").clicked() {
            session.cancel_exporting_poses();
            outcome = Some(DialogOutcome::Lose(Loss::Close));
        }
        *close |= ui.button("Stay open").on_hover_text("Go on exporting, and keep the window (Esc)").clicked();
    });
    outcome
}
