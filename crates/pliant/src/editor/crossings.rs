//! Faces that pass through others, looked for while the surface rests.
//!
//! A search takes seconds on a large mesh and helps nobody once the surface has moved on, so it begins when the solver has
//! settled, runs on a thread of its own, and is stopped as soon as anything moves.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use glam::DVec3;
use pliant_geometry::crossings_of_all;

use crate::document::{Model, Pose};

/// What is known of the faces that cross others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Crossings {
    /// Nobody asked.
    Off,
    /// The surface moves; a search begins when it rests.
    Waiting,
    /// A search is under way.
    Searching,
    /// So many faces of the pose on screen cross others, in so many pairs.
    Found {
        /// Faces that cross at least one other.
        n_faces: usize,
        /// Pairs of faces that cross.
        n_pairs: usize,
    },
}

/// When to look.
pub(super) enum Wanted<'a> {
    /// Never.
    Nothing,
    /// When the surface rests.
    Later,
    /// Now, in this pose of this surface.
    Now(&'a Arc<Model>, &'a Pose),
}

/// Looks for crossings, and keeps what was found last.
pub(super) struct Search {
    wake: Arc<dyn Fn() + Send + Sync>,
    running: Option<Running>,
    found: Option<Found>,
    is_wanted: bool,
}

struct Running {
    positions: Arc<[DVec3]>,
    stop: Arc<AtomicBool>,
    answer: Receiver<Option<Vec<[u32; 2]>>>,
}

struct Found {
    positions: Arc<[DVec3]>,
    faces: Arc<[[u32; 3]]>,
    n_pairs: usize,
}

impl Search {
    /// Looks for nothing yet. `wake` is called when a search is over.
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Search {
        Search { wake, running: None, found: None, is_wanted: false }
    }

    /// Begins, goes on, stops or takes the answer, as is wanted now. An error when a search could not be made.
    pub(super) fn update(&mut self, wanted: Wanted<'_>) -> Result<(), String> {
        self.is_wanted = !matches!(wanted, Wanted::Nothing);
        let Wanted::Now(model, pose) = wanted else {
            self.stop();
            if !self.is_wanted {
                self.found = None;
            }
            return Ok(());
        };
        if self.running.as_ref().is_some_and(|running| !Arc::ptr_eq(&running.positions, &pose.positions)) {
            self.stop();
        }
        let taken = self.take(model);
        let is_known = self.found.as_ref().is_some_and(|found| Arc::ptr_eq(&found.positions, &pose.positions));
        if self.running.is_none() && !is_known && taken.is_ok() {
            return self.start(model, pose);
        }
        taken
    }

    /// What is known of this pose.
    pub(super) fn state(&self, pose: &Pose) -> Crossings {
        match (&self.found, &self.running) {
            _ if !self.is_wanted => Crossings::Off,
            (Some(found), _) if Arc::ptr_eq(&found.positions, &pose.positions) => {
                Crossings::Found { n_faces: found.faces.len(), n_pairs: found.n_pairs }
            }
            (_, Some(_)) => Crossings::Searching,
            (_, None) => Crossings::Waiting,
        }
    }

    /// The faces that cross others in this pose, by their vertices.
    pub(super) fn faces(&self, pose: &Pose) -> Option<Arc<[[u32; 3]]>> {
        let found = self.found.as_ref().filter(|found| Arc::ptr_eq(&found.positions, &pose.positions))?;
        Some(found.faces.clone())
    }

    fn stop(&mut self) {
        if let Some(running) = self.running.take() {
            running.stop.store(true, Ordering::Relaxed);
        }
    }

    fn start(&mut self, model: &Arc<Model>, pose: &Pose) -> Result<(), String> {
        let stop = Arc::new(AtomicBool::new(false));
        let (sender, answer) = channel();
        let (model, positions, wake) = (model.clone(), pose.positions.clone(), self.wake.clone());
        let (stopped, positions_too) = (stop.clone(), positions.clone());
        let work = move || {
            let go_on = || !stopped.load(Ordering::Relaxed);
            let search = || crossings_of_all(&positions, &model.triangles, &go_on);
            // Nobody listens any more once the search was stopped. Without an answer it has failed.
            if let Ok(found) = catch_unwind(AssertUnwindSafe(search)) {
                let _ = sender.send(found);
            }
            drop(sender);
            wake();
        };
        let thread = std::thread::Builder::new().name("self-intersections".into()).spawn(work);
        thread.map_err(|error| format!("Self-intersections cannot be looked for: {error}"))?;
        self.running = Some(Running { positions: positions_too, stop, answer });
        Ok(())
    }

    /// Takes the answer of the running search, if it is there.
    fn take(&mut self, model: &Model) -> Result<(), String> {
        let Some(running) = &self.running else { return Ok(()) };
        match running.answer.try_recv() {
            Err(TryRecvError::Empty) => Ok(()),
            Ok(pairs) => {
                let positions = running.positions.clone();
                self.running = None;
                self.found = pairs.map(|pairs| Found { positions, faces: faces(model, &pairs), n_pairs: pairs.len() });
                Ok(())
            }
            Err(TryRecvError::Disconnected) => {
                // The same search would fail again: as if nothing had been found in this pose.
                let positions = running.positions.clone();
                self.running = None;
                self.found = Some(Found { positions, faces: Arc::new([]), n_pairs: 0 });
                Err("Looking for self-intersections stopped unexpectedly; please report it".into())
            }
        }
    }
}

impl Drop for Search {
    fn drop(&mut self) {
        self.stop();
    }
}

/// The triangles of these pairs, each once.
fn faces(model: &Model, pairs: &[[u32; 2]]) -> Arc<[[u32; 3]]> {
    let mut faces: Vec<u32> = pairs.as_flattened().to_vec();
    faces.sort_unstable();
    faces.dedup();
    faces.iter().map(|&face| model.triangles[face as usize]).collect()
}
