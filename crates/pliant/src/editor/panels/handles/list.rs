//! The list of groups: color, name, vertices. Only the rows in sight are made, so that hundreds cost nothing.

use std::sync::Arc;

use egui::{Align, Color32, Layout, Popup, Response, RichText, ScrollArea, Sense, TextEdit, Ui};

use crate::document::{Command, Group, GroupColor, GroupId};
use crate::editor::Session;

/// Rows in sight at once (by eye: leaves room for the other sections).
const ROWS: f32 = 8.0;
/// From this many groups on, a field narrows the list.
const FILTER_FROM: usize = 9;
/// Side of a color, in points.
const SWATCH: f32 = 16.0;

/// Shows the list; a click chooses, Shift+click or Ctrl+click chooses several, a double click renames.
pub(super) fn show(ui: &mut Ui, session: &mut Session) {
    let Some(document) = session.document() else { return };
    let (groups, active) = (document.scene().groups.clone(), document.scene().active.clone());
    let shown = filtered(ui, &groups);
    let row_height = ui.spacing().interact_size.y;
    let height = ROWS * (row_height + ui.spacing().item_spacing.y);
    let mut commands = Vec::new();
    ScrollArea::vertical().id_salt("groups").max_height(height).auto_shrink([false, true]).show_rows(
        ui,
        row_height,
        shown.len(),
        |ui, rows| {
            for group in shown[rows].iter().map(|&k| &groups[k]) {
                ui.push_id(group.id.0, |ui| row(ui, group, &active, &mut commands));
            }
        },
    );
    if shown.is_empty() {
        ui.label(RichText::new("No name contains this").weak());
    }
    commands.into_iter().for_each(|command| session.apply(command));
}

/// Places of the groups whose names contain what was typed.
fn filtered(ui: &mut Ui, groups: &Arc<[Group]>) -> Vec<usize> {
    if groups.len() < FILTER_FROM {
        return (0..groups.len()).collect();
    }
    let id = ui.make_persistent_id("filter");
    let mut filter: String = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let field = TextEdit::singleline(&mut filter).hint_text("Find by name").desired_width(f32::INFINITY);
    let response = ui.add(field).on_hover_text("Show only handles and anchors whose names contain this");
    name_for_readers(ui, &response, "Find handles by name");
    let wanted = filter.trim().to_lowercase();
    ui.data_mut(|data| data.insert_temp(id, filter));
    (0..groups.len()).filter(|&k| groups[k].name.to_lowercase().contains(&wanted)).collect()
}

fn row(ui: &mut Ui, group: &Group, active: &crate::document::ActiveGroups, commands: &mut Vec<Command>) {
    let is_active = active.contains(group.id);
    ui.horizontal(|ui| {
        // What is done to one of several chosen groups is done to all of them.
        let meant = if is_active { active.ids().to_vec() } else { vec![group.id] };
        color(ui, group, &meant, commands);
        if !rename(ui, group, commands) {
            let label = ui.selectable_label(is_active, &group.name);
            let label = label.on_hover_text("Click: work on it · Shift+click: on several · double click: rename");
            if label.double_clicked() {
                ui.data_mut(|data| data.insert_temp(rename_id(), Some((group.id, group.name.clone()))));
            } else if label.clicked() {
                let several = ui.input(|input| input.modifiers.shift || input.modifiers.command);
                commands.push(match several {
                    true => Command::ActivateSeveral(active.toggled(group.id)),
                    false if is_active && active.len() == 1 => Command::Activate(None),
                    false => Command::Activate(Some(group.id)),
                });
            }
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let close = ui.small_button("×").on_hover_text("Let go");
            name_for_readers(ui, &close, &format!("Let go of {}", group.name));
            if close.clicked() {
                commands.push(Command::Release(vec![group.id]));
            }
            let count = RichText::new(group.vertices.len().to_string()).weak().small();
            ui.label(count).on_hover_text("Vertices it holds");
        });
    });
}

/// The color of a group: a click offers the others, and whether its dots are shown.
fn color(ui: &mut Ui, group: &Group, meant: &[GroupId], commands: &mut Vec<Command>) {
    let name = format!("Color of {}", group.name);
    let response = swatch(ui, group.color, group.dots, &name);
    let response = response.on_hover_text("Color, and whether its dots are shown");
    Popup::menu(&response).show(|ui| {
        ui.horizontal(|ui| {
            for color in GroupColor::ALL {
                if swatch(ui, color, true, color.name()).on_hover_text(color.name()).clicked() {
                    step(commands, "Color handle", meant, |id| Command::SetColor(id, color));
                    ui.close();
                }
            }
        });
        let mut shown = group.dots;
        let tip = "Handles without dots still hold; they are taken by their vertices or from this list";
        if ui.checkbox(&mut shown, "Show dots").on_hover_text(tip).changed() {
            step(commands, if shown { "Show dots" } else { "Hide dots" }, meant, |id| Command::ShowDots(id, shown));
        }
    });
}

fn step(commands: &mut Vec<Command>, name: &'static str, meant: &[GroupId], command: impl Fn(GroupId) -> Command) {
    commands.push(Command::Begin(name));
    commands.extend(meant.iter().map(|&id| command(id)));
    commands.push(Command::Commit);
}

/// A disc of a color, hollow where it is not shown.
fn swatch(ui: &mut Ui, color: GroupColor, is_full: bool, name: &str) -> Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(SWATCH), Sense::click());
    let enabled = ui.is_enabled();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, name));
    let [red, green, blue] = color.rgb();
    let fill = Color32::from_rgb(red, green, blue);
    let outline = match response.hovered() || response.has_focus() {
        true => ui.visuals().widgets.hovered.fg_stroke,
        false => egui::Stroke::new(1.0, ui.visuals().weak_text_color()),
    };
    if is_full {
        ui.painter().circle_filled(rect.center(), 6.0, fill);
        ui.painter().circle_stroke(rect.center(), 6.0, outline);
    } else {
        ui.painter().circle_stroke(rect.center(), 5.0, egui::Stroke::new(2.0, fill));
    }
    response
}

/// The group that is being renamed, and its name so far: one at a time in the window.
fn rename_id() -> egui::Id {
    egui::Id::unique("group being renamed")
}

/// The field in which the group is renamed, if it is. Enter or leaving the field takes the name over, Esc does not.
fn rename(ui: &mut Ui, group: &Group, commands: &mut Vec<Command>) -> bool {
    let Some((id, mut name)) = ui.data(|data| data.get_temp::<Option<(GroupId, String)>>(rename_id())).flatten() else {
        return false;
    };
    if id != group.id {
        return false;
    }
    let response = ui.add(TextEdit::singleline(&mut name).desired_width(130.0));
    name_for_readers(ui, &response, "Name");
    if response.lost_focus() {
        let trimmed = name.trim();
        if !ui.input(|input| input.key_pressed(egui::Key::Escape)) && !trimmed.is_empty() && trimmed != group.name {
            commands.push(Command::Rename(group.id, trimmed.to_owned()));
        }
        ui.data_mut(|data| data.insert_temp(rename_id(), None::<(GroupId, String)>));
    } else {
        if !response.has_focus() {
            response.request_focus();
        }
        ui.data_mut(|data| data.insert_temp(rename_id(), Some((id, name))));
    }
    true
}

/// What screen readers and tests call a control without words.
fn name_for_readers(ui: &Ui, response: &Response, name: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}
