//! The menu bar.

use egui::{MenuBar, Ui};

use crate::editor::{Action, ColorBy, Sample, Session};
use crate::tools::ToolKind;
use crate::viewport::Axis;

/// Shows the menus; returns what was chosen.
pub(in crate::editor) fn menu(ui: &mut Ui, session: &mut Session) -> Option<Action> {
    let mut chosen = None;
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| {
            items(ui, session, &[Action::Open], &mut chosen);
            ui.menu_button("Open sample", |ui| {
                for sample in Sample::ALL {
                    item(ui, session, Action::OpenSample(sample), None, &mut chosen);
                }
            });
            ui.separator();
            items(ui, session, &[Action::Save, Action::SaveAs], &mut chosen);
            ui.separator();
            items(ui, session, &[Action::Quit], &mut chosen);
        });
        ui.menu_button("Edit", |ui| {
            let history = session.document().map(|document| document.history());
            let undo = history.and_then(|history| history.undo_name()).map(|name| format!("Undo {}", lower(name)));
            let redo = history.and_then(|history| history.redo_name()).map(|name| format!("Redo {}", lower(name)));
            item(ui, session, Action::Undo, undo, &mut chosen);
            item(ui, session, Action::Redo, redo, &mut chosen);
            ui.separator();
            let select = [
                Action::SelectAll,
                Action::SelectNone,
                Action::HandleFromSelection,
                Action::AnchorFromSelection,
                Action::HoldEverythingElse,
            ];
            items(ui, session, &select, &mut chosen);
            ui.separator();
            items(ui, session, &[Action::FillSelection, Action::FillAll, Action::LearnRigidity], &mut chosen);
            ui.separator();
            items(ui, session, &[Action::DeleteHandle, Action::ResetPose], &mut chosen);
        });
        ui.menu_button("Tools", |ui| items(ui, session, &ToolKind::ALL.map(Action::Tool), &mut chosen));
        ui.menu_button("View", |ui| {
            colors(ui, session);
            ui.separator();
            items(ui, session, &[Action::ToggleWireframe, Action::ToggleShading], &mut chosen);
            ui.separator();
            items(ui, session, &[Action::Frame, Action::ToggleProjection], &mut chosen);
            let axes = [Axis::Front, Axis::Back, Axis::Right, Axis::Left, Axis::Top, Axis::Bottom];
            items(ui, session, &axes.map(Action::LookFrom), &mut chosen);
            ui.separator();
            items(ui, session, &[Action::ToggleTheme], &mut chosen);
        });
        ui.menu_button("Help", |ui| items(ui, session, &[Action::Keys], &mut chosen));
    });
    chosen
}

fn colors(ui: &mut Ui, session: &mut Session) {
    let mut look = session.look.clone();
    for (color_by, label) in
        [(ColorBy::Plain, "Plain"), (ColorBy::Rigidity, "Color by rigidity"), (ColorBy::Energy, "Color by energy")]
    {
        ui.radio_value(&mut look.color_by, color_by, label);
    }
    if look != session.look {
        session.set_look(look);
    }
}

fn items(ui: &mut Ui, session: &Session, actions: &[Action], chosen: &mut Option<Action>) {
    for &action in actions {
        item(ui, session, action, None, chosen);
    }
}

fn item(ui: &mut Ui, session: &Session, action: Action, label: Option<String>, chosen: &mut Option<Action>) {
    let mut button = egui::Button::new(label.unwrap_or_else(|| action.label().into()));
    if let Some(shortcut) = action.shortcut() {
        button = button.shortcut_text(ui.ctx().format_shortcut(&shortcut));
    }
    let obstacle = action.obstacle(session);
    let response = ui.add_enabled(obstacle.is_none(), button).on_hover_text(action.tooltip());
    if response.on_disabled_hover_text(obstacle.unwrap_or_default()).clicked() {
        *chosen = Some(action);
    }
}

fn lower(name: &str) -> String {
    name.to_lowercase()
}
