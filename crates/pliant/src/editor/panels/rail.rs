//! The rail of tools at the left.

use egui::{Align2, Color32, CornerRadius, FontId, Sense, Ui, Vec2, WidgetInfo};

use super::icons;
use crate::editor::{Action, Session, theme};
use crate::tools::ToolKind;

const BUTTON: Vec2 = Vec2::new(60.0, 56.0);
const ICON: f32 = 22.0;

/// Shows the rail; a click takes a tool in hand.
pub(in crate::editor) fn rail(ui: &mut Ui, session: &mut Session) {
    ui.vertical_centered(|ui| {
        ui.add_space(4.0);
        for kind in ToolKind::ALL {
            let key =
                Action::of_tool(kind).map(|action| session.habits.shortcuts.text(action, ui.ctx())).unwrap_or_default();
            if button(ui, kind, &key, session.tool_kind() == kind).clicked() {
                session.take_tool(kind);
            }
        }
    });
}

fn button(ui: &mut Ui, kind: ToolKind, key: &str, is_current: bool) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(BUTTON, Sense::click());
    response.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_current, kind.label()));
    let visuals = ui.style().interact(&response);
    let (fill, ink) = match (is_current, response.hovered()) {
        (true, _) => (theme::ACCENT, Color32::from_gray(20)),
        (false, true) => (visuals.weak_bg_fill, visuals.text_color()),
        (false, false) => (Color32::TRANSPARENT, visuals.text_color()),
    };
    let painter = ui.painter();
    painter.rect_filled(rect, CornerRadius::same(7), fill);
    let icon = egui::Rect::from_center_size(rect.center_top() + Vec2::new(0.0, 21.0), Vec2::splat(ICON));
    icons::paint(painter, icon, kind, ink);
    let below = rect.center_bottom() - Vec2::new(0.0, 6.0);
    painter.text(below, Align2::CENTER_BOTTOM, kind.label(), FontId::proportional(11.0), ink);
    if response.has_focus() {
        let stroke = egui::Stroke::new(1.5, theme::ACCENT);
        painter.rect_stroke(rect, CornerRadius::same(7), stroke, egui::StrokeKind::Inside);
    }
    let key = if key.is_empty() { String::new() } else { format!(" ({key})") };
    response.on_hover_text(format!("{}{key}", kind.description()))
}
