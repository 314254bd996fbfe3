//! Work that takes longer than a frame, each piece on a thread of its own.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use pliant_geometry::VertexNormals;
use pliant_meshfile::OpenOptions;

use super::opening::Opening;
use super::{Leftover, Origin, ProjectFile, Restored, Sample, leftovers};
use crate::document::{Model, ModelError, Snapshot};
use crate::project::{self, Contents, EXTENSION, MeshChoice, ProjectError};
use crate::tools::Surface;
use crate::viewport::SurfaceFrame;

/// What can be done in the background.
pub enum Job {
    /// Reads a mesh file.
    Open(PathBuf),
    /// Reads a mesh of the program's own.
    OpenSample(Sample),
    /// Reads a project whose mesh was chosen, or an autosave.
    OpenProject {
        /// The project.
        path: PathBuf,
        /// Its mesh.
        choice: MeshChoice,
        /// The autosave that it is, if it is one.
        leftover: Option<Arc<Leftover>>,
    },
    /// Writes a project.
    Save {
        /// What to write.
        contents: Box<Contents>,
        /// Where.
        to: PathBuf,
    },
    /// Looks for autosaves of windows that stopped.
    FindLeftovers(PathBuf),
    /// Writes the deformed mesh.
    Export {
        /// What was opened.
        model: Arc<Model>,
        /// What to write.
        snapshot: Snapshot,
        /// Where.
        to: PathBuf,
    },
    /// Asks the platform's dialog for a file to open.
    BrowseOpen,
    /// Asks the platform's dialog for files with poses of a surface.
    BrowsePoses(Arc<Model>),
    /// Asks the platform's dialog for a file to write.
    BrowseSave {
        /// Proposed name.
        name: String,
        /// Whether a project is to be written, or a mesh.
        project: bool,
    },
}

/// A model with what the window needs to show and pick it.
pub struct Opened {
    /// The model.
    pub model: Arc<Model>,
    /// Picking.
    pub surface: Surface,
    /// Normals of later poses.
    pub normals: VertexNormals,
    /// What was made of it, when it comes from a project.
    pub restored: Option<Box<Restored>>,
}

/// What a job came to.
pub enum JobEvent {
    /// A mesh is ready.
    Opened {
        /// Everything about it.
        opened: Box<Opened>,
        /// Where it came from, when it is one of the program's own.
        sample: Option<Sample>,
    },
    /// The project was written.
    Saved {
        /// What is on disk now.
        contents: Box<Contents>,
        /// Where.
        to: PathBuf,
        /// What could not be done as wished.
        warnings: Vec<String>,
    },
    /// The mesh was written.
    Exported {
        /// What was opened.
        model: Arc<Model>,
        /// Where.
        to: PathBuf,
        /// What is in the file.
        snapshot: Snapshot,
        /// What the file could not hold.
        warnings: Vec<String>,
    },
    /// A project is linked to a mesh that is not there any more, or another one by now.
    MeshWanted {
        /// The project.
        project: PathBuf,
        /// Where its mesh should be.
        mesh: PathBuf,
        /// What is wrong with that.
        why: String,
    },
    /// Autosaves of windows that stopped.
    Leftovers(Vec<Leftover>),
    /// A path was chosen to open.
    ChosenToOpen(PathBuf),
    /// Files with poses of a surface were chosen.
    ChosenPoses(Arc<Model>, Vec<PathBuf>),
    /// A path was chosen to write.
    ChosenToSave(PathBuf),
    /// There is no dialog on this machine, or it was closed at once.
    NoDialog,
    /// The dialog was closed without a choice, or the mesh is no longer wanted.
    Dismissed,
    /// It failed: why.
    Failed {
        /// What was tried, as the status line says it.
        what: &'static str,
        /// Why not, and what to do.
        why: String,
    },
}

/// A dialog that answers this fast was never shown.
const INSTANT: std::time::Duration = std::time::Duration::from_millis(400);

/// Starts jobs and collects what they came to.
pub(super) struct Jobs {
    sender: Sender<(u64, JobEvent)>,
    receiver: Receiver<(u64, JobEvent)>,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// Number and label of each unfinished job, oldest first.
    running: Vec<(u64, &'static str)>,
    next: u64,
    /// The newest job that opens a mesh, while it runs: what older ones bring is no longer wanted.
    opening: Option<(u64, Opening)>,
}

impl Jobs {
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Jobs {
        let (sender, receiver) = channel();
        Jobs { sender, receiver, wake, running: Vec::new(), next: 0, opening: None }
    }

