//! Learning rigidity in the editor: which poses, the work on them, and the result while it is still only looked at.
//! Nothing of it is part of the document until it is applied.

mod result;
mod task;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use pliant_meshfile::poses::PoseOptions;
use pliant_solver::Weights;

pub use result::{Omega, Settings, Shown, Trial};
use task::{Found, Progress, Subject, Task};

use crate::document::Model;
use crate::learning::gather::{Reading, Wish};
use crate::learning::leave_one_out::{Options, Report};
use crate::learning::sources::{Source, n_own_poses};

/// The largest r whose energies are gathered unless asked otherwise: the paper's.
const USUAL_R_MAX: u16 = 6;

/// The state of the panel.
pub struct Learning {
    model: Arc<Model>,
    weights: Weights,
    wake: Arc<dyn Fn() + Send + Sync>,
    /// How many poses the mesh's own file has, at most.
    pub n_own: usize,
    /// Where poses come from.
    sources: Vec<Source>,
    /// How files are read.
    pub options: PoseOptions,
    /// The largest r whose energies are gathered.
    pub r_max: u16,
    stage: Stage,
    /// Why the last attempt came to nothing.
    pub trouble: Option<String>,
    /// Whether files were added after the poses were read.
    pub has_new_files: bool,
    /// Whether it helps to take files with other faces for poses of this mesh.
    pub can_use_faces: bool,
}

enum Stage {
    /// Choosing poses.
    Choosing,
    /// Reading them.
    Gathering(Task),
    /// Some cannot be used: is the rest enough?
    Asking(Box<Trial>),
    /// Looking at the result.
    Looking(Box<Trial>, Check),
}

/// The check of the result by poses left out.
enum Check {
    None,
    Running(Task, Settings),
    Done(Report, Settings),
}

