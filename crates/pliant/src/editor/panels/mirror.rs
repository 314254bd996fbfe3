//! The inspector's part for painting both sides at once.

use egui::{DragValue, RichText, Ui};

use super::paint::buttons;
use crate::editor::{Action, Session, theme};
use crate::tools::MirrorKind;

/// How the other side is found, and what was found.
pub(super) fn mirror(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    let mut options = session.options.paint.mirror.clone();
    ui.horizontal(|ui| {
        for (kind, label, tip) in [
            (MirrorKind::Off, "Off", "Paint where the pointer is and nowhere else"),
            (
                MirrorKind::Plane,
                "By plane",
                "Brush, fill and lock act on both sides of a plane (the shape at rest counts)",
            ),
            (
                MirrorKind::Topology,
                "By mesh",
                "Both sides are found by how the mesh hangs together: right for a symmetric mesh in any pose",
            ),
        ] {
            ui.selectable_value(&mut options.kind, kind, label).on_hover_text(tip);
        }
    });
    if options.kind != MirrorKind::Off {
        plane(ui, session, &mut options);
    }
    if options != session.options.paint.mirror {
        session.options.paint.mirror = options;
        session.options.paint = session.options.paint.clone().in_range();
    }
    if session.options.paint.mirror.kind == MirrorKind::Topology {
        let edge = match session.options.paint.mirror.edge {
            Some([a, b]) => format!("From the edge between vertices {a} and {b}"),
            None => "From the edge that looks most like the middle".to_owned(),
        };
        ui.label(RichText::new(edge).weak());
        buttons(ui, session, &[Action::TAKE_MIDDLE_EDGE, Action::FORGET_MIDDLE_EDGE], chosen);
    }
    found(ui, session);
}

fn plane(ui: &mut Ui, session: &Session, options: &mut crate::tools::MirrorOptions) {
    let Some(document) = session.document() else { return };
    let model = document.model();
    ui.horizontal(|ui| {
        ui.label("Across");
        for (axis, label) in ["x", "y", "z"].into_iter().enumerate() {
            let tip = format!("The plane is at a right angle to the {label} axis");
            ui.selectable_value(&mut options.axis, axis, label).on_hover_text(tip);
        }
    });
    ui.horizontal(|ui| {
        let mut at = options.plane(model).at;
        let speed = 1e-3 * f64::from(model.diagonal());
        let field = ui.add(DragValue::new(&mut at).speed(speed).max_decimals(6));
        let label = ui.label("at");
        let tip = "Where the plane cuts its axis, in the model's units";
        if field.labelled_by(label.id).on_hover_text(tip).changed() {
            options.at = Some(at);
        }
        for (place, label, tip, already) in [
            (None, "middle", "Through the middle of the model", "The plane goes through the middle of the model"),
            (Some(0.0), "origin", "Through the origin", "The plane goes through the origin"),
        ] {
            let button = ui.add_enabled(options.at != place, egui::Button::new(label));
            if button.on_hover_text(tip).on_disabled_hover_text(already).clicked() {
                options.at = place;
            }
        }
    });
    ui.horizontal(|ui| {
        let speed = 1e-4 * f64::from(model.diagonal());
        let field = DragValue::new(&mut options.tolerance).range(0.0..=f64::MAX).speed(speed).max_decimals(6);
        let field = ui.add(field);
        let label = ui.label("tolerance");
        field
            .labelled_by(label.id)
            .on_hover_text("How far from its mirrored place a vertex may be to count as the image");
    });
}

/// How many vertices have no partner, and where the sides differ.
fn found(ui: &mut Ui, session: &Session) {
    if session.options.paint.mirror.kind == MirrorKind::Off {
        return;
    }
    let (text, is_warning) = match session.mirror() {
        Some(mirror) => match (mirror.map.n_alone(), mirror.uneven) {
            (0, _) => ("Every vertex has a partner".to_owned(), false),
            (n, None) => (format!("{n} of {} vertices have no partner", mirror.map.n_vertices()), true),
            (n, Some([a, b])) => (
                format!(
                    "{n} of {} vertices have no partner: the sides first differ at vertices {} and {}",
                    mirror.map.n_vertices(),
                    a.0,
                    b.0
                ),
                true,
            ),
        },
        None if session.is_preparing() => ("Looking for the other side…".to_owned(), false),
        None => ("The other side could not be found".to_owned(), true),
    };
    let text = RichText::new(text);
    ui.label(if is_warning { text.color(theme::ACCENT) } else { text.weak() });
}