    /// Starts a job; files are opened with `options`. A thread that cannot be started is a failure like any other.
    pub(super) fn start(&mut self, job: Job, options: OpenOptions) {
        let (sender, wake) = (self.sender.clone(), self.wake.clone());
        let number = self.next;
        self.next += 1;
        let what = label(&job);
        let opening = Opening::default();
        if matches!(job, Job::Open(_) | Job::OpenProject { .. } | Job::OpenSample(_)) {
            self.cancel_opening();
            self.opening = Some((number, opening.clone()));
        }
        self.running.push((number, what));
        let work = move || {
            let outcome =
                std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| run(job, &opening, options, &*wake)));
            let event = outcome
                .unwrap_or_else(|_| JobEvent::Failed { what, why: "it stopped unexpectedly; please report it".into() });
            // Nobody listens any more once the window is closed.
            let _ = sender.send((number, event));
            wake();
        };
        if let Err(error) = std::thread::Builder::new().name("job".into()).spawn(work) {
            let _ = self
                .sender
                .send((number, JobEvent::Failed { what, why: format!("no thread could be started: {error}") }));
        }
    }

    /// The next finished job.
    pub(super) fn poll(&mut self) -> Option<JobEvent> {
        loop {
            let (number, event) = self.receiver.try_recv().ok()?;
            self.running.retain(|&(running, _)| running != number);
            let is_newest = self.opening.as_ref().is_some_and(|(newest, _)| *newest == number);
            if is_newest {
                self.opening = None;
            }
            if is_newest || !matches!(event, JobEvent::Opened { .. } | JobEvent::MeshWanted { .. }) {
                return Some(event);
            }
        }
    }

    /// How far the newest job is that opens a mesh, while one does.
    pub(super) fn opening(&self) -> Option<f64> {
        self.opening.as_ref().map(|(_, opening)| opening.fraction())
    }

    /// Stops opening a mesh: the one on screen stays.
    pub(super) fn cancel_opening(&mut self) {
        if let Some((number, opening)) = self.opening.take() {
            opening.stop();
            self.running.retain(|&(running, _)| running != number);
        }
    }

    /// Whether a mesh is being written.
    pub(super) fn is_saving(&self) -> bool {
        self.running.iter().any(|&(_, what)| what == SAVING)
    }

    /// What is being done, for the status line.
    pub(super) fn running(&self) -> Option<&'static str> {
        self.running.last().map(|&(_, label)| label)
    }
}

const OPENING: &str = "Opening…";
const SAVING: &str = "Saving…";
const LOOKING: &str = "Looking for unsaved work…";

fn label(job: &Job) -> &'static str {
    match job {
        Job::Open(_) | Job::OpenProject { .. } | Job::OpenSample(_) => OPENING,
        Job::Save { .. } | Job::Export { .. } => SAVING,
        Job::FindLeftovers(_) => LOOKING,
        Job::BrowseOpen | Job::BrowsePoses(_) | Job::BrowseSave { .. } => "Waiting for the file dialog…",
    }
}

fn run(job: Job, opening: &Opening, options: OpenOptions, wake: &(dyn Fn() + Send + Sync)) -> JobEvent {
    match job {
        Job::Open(path) if project::is_project(&path) => open_project(path, &MeshChoice::Named, None, opening, wake),
        Job::Open(path) => match opening.read(&path, options, wake) {
            ControlFlow::Continue(model) => opened(model, None),
            ControlFlow::Break(()) => JobEvent::Dismissed,
        },
        Job::OpenProject { path, choice, leftover } => open_project(path, &choice, leftover, opening, wake),
        Job::Save { contents, to } => match project::save(&contents, &to) {
            Ok(warnings) => JobEvent::Saved { contents, to, warnings },
            Err(error) => JobEvent::Failed { what: SAVING, why: error.to_string() },
        },
        Job::FindLeftovers(folder) => JobEvent::Leftovers(leftovers(&folder)),
        Job::OpenSample(sample) => opened(sample.model(), Some(sample)),
        Job::Export { model, snapshot, to } => export(model, snapshot, to),
        Job::BrowseOpen => {
            let both: Vec<&str> = pliant_meshfile::Format::EXTENSIONS.iter().copied().chain([EXTENSION]).collect();
            let dialog = rfd::FileDialog::new().add_filter("Meshes and projects", &both);
            ask(|| dialog.pick_file(), JobEvent::ChosenToOpen)
        }
        Job::BrowsePoses(model) => {
            let dialog = rfd::FileDialog::new().add_filter("Meshes", pliant_meshfile::Format::EXTENSIONS);
            ask(|| dialog.pick_files(), |paths| JobEvent::ChosenPoses(model, paths))
        }
        Job::BrowseSave { name, project } => {
            let dialog = rfd::FileDialog::new().set_file_name(name);
            let dialog = match project {
                true => dialog.add_filter("Projects", &[EXTENSION]),
                false => dialog.add_filter("Meshes", pliant_meshfile::Format::EXTENSIONS),
            };
            ask(|| dialog.save_file(), JobEvent::ChosenToSave)
        }
    }
}