/// What the panel shows.
pub enum View<'a> {
    /// Poses are being chosen.
    Choosing,
    /// They are being read.
    Gathering {
        /// From 0 to 1.
        done: f64,
        /// Once it can be told.
        left: Option<Duration>,
    },
    /// Some cannot be used.
    Asking(&'a Reading),
    /// There is a result.
    Looking {
        /// The result with its sliders.
        trial: &'a mut Trial,
        /// Fraction of a check under way, with the time left.
        checking: Option<(f64, Option<Duration>)>,
        /// What a check said, and whether it was of these settings.
        report: Option<(&'a Report, bool)>,
    },
}

impl Learning {
    pub(super) fn new(model: Arc<Model>, weights: Weights, wake: Arc<dyn Fn() + Send + Sync>) -> Learning {
        let options = PoseOptions::default();
        let n_own = n_own_poses(&model.file, options);
        let sources = if n_own > 0 { vec![Source::Reference] } else { Vec::new() };
        let (stage, trouble) = (Stage::Choosing, None);
        Learning {
            model,
            weights,
            wake,
            n_own,
            sources,
            options,
            r_max: USUAL_R_MAX,
            stage,
            trouble,
            has_new_files: false,
            can_use_faces: false,
        }
    }

    /// Where poses come from.
    pub fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// Whether it is about this surface.
    pub(super) fn is_about(&self, model: &Arc<Model>) -> bool {
        Arc::ptr_eq(&self.model, model)
    }

    /// Adds files that are not in the list yet. What was learned or is under way stays.
    pub fn add_files(&mut self, paths: impl IntoIterator<Item = PathBuf>) {
        for path in paths {
            let source = Source::File(path);
            if !self.sources.contains(&source) {
                self.sources.push(source);
                self.has_new_files = !matches!(self.stage, Stage::Choosing);
            }
        }
    }

    /// Adds the poses of the mesh's own file.
    pub fn add_own(&mut self) {
        if self.n_own > 0 && !self.sources.contains(&Source::Reference) {
            self.sources.insert(0, Source::Reference);
        }
    }

    /// Takes a source off the list.
    pub fn remove(&mut self, place: usize) {
        if place < self.sources.len() {
            self.sources.remove(place);
        }
    }

    /// Back to choosing poses; what is under way stops, and a result is forgotten.
    pub fn choose(&mut self) {
        self.stage = Stage::Choosing;
        self.forget_trouble();
    }

    /// Begins to read the poses, for the energy with these weights.
    pub(super) fn start_with(&mut self, weights: Weights) {
        self.weights = weights;
        self.start();
    }

    fn start(&mut self) {
        self.forget_trouble();
        self.stage = Stage::Gathering(Task::gather(self.subject()));
    }

    fn forget_trouble(&mut self) {
        (self.trouble, self.can_use_faces, self.has_new_files) = (None, false, false);
    }

    fn subject(&self) -> Subject {
        let wish = Wish { sources: self.sources.clone(), options: self.options, range: 1..=self.r_max };
        Subject { model: self.model.clone(), weights: self.weights, wish, wake: self.wake.clone() }
    }

    /// Agrees to learn from the poses that could be used.
    pub fn accept(&mut self) {
        match std::mem::replace(&mut self.stage, Stage::Choosing) {
            Stage::Asking(trial) => self.stage = Stage::Looking(trial, Check::None),
            other => self.stage = other,
        }
    }

    /// Reads again, taking files with other faces but as many vertices for poses of the reference.
    pub fn use_reference_faces(&mut self) {
        self.options.reference_faces = true;
        self.start();
    }

    /// Begins to predict each pose from the others.
    pub fn check(&mut self) {
        let subject = self.subject();
        if let Stage::Looking(trial, check) = &mut self.stage {
            let settings = trial.settings();
            let options = Options {
                range: trial.known_range(),
                chosen: Some(settings.range.clone()),
                smoothing: settings.smoothing,
                omega: trial.omega_given(),
                ..Options::default()
            };
            *check = Check::Running(Task::check(subject, options), settings);
            self.trouble = None;
        }
    }

    /// Stops a check.
    pub fn stop_check(&mut self) {
        if let Stage::Looking(_, check) = &mut self.stage {
            *check = Check::None;
        }
    }

    /// Takes what a task came to.
    pub(super) fn poll(&mut self) {
        let task = match &self.stage {
            Stage::Gathering(task) | Stage::Looking(_, Check::Running(task, _)) => task,
            _ => return,
        };
        match task.poll() {
            Progress::Running => {}
            Progress::Done(found) => self.take(found),
            Progress::Stopped => self.give_up(None),
        }
    }

    fn take(&mut self, found: Found) {
        match (found, &mut self.stage) {
            (Found::Gathered(found), _) => {
                let (gathered, omega) = *found;
                let is_whole = gathered.reading.broken.is_empty();
                let trial = Box::new(Trial::new(self.model.mesh.clone(), gathered, omega));
                self.stage = if is_whole { Stage::Looking(trial, Check::None) } else { Stage::Asking(trial) };
            }
            (Found::Checked(report), Stage::Looking(_, check)) => {
                if let Check::Running(_, settings) = check {
                    *check = Check::Done(report, settings.clone());
                }
            }
            (Found::Failed(why, faces), _) => {
                self.give_up(Some(why));
                self.can_use_faces = faces;
            }
            (Found::Checked(_), _) => {}
        }
    }

    /// The task is gone; what was there before it stays.
    fn give_up(&mut self, why: Option<String>) {
        self.trouble = why;
        match &mut self.stage {
            Stage::Looking(_, check) => *check = Check::None,
            stage => *stage = Stage::Choosing,
        }
    }

    /// What to show.
    pub fn view(&mut self) -> View<'_> {
        match &mut self.stage {
            Stage::Choosing => View::Choosing,
            Stage::Gathering(task) => View::Gathering { done: task.fraction(), left: task.left() },
            Stage::Asking(trial) => View::Asking(trial.reading()),
            Stage::Looking(trial, check) => {
                let (mut checking, mut report) = (None, None);
                match check {
                    Check::None => {}
                    Check::Running(task, _) => checking = Some((task.fraction(), task.left())),
                    Check::Done(done, settings) => report = Some((&*done, *settings == trial.settings())),
                }
                View::Looking { trial, checking, report }
            }
        }
    }

    /// Shows the document's r instead of a result: somebody paints.
    pub(super) fn look_away(&mut self) {
        if let Stage::Looking(trial, _) = &mut self.stage {
            trial.shown = Shown::Now;
        }
    }

    /// The result, if there is one to look at.
    pub fn trial(&self) -> Option<&Trial> {
        match &self.stage {
            Stage::Looking(trial, _) => Some(trial),
            _ => None,
        }
    }
}
