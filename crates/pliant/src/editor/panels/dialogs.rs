//! Dialogs in the window: open, save, those of the menu Help, and the question before unsaved changes are lost.

use std::path::PathBuf;

use egui::{Id, Key, Modal, RichText, TextEdit, Ui};

use super::key_sheet::KeySheet;
use super::palette::Palette;
use super::{exporting, files, help};
use crate::editor::{Action, Job, Sample, Session};
use crate::project::Mesh;

/// The dialog on screen.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::editor) enum Dialog {
    /// None.
    #[default]
    None,
    /// Which mesh to open.
    Open {
        /// What is typed.
        path: String,
    },
    /// Where to write the project.
    Save {
        /// What is typed.
        path: String,
        /// How the mesh goes into it.
        mesh: Mesh,
    },
    /// Where to write the bent mesh.
    Export {
        /// What is typed.
        path: String,
    },
    /// Where the mesh of a project is.
    Mesh {
        /// The project.
        project: PathBuf,
        /// What is typed.
        path: String,
        /// What is wrong with the mesh it names.
        why: String,
    },
    /// Any action by its name.
    Palette(Palette),
    /// Keys and mouse.
    Keys(KeySheet),
    /// What r means.
    WhatIsRigidity,
    /// Version and license.
    About,
    /// Unsaved changes would be lost.
    Unsaved(Loss),
    /// Closing would stop an export of poses.
    Exporting,
}

/// What would lose unsaved changes.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::editor) enum Loss {
    /// Opening a file.
    Open(PathBuf),
    /// Opening a sample.
    OpenSample(Sample),
    /// Opening the autosave in this file.
    Recover(PathBuf),
    /// Opening a project with a mesh that was chosen.
    OpenProject(PathBuf, PathBuf),
    /// Showing a mesh that has been read meanwhile.
    Show,
    /// Closing the window.
    Close,
}

/// What the window must do after a dialog.
#[derive(Debug, PartialEq)]
pub(in crate::editor) enum DialogOutcome {
    /// Open this file.
    Open(PathBuf),
    /// Open this sample.
    OpenSample(Sample),
    /// Write the project here.
    Save(PathBuf, Mesh),
    /// Write the mesh here.
    Export(PathBuf),
    /// Open a project with this mesh.
    OpenProject(PathBuf, PathBuf),
    /// Lose the changes.
    Lose(Loss),
    /// Save first, then go on.
    SaveFirst(Loss),
    /// Do this.
    Do(Action),
    /// Nothing.
    Canceled,
}

impl Dialog {
    /// Shows the dialog, if any.
    pub(in crate::editor) fn show(&mut self, ctx: &egui::Context, session: &mut Session) -> Option<DialogOutcome> {
        if *self == Dialog::None {
            return None;
        }
        let mut outcome = None;
        let mut close = false;
        let modal = Modal::new(Id::unique("dialog")).show(ctx, |ui| {
            ui.set_width(520.0_f32.min(ui.ctx().content_rect().width() - 48.0));
            match self {
                Dialog::None => {}
                Dialog::Open { path } => outcome = open(ui, path, session, &mut close),
                Dialog::Save { path, mesh } => outcome = files::save(ui, (path, mesh), session, &mut close),
                Dialog::Export { path } => outcome = export(ui, path, session, &mut close),
                Dialog::Mesh { project, path, why } => {
                    outcome = files::mesh(ui, (project, path, why), session, &mut close);
                }
                Dialog::Palette(palette) => outcome = palette.show(ui, session).map(DialogOutcome::Do),
                Dialog::Keys(sheet) => sheet.show(ui, session, &mut close),
                Dialog::WhatIsRigidity => help::what_rigidity_is(ui, &mut close),
                Dialog::About => help::about(ui, &mut close),
                Dialog::Exporting => outcome = exporting::question(ui, session, &mut close),
                Dialog::Unsaved(loss) => outcome = unsaved(ui, loss, session, &mut close),
            }
        });
        if outcome.is_some() || close || modal.should_close() {
            *self = Dialog::None;
            return outcome.or(Some(DialogOutcome::Canceled));
        }
        None
    }
}

fn open(ui: &mut Ui, path: &mut String, session: &mut Session, close: &mut bool) -> Option<DialogOutcome> {
    ui.heading("Open a mesh or a project");
    let text = "OBJ, glTF, GLB, PLY, STL, OFF and .pliant. A file dropped on the window opens too.";
    ui.label(RichText::new(text).weak());
    ui.add_space(6.0);
    let entered = path_field(ui, path, || session.start(Job::BrowseOpen));
    ui.add_space(6.0);
    let mut outcome = super::recent::list(ui, session).map(DialogOutcome::Open);
    ui.horizontal(|ui| {
        ui.label(RichText::new("Samples").weak());
        for sample in Sample::ALL {
            if ui.button(sample.name()).on_hover_text("A mesh that comes with Pliant").clicked() {
                outcome = Some(DialogOutcome::OpenSample(sample));
            }
        }
    });
    ui.add_space(6.0);
    let unit = session.document().map_or(0.001, |document| 0.01 * document.model().mean_edge());
    super::weld::choice(ui, &mut session.welding, unit);
    ui.add_space(10.0);
    if confirm(ui, "Open", !path.trim().is_empty(), "Type a path or browse for a file", entered, close) {
        outcome = Some(DialogOutcome::Open(PathBuf::from(path.trim())));
    }
    outcome
}

