//! Three hints for a newcomer; each gets a check mark once followed, and they vanish when all are, or when dismissed.

use egui::{Align2, Color32, Frame, Rect, RichText, Ui, vec2};

use crate::editor::{Session, theme};

/// Shows the hints in the upper left corner of `viewport` while they are wanted.
pub(in crate::editor) fn welcome(ui: &Ui, viewport: Rect, session: &mut Session) {
    let Some(steps) = session.welcome() else { return };
    let hints = [
        (steps.pulled, "Pull the hand: drag it with the mouse"),
        (steps.painted, "Press B and paint: how stiff should it be?"),
        (steps.undone, "Take it back with Ctrl+Z"),
    ];
    let mut dismissed = steps.all_done();
    egui::Area::new(egui::Id::unique("welcome"))
        .pivot(Align2::LEFT_TOP)
        .fixed_pos(viewport.left_top() + vec2(12.0, 12.0))
        .show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new("Start here").strong());
                    let button = ui.small_button("×").on_hover_text("Dismiss the hints");
                    dismissed |= button.clicked();
                });
                for (done, text) in hints {
                    ui.horizontal(|ui| {
                        let (rect, _) = ui.allocate_exact_size(vec2(12.0, 16.0), egui::Sense::hover());
                        if done {
                            ui.painter().circle_filled(rect.center(), 5.0, Color32::from_rgb(92, 180, 110));
                        } else {
                            let stroke = egui::Stroke::new(1.5, theme::ACCENT);
                            ui.painter().circle_stroke(rect.center(), 4.5, stroke);
                        }
                        let text = RichText::new(text);
                        ui.label(if done { text.weak() } else { text });
                    });
                }
            });
        });
    if dismissed {
        session.dismiss_welcome();
    }
}
