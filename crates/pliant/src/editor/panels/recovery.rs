//! What windows that stopped have left behind: to recover, to discard, or to be asked about again.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::SystemTime;

use egui::{Id, Modal, RichText, ScrollArea, Ui};

use crate::editor::{Leftover, Session};

/// Shows what is left behind, if anything is; returns the file of what is to be recovered.
pub(in crate::editor) fn recovery(ctx: &egui::Context, session: &mut Session) -> Option<PathBuf> {
    // While something opens, its progress is shown instead.
    if session.recovery.is_empty() || session.opening().is_some() {
        return None;
    }
    let mut chosen = None;
    let mut later = false;
    let mut discarded = None;
    let modal = Modal::new(Id::unique("recovery")).show(ctx, |ui| {
        ui.set_width(520.0_f32.min(ui.ctx().content_rect().width() - 48.0));
        ui.heading("Recover unsaved work?");
        ui.label("Pliant did not close in order. What was not saved then:");
        ui.add_space(6.0);
        let height = ui.ctx().content_rect().height() - 240.0;
        ScrollArea::vertical().max_height(height).show(ui, |ui| {
            for leftover in &session.recovery {
                ui.push_id(&leftover.file, |ui| row(ui, leftover, &mut chosen, &mut discarded));
            }
        });
        ui.add_space(8.0);
        let tip = "Nothing is removed; you are asked again at the next start";
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            later = ui.button("Later").on_hover_text(tip).clicked();
        });
    });
    if let Some(leftover) = discarded {
        session.discard_leftover(&leftover);
    } else if chosen.is_none() && (later || modal.should_close()) {
        session.recovery.clear();
    }
    chosen
}

fn row(ui: &mut Ui, leftover: &Arc<Leftover>, chosen: &mut Option<PathBuf>, discarded: &mut Option<Arc<Leftover>>) {
    ui.horizontal(|ui| {
        ui.vertical(|ui| {
            ui.set_width(ui.available_width() - 170.0);
            match &leftover.summary {
                Ok(summary) => {
                    ui.label(RichText::new(&summary.name).strong());
                    ui.label(RichText::new(ago(leftover.written)).weak());
                    if let Some(project) = &summary.belongs_to {
                        ui.label(RichText::new(format!("changes to {}", project.display())).weak());
                    }
                }
                Err(why) => {
                    ui.label(RichText::new("Cannot be read").strong());
                    ui.label(RichText::new(format!("{}: {why}", ago(leftover.written))).weak());
                }
            }
        });
        let is_sound = leftover.summary.is_ok();
        let recover = ui.add_enabled(is_sound, egui::Button::new("Recover"));
        let recover = recover.on_hover_text("Open it as it was; no file is changed until you save");
        if recover.on_disabled_hover_text("It is damaged").clicked() {
            *chosen = Some(leftover.file.clone());
        }
        if ui.button("Discard").on_hover_text("Remove it for good").clicked() {
            *discarded = Some(leftover.clone());
        }
    });
    ui.add_space(4.0);
}

/// How long ago that was, in words.
fn ago(then: SystemTime) -> String {
    let seconds = then.elapsed().map_or(0, |age| age.as_secs());
    let counted = |n: u64, what: &str| format!("{n} {what}{} ago", if n == 1 { "" } else { "s" });
    match seconds {
        0..60 => "less than a minute ago".into(),
        60..3600 => counted(seconds / 60, "minute"),
        3600..86_400 => counted(seconds / 3600, "hour"),
        _ => counted(seconds / 86_400, "day"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn times_are_told_as_people_do() {
        for (seconds, expected) in
            [(5, "less than a minute ago"), (65, "1 minute ago"), (7300, "2 hours ago"), (90_000, "1 day ago")]
        {
            assert_eq!(ago(SystemTime::now() - Duration::from_secs(seconds)), expected);
        }
    }
}
