//! Dialogs about projects: where to save one, and where the mesh of one is.

use std::path::{Path, PathBuf};

use egui::{RichText, Ui};

use super::dialogs::{DialogOutcome, confirm, path_field};
use crate::editor::{Job, Session};
use crate::project::{EXTENSION, Mesh, is_project};

/// Where to save the project, and what becomes of its mesh.
pub(super) fn save(
    ui: &mut Ui,
    (path, mesh): (&mut String, &mut Mesh),
    session: &mut Session,
    close: &mut bool,
) -> Option<DialogOutcome> {
    ui.heading("Save the project");
    let text = "Keeps everything to go on with: mesh, rigidity, handles, pose and view. To use the bent mesh in other \
                programs, export it (Ctrl+E).";
    ui.label(RichText::new(text).weak());
    ui.add_space(6.0);
    let name = PathBuf::from(path.trim()).file_name().map(|name| name.to_string_lossy().into_owned());
    let browse = || session.start(Job::BrowseSave { name: name.unwrap_or_default(), project: true });
    let entered = path_field(ui, path, browse);
    packing(ui, mesh, session);
    let typed = PathBuf::from(path.trim());
    let is_named = typed.file_name().is_some();
    let target = with_ending(&typed);
    let exists = is_named && target.is_file();
    let note = match (is_named, exists) {
        (false, _) => "Type where to save it",
        (true, true) => "This file exists and will be replaced",
        (true, false) => "",
    };
    ui.label(RichText::new(note).weak());
    ui.add_space(6.0);
    let label = if exists { "Replace" } else { "Save" };
    confirm(ui, label, is_named, note, entered, close).then_some(DialogOutcome::Save(target, *mesh))
}

/// The choice between packing the mesh and linking to its file.
fn packing(ui: &mut Ui, mesh: &mut Mesh, session: &Session) {
    let has_file = session.document().is_some_and(|document| document.model().file.path.is_some());
    let mut packed = *mesh == Mesh::Packed || !has_file;
    ui.add_enabled_ui(has_file, |ui| {
        let tip = "Packed, the project opens anywhere and whatever becomes of the mesh's file. Otherwise it is smaller, and \
                   needs that file where it is and as it is";
        let checkbox = ui.checkbox(&mut packed, "Pack the mesh into the project").on_hover_text(tip);
        checkbox.on_disabled_hover_text("This mesh comes from no file: it is always packed");
    });
    *mesh = if packed { Mesh::Packed } else { Mesh::Linked };
}

/// A path that ends like a project's.
fn with_ending(path: &Path) -> PathBuf {
    if is_project(path) {
        return path.to_owned();
    }
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(EXTENSION);
    PathBuf::from(name)
}

/// Where the mesh of a linked project is.
pub(super) fn mesh(
    ui: &mut Ui,
    (project, path, why): (&Path, &mut String, &str),
    session: &mut Session,
    close: &mut bool,
) -> Option<DialogOutcome> {
    ui.heading("Where is the mesh of this project?");
    ui.label(why);
    ui.add_space(6.0);
    let entered = path_field(ui, path, || session.start(Job::BrowseOpen));
    let typed = PathBuf::from(path.trim());
    let is_mesh = pliant_meshfile::Format::of(&typed).is_some() && typed.is_file();
    let note = if is_mesh { "" } else { "Choose a mesh file that exists" };
    ui.label(RichText::new(note).weak());
    ui.add_space(6.0);
    let opens = confirm(ui, "Open with this mesh", is_mesh, note, entered, close);
    opens.then(|| DialogOutcome::OpenProject(project.to_owned(), typed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_project_always_ends_like_one() {
        for (typed, expected) in
            [("a", "a.pliant"), ("b.Pliant", "b.Pliant"), ("v1.2", "v1.2.pliant"), ("c.obj", "c.obj.pliant")]
        {
            assert_eq!(with_ending(Path::new(typed)), Path::new(expected));
        }
    }
}
