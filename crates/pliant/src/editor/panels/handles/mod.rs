//! Handles and anchors: the list of groups, what can be done with those that are chosen, and their numbers.

mod list;
mod numbers;

use egui::{RichText, Ui};

use super::action_button;
use crate::editor::{Action, Session};

/// What can be done with the chosen groups, in the order of its buttons.
const ACTIONS: [Action; 8] = [
    Action::RETURN_TO_REST,
    Action::SWAP_KINDS,
    Action::MERGE_GROUPS,
    Action::ADD_TO_GROUP,
    Action::REMOVE_FROM_GROUP,
    Action::SELECT_GROUPS,
    Action::FRAME_GROUPS,
    Action::DELETE_HANDLE,
];

/// The section.
pub(super) fn handles(ui: &mut Ui, session: &mut Session, chosen: &mut Option<Action>) {
    let Some(document) = session.document() else {
        return;
    };
    let scene = document.scene();
    if scene.groups.is_empty() {
        ui.label(RichText::new("None yet. Hold one part with an anchor, pull another with a handle.").weak());
        return;
    }
    let (n_groups, n_active) = (scene.groups.len(), scene.active.len());
    list::show(ui, session);
    ui.label(RichText::new(format!("{n_active} of {n_groups} chosen")).weak());
    ui.horizontal_wrapped(|ui| {
        for action in ACTIONS {
            if action_button(ui, session, action).clicked() {
                *chosen = Some(action);
            }
        }
    });
    numbers::show(ui, session);
    ui.horizontal(|ui| {
        for action in [Action::CHOOSE_ALL_GROUPS, Action::RESET_POSE] {
            if action_button(ui, session, action).clicked() {
                *chosen = Some(action);
            }
        }
    });
}