fn ask<T>(dialog: impl FnOnce() -> Option<T>, chosen: impl FnOnce(T) -> JobEvent) -> JobEvent {
    let start = std::time::Instant::now();
    match dialog() {
        Some(path) => chosen(path),
        None if start.elapsed() < INSTANT => JobEvent::NoDialog,
        None => JobEvent::Dismissed,
    }
}

fn open_project(
    path: PathBuf,
    choice: &MeshChoice,
    leftover: Option<Arc<Leftover>>,
    opening: &Opening,
    wake: &(dyn Fn() + Send + Sync),
) -> JobEvent {
    let loaded = match opening.read_project(&path, choice, wake) {
        ControlFlow::Continue(Ok(loaded)) => loaded,
        ControlFlow::Continue(Err(error)) => {
            let why = error.to_string();
            return match error {
                ProjectError::MeshMissing { path: project, mesh }
                | ProjectError::MeshChanged { path: project, mesh } => JobEvent::MeshWanted { project, mesh, why },
                // The one that was chosen is shown again, to be replaced by the right one.
                ProjectError::OtherMesh { mesh, .. } => JobEvent::MeshWanted { project: path, mesh, why },
                _ => JobEvent::Failed { what: OPENING, why },
            };
        }
        ControlFlow::Break(()) => return JobEvent::Dismissed,
    };
    let (model, restored) = Restored::of(loaded, |mesh| match leftover {
        Some(leftover) => Origin::Leftover(leftover),
        None => Origin::Project(ProjectFile::new(path, mesh)),
    });
    let opened = Opened { restored: Some(Box::new(restored)), ..Opened::new(Arc::new(model)) };
    JobEvent::Opened { opened: Box::new(opened), sample: None }
}

fn opened(model: Result<Model, ModelError>, sample: Option<Sample>) -> JobEvent {
    match model {
        Ok(model) => JobEvent::Opened { opened: Box::new(Opened::new(Arc::new(model))), sample },
        Err(error) => JobEvent::Failed { what: OPENING, why: error.to_string() },
    }
}

impl Opened {
    /// Prepares what is needed to show and pick a model at rest.
    pub fn new(model: Arc<Model>) -> Opened {
        let vertex_normals = VertexNormals::new(model.mesh.n_vertices(), &model.triangles);
        let positions: Vec<_> = model.mesh.positions().iter().map(|&p| model.to_view(p)).collect();
        let mut normals = Vec::new();
        vertex_normals.compute(&positions, &model.triangles, &mut normals);
        let surface = Surface::new(&model, Arc::new(SurfaceFrame { positions, normals }));
        Opened { model, surface, normals: vertex_normals, restored: None }
    }
}

fn export(model: Arc<Model>, snapshot: Snapshot, to: PathBuf) -> JobEvent {
    let rigidity = &snapshot.scene.rigidity;
    // A file that never had r gets none as long as r is what it would be anyway.
    let matters = rigidity.max() > 1 || model.file.rigidity.is_some();
    let rigidity = matters.then(|| rigidity.as_slice());
    match model.file.save(&to, &snapshot.pose.positions, rigidity) {
        Ok(warnings) => {
            let warnings = warnings.iter().map(ToString::to_string).collect();
            JobEvent::Exported { model, to, snapshot, warnings }
        }
        Err(error) => JobEvent::Failed { what: SAVING, why: error.to_string() },
    }
}
