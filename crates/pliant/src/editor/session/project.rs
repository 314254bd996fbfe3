//! Projects, autosave and what lasts from one start to the next.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::Session;
use crate::document::{History, Model, Snapshot};
use crate::editor::preferences::forgiving;
use crate::editor::{Autosave, Job, Leftover, Look, NoticeKind, Origin, Preferences, ProjectFile, Restored};
use crate::project::{Contents, Mesh, MeshChoice};
use crate::tools::{Options, ToolKind};

/// Changed preferences are written so long after the change: a slider that is dragged is written once.
const PREFERENCES_AFTER: Duration = Duration::from_secs(2);

impl Session {
    /// From now on settings, recent files and autosaves are kept in `folder`, and those of earlier starts are used.
    pub fn remember_in(&mut self, folder: &Path) {
        self.preferences = Preferences::load(folder);
        self.recent = self.preferences.get(crate::editor::recent::NAME);
        self.habits = self.preferences.get("habits");
        self.options = self.preferences.get::<Options>("options").in_range();
        self.set_look(self.preferences.get::<Look>("look").in_range());
        if let Some(bytes) = self.preferences.get::<Option<usize>>("history_bytes") {
            self.set_history_budget(bytes);
        }
        let autosaves = folder.join("autosave");
        self.start(Job::FindLeftovers(autosaves.clone()));
        match Autosave::new(&autosaves) {
            Ok(autosave) => self.autosave = Some(autosave),
            Err(error) => {
                let text = format!("Work is not kept for the case of a crash: {}: {error}", autosaves.display());
                self.notices.push(NoticeKind::Warning, text);
            }
        }
    }

    /// Looks after the autosave, the preferences and what stands on the hint line for a moment; [`Session::poll`] does it with the time it is.
    pub fn tick(&mut self, now: Instant) {
        self.keep_preferences(now);
        self.end_aside(now);
        let Some(mut autosave) = self.autosave.take() else { return };
        let is_busy = self.tool_is_active() || self.document().is_some_and(|document| document.in_step());
        let contents = || self.contents(Mesh::Packed);
        let trouble = autosave.tick(now, self.document(), is_busy, contents, &self.wake);
        self.autosave = Some(autosave);
        if let Some(trouble) = trouble {
            self.notices.push(NoticeKind::Error, trouble);
        }
    }

    /// How long until [`Session::tick`] has something to do, if nothing else happens.
    pub fn due_in(&self, now: Instant) -> Option<Duration> {
        let autosave = self.autosave.as_ref().and_then(|autosave| autosave.due_in(now));
        let preferences = self.preferences_due.map(|due| due.saturating_duration_since(now));
        let aside = self.aside.as_ref().map(|(_, until)| until.saturating_duration_since(now));
        autosave.into_iter().chain(preferences).chain(aside).min()
    }

    /// Where this window keeps its autosave, if it does.
    pub fn autosave_path(&self) -> Option<&Path> {
        self.autosave.as_ref().map(Autosave::path)
    }

    /// The window closes in order: what lasts is written, no autosave is left, and nothing of an export. Waits for all.
    pub fn end(&mut self) {
        self.end_exporting();
        self.note_preferences();
        if let Some(changes) = self.preferences.take_changes() {
            changes.write();
        }
        if let Some(autosave) = self.autosave.take() {
            autosave.finish();
        }
    }

    fn note_preferences(&mut self) {
        let is_noted = self.noted.as_ref().is_some_and(|(options, look, budget, recent, habits)| {
            let is_same = *options == self.options && *look == self.look && *budget == self.history_budget;
            is_same && *recent == self.recent && *habits == self.habits
        });
        if is_noted {
            return;
        }
        let (look, habits) = (self.look.clone(), self.habits.clone());
        self.noted = Some((self.options.clone(), look, self.history_budget, self.recent.clone(), habits));
        self.preferences.set("habits", &self.habits);
        self.preferences.set("options", &self.options);
        self.preferences.set("look", &self.look);
        self.preferences.set("history_bytes", &Some(self.history_budget));
        self.preferences.set(crate::editor::recent::NAME, &self.recent);
    }

    fn keep_preferences(&mut self, now: Instant) {
        self.note_preferences();
        if !self.preferences.is_changed() {
            self.preferences_due = None;
            return;
        }
        let due = *self.preferences_due.get_or_insert(now + PREFERENCES_AFTER);
        if now >= due
            && let Some(changes) = self.preferences.take_changes()
        {
            self.preferences_due = None;
            // Without a thread they are written when the window closes.
            let _ = std::thread::Builder::new().name("preferences".into()).spawn(move || changes.write());
        }
    }

    /// What a project of the present state holds.
    fn contents(&self, mesh: Mesh) -> Option<Contents> {
        let open = self.open()?;
        let settings = json!({"options": self.options, "look": self.look, "tool": self.tool_kind()});
        let belongs_to = open.project.as_ref().map(|project| project.path.clone());
        Some(Contents { settings, mesh, belongs_to, ..Contents::of(&open.document, open.camera) })
    }

