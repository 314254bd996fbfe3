//! The legend of the coloring, in a corner of the viewport.

use egui::{Align2, Color32, CornerRadius, FontId, Rect, Ui, Vec2, pos2, vec2};

use crate::editor::look::ramp_max;
use crate::editor::{Learning, Session, Shown, theme};
use crate::viewport::{Coloring, energy_color, rigidity_color};

const SWATCH: Vec2 = Vec2::new(26.0, 14.0);
/// Longer ramps are drawn without a number on every swatch.
const NUMBERED: u16 = 12;

/// Paints the legend into the lower left corner of `viewport`. With a click on a swatch its r becomes the current one.
pub(in crate::editor) fn legend(ui: &mut Ui, viewport: Rect, session: &mut Session) {
    let Some(max) = session.shown_rigidity().map(ramp_max) else { return };
    let coloring = session.coloring().0;
    let size = match coloring {
        Coloring::Plain => return,
        Coloring::Rigidity => vec2(f32::from(max.min(NUMBERED)) * SWATCH.x + 20.0, 52.0),
        Coloring::Energy => vec2(180.0, 48.0),
    };
    let corner = pos2(viewport.left() + 12.0, viewport.bottom() - size.y - 12.0);
    // A layer of its own, so that a click on the legend does nothing to the surface behind it.
    egui::Area::new(egui::Id::unique("legend")).fixed_pos(corner).show(ui.ctx(), |ui| {
        let (card, _) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
        let fill = theme::palette(session.look.theme).panel.gamma_multiply(0.86);
        ui.painter().rect_filled(card, CornerRadius::same(6), fill);
        match coloring {
            Coloring::Plain => {}
            Coloring::Rigidity => rigidity(ui, card, max, session),
            Coloring::Energy => numbers(ui, card, session),
        }
    });
}

fn rigidity(ui: &mut Ui, card: Rect, max: u16, session: &mut Session) {
    let n = max.min(NUMBERED);
    title(ui, card, "Rigidity", "soft", "stiff", session);
    for k in 0..n {
        let r = if n < 2 { 1 } else { 1 + (u32::from(k) * u32::from(max - 1) / u32::from(n - 1)) as u16 };
        let corner = pos2(card.left() + 10.0 + f32::from(k) * SWATCH.x, card.top() + 26.0);
        let rect = Rect::from_min_size(corner, SWATCH + vec2(0.0, 6.0));
        let [red, green, blue] = rigidity_color(r, max);
        let response = ui.interact(rect, ui.scope_id().with(("legend", r)), egui::Sense::click());
        ui.painter().rect_filled(rect, CornerRadius::ZERO, Color32::from_rgb(red, green, blue));
        let luma = 0.3 * f32::from(red) + 0.59 * f32::from(green) + 0.11 * f32::from(blue);
        let ink = if luma > 140.0 { Color32::from_gray(20) } else { Color32::from_gray(240) };
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, r, FontId::proportional(11.0), ink);
        if r == session.options.rigidity {
            let stroke = egui::Stroke::new(2.0, theme::ACCENT);
            ui.painter().rect_stroke(rect, CornerRadius::ZERO, stroke, egui::StrokeKind::Outside);
        }
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Rigidity {r}")));
        if response.on_hover_text(format!("Paint and fill with rigidity {r}")).clicked() {
            session.choose_rigidity(r);
        }
    }
}

fn numbers(ui: &mut Ui, card: Rect, session: &mut Session) {
    let is_confidence =
        session.learning.as_ref().and_then(Learning::trial).is_some_and(|trial| trial.shown == Shown::Confidence);
    let name = if is_confidence { "Confidence" } else { "Energy" };
    title(ui, card, name, "low", "high", session);
    let steps = 40;
    for k in 0..steps {
        let [r, g, b] = energy_color(k as f32 / (steps - 1) as f32);
        let corner = pos2(card.left() + 10.0 + k as f32 * 4.0, card.top() + 26.0);
        let rect = Rect::from_min_size(corner, vec2(4.5, 12.0));
        ui.painter().rect_filled(rect, CornerRadius::ZERO, Color32::from_rgb(r, g, b));
    }
}

fn title(ui: &Ui, card: Rect, name: &str, low: &str, high: &str, session: &Session) {
    let colors = theme::palette(session.look.theme);
    let font = || FontId::proportional(11.0);
    let y = card.top() + 14.0;
    let painter = ui.painter();
    painter.text(pos2(card.left() + 10.0, y), Align2::LEFT_CENTER, low, font(), colors.quiet);
    painter.text(pos2(card.center().x, y), Align2::CENTER_CENTER, name, font(), colors.text);
    painter.text(pos2(card.right() - 10.0, y), Align2::RIGHT_CENTER, high, font(), colors.quiet);
}
