//! The inspector of the select tool: how to select, what is selected, what to make of it, and stored sets.

use egui::{ComboBox, DragValue, RichText, ScrollArea, TextEdit, Ui, WidgetInfo};
use pliant_solver::Rigidity;

use super::{action_button, paint, status::grouped};
use crate::document::{Command, SelectMode, SetChange, SetId, StoredSet};
use crate::editor::{Action, Session};
use crate::tools::SelectShape;

/// Stored sets that are listed before the list scrolls (by eye).
const SETS_HEIGHT: f32 = 160.0;

/// Everything about selecting.
pub(super) fn select(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    shape(ui, session);
    count(ui, session);
    buttons(
        ui,
        session,
        chosen,
        &[
            Action::SELECT_ALL,
            Action::SELECT_NONE,
            Action::INVERT_SELECTION,
            Action::GROW_SELECTION,
            Action::SHRINK_SELECTION,
            Action::SELECT_LINKED,
            Action::SELECT_SAME_RIGIDITY,
            Action::SELECT_BORDER,
            Action::SELECT_HANDLE,
        ],
    );
    by_rigidity(ui, session);
    by_part(ui, session);
    ui.add_space(6.0);
    ui.label(RichText::new("Make of it").strong());
    buttons(
        ui,
        session,
        chosen,
        &[
            Action::HANDLE_FROM_SELECTION,
            Action::ANCHOR_FROM_SELECTION,
            Action::FILL_SELECTION,
            Action::HOLD_EVERYTHING_ELSE,
            Action::RELEASE_EVERYTHING,
        ],
    );
    region(ui, session);
    ui.add_space(6.0);
    sets(ui, session, chosen);
}

fn buttons(ui: &mut Ui, session: &Session, chosen: &mut Option<Action>, actions: &[Action]) {
    ui.horizontal_wrapped(|ui| {
        for &action in actions {
            if action_button(ui, session, action).clicked() {
                *chosen = Some(action);
            }
        }
    });
}

/// What a drag draws, and how far it reaches.
fn shape(ui: &mut Ui, session: &mut Session) {
    let tip = |shape| match shape {
        SelectShape::Box => "Drag a rectangle around vertices (Shift+C changes the shape)",
        SelectShape::Lasso => "Drag a line around vertices; it closes by itself (Shift+C changes the shape)",
        SelectShape::Brush => "Drag a circle over the surface (Shift+C changes the shape)",
    };
    ui.horizontal(|ui| {
        for shape in SelectShape::ALL {
            ui.selectable_value(&mut session.options.select_shape, shape, shape.label()).on_hover_text(tip(shape));
        }
    });
    // One row for either, so that nothing below moves.
    if session.options.select_shape == SelectShape::Brush {
        return paint::radius(ui, session);
    }
    ui.horizontal(|ui| {
        ui.selectable_value(&mut session.options.select_through, true, "Through")
            .on_hover_text("Also take vertices that are hidden behind the surface");
        ui.selectable_value(&mut session.options.select_through, false, "Front only")
            .on_hover_text("Take only vertices that can be seen");
    });
}

fn count(ui: &mut Ui, session: &Session) {
    let Some(document) = session.document() else { return };
    let (n, all) = (document.scene().selection.len(), document.model().mesh.n_vertices());
    ui.label(RichText::new(format!("{} of {} selected", grouped(n), grouped(all))).weak());
}

/// A range of r.
fn by_rigidity(ui: &mut Ui, session: &mut Session) {
    let id = ui.scope_id().with("rigidity range");
    let mut range = ui.data(|data| data.get_temp::<(u16, u16)>(id)).unwrap_or((1, 1));
    ui.horizontal(|ui| {
        ui.label("Rigidity");
        let from = ui.add(DragValue::new(&mut range.0).range(1..=Rigidity::MAX).speed(0.1));
        from.on_hover_text("Smallest rigidity to select");
        range.1 = range.1.max(range.0);
        ui.label("to");
        let to = ui.add(DragValue::new(&mut range.1).range(1..=Rigidity::MAX).speed(0.1));
        to.on_hover_text("Largest rigidity to select");
        range.0 = range.0.min(range.1);
        let button = ui.button("Select").on_hover_text("Select the vertices in this range · Shift adds · Ctrl removes");
        button.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Select by rigidity"));
        if button.clicked() {
            session.select_rigidity(range.0..=range.1, mode(ui));
        }
    });
    ui.data_mut(|data| data.insert_temp(id, range));
}

