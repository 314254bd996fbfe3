//! The inspector's part for painting: brush, fill, and the rigidity they give.

use egui::{DragValue, RichText, Slider, Ui};
use pliant_solver::Rigidity;

use super::action_button;
use crate::editor::{Action, Session};
use crate::tools::{BrushMode, BrushReach, BrushUnit, FillBoundary, Options, PaintOptions};

/// What the brush does, how large it is, and where it reaches.
pub(super) fn brush(ui: &mut Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        for (mode, label, tip) in [
            (BrushMode::Set, "Set", "Give the current rigidity"),
            (BrushMode::Stiffer, "Stiffer", "One more with each stroke"),
            (BrushMode::Softer, "Softer", "One less with each stroke (Ctrl)"),
            (BrushMode::Smooth, "Smooth", "Blend with the neighbors (Shift)"),
            (BrushMode::Lock, "Lock", "Lock what the brush touches: its rigidity stays as it is (Ctrl unlocks)"),
        ] {
            ui.selectable_value(&mut session.options.brush_mode, mode, label).on_hover_text(tip);
        }
    });
    radius(ui, session);
    let paint = &mut session.options.paint;
    ui.horizontal(|ui| {
        let slider = Slider::new(&mut paint.spacing, PaintOptions::SPACING).fixed_decimals(2);
        let slider = ui.add(slider);
        let label = ui.label("spacing");
        slider
            .labelled_by(label.id)
            .on_hover_text("Way between dabs of a stroke, in radii: small is smooth, 2 leaves gaps");
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Reach");
        for (reach, label, tip) in [
            (
                BrushReach::Surface,
                "surface",
                "Along the surface, around its edges too, never to a sheet that only lies near",
            ),
            (BrushReach::Front, "front", "Along the surface, only where it faces you"),
            (
                BrushReach::Through,
                "through",
                "Everything under the circle, hidden or not: both sides of an arm at once",
            ),
        ] {
            ui.selectable_value(&mut paint.reach, reach, label).on_hover_text(tip);
        }
    });
    *paint = paint.clone().in_range();
}

/// Size of the circle.
pub(super) fn radius(ui: &mut Ui, session: &mut Session) {
    let diagonal = session.document().map_or(1.0, |document| document.model().diagonal());
    let options = &mut session.options;
    ui.horizontal(|ui| {
        let slider = match options.paint.unit {
            BrushUnit::Screen => {
                let slider = Slider::new(&mut options.brush_radius_px, Options::BRUSH_RADIUS_PX);
                ui.add(slider.logarithmic(true).fixed_decimals(0).suffix(" px"))
                    .on_hover_text("Radius on screen: zoom in to paint finer ([ ] or F and a move to the side)")
            }
            BrushUnit::Model => {
                // From a thousandth of the model to half of it.
                let range = 1e-3 * diagonal..=0.5 * diagonal;
                let slider = Slider::new(&mut options.paint.radius, range).clamping(egui::SliderClamping::Never);
                ui.add(slider.logarithmic(true))
                    .on_hover_text("Radius in the model's units, the same from near and far ([ ] or F and a move)")
            }
        };
        let label = ui.label("radius");
        slider.labelled_by(label.id);
    });
    ui.horizontal(|ui| {
        ui.label("Radius in");
        for (unit, label, tip) in [
            (BrushUnit::Screen, "screen points", "The circle keeps its size on screen"),
            (BrushUnit::Model, "model units", "The circle keeps its size on the model"),
        ] {
            ui.selectable_value(&mut options.paint.unit, unit, label).on_hover_text(tip);
        }
    });
}

/// What bounds a fill.
pub(super) fn fill(ui: &mut Ui, session: &mut Session) {
    let paint = &mut session.options.paint;
    ui.horizontal_wrapped(|ui| {
        ui.label("Fill");
        for (boundary, label, tip) in FillBoundary::ALL {
            ui.selectable_value(&mut paint.boundary, boundary, label).on_hover_text(tip);
        }
    });
    let by_angle = paint.boundary == FillBoundary::SharpEdges;
    ui.add_enabled_ui(by_angle, |ui| {
        ui.horizontal(|ui| {
            let slider = Slider::new(&mut paint.sharp_degrees, PaintOptions::SHARP_DEGREES).fixed_decimals(0);
            let slider = ui.add(slider.suffix("°"));
            let label = ui.label("sharp from");
            slider
                .labelled_by(label.id)
                .on_hover_text("Edges at which the surface turns by more than this bound a fill")
                .on_disabled_hover_text("Choose 'Sharp edges' to fill up to them");
        });
    });
    *paint = paint.clone().in_range();
}

/// The current r and what it can be given to.
pub(super) fn rigidity(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    ui.horizontal(|ui| {
        let range = 1..=Rigidity::MAX;
        let value = DragValue::new(&mut session.options.rigidity).range(range).speed(0.1);
        let value = ui.add(value).on_hover_text(
            "Size of the neighborhood that moves as one piece, in rings of edges (r in the paper). 1 is soft rubber, \
             6 is stiff, 20 is nearly metal",
        );
        let label = ui.label("current rigidity");
        value.labelled_by(label.id);
    });
    ui.horizontal_wrapped(|ui| {
        for r in [1, 2, 3, 4, 6, 10, 20] {
            let is_current = session.options.rigidity == r;
            let tip = format!("Paint and fill with rigidity {r}");
            if ui.selectable_label(is_current, r.to_string()).on_hover_text(tip).clicked() {
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
    buttons(ui, session, &[Action::FILL_ALL, Action::LEARN_RIGIDITY], chosen);
}

/// What is locked, and what can be.
pub(super) fn locks(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    let n = session.document().map_or(0, |document| document.scene().locked.vertices().len());
    let text = match n {
        0 => "Nothing is locked".to_owned(),
        1 => "1 vertex is locked".to_owned(),
        n => format!("{n} vertices are locked"),
    };
    ui.label(RichText::new(text).weak());
    let actions = [
        Action::LOCK_SELECTION,
        Action::UNLOCK_SELECTION,
        Action::LOCK_RIGIDITY,
        Action::UNLOCK_RIGIDITY,
        Action::LOCK_ALL,
        Action::UNLOCK_ALL,
    ];
    buttons(ui, session, &actions, chosen);
}

pub(super) fn buttons(ui: &mut Ui, session: &Session, actions: &[Action], chosen: &mut Option<Action>) {
    ui.horizontal_wrapped(|ui| {
        for &action in actions {
            if action_button(ui, session, action).clicked() {
                *chosen = Some(action);
            }
        }
    });
}
