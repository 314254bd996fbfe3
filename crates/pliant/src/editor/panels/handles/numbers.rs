//! Where the chosen handles are, in numbers that can be typed. Each edit is one step.

use egui::{DragValue, Grid, Response, RichText, Ui};
use glam::DVec3;

use crate::document::{Command, GroupKind, Placement};
use crate::editor::Session;
use crate::tools::{fixed, length};

const AXES: [&str; 3] = ["x", "y", "z"];

/// What a row of three numbers is about.
struct Row {
    name: &'static str,
    tip: &'static str,
    unit: &'static str,
    /// Change for a point of pointer movement.
    speed: f64,
    step: &'static str,
}

/// Shows the fields, unless no handle is chosen.
pub(super) fn show(ui: &mut Ui, session: &mut Session) {
    end_drag(ui, session);
    let (Some(shown), Some(document)) = (session.placement(), session.document()) else {
        let held = session.active_groups();
        if !held.is_empty() && held.iter().all(|group| group.kind == GroupKind::Anchor) {
            ui.label(RichText::new("Anchors stay where they are. Make one a handle to move it.").weak());
        }
        return;
    };
    let diagonal = f64::from(document.model().diagonal());
    let rows = [
        Row {
            name: "Move",
            tip: "Way of the handle since it was placed, in the model's units",
            unit: "",
            speed: diagonal * 1e-3,
            step: "Move handle",
        },
        Row {
            name: "Turn",
            tip: "Turns about x, then y, then z, about the pivot; all chosen handles turn together",
            unit: "°",
            speed: 0.5,
            step: "Turn handle",
        },
        Row { name: "Scale", tip: "Along the handle's own axes", unit: "", speed: 0.005, step: "Scale handle" },
    ];
    Grid::new("placement").num_columns(4).spacing([6.0, 4.0]).show(ui, |ui| {
        for (k, row) in rows.iter().enumerate() {
            ui.label(row.name).on_hover_text(row.tip);
            for axis in 0..3 {
                let mut wanted = shown;
                let numbers = [&mut wanted.translation, &mut wanted.degrees, &mut wanted.scale];
                let format = |value: f64| match k {
                    0 => length(value, diagonal),
                    1 => fixed(value, 1),
                    _ => fixed(value, 3),
                };
                let response = field(ui, row, axis, &mut *numbers[k], &format);
                react(ui, session, row.step, (&response, (wanted != shown).then_some(wanted)));
            }
            ui.end_row();
        }
    });
}

fn field(ui: &mut Ui, row: &Row, axis: usize, numbers: &mut DVec3, format: &dyn Fn(f64) -> String) -> Response {
    let value = &mut numbers[axis];
    let before = *value;
    let drag = DragValue::new(&mut *value)
        .speed(row.speed)
        .suffix(row.unit)
        .update_while_editing(false)
        .custom_formatter(|value, _| format(value))
        .custom_parser(|text| text.trim().replace(',', ".").parse().ok());
    let response = ui.add_sized([62.0, ui.spacing().interact_size.y], drag);
    let name = format!("{} {}", row.name, AXES[axis]);
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name.clone()));
    // Leaving a field gives back the digits that were shown: not a wish.
    if !response.dragged() && format(*value) == format(before) {
        *value = before;
    }
    response.on_hover_text(format!("{name}: {}. Drag sideways, or click and type", row.tip))
}

/// One step for a typed number, and one for a whole drag.
fn react(ui: &Ui, session: &mut Session, step: &'static str, (response, wanted): (&Response, Option<Placement>)) {
    if response.drag_started() {
        session.apply(Command::Begin(step));
        ui.data_mut(|data| data.insert_temp(drag_id(), true));
    }
    let Some(wanted) = wanted else { return };
    if response.dragged() {
        // Esc has taken the drag back: it stays so until the button is let go.
        if session.document().is_some_and(|document| document.in_step()) {
            session.place_active(wanted);
        }
    } else {
        session.apply(Command::Begin(step));
        session.place_active(wanted);
        session.apply(Command::Commit);
    }
}

/// Whether a number is being dragged: its step ends with the button, also where the field has gone meanwhile.
fn drag_id() -> egui::Id {
    egui::Id::unique("placement being dragged")
}

fn end_drag(ui: &Ui, session: &mut Session) {
    let is_open = ui.data(|data| data.get_temp::<bool>(drag_id())).unwrap_or(false);
    if is_open && !ui.input(|input| input.pointer.any_down()) {
        session.apply(Command::Commit);
        ui.data_mut(|data| data.remove::<bool>(drag_id()));
    }
}