/// The names of the file's parts.
fn by_part(ui: &mut Ui, session: &mut Session) {
    let Some(model) = session.document().map(|document| document.model().clone()) else { return };
    let parts = &model.file.parts;
    let mut wanted = None;
    ui.horizontal(|ui| {
        ui.label("Part");
        ui.add_enabled_ui(parts.len() > 1, |ui| {
            let combo = ComboBox::from_id_salt("part").selected_text("Choose…").height(320.0);
            let combo = combo.show_ui(ui, |ui| {
                let mut names: Vec<&str> = parts.iter().map(|part| part.name.as_str()).collect();
                names.sort_unstable();
                names.dedup();
                let row = ui.spacing().interact_size.y;
                ScrollArea::vertical().max_height(300.0).show_rows(ui, row, names.len(), |ui, rows| {
                    for &name in &names[rows] {
                        let label = if name.is_empty() { "(no name)" } else { name };
                        if ui.selectable_label(false, label).clicked() {
                            wanted = Some(name.to_owned());
                        }
                    }
                });
            });
            combo
                .response
                .on_hover_text("Select a part or material of the file · Shift adds · Ctrl removes")
                .on_disabled_hover_text("The file is all one part");
        });
    });
    if let Some(name) = wanted {
        session.select_part(&name, mode(ui));
    }
}

/// Says so while only a region bends. The line is always there, so that nothing below moves.
fn region(ui: &mut Ui, session: &Session) {
    let text = match session.region_of_interest() {
        Some(n) => format!("{} vertices bend, everything else is held", grouped(n)),
        None => "Everything bends that is not held".into(),
    };
    ui.label(RichText::new(text).weak());
}

/// Stored sets: store, recall, rename, bring up to date, delete.
fn sets(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new("Stored sets").strong());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if action_button(ui, session, Action::STORE_SELECTION).clicked() {
                *chosen = Some(Action::STORE_SELECTION);
            }
        });
    });
    let Some(scene) = session.document().map(|document| document.scene().clone()) else { return };
    if scene.sets.is_empty() {
        ui.label(RichText::new("None yet. Store keeps the selection here, and in the project.").weak());
        return;
    }
    let renamed = ui.scope_id().with("renamed set");
    let mut changes = Vec::new();
    ScrollArea::vertical().id_salt("sets").max_height(SETS_HEIGHT).show(ui, |ui| {
        for set in scene.sets.iter() {
            ui.push_id(set.id.0, |ui| row(ui, set, renamed, !scene.selection.is_empty(), &mut changes));
        }
    });
    changes.into_iter().for_each(|change| session.apply(Command::Sets(change)));
}

fn row(ui: &mut Ui, set: &StoredSet, renamed: egui::Id, can_update: bool, changes: &mut Vec<SetChange>) {
    if let Some((id, name)) = ui.data(|data| data.get_temp::<(SetId, String)>(renamed))
        && id == set.id
    {
        return name_field(ui, set, name, renamed, changes);
    }
    let named = |button: &egui::Response, what: &str| {
        button.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, format!("{what} {}", set.name)));
    };
    ui.horizontal(|ui| {
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let delete = ui.small_button("×").on_hover_text("Forget this set; the vertices stay");
            named(&delete, "Delete");
            if delete.clicked() {
                changes.push(SetChange::Delete(set.id));
            }
            let update = ui.add_enabled(can_update, egui::Button::new("update").small());
            let update = update
                .on_hover_text("Make this set what is selected now")
                .on_disabled_hover_text("Nothing is selected");
            named(&update, "Update");
            if update.clicked() {
                changes.push(SetChange::Update(set.id));
            }
            let rename = ui.small_button("rename").on_hover_text("Give this set another name");
            named(&rename, "Rename");
            if rename.clicked() {
                ui.data_mut(|data| data.insert_temp(renamed, (set.id, set.name.clone())));
            }
            ui.label(RichText::new(grouped(set.vertices.len())).weak()).on_hover_text("Vertices of this set");
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                let name = ui.add(egui::Button::selectable(false, &set.name).truncate());
                if name.on_hover_text("Select these vertices · Shift adds · Ctrl removes").clicked() {
                    changes.push(SetChange::Recall(set.id, mode(ui)));
                }
            });
        });
    });
}

/// What is typed becomes the name when the field is left; Esc leaves the old one.
fn name_field(ui: &mut Ui, set: &StoredSet, mut name: String, renamed: egui::Id, changes: &mut Vec<SetChange>) {
    let field = ui.add(TextEdit::singleline(&mut name).hint_text("Name").desired_width(f32::INFINITY));
    field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, format!("New name of {}", set.name)));
    if field.lost_focus() {
        if !ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            changes.push(SetChange::Rename(set.id, name));
        }
        ui.data_mut(|data| data.remove::<(SetId, String)>(renamed));
    } else {
        if !field.has_focus() {
            field.request_focus();
        }
        ui.data_mut(|data| data.insert_temp(renamed, (set.id, name)));
    }
}

/// How a click joins the selection.
fn mode(ui: &Ui) -> SelectMode {
    match ui.input(|input| input.modifiers) {
        keys if keys.shift => SelectMode::Add,
        keys if keys.command => SelectMode::Remove,
        _ => SelectMode::Replace,
    }
}
