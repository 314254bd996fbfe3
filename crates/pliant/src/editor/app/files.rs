//! What the window does about files: asking, opening, saving, exporting, recovering, closing.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::EditorApp;
use crate::editor::panels::{Dialog, DialogOutcome, Loss};
use crate::editor::{Job, JobEvent, NoticeKind};
use crate::project::{EXTENSION, Mesh, MeshChoice};

impl EditorApp {
    pub(in crate::editor) fn ask_what_to_open(&mut self, _ctx: &egui::Context) {
        self.dialog = Dialog::Open { path: String::new() };
    }

    pub(in crate::editor) fn reopen(&mut self, ctx: &egui::Context) {
        let path = self.session.document().and_then(|document| document.model().file.path.clone());
        if let Some(path) = path {
            self.lose(Loss::Open(path), ctx);
        }
    }

    /// Saves the project to where it was last saved, or asks.
    pub(in crate::editor) fn save(&mut self) {
        match self.session.open().and_then(|open| open.project.clone()) {
            Some(project) if project.is_foreign() => {
                let text =
                    format!("{} was written by another window or program since it was opened", project.path.display());
                self.session.notices.push(NoticeKind::Warning, text);
                self.ask_where_to_save();
            }
            Some(project) => self.session.save_project(project.path, project.mesh),
            None => self.ask_where_to_save(),
        }
    }

    pub(in crate::editor) fn ask_where_to_save(&mut self) {
        let Some(open) = self.session.open() else { return };
        let (path, mesh) = match &open.project {
            Some(project) => (project.path.clone(), project.mesh),
            None => (self.proposed(&format!("{}.{EXTENSION}", open.name())), Mesh::default()),
        };
        self.dialog = Dialog::Save { path: path.display().to_string(), mesh };
    }

    pub(in crate::editor) fn ask_where_to_export(&mut self) {
        let Some(open) = self.session.open() else { return };
        let file = &open.document.model().file;
        let path = open.exported.as_ref().map(|(path, _)| path.clone());
        let path = path.unwrap_or_else(|| self.proposed(&format!("{}-bent.{}", open.name(), file.format.extension())));
        self.dialog = Dialog::Export { path: path.display().to_string() };
    }

