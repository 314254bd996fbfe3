//! Dialogs in the window: open, save, the sheet of keys, and the question before unsaved changes are lost.

use std::path::PathBuf;

use egui::{Grid, Id, Key, Modal, RichText, ScrollArea, TextEdit, Ui};

use crate::editor::{Action, Job, Sample, Session};

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
    /// Where to write.
    Save {
        /// What is typed.
        path: String,
    },
    /// Keys and mouse.
    Keys,
    /// Unsaved changes would be lost.
    Unsaved(Loss),
}

/// What would lose unsaved changes.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::editor) enum Loss {
    /// Opening a file.
    Open(PathBuf),
    /// Opening a sample.
    OpenSample(Sample),
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
    /// Write here.
    Save(PathBuf),
    /// Lose the changes.
    Lose(Loss),
    /// Save first, then go on.
    SaveFirst(Loss),
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
                Dialog::Save { path } => outcome = save(ui, path, session, &mut close),
                Dialog::Keys => keys(ui, session, &mut close),
                Dialog::Unsaved(loss) => outcome = unsaved(ui, loss, &mut close),
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
    ui.heading("Open a mesh");
    ui.label(RichText::new("OBJ, glTF, GLB, PLY, STL and OFF. A file dropped on the window opens too.").weak());
    ui.add_space(6.0);
    let entered = path_field(ui, path, || session.start(Job::BrowseOpen));
    ui.add_space(6.0);
    let mut outcome = None;
    ui.horizontal(|ui| {
        ui.label(RichText::new("Samples").weak());
        for sample in Sample::ALL {
            if ui.button(sample.name()).clicked() {
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

fn save(ui: &mut Ui, path: &mut String, session: &mut Session, close: &mut bool) -> Option<DialogOutcome> {
    ui.heading("Save the bent mesh");
    let text = "The ending chooses the format: .glb, .gltf, .obj, .ply, .stl or .off. Rigidity is kept with the mesh.";
    ui.label(RichText::new(text).weak());
    ui.add_space(6.0);
    let name = PathBuf::from(path.trim()).file_name().map(|name| name.to_string_lossy().into_owned());
    let entered = path_field(ui, path, || session.start(Job::BrowseSave { name: name.unwrap_or_default() }));
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
    let label = if exists { "Replace" } else { "Save" };
    confirm(ui, label, known, note, entered, close).then_some(DialogOutcome::Save(typed))
}

/// A field for a path with a button for the platform's dialog; whether Enter was pressed in it.
fn path_field(ui: &mut Ui, path: &mut String, browse: impl FnOnce()) -> bool {
    let mut entered = false;
    ui.horizontal(|ui| {
        let width = ui.available_width() - 90.0;
        let field = ui.add(TextEdit::singleline(path).hint_text("Path").desired_width(width).id_salt("path"));
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

fn confirm(ui: &mut Ui, label: &str, can: bool, why_not: &str, entered: bool, close: &mut bool) -> bool {
    let mut confirmed = entered && can;
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let button = ui.add_enabled(can, egui::Button::new(label)).on_disabled_hover_text(why_not);
        confirmed |= button.clicked();
        *close |= ui.button("Cancel").clicked();
    });
    confirmed
}

fn unsaved(ui: &mut Ui, loss: &Loss, close: &mut bool) -> Option<DialogOutcome> {
    ui.heading("Save your changes?");
    let what = match loss {
        Loss::Close => "Closing the window",
        Loss::Open(_) | Loss::OpenSample(_) | Loss::Show => "Opening another mesh",
    };
    ui.label(format!("{what} loses what was bent and painted since the last save."));
    ui.add_space(10.0);
    let mut outcome = None;
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        if ui.button("Save…").clicked() {
            outcome = Some(DialogOutcome::SaveFirst(loss.clone()));
        }
        if ui.button("Discard").clicked() {
            outcome = Some(DialogOutcome::Lose(loss.clone()));
        }
        *close |= ui.button("Cancel").clicked();
    });
    outcome
}

fn keys(ui: &mut Ui, session: &Session, close: &mut bool) {
    ui.heading("Keys and mouse");
    ui.add_space(4.0);
    let height = ui.ctx().content_rect().height() - 180.0;
    ScrollArea::vertical().max_height(height).show(ui, |ui| {
        Grid::new("keys").num_columns(2).spacing([24.0, 3.0]).striped(true).show(ui, |ui| {
            for (what, how) in [
                ("Left button", "the tool in hand"),
                ("Middle or right drag, Alt + left drag", "turn the view"),
                ("Shift + middle or right drag", "move the view"),
                ("Wheel, pinch, Alt + right drag", "zoom toward the pointer"),
                ("Shift while dragging a handle", "keep to an axis"),
                ("Ctrl while turning with the gizmo", "steps of 15°"),
                ("Ctrl / Shift while painting", "softer / smooth"),
                ("Shift / Ctrl while selecting", "add / remove"),
                ("Esc", "take back the drag or stroke under way"),
                ("F held while moving the mouse", "brush radius"),
                ("1 … 9, two digits typed quickly", "current rigidity"),
            ] {
                ui.label(RichText::new(what).strong());
                ui.label(how);
                ui.end_row();
            }
            for action in Action::all() {
                let key = session.shortcuts.text(action, ui.ctx());
                if !key.is_empty() {
                    ui.label(RichText::new(key).strong());
                    ui.label(action.label()).on_hover_text(action.tooltip());
                    ui.end_row();
                }
            }
        });
    });
    ui.add_space(8.0);
    *close |= ui.button("Close").clicked();
}
