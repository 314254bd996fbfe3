//! Messages over the viewport, each with a button to dismiss it.

use egui::{Align2, Color32, Frame, Rect, RichText, Ui, vec2};

use crate::editor::{NoticeKind, Session, theme};

/// Shows the messages in the upper right corner of `viewport`.
pub(in crate::editor) fn notices(ui: &Ui, viewport: Rect, session: &mut Session) {
    if session.notices.list().is_empty() {
        return;
    }
    let mut dismissed = None;
    let width = 360.0_f32.min(viewport.width() - 24.0);
    egui::Area::new(egui::Id::unique("notices"))
        .pivot(Align2::RIGHT_TOP)
        .fixed_pos(viewport.right_top() + vec2(-12.0, 12.0))
        .show(ui.ctx(), |ui| {
            for (index, notice) in session.notices.list().iter().enumerate() {
                let (color, word) = match notice.kind {
                    NoticeKind::Done => (Color32::from_rgb(92, 180, 110), "Done"),
                    NoticeKind::Warning => (theme::ACCENT, "Note"),
                    NoticeKind::Error => (Color32::from_rgb(226, 92, 80), "Problem"),
                };
                let frame = Frame::popup(ui.style()).stroke(egui::Stroke::new(1.0, color));
                frame.show(ui, |ui| {
                    ui.set_width(width);
                    ui.horizontal_top(|ui| {
                        ui.label(RichText::new(word).color(color).strong());
                        ui.with_layout(egui::Layout::right_to_left(egui::Align::Min), |ui| {
                            let button = ui.button("×").on_hover_text("Dismiss");
                            button
                                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Dismiss message"));
                            if button.clicked() {
                                dismissed = Some(index);
                            }
                            ui.with_layout(egui::Layout::left_to_right(egui::Align::Min), |ui| {
                                ui.add(egui::Label::new(&notice.text).wrap());
                            });
                        });
                    });
                });
            }
        });
    if let Some(index) = dismissed {
        session.notices.dismiss(index);
    }
}