    /// Writes the project in the background.
    pub fn save_project(&mut self, to: PathBuf, mesh: Mesh) {
        if let Some(contents) = self.contents(mesh) {
            self.start(Job::Save { contents: Box::new(Contents { belongs_to: None, ..contents }), to });
        }
    }

    /// Writes the bent mesh in the background.
    pub fn export(&mut self, to: PathBuf) {
        if let Some(document) = self.document() {
            let (model, snapshot) = (document.model().clone(), document.snapshot());
            self.start(Job::Export { model, snapshot, to });
        }
    }

    pub(super) fn saved(&mut self, contents: &Contents, to: &Path, warnings: &[String]) {
        self.say_written("Saved", to, warnings);
        let mesh = contents.mesh;
        // Another mesh may have been opened while this one was written.
        let model = &contents.model;
        if let Some(open) = self.open.as_mut().filter(|open| Arc::ptr_eq(open.document.model(), model)) {
            open.document.mark_saved(contents.snapshot.clone());
            open.project = Some(ProjectFile::new(to.to_owned(), mesh));
        }
    }

    pub(super) fn exported(&mut self, model: &Arc<Model>, to: PathBuf, snapshot: Snapshot, warnings: &[String]) {
        self.say_written("Exported", &to, warnings);
        if let Some(open) = self.open.as_mut().filter(|open| Arc::ptr_eq(open.document.model(), model)) {
            open.exported = Some((to, snapshot));
        }
    }

    fn say_written(&mut self, what: &str, to: &Path, warnings: &[String]) {
        self.recent.add(to);
        self.notices.clear();
        self.notices.push(NoticeKind::Done, format!("{what} {}", to.display()));
        for warning in warnings {
            self.notices.push(NoticeKind::Warning, warning.clone());
        }
    }

    /// Takes over the settings of tools and picture that a project holds. The window's colors stay the user's.
    pub(super) fn take_settings(&mut self, restored: Option<&mut Restored>) {
        let Some(mut settings) = restored.map(|restored| restored.settings.take()) else { return };
        let mut stored = |name: &str| settings.get_mut(name).map(Value::take);
        if let Some(options) = stored("options") {
            self.options = forgiving::<Options>(&options).in_range();
        }
        if let Some(look) = stored("look") {
            let theme = self.look.theme;
            self.set_look(Look { theme, ..forgiving::<Look>(&look).in_range() });
        }
        if let Some(Ok(kind)) = stored("tool").map(serde_json::from_value::<ToolKind>) {
            self.take_tool(kind);
        }
    }

    /// A document has come to the screen; the one before was saved or given up.
    pub(super) fn arrived(&mut self, origin: Option<Origin>) {
        let budget = self.history_budget;
        let Some(open) = &mut self.open else { return };
        open.document.set_history_budget(budget);
        let file = match &open.project {
            Some(project) => Some(project.path.clone()),
            None => open.document.model().file.path.clone(),
        };
        if let Some(file) = file {
            self.recent.add(&file);
        }
        if let Some(autosave) = &mut self.autosave {
            autosave.start_over();
        }
        if let Some(Origin::Leftover(leftover)) = origin {
            self.recovery.retain(|other| other.file != leftover.file);
            let name = self.open.as_ref().map(|open| open.name()).unwrap_or_default();
            self.notices.push(NoticeKind::Done, format!("Recovered {name}: save it (Ctrl+S) to keep it for good"));
            if let Some(autosave) = &mut self.autosave {
                autosave.recovered(leftover);
            }
        }
    }

    /// Opens the autosave in this file, if it is one of those that are offered.
    pub fn recover(&mut self, file: &Path) {
        if let Some(leftover) = self.recovery.iter().find(|leftover| leftover.file == file).cloned() {
            let path = leftover.file.clone();
            self.start(Job::OpenProject { path, choice: MeshChoice::Named, leftover: Some(leftover) });
        }
    }

    /// Removes an autosave that is offered, for good.
    pub fn discard_leftover(&mut self, leftover: &Leftover) {
        leftover.discard();
        self.recovery.retain(|other| other.file != leftover.file);
    }

    /// Asks the window to open a file, after a question if changes would be lost. One that is gone is taken off the list of
    /// recent files.
    pub fn want(&mut self, path: PathBuf) {
        if path.is_file() {
            self.wanted = Some(path);
            return;
        }
        self.notices.push(NoticeKind::Error, format!("{} is not there any more", path.display()));
        self.recent.remove(&path);
    }

    /// The file that is to be opened, once.
    pub fn take_wanted(&mut self) -> Option<PathBuf> {
        self.wanted.take()
    }

    /// Goes to the state after the first `n` steps of the history.
    pub fn jump(&mut self, n: usize) {
        self.cancel_tool();
        if let Some(open) = &mut self.open {
            open.document.jump(n);
        }
        self.synchronize();
    }

    /// Bytes that the history may take.
    pub fn history_budget(&self) -> usize {
        self.history_budget
    }

    /// Changes how many bytes the history may take, of this document and of those that follow.
    pub fn set_history_budget(&mut self, bytes: usize) {
        self.history_budget = bytes.clamp(*History::BUDGETS.start(), *History::BUDGETS.end());
        if let Some(open) = &mut self.open {
            open.document.set_history_budget(bytes);
        }
    }
}
