//! The sections of the inspector.

use egui::{RichText, Slider, Ui};

use super::action_button;
use crate::document::{Command, Group, GroupKind};
use crate::editor::{Action, Session};
use crate::tools::{Options, SelectShape};

/// Patch size of handles and anchors.
pub(super) fn patch(ui: &mut Ui, session: &mut Session) {
    ui.horizontal(|ui| {
        let slider = Slider::new(&mut session.options.patch_rings, 0..=Options::MOST_PATCH_RINGS);
        ui.add(slider).on_hover_text("Rings of vertices around the clicked one that are held with it; 0 is one vertex");
        ui.label("patch rings");
    });
}

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

/// The groups.
pub(super) fn handles(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    let Some(document) = session.document() else {
        return;
    };
    let (groups, active) = (document.scene().groups.clone(), document.scene().active.lead());
    if groups.is_empty() {
        ui.label(RichText::new("None yet. Hold one part with an anchor, pull another with a handle.").weak());
        return;
    }
    let mut commands = Vec::new();
    for group in groups.iter() {
        ui.push_id(group.id.0, |ui| {
            group_row(ui, group, active == Some(group.id), &mut commands);
            if active == Some(group.id) {
                name_field(ui, group, &mut commands);
            }
        });
    }
    commands.into_iter().for_each(|command| session.apply(command));
    ui.horizontal(|ui| {
        if action_button(ui, session, Action::RESET_POSE).clicked() {
            *chosen = Some(Action::RESET_POSE);
        }
    });
}

fn group_row(ui: &mut Ui, group: &Group, is_active: bool, commands: &mut Vec<Command>) {
    ui.horizontal(|ui| {
        let [red, green, blue] = group.color.rgb();
        let (rect, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
        ui.painter().circle_filled(rect.center(), 5.0, egui::Color32::from_rgb(red, green, blue));
        ui.painter().circle_stroke(rect.center(), 5.0, ui.visuals().widgets.noninteractive.fg_stroke);
        let label = ui.selectable_label(is_active, &group.name);
        if label.on_hover_text(format!("{} vertices", group.vertices.len())).clicked() {
            commands.push(Command::Activate((!is_active).then_some(group.id)));
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            if ui.small_button("×").on_hover_text("Let go").clicked() {
                commands.push(Command::Release(vec![group.id]));
            }
            let (label, kind, tip) = match group.kind {
                GroupKind::Handle => ("anchor it", GroupKind::Anchor, "Hold it where it is now"),
                GroupKind::Anchor => ("free it", GroupKind::Handle, "Make it movable"),
            };
            if ui.small_button(label).on_hover_text(tip).clicked() {
                commands.push(Command::SetKind(group.id, kind));
            }
            if ui.small_button("rest").on_hover_text("Put it back to the rest shape").clicked() {
                commands.push(Command::ReturnToRest(group.id));
            }
        });
    });
}

/// Renames the group; what is typed becomes its name when the field is left.
fn name_field(ui: &mut Ui, group: &Group, commands: &mut Vec<Command>) {
    let id = ui.make_persistent_id("name");
    let mut name = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| group.name.clone());
    let field = ui.add(egui::TextEdit::singleline(&mut name).hint_text("Name").desired_width(160.0));
    if field.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let name = name.trim().to_owned();
        if !name.is_empty() && name != group.name {
            commands.push(Command::Rename(group.id, name));
        }
    } else if field.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, name));
    }
}
