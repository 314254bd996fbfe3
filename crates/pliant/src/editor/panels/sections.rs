//! Settings of the select tool.

use egui::{RichText, Ui};

use super::action_button;
use crate::editor::{Action, Session};
use crate::tools::SelectShape;

/// Shape and reach of the selection, and what to make of it.
pub(super) fn select(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    ui.horizontal(|ui| {
        ui.selectable_value(&mut session.options.select_shape, SelectShape::Box, "Box");
        ui.selectable_value(&mut session.options.select_shape, SelectShape::Lasso, "Lasso");
        ui.checkbox(&mut session.options.select_through, "through")
            .on_hover_text("Also take vertices that are hidden behind the surface");
    });
    let n = session.document().map_or(0, |document| document.scene().selection.vertices().len());
    ui.label(RichText::new(format!("{n} selected")).weak());
    ui.horizontal_wrapped(|ui| {
        for action in [
            Action::HANDLE_FROM_SELECTION,
            Action::ANCHOR_FROM_SELECTION,
            Action::HOLD_EVERYTHING_ELSE,
            Action::FILL_SELECTION,
            Action::SELECT_NONE,
        ] {
            if action_button(ui, session, action).clicked() {
                *chosen = Some(action);
            }
        }
    });
}
