//! Learning and its check on threads of their own, with progress and a way to stop.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};
use std::time::{Duration, Instant};

use pliant_solver::{Analysis, Weights};

use crate::document::Model;
use crate::learning::Progress as Watch;
use crate::learning::gather::{GatherError, Gathered, Wish, collect, gather};
use crate::learning::leave_one_out::{Options, Report, leave_one_out};

/// The window is woken this often for the sake of progress.
const PROGRESS_EVERY: Duration = Duration::from_millis(100);
/// Before this much is known, an estimate of the time left would only jump about.
const TELLING_FRACTION: f64 = 0.02;

/// What a task found.
pub(super) enum Found {
    /// Energies, and an ω for them.
    Gathered(Box<(Gathered, f64)>),
    /// How well poses were predicted.
    Checked(Report),
    /// Nothing: why, and what to do; and whether the reference's faces would help.
    Failed(String, bool),
}

/// Whether a task is still at it.
pub(super) enum Progress {
    /// Yes.
    Running,
    /// It has found something.
    Done(Found),
    /// It was stopped.
    Stopped,
}

#[derive(Default)]
struct Shared {
    is_stopped: AtomicBool,
    /// Bits of the fraction that is done.
    done: AtomicU64,
}

/// Work on a thread of its own. Dropping it stops the work soon.
pub(super) struct Task {
    shared: Arc<Shared>,
    receiver: Receiver<ControlFlow<(), Found>>,
    begun: Instant,
}

/// What every task needs.
#[derive(Clone)]
pub(super) struct Subject {
    pub(super) model: Arc<Model>,
    pub(super) weights: Weights,
    pub(super) wish: Wish,
    pub(super) wake: Arc<dyn Fn() + Send + Sync>,
}

impl Task {
    /// Gathers the energies of all poses.
    pub(super) fn gather(subject: Subject) -> Task {
        Task::start(subject, |Subject { model, weights, wish, .. }, watch| {
            let analysis = Arc::new(Analysis::new(model.mesh.clone(), *weights));
            match gather(&model.file, &analysis, wish, watch) {
                Ok(ControlFlow::Continue(gathered)) => {
                    let omega = gathered.table.auto_omega();
                    ControlFlow::Continue(Found::Gathered(Box::new((gathered, omega))))
                }
                Ok(ControlFlow::Break(())) => ControlFlow::Break(()),
                Err(error) => {
                    let faces = matches!(&error, GatherError::NoPoses(reading) if reading.only_faces_differ);
                    ControlFlow::Continue(Found::Failed(error.to_string(), faces))
                }
            }
        })
    }

    /// Predicts each pose from the others.
    pub(super) fn check(subject: Subject, options: Options) -> Task {
        Task::start(subject, move |Subject { model, weights, wish, .. }, watch| {
            let poses = match collect(&model.file, wish, watch) {
                Ok(poses) => poses?,
                Err(error) => return ControlFlow::Continue(Found::Failed(error.to_string(), false)),
            };
            let analysis = Arc::new(Analysis::new(model.mesh.clone(), *weights));
            match leave_one_out(&analysis, &poses, &options, watch) {
                Ok(ControlFlow::Continue(report)) => ControlFlow::Continue(Found::Checked(report)),
                Ok(ControlFlow::Break(())) => ControlFlow::Break(()),
                Err(error) => ControlFlow::Continue(Found::Failed(error.to_string(), false)),
            }
        })
    }

    fn start(
        subject: Subject,
        work: impl FnOnce(&Subject, &mut Watch<'_>) -> ControlFlow<(), Found> + Send + 'static,
    ) -> Task {
        let shared = Arc::new(Shared::default());
        let (sender, receiver) = sync_channel(1);
        let (shared_there, sender_there) = (shared.clone(), sender.clone());
        let run = move || {
            let mut told = Instant::now();
            let mut watch = |done: f64| {
                shared_there.done.store(done.to_bits(), Ordering::Relaxed);
                if told.elapsed() >= PROGRESS_EVERY {
                    told = Instant::now();
                    (subject.wake)();
                }
                if shared_there.is_stopped.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| work(&subject, &mut watch)));
            let found = found.unwrap_or_else(|_| {
                ControlFlow::Continue(Found::Failed("learning stopped unexpectedly; please report it".into(), false))
            });
            // Nobody listens any more once the panel is closed.
            let _ = sender_there.send(found);
            (subject.wake)();
        };
        if let Err(error) = std::thread::Builder::new().name("learning".into()).spawn(run) {
            let _ = sender
                .send(ControlFlow::Continue(Found::Failed(format!("no thread could be started: {error}"), false)));
        }
        Task { shared, receiver, begun: Instant::now() }
    }

    /// Asks it to stop; it does so soon.
    pub(super) fn stop(&self) {
        self.shared.is_stopped.store(true, Ordering::Relaxed);
    }

    /// What it came to, if it has.
    pub(super) fn poll(&self) -> Progress {
        match self.receiver.try_recv() {
            Ok(ControlFlow::Continue(found)) => Progress::Done(found),
            Ok(ControlFlow::Break(())) | Err(TryRecvError::Disconnected) => Progress::Stopped,
            Err(TryRecvError::Empty) => Progress::Running,
        }
    }

    /// The fraction that is done, from 0 to 1.
    pub(super) fn fraction(&self) -> f64 {
        f64::from_bits(self.shared.done.load(Ordering::Relaxed)).clamp(0.0, 1.0)
    }

    /// Time left, once it can be told.
    pub(super) fn left(&self) -> Option<Duration> {
        let done = self.fraction();
        (done >= TELLING_FRACTION).then(|| self.begun.elapsed().mul_f64((1.0 - done) / done))
    }
}

impl Drop for Task {
    fn drop(&mut self) {
        self.stop();
    }
}
