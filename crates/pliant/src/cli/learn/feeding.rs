//! Poses into the learner: while the energies of one are computed, the next is read.

use std::path::Path;
use std::time::Instant;

use pliant_meshfile::poses::{PoseError, PoseFault};
use pliant_solver::PoseLearner;

use crate::cli::args::LearnOptions;
use crate::cli::console::Console;
use crate::cli::failure::Failure;
use crate::cli::solve::milliseconds;
use crate::learning::sources::Sources;

/// Broken poses named one by one; the others are only counted.
const BROKEN_NAMED: usize = 20;

/// Takes poses for the learner, and keeps account.
pub(super) struct Feeding<'a> {
    learner: &'a mut PoseLearner,
    /// Of the reference.
    path: &'a Path,
    skip_broken: bool,
    /// Whether the poses are those of the reference's own file.
    is_own: bool,
    /// Time spent on energies.
    pub(super) energies_ms: f64,
    warnings: Vec<String>,
    n_broken: usize,
    first_broken: Option<PoseError>,
    begun: Instant,
}

impl<'a> Feeding<'a> {
    pub(super) fn new(learner: &'a mut PoseLearner, options: &'a LearnOptions) -> Self {
        let (begun, path, skip_broken) = (Instant::now(), options.reference.as_path(), options.skip_broken);
        let is_own = options.poses.is_empty();
        Feeding {
            learner,
            path,
            skip_broken,
            is_own,
            energies_ms: 0.0,
            warnings: Vec::new(),
            n_broken: 0,
            first_broken: None,
            begun,
        }
    }

    /// Gives every pose to the learner.
    pub(super) fn feed(&mut self, sources: &mut Sources<'_>, console: &mut Console<'_>) -> Result<(), Failure> {
        let mut found = sources.next();
        while let Some(item) = found {
            found = match item {
                Ok(None) => sources.next(),
                Ok(Some(pose)) => {
                    console.progress(|| self.progress(&pose.name, sources.n_left()));
                    let (learner, clock) = (&mut *self.learner, Instant::now());
                    let add = || (learner.add(&pose.points), milliseconds(clock));
                    let ((added, ms), next) = rayon::join(add, || sources.next());
                    self.energies_ms += ms;
                    added.map_err(|source| Failure::Learn { path: self.path.to_owned(), source })?;
                    next
                }
                Err(error) => {
                    self.broken(error)?;
                    sources.next()
                }
            };
        }
        Ok(())
    }

    /// What was passed over.
    pub(super) fn warnings(&mut self) -> Vec<String> {
        if self.n_broken > BROKEN_NAMED {
            self.warnings.push(format!("{} more poses were skipped", self.n_broken - BROKEN_NAMED));
        }
        std::mem::take(&mut self.warnings)
    }

    /// How many poses the learner has.
    pub(super) fn n_poses(&self) -> usize {
        self.learner.n_poses()
    }

    /// Why there is no pose at all.
    pub(super) fn no_poses(self) -> Failure {
        let (path, count) = (self.path.to_owned(), self.n_broken);
        match self.first_broken {
            Some(first) => Failure::AllSkipped { path, count, first: Box::new(first) },
            None => Failure::NoPoses { path },
        }
    }

    /// A pose that cannot be used ends the command, or is said and passed over.
    fn broken(&mut self, error: PoseError) -> Result<(), Failure> {
        if !self.skip_broken || matches!(error, PoseError::File { fault: PoseFault::Nothing, .. }) {
            return Err(Failure::Pose { error, is_own: self.is_own });
        }
        self.n_broken += 1;
        if self.n_broken <= BROKEN_NAMED {
            self.warnings.push(format!("skipped: {error}"));
        }
        self.first_broken.get_or_insert(error);
        Ok(())
    }

    fn progress(&self, name: &str, n_left: usize) -> String {
        let n_done = self.learner.n_poses();
        let done = format!("pose {} of {}: {name}", n_done + 1, n_done + 1 + n_left);
        if n_done == 0 {
            return done;
        }
        let seconds = self.begun.elapsed().as_secs_f64() / n_done as f64 * (n_left + 1) as f64;
        format!("{done}, {} s left", seconds.ceil())
    }
}
