//! The parts of the window around the viewport. Each is a function of the session.

mod dialogs;
mod exporting;
mod files;
mod gizmo;
mod handles;
mod help;
mod history;
mod icons;
mod inspect;
mod inspector;
mod key_sheet;
mod learn;
mod legend;
mod menu;
mod mesh_section;
mod mirror;
mod notices;
mod paint;
mod palette;
mod rail;
mod recent;
mod recovery;
mod select;
mod solver;
mod status;
mod view;
mod welcome;
mod weld;

pub(super) use dialogs::{Dialog, DialogOutcome, Loss};
pub(super) use inspect::inspect;
pub(super) use inspector::inspector;
pub(super) use key_sheet::KeySheet;
pub(super) use learn::learn;
pub(super) use legend::legend;
pub(super) use menu::menu;
pub(super) use notices::notices;
pub(super) use palette::Palette;
pub(super) use rail::rail;
pub(super) use recovery::recovery;
pub(super) use status::status;
pub(super) use welcome::welcome;

use super::Action;
use egui::{Response, Ui};

use super::Session;

/// Names a control for those who hear the window rather than see it.
fn name(ui: &Ui, response: &Response, name: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}

/// The tooltip of an action, with its key if it has one.
fn tip(ui: &Ui, session: &Session, action: Action) -> String {
    let tip = match session.habits.shortcuts.text(action, ui.ctx()) {
        key if key.is_empty() => action.tooltip().to_owned(),
        key => format!("{} ({key})", action.tooltip()),
    };
    match session.textures_obstacle.filter(|_| action == Action::COLOR_PLAIN) {
        Some(why) => format!("{tip}. Textures are not shown: {why}"),
        None => tip,
    }
}

/// A button for an action: label, tooltip with its key, and the reason when it cannot be done now.
pub(super) fn action_button(ui: &mut Ui, session: &Session, action: Action) -> Response {
    let obstacle = action.obstacle(session);
    let response = ui.add_enabled(obstacle.is_none(), egui::Button::new(action.label()));
    response.on_hover_text(tip(ui, session, action)).on_disabled_hover_text(obstacle.unwrap_or_default())
}
