//! A mesh on its way from its file to the screen: how far it is, and a way to stop it.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use pliant_meshfile::OpenOptions;

use crate::document::{Model, ModelError};
use crate::project::{self, Loaded, MeshChoice, ProjectError};

/// The window is woken this often for the sake of progress.
const PROGRESS_EVERY: Duration = Duration::from_millis(100);
/// Share of reading the file in the work; the rest is preparing the surface for the solver and the picture (measured on a
/// million vertices).
const READING: f64 = 0.6;

/// What the window and the thread that opens both know. Clones are the same opening.
#[derive(Clone, Default)]
pub(super) struct Opening(Arc<Shared>);

#[derive(Default)]
struct Shared {
    is_stopped: AtomicBool,
    /// Bits of the fraction that is done.
    done: AtomicU64,
}

impl Opening {
    /// Asks it to stop; it does so soon.
    pub(super) fn stop(&self) {
        self.0.is_stopped.store(true, Ordering::Relaxed);
    }

    /// Whether it was asked to stop.
    pub(super) fn is_stopped(&self) -> bool {
        self.0.is_stopped.load(Ordering::Relaxed)
    }

    /// The fraction that is done, from 0 to 1.
    pub(super) fn fraction(&self) -> f64 {
        f64::from_bits(self.0.done.load(Ordering::Relaxed)).clamp(0.0, 1.0)
    }

    /// Reads a model; a break when it was stopped.
    pub(super) fn read(
        &self,
        path: &Path,
        options: OpenOptions,
        wake: &(dyn Fn() + Send + Sync),
    ) -> ControlFlow<(), Result<Model, ModelError>> {
        let file = options.open_with_progress(path, &mut self.progress(wake));
        if self.is_stopped() {
            return ControlFlow::Break(());
        }
        let mut model = file.map_err(ModelError::from).and_then(Model::from_file);
        if let Ok(model) = &mut model {
            model.load_textures();
        }
        ControlFlow::Continue(model)
    }

    /// Reads a project; a break when it was stopped.
    pub(super) fn read_project(
        &self,
        path: &Path,
        choice: &MeshChoice,
        wake: &(dyn Fn() + Send + Sync),
    ) -> ControlFlow<(), Result<Loaded, ProjectError>> {
        let mut loaded = project::open(path, choice, &mut self.progress(wake));
        if let Ok(loaded) = &mut loaded {
            loaded.model.load_textures();
        }
        if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(loaded) }
    }

    /// What follows the reading: notes how far it is, and stops it when asked to.
    fn progress(&self, wake: &(dyn Fn() + Send + Sync)) -> impl FnMut(f64) -> ControlFlow<()> + Send {
        let mut told = Instant::now();
        move |fraction: f64| {
            self.0.done.store((READING * fraction).to_bits(), Ordering::Relaxed);
            if told.elapsed() >= PROGRESS_EVERY {
                told = Instant::now();
                wake();
            }
            if self.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_opening_that_is_stopped_gives_nothing_and_one_that_is_not_tells_how_far_it_is() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("triangle.obj");
        std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("a file");
        let opening = Opening::default();
        let read = opening.read(&path, OpenOptions::default(), &|| {});
        assert!(matches!(read, ControlFlow::Continue(Ok(model)) if model.mesh.n_vertices() == 3));
        assert_eq!(opening.fraction(), READING);
        let other = opening.clone();
        other.stop();
        assert!(opening.read(&path, OpenOptions::default(), &|| {}).is_break());
    }
}