fn export(ui: &mut Ui, path: &mut String, session: &mut Session, close: &mut bool) -> Option<DialogOutcome> {
    ui.heading("Export the bent mesh");
    let text = "The ending chooses the format: .glb, .gltf, .obj, .ply, .stl or .off. Rigidity is kept with the mesh.";
    ui.label(RichText::new(text).weak());
    ui.add_space(6.0);
    let name = PathBuf::from(path.trim()).file_name().map(|name| name.to_string_lossy().into_owned());
    let browse = || session.start(Job::BrowseSave { name: name.unwrap_or_default(), project: false });
    let entered = path_field(ui, path, browse);
    let typed = PathBuf::from(path.trim());
    let known = pliant_meshfile::Format::of(&typed).is_some();
    let exists = typed.is_file();
    let note = match (known, exists) {
        (false, _) => "Choose an ending that can be written: .glb, .gltf, .obj, .ply, .stl or .off",
        (true, true) => "This file exists and will be replaced",
        (true, false) => "",
    };
    ui.label(RichText::new(note).weak());
    ui.add_space(6.0);
    let label = if exists { "Replace" } else { "Export" };
    confirm(ui, label, known, note, entered, close).then_some(DialogOutcome::Export(typed))
}

/// A field for a path with a button for the platform's dialog; whether Enter was pressed in it.
pub(super) fn path_field(ui: &mut Ui, path: &mut String, browse: impl FnOnce()) -> bool {
    let mut entered = false;
    ui.horizontal(|ui| {
        let width = ui.available_width() - 90.0;
        let field = ui.add(TextEdit::singleline(path).hint_text("Path").desired_width(width).id_salt("path"));
        let field = field.on_hover_text("Path of the file, with its ending");
        entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if !field.has_focus() && !entered && ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        if ui.button("Browse…").on_hover_text("The platform's own file dialog").clicked() {
            browse();
        }
    });
    entered
}

pub(super) fn confirm(ui: &mut Ui, label: &str, can: bool, why_not: &str, entered: bool, close: &mut bool) -> bool {
    let mut confirmed = entered && can;
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let button = ui.add_enabled(can, egui::Button::new(label)).on_hover_text("Or press Enter in the path");
        confirmed |= button.on_disabled_hover_text(why_not).clicked();
        *close |= ui.button("Cancel").on_hover_text("Do nothing (Esc)").clicked();
    });
    confirmed
}

fn unsaved(ui: &mut Ui, loss: &Loss, session: &Session, close: &mut bool) -> Option<DialogOutcome> {
    ui.heading("Save your changes?");
    let what = match loss {
        Loss::Close => "Closing the window",
        Loss::Open(_) | Loss::OpenSample(_) | Loss::OpenProject(..) | Loss::Show => "Opening another mesh",
        Loss::Recover(_) => "Recovering unsaved work",
    };
    ui.label(format!("{what} loses what was bent, painted and placed since the last save."));
    if let Some(path) = session.open().and_then(|open| open.is_exported()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        ui.label(RichText::new(format!("The bent mesh itself is in {name}; handles and anchors are not.")).weak());
    }
    ui.add_space(10.0);
    let mut outcome = None;
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        if ui.button("Save…").on_hover_text("Save first, then go on").clicked() {
            outcome = Some(DialogOutcome::SaveFirst(loss.clone()));
        }
        if ui.button("Discard").on_hover_text("Go on, and lose the changes").clicked() {
            outcome = Some(DialogOutcome::Lose(loss.clone()));
        }
        *close |= ui.button("Cancel").on_hover_text("Stay here, and keep everything (Esc)").clicked();
    });
    outcome
}

#[cfg(test)]
mod tests {
    use egui::{Context, Event, Modifiers, RawInput};

    use super::*;

    /// One of each kind.
    fn every_dialog() -> Vec<Dialog> {
        // A new kind does not compile here, to be listed below.
        match Dialog::None {
            Dialog::None | Dialog::Open { .. } | Dialog::Save { .. } | Dialog::Palette(_) => {}
            Dialog::Export { .. } | Dialog::Mesh { .. } | Dialog::Exporting => {}
            Dialog::Keys(_) | Dialog::WhatIsRigidity | Dialog::About | Dialog::Unsaved(_) => {}
        }
        let path = String::new();
        vec![
            Dialog::Open { path: path.clone() },
            Dialog::Save { path: path.clone(), mesh: Mesh::Packed },
            Dialog::Export { path: path.clone() },
            Dialog::Mesh { project: PathBuf::new(), path, why: String::new() },
            Dialog::Palette(Palette::default()),
            Dialog::Keys(KeySheet::default()),
            Dialog::WhatIsRigidity,
            Dialog::About,
            Dialog::Unsaved(Loss::Close),
        ]
    }

    fn frame(ctx: &Context, dialog: &mut Dialog, session: &mut Session, events: Vec<Event>) {
        let input = RawInput { events, ..RawInput::default() };
        let mut output = ctx.run_ui(input, |ui| {
            dialog.show(ui.ctx(), session);
        });
        output.textures_delta.clear();
    }

    #[test]
    fn every_dialog_closes_by_escape() {
        let mut session = Session::new(|| {}).expect("a solver thread");
        for mut dialog in every_dialog() {
            let ctx = Context::default();
            let was = dialog.clone();
            for _ in 0..3 {
                frame(&ctx, &mut dialog, &mut session, Vec::new());
            }
            assert_ne!(dialog, Dialog::None, "{was:?} closed by itself");
            let (key, modifiers) = (Key::Escape, Modifiers::NONE);
            let press = Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers };
            frame(&ctx, &mut dialog, &mut session, vec![press]);
            assert_eq!(dialog, Dialog::None, "{was:?} stays in spite of Esc");
        }
    }
}
