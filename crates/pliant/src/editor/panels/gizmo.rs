//! Settings of the handle tool: size of patches, and the gizmo.

use egui::{DragValue, Slider, Ui};

use super::action_button;
use crate::editor::{Action, Session};
use crate::tools::{Axes, GizmoShown, Options, Pivot, ToolKind, length};

/// Patch size of handles and anchors, and the gizmo of handles.
pub(super) fn tool(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    ui.horizontal(|ui| {
        let slider = Slider::new(&mut session.options.patch_rings, 0..=Options::MOST_PATCH_RINGS);
        ui.add(slider).on_hover_text(
            "Rings of vertices around the clicked one that are held with it; 0 is one vertex. Keys [ and ]",
        );
        ui.label("patch rings");
    });
    if session.tool_kind() == ToolKind::Handle {
        shown(ui, session);
        pivot(ui, session, chosen);
        axes(ui, session);
        grid(ui, session);
    }
}

fn shown(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.label("Gizmo");
        let shown = &mut session.options.gizmo.shown;
        for (value, label, tip) in [
            (GizmoShown::All, "all", "Arrows, squares, rings and knobs"),
            (GizmoShown::Move, "move", "Arrows and squares (Shift+G)"),
            (GizmoShown::Turn, "turn", "Rings (Shift+R)"),
            (GizmoShown::Scale, "scale", "Knobs (Shift+S)"),
        ] {
            ui.selectable_value(shown, value, label).on_hover_text(tip);
        }
    });
}

fn pivot(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    ui.horizontal(|ui| {
        ui.label("Pivot");
        let pivot = &mut session.options.gizmo.pivot;
        for (value, label, tip) in [
            (Pivot::Middle, "middle", "The middle of all chosen handles stays in place"),
            (Pivot::Each, "each", "Each handle turns about its own middle"),
            (Pivot::Origin, "origin", "The world's origin stays in place"),
        ] {
            ui.selectable_value(pivot, value, label).on_hover_text(tip);
        }
        if session.has_picked_pivot() {
            let _ = ui.selectable_label(true, "point").on_hover_text("The picked point stays in place");
        }
        if action_button(ui, session, Action::PICK_PIVOT).clicked() {
            *chosen = Some(Action::PICK_PIVOT);
        }
    });
}

fn axes(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        ui.label("Axes");
        let axes = &mut session.options.gizmo.axes;
        for (value, label, tip) in [
            (Axes::World, "world", "As the world's"),
            (Axes::Local, "local", "As the handle that was chosen last has been turned"),
            (Axes::View, "view", "Right, up and toward you"),
        ] {
            ui.selectable_value(axes, value, label).on_hover_text(tip);
        }
    });
}

/// The grid of moves, kept above what can be told apart on the model.
fn grid(ui: &mut Ui, session: &mut Session) {
    let Some(diagonal) = session.document().map(|document| f64::from(document.model().diagonal())) else { return };
    ui.horizontal(|ui| {
        let step = &mut session.options.gizmo.step;
        let drag = DragValue::new(step)
            .speed(diagonal * 1e-4)
            .range(diagonal * 1e-6..=diagonal * 10.0)
            .clamp_existing_to_range(false)
            .custom_formatter(|value, _| length(value, diagonal))
            .custom_parser(|text| text.trim().replace(',', ".").parse().ok());
        let response = ui.add(drag).on_hover_text("Step of moves while Ctrl is held; turns step by 15°, scales by 0.1");
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Grid step"));
        ui.label("grid step (Ctrl)");
    });
}
