//! The choice of welding, for the next file and for the one that is open.

use egui::{DragValue, RichText, Ui};
use pliant_meshfile::Welding;

use super::action_button;
use crate::editor::{Action, Session};

/// A row to choose how vertices are welded. `unit` is a length that suits the mesh, to begin with.
pub(super) fn choice(ui: &mut Ui, welding: &mut Welding, unit: f64) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Weld");
        let is_within = matches!(welding, Welding::Within(_));
        for (value, label, tip) in [
            (Welding::Exact, "exact", "Vertices at exactly the same place are one point of the surface"),
            (Welding::Within(unit), "within", "So are vertices that are at most so far apart: closes small gaps"),
            (Welding::Never, "never", "Every vertex is a point of its own: the surface comes apart at its seams"),
        ] {
            let is_this = *welding == value || (is_within && label == "within");
            if ui.selectable_label(is_this, label).on_hover_text(tip).clicked() && !is_this {
                *welding = value;
            }
        }
        if let Welding::Within(distance) = welding {
            let speed = (*distance * 0.01).max(f64::MIN_POSITIVE);
            let value = DragValue::new(distance).range(0.0..=f64::MAX).speed(speed).max_decimals(9);
            ui.add(value).on_hover_text("Distance in the units of the file");
        }
    });
}

/// How the open mesh was welded, and how to open it otherwise.
pub(super) fn mesh(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    let Some(document) = session.document() else { return };
    let is = document.model().file.welding;
    // Gaps that a person wants closed are much smaller than edges.
    let unit = 0.01 * document.model().mean_edge();
    choice(ui, &mut session.welding, unit);
    if session.welding != is {
        ui.horizontal(|ui| {
            if action_button(ui, session, Action::REOPEN).clicked() {
                *chosen = Some(Action::REOPEN);
            }
            ui.label(RichText::new(format!("welded now: {is}")).weak());
        });
    }
}
