//! Kept poses on their way into files, in the background.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use super::Session;
use crate::editor::NoticeKind;
use crate::posing::{Canceled, Export, Plan, export};
use crate::solving::SolveRequest;
use crate::viewport::ViewScene;

type Outcome = Result<Result<Vec<String>, Canceled>, String>;

/// An export under way. Dropped, it stops and leaves nothing.
pub(super) struct Exporting {
    plan: Plan,
    n_poses: usize,
    /// Bits of the fraction that is done.
    done: Arc<AtomicU64>,
    is_over: Arc<AtomicBool>,
    outcome: Receiver<Outcome>,
}

impl Drop for Exporting {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
    }
}

/// How long a window that closes waits for an export to clear away what it wrote: longer than any iteration of a mesh
/// that is edited at all. What stays is cleared away by the next export to the same place.
const CLEARING: Duration = Duration::from_secs(5);

impl Session {
    /// Stops an export that is under way and lets it clear away what it wrote.
    pub(super) fn end_exporting(&mut self) {
        if let Some(exporting) = self.exporting.take() {
            exporting.is_over.store(true, Ordering::Relaxed);
            // It answers when it is over.
            let _ = exporting.outcome.recv_timeout(CLEARING);
        }
    }

    /// How far the export of the poses is, from 0 to 1, while there is one.
    pub fn exporting_poses(&self) -> Option<f64> {
        self.exporting.as_ref().map(|exporting| f64::from_bits(exporting.done.load(Ordering::Relaxed)))
    }

    /// Stops it: no file is written.
    pub fn cancel_exporting_poses(&mut self) {
        if self.exporting.take().is_some() {
            self.notices.push(NoticeKind::Done, "The export was canceled: nothing was written");
        }
    }

    /// Writes the kept poses in the background; `look` is what pictures are drawn like.
    pub fn export_poses(&mut self, plan: Plan, look: Option<ViewScene>) {
        let Some(document) = self.open.as_ref().map(|open| &open.document) else { return };
        let work = Export {
            plan: plan.clone(),
            poses: document.scene().poses.clone(),
            template: SolveRequest::of(document, None),
            ground: self.status.report.as_ref().and_then(|report| report.ground.upgrade()),
            look,
        };
        let (sender, outcome) = channel();
        let (done, is_over) = (Arc::new(AtomicU64::new(0)), Arc::new(AtomicBool::new(false)));
        let n_poses = work.poses.len();
        self.exporting = Some(Exporting { plan, n_poses, done: done.clone(), is_over: is_over.clone(), outcome });
        let wake = self.wake.clone();
        let run = move || {
            let progress = |fraction: f64| {
                // A window that draws for every iteration would have no time for anything else.
                let percent = |bits: u64| (f64::from_bits(bits) * 100.0) as u32;
                let before = done.swap(fraction.to_bits(), Ordering::Relaxed);
                if percent(before) != percent(fraction.to_bits()) {
                    wake();
                }
                !is_over.load(Ordering::Relaxed)
            };
            let outcome = catch_unwind(AssertUnwindSafe(|| export(&work, &progress)));
            // Nobody listens any more once it was canceled or the window is closed.
            let _ = sender.send(outcome.unwrap_or_else(|_| Err("it stopped unexpectedly; please report it".into())));
            wake();
        };
        if let Err(error) = std::thread::Builder::new().name("export".into()).spawn(run) {
            self.exporting = None;
            self.notices.push(NoticeKind::Error, format!("No thread to export with could be started: {error}"));
        }
    }

    /// Says what an export came to.
    pub(super) fn poll_exporting(&mut self) {
        let Some(outcome) = self.exporting.as_ref().and_then(|exporting| exporting.outcome.try_recv().ok()) else {
            return;
        };
        let Some(exporting) = self.exporting.take() else { return };
        match outcome {
            Ok(Ok(warnings)) => {
                let files = exporting.plan.files(exporting.n_poses);
                let text = match &files[..] {
                    [first, .., last] => {
                        format!("Saved {} files, {} to {}", files.len(), first.display(), last.display())
                    }
                    _ => format!("Saved {}", exporting.plan.to.display()),
                };
                self.notices.push(NoticeKind::Done, text);
                for warning in warnings {
                    self.notices.push(NoticeKind::Warning, warning);
                }
            }
            Ok(Err(Canceled)) => {}
            Err(why) => self.notices.push(NoticeKind::Error, format!("The poses were not exported: {why}")),
        }
    }
}
