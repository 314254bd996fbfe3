//! The inspector's part for painting: brush, fill, and the rigidity they give.

use egui::{DragValue, RichText, Slider, Ui};
use pliant_solver::Rigidity;

use super::action_button;
use crate::editor::{Action, Session};
use crate::tools::{BrushMode, Options};

/// Radius and mode of the brush.
pub(super) fn brush(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        let slider = Slider::new(&mut session.options.brush_radius_px, Options::BRUSH_RADIUS_PX);
        ui.add(slider.logarithmic(true).fixed_decimals(0).suffix(" px"))
            .on_hover_text("Radius on screen; painting follows the surface and does not reach its other side");
        ui.label("radius");
    });
    ui.horizontal_wrapped(|ui| {
        for (mode, label, tip) in [
            (BrushMode::Set, "Set", "Give the current rigidity"),
            (BrushMode::Stiffer, "Stiffer", "One more with each stroke"),
            (BrushMode::Softer, "Softer", "One less with each stroke (Ctrl)"),
            (BrushMode::Smooth, "Smooth", "Blend with the neighbors (Shift)"),
        ] {
            ui.selectable_value(&mut session.options.brush_mode, mode, label).on_hover_text(tip);
        }
    });
}

/// The current r and what it can be given to.
pub(super) fn rigidity(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    ui.horizontal(|ui| {
        let range = 1..=Rigidity::MAX;
        let value = DragValue::new(&mut session.options.rigidity).range(range).speed(0.1);
        ui.add(value).on_hover_text(
            "Size of the neighborhood that moves as one piece, in rings of edges (r in the paper). 1 is soft rubber, \
             6 is stiff, 20 is nearly metal",
        );
        ui.label("current rigidity");
    });
    ui.horizontal_wrapped(|ui| {
        for r in [1, 2, 3, 4, 6, 10, 20] {
            let is_current = session.options.rigidity == r;
            if ui.selectable_label(is_current, r.to_string()).clicked() {
                session.choose_rigidity(r);
            }
        }
    });
    if let Some(document) = session.document() {
        let r = &document.scene().rigidity;
        let text = match (r.min(), r.max()) {
            (min, max) if min == max => format!("{min} everywhere"),
            (min, max) => format!("{min} to {max}, mean {:.1}", r.mean()),
        };
        ui.label(RichText::new(text).weak());
    }
    super::solver::rigidity_note(ui, session);
    ui.horizontal_wrapped(|ui| {
        for action in [Action::FILL_ALL, Action::LEARN_RIGIDITY] {
            if action_button(ui, session, action).clicked() {
                *chosen = Some(action);
            }
        }
    });
}
