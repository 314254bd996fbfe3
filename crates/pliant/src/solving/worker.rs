//! The thread that iterates.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::mailbox::{Closed, Mailbox};
use super::{Engine, SolveReport, SolveRequest, SolveState};

/// How long the worker iterates before it shows the surface: half a frame at 60 Hz leaves the rest to the picture.
const REPORT_EVERY: Duration = Duration::from_millis(8);

/// A solver thread. Dropping this tells it to end; it does so after the iteration or factorization under way.
pub struct Worker {
    requests: Arc<Mailbox<SolveRequest>>,
    reports: Arc<Mailbox<SolveReport>>,
}

impl Worker {
    /// Starts the thread. `wake` is called (from that thread) whenever a report is there to be taken.
    pub fn start(wake: impl Fn() + Send + 'static) -> std::io::Result<Worker> {
        let requests = Arc::new(Mailbox::new());
        let reports = Arc::new(Mailbox::new());
        let (inbox, outbox) = (requests.clone(), reports.clone());
        std::thread::Builder::new().name("solver".into()).spawn(move || {
            let send = |report| {
                outbox.put_over(report, keep_pose);
                wake();
            };
            // The only way out is the closed mailbox.
            let Err(Closed) = run(&inbox, send);
        })?;
        Ok(Worker { requests, reports })
    }

    /// States a new wish; an older one that has not been read yet is forgotten.
    pub fn request(&self, request: SolveRequest) {
        self.requests.put(request);
    }

    /// The newest report since the last look.
    pub fn poll(&self) -> Option<SolveReport> {
        self.reports.take().ok().flatten()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.requests.close();
    }
}

enum Never {}

fn run(inbox: &Mailbox<SolveRequest>, send: impl Fn(SolveReport)) -> Result<Never, Closed> {
    let mut engine: Option<Engine> = None;
    let mut newest: Option<SolveRequest> = None;
    loop {
        let is_busy = engine.as_ref().is_some_and(Engine::is_busy);
        let wish = if is_busy { inbox.take()? } else { Some(inbox.wait()?) };
        newest = wish.clone().or(newest);
        let round = catch_unwind(AssertUnwindSafe(|| {
            if let Some(wish) = wish {
                turn_to(&mut engine, wish, &send);
            }
            let Some(engine) = &mut engine else { return };
            let start = Instant::now();
            while engine.is_busy() {
                engine.step();
                if start.elapsed() >= REPORT_EVERY {
                    break;
                }
            }
            send(engine.report());
        }));
        if let Err(panic) = round {
            // Nothing can be said of an engine that was left halfway.
            engine = None;
            if let Some(wish) = &newest {
                send(bare_report(wish, failure(&*panic)));
            }
        }
    }
}

/// A pose that has not been looked at yet goes on with a later report that brings none.
fn keep_pose(old: SolveReport, new: SolveReport) -> SolveReport {
    if new.pose.is_none() && new.epoch == old.epoch && Arc::ptr_eq(&new.model, &old.model) {
        return SolveReport { pose: old.pose, frame: old.frame, ..new };
    }
    new
}

fn turn_to(engine: &mut Option<Engine>, wish: SolveRequest, send: impl Fn(SolveReport)) {
    match engine {
        Some(engine) if engine.serves(&wish) => {
            if engine.must_refactor(&wish) && !wish.groups.is_empty() {
                send(bare_report(&wish, SolveState::Preparing));
            }
            engine.adopt(wish);
        }
        _ => {
            send(bare_report(&wish, SolveState::Preparing));
            *engine = None; // frees the old factor before the new one is made
            *engine = Some(Engine::new(wish));
        }
    }
}

fn bare_report(wish: &SolveRequest, state: SolveState) -> SolveReport {
    SolveReport {
        model: wish.model.clone(),
        revision: wish.revision,
        epoch: wish.epoch,
        state,
        pose: None,
        frame: None,
        energy: 0.0,
        iteration: 0,
        relative_decrease: 0.0,
        iteration_ms: 0.0,
        energies: Arc::new([]),
        vertex_energies: None,
        remarks: Vec::new(),
    }
}

fn failure(panic: &(dyn std::any::Any + Send)) -> SolveState {
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    let what = text.unwrap_or("unknown cause");
    SolveState::Failed(format!("the solver stopped unexpectedly ({what}); the last good pose is kept, undo to go on"))
}
