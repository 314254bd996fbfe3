//! Files that were opened or saved lately, in the menu and in the open dialog.

use std::path::{Path, PathBuf};

use egui::{RichText, Ui};

use crate::editor::Session;

/// What the open dialog shows without scrolling (by eye).
const IN_DIALOG: usize = 6;

/// The submenu of recent files.
pub(super) fn menu(ui: &mut Ui, session: &mut Session) {
    let recent: Vec<PathBuf> = session.recent.paths().map(Path::to_owned).collect();
    ui.add_enabled_ui(!recent.is_empty(), |ui| {
        let menu = ui.menu_button("Open recent", |ui| {
            for path in recent {
                if ui.button(name_of(&path)).on_hover_text(path.display().to_string()).clicked() {
                    session.want(path);
                    ui.close();
                }
            }
            ui.separator();
            if ui.button("Clear this list").on_hover_text("Forget these files; the files themselves stay").clicked() {
                session.recent.clear();
                ui.close();
            }
        });
        menu.response.on_disabled_hover_text("Nothing was opened or saved yet");
    });
}

/// The newest files as buttons; returns the one that was pressed.
pub(super) fn list(ui: &mut Ui, session: &Session) -> Option<PathBuf> {
    let mut chosen = None;
    if session.recent.paths().len() == 0 {
        return None;
    }
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("Recent").weak());
        for path in session.recent.paths().take(IN_DIALOG) {
            if ui.button(name_of(path)).on_hover_text(path.display().to_string()).clicked() {
                chosen = Some(path.to_owned());
            }
        }
    });
    ui.add_space(6.0);
    chosen
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