    /// A path for a new file of this name: beside the project or the mesh, or else where files were opened lately.
    fn proposed(&self, name: &str) -> PathBuf {
        let open = self.session.open();
        let project = open.and_then(|open| open.project.as_ref()).map(|project| project.path.as_path());
        let mesh = open.and_then(|open| open.document.model().file.path.as_deref());
        let folder = project.or(mesh).and_then(Path::parent).or_else(|| self.session.recent.folder());
        folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name))
    }

    /// Does what would lose unsaved changes, or asks first.
    pub(in crate::editor) fn lose(&mut self, loss: Loss, ctx: &egui::Context) {
        if self.session.document().is_some_and(|document| document.is_modified()) {
            self.dialog = Dialog::Unsaved(loss);
        } else {
            self.proceed(loss, ctx);
        }
    }

    fn proceed(&mut self, loss: Loss, ctx: &egui::Context) {
        match loss {
            Loss::Open(path) => self.session.start(Job::Open(path)),
            Loss::OpenSample(sample) => self.session.start(Job::OpenSample(sample)),
            Loss::OpenProject(path, mesh) => {
                self.session.start(Job::OpenProject { path, choice: MeshChoice::Chosen(mesh), leftover: None });
            }
            Loss::Recover(file) => self.session.recover(&file),
            Loss::Show => {
                if let Some((opened, sample)) = self.opened_meanwhile.take() {
                    self.session.notices.clear();
                    self.session.show(*opened, sample);
                }
            }
            Loss::Close if self.session.exporting_poses().is_some() => self.dialog = Dialog::Exporting,
            Loss::Close => {
                self.may_close = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }

    pub(super) fn after_dialog(&mut self, outcome: DialogOutcome, ctx: &egui::Context) {
        match outcome {
            DialogOutcome::Open(path) => self.lose(Loss::Open(path), ctx),
            DialogOutcome::OpenSample(sample) => self.lose(Loss::OpenSample(sample), ctx),
            DialogOutcome::OpenProject(project, mesh) => self.lose(Loss::OpenProject(project, mesh), ctx),
            DialogOutcome::Save(path, mesh) => self.session.save_project(path, mesh),
            DialogOutcome::Export(path) => self.session.export(path),
            DialogOutcome::Do(action) => action.perform(self, ctx),
            DialogOutcome::Lose(loss) => self.proceed(loss, ctx),
            DialogOutcome::SaveFirst(loss) => {
                self.after_save = Some(loss);
                self.save();
            }
            DialogOutcome::Canceled => {
                self.after_save = None;
                self.opened_meanwhile = None;
            }
        }
    }

    /// Answers what jobs ask the window.
    pub(super) fn take_events(&mut self, ctx: &egui::Context) {
        for event in self.session.poll() {
            match (event, &mut self.dialog) {
                (JobEvent::ChosenToOpen(chosen), Dialog::Mesh { path, .. }) => *path = chosen.display().to_string(),
                (JobEvent::ChosenToOpen(path), _) => {
                    self.dialog = Dialog::None;
                    self.lose(Loss::Open(path), ctx);
                }
                (JobEvent::ChosenPoses(model, paths), _) => {
                    if let Some(learning) = self.session.learning.as_mut().filter(|panel| panel.is_about(&model)) {
                        learning.add_files(paths);
                    }
                }
                (JobEvent::ChosenToSave(chosen), Dialog::Save { path, .. } | Dialog::Export { path }) => {
                    *path = chosen.display().to_string();
                }
                (JobEvent::MeshWanted { project, mesh, why }, dialog) => {
                    *dialog = Dialog::Mesh { project, path: mesh.display().to_string(), why };
                }
                (JobEvent::Opened { opened, sample }, dialog) => {
                    self.opened_meanwhile = Some((opened, sample));
                    *dialog = Dialog::Unsaved(Loss::Show);
                }
                (JobEvent::Saved { .. }, _) => {
                    if let Some(loss) = self.after_save.take() {
                        self.proceed(loss, ctx);
                    }
                }
                (JobEvent::Failed { .. }, _) => self.after_save = None,
                _ => {}
            }
        }
        if let Some(path) = self.session.take_wanted() {
            self.lose(Loss::Open(path), ctx);
        }
        if let Some(wait) = self.session.due_in(Instant::now()) {
            ctx.request_repaint_after(wait);
        }
    }

    /// Files that were dropped on the window: poses while rigidity is learned, else a mesh or project to open.
    pub(super) fn take_dropped(&mut self, ctx: &egui::Context) {
        let dropped: Vec<PathBuf> =
            ctx.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        if let Some(learning) = &mut self.session.learning
            && !dropped.is_empty()
        {
            learning.add_files(dropped);
        } else if let Some(path) = dropped.into_iter().next() {
            self.lose(Loss::Open(path), ctx);
        }
    }

    /// Asks before the window closes with unsaved changes, lets a save that is under way come to its end, and asks before it
    /// stops an export.
    pub(super) fn take_close(&mut self, ctx: &egui::Context) {
        if !ctx.input(|input| input.viewport().close_requested()) || self.may_close {
            return;
        }
        if self.session.is_saving() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.after_save = Some(Loss::Close);
        } else if self.session.document().is_some_and(|document| document.is_modified()) {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.dialog = Dialog::Unsaved(Loss::Close);
        } else if self.session.exporting_poses().is_some() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.dialog = Dialog::Exporting;
        }
    }

    pub(super) fn name_window(&mut self, ctx: &egui::Context) {
        let title = match self.session.open() {
            Some(open) => {
                let mark = if open.document.is_modified() { "• " } else { "" };
                format!("{mark}{} – Pliant", open.name())
            }
            None => "Pliant".into(),
        };
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }
}
