//! The menu *File*.

use egui::{Key, ViewportCommand};

use super::actions;
use super::entry::{CTRL, CTRL_SHIFT, Entry};
use crate::editor::panels::Loss;
use crate::editor::{EditorApp, Sample, Session};

actions! {
    /// Shows the open dialog.
    OPEN = Entry::new(
        "file.open",
        "Open…",
        "Open a mesh (OBJ, glTF, GLB, PLY, STL, OFF) or a project. A file dropped on the window opens too",
    )
    .key(CTRL, Key::O)
    .anytime()
    .window(EditorApp::ask_what_to_open);
    /// Opens the start sample.
    SAMPLE_CREATURE = sample("sample.creature", Sample::Creature, "A creature with four limbs, ears and a tail")
        .window(|app, ctx| open_sample(app, ctx, Sample::Creature));
    /// Opens the cactus.
    SAMPLE_CACTUS = sample("sample.cactus", Sample::Cactus, "A ribbed trunk with two arms")
        .window(|app, ctx| open_sample(app, ctx, Sample::Cactus));
    /// Opens the sheet.
    SAMPLE_SHEET = sample("sample.sheet", Sample::Sheet, "An open surface with a border")
        .window(|app, ctx| open_sample(app, ctx, Sample::Sheet));
    /// Opens the bar.
    SAMPLE_BAR = sample("sample.bar", Sample::Bar, "A bar of square section, as in the paper")
        .window(|app, ctx| open_sample(app, ctx, Sample::Bar));
    /// Opens the thin bar.
    SAMPLE_THIN_BAR = sample("sample.thin-bar", Sample::ThinBar, "A long, thin bar, as in the paper")
        .window(|app, ctx| open_sample(app, ctx, Sample::ThinBar));
    /// Opens the gecko.
    SAMPLE_GECKO = sample("sample.gecko", Sample::Gecko, "An animal with twelve poses to learn rigidity from")
        .window(|app, ctx| open_sample(app, ctx, Sample::Gecko));
    /// Opens the jointed bar.
    SAMPLE_JOINTED_BAR = sample("sample.jointed-bar", Sample::JointedBar, "A bar with joints, and twelve poses")
        .window(|app, ctx| open_sample(app, ctx, Sample::JointedBar));
    /// Reads the file again.
    REOPEN = Entry::new("file.reopen", "Reopen", "Read the file again, as it is now, with the welding that is chosen")
        .unless(comes_from_no_file)
        .window(EditorApp::reopen);
    /// Writes the project to where it was last written, or asks.
    SAVE = Entry::new("file.save", "Save", "Save the project: mesh, rigidity, handles, pose and view, to go on with later")
        .key(CTRL, Key::S)
        .apart()
        .window(|app, _| app.save());
    /// Asks where to write the project.
    SAVE_AS = Entry::new("file.save-as", "Save as…", "Save the project under another name")
        .key(CTRL_SHIFT, Key::S)
        .window(|app, _| app.ask_where_to_save());
    /// Asks where to write the mesh.
    EXPORT = Entry::new(
        "file.export",
        "Export mesh…",
        "Write the bent mesh for other programs: OBJ, glTF, GLB, PLY, STL or OFF, with everything else its file held",
    )
    .key(CTRL, Key::E)
    .window(|app, _| app.ask_where_to_export());
    /// Closes the window.
    QUIT = Entry::new("file.quit", "Quit", "Close the window; unsaved work is asked about first")
        .key(CTRL, Key::Q)
        .anytime()
        .apart()
        .window(|_, ctx| ctx.send_viewport_cmd(ViewportCommand::Close));
}

const fn sample(id: &'static str, sample: Sample, tooltip: &'static str) -> Entry {
    Entry::new(id, sample.name(), tooltip).anytime().within("Open sample")
}

fn open_sample(app: &mut EditorApp, ctx: &egui::Context, sample: Sample) {
    app.lose(Loss::OpenSample(sample), ctx);
}

fn comes_from_no_file(session: &Session) -> Option<&'static str> {
    let path = session.document().and_then(|document| document.model().file.path.as_ref());
    if session.open().is_some_and(|open| open.project.is_some()) {
        return Some("This mesh belongs to a project: to weld it in another way, open its own file");
    }
    path.is_none().then_some("This mesh comes from no file")
}
