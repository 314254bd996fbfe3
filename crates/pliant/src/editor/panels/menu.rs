//! The menu bar, made from the table of actions.

use egui::{MenuBar, Ui};

use super::tip;
use crate::editor::{Action, Session};

/// Shows the menus; returns what was chosen.
pub(in crate::editor) fn menu(ui: &mut Ui, session: &mut Session) -> Option<Action> {
    let mut chosen = None;
    MenuBar::new().ui(ui, |ui| {
        for menu in Action::MENUS {
            ui.menu_button(menu.name, |ui| items(ui, session, menu.actions, &mut chosen));
        }
    });
    chosen
}

/// Actions one below the other; a run of them with the same submenu is in a menu of its own.
fn items(ui: &mut Ui, session: &mut Session, actions: &[Action], chosen: &mut Option<Action>) {
    for run in actions.chunk_by(|a, b| a.submenu() == b.submenu()) {
        match run.first().and_then(|action| action.submenu()) {
            Some(name) => {
                if run[0].begins_part() {
                    ui.separator();
                }
                ui.menu_button(name, |ui| run.iter().for_each(|&action| item(ui, session, action, chosen)));
            }
            None => {
                for &action in run {
                    if action.begins_part() {
                        ui.separator();
                    }
                    item(ui, session, action, chosen);
                    if action == Action::OPEN {
                        super::recent::menu(ui, session);
                    }
                }
            }
        }
    }
}

fn item(ui: &mut Ui, session: &Session, action: Action, chosen: &mut Option<Action>) {
    let title = action.title(session);
    let mut button = match action.is_on(session) {
        Some(is_on) => egui::Button::selectable(is_on, title),
        None => egui::Button::new(title),
    };
    let key = session.habits.shortcuts.text(action, ui.ctx());
    if !key.is_empty() {
        button = button.shortcut_text(key);
    }
    let obstacle = action.obstacle(session);
    let response = ui.add_enabled(obstacle.is_none(), button).on_hover_text(tip(ui, session, action));
    if response.on_disabled_hover_text(obstacle.unwrap_or_default()).clicked() {
        *chosen = Some(action);
    }
}
