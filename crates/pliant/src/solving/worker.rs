//! The thread that iterates.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::mailbox::{Closed, Mailbox};
use super::{Engine, SolveReport, SolveRequest, SolveState};

/// How long the worker iterates before it shows the surface: half a frame at 60 Hz leaves the rest to the picture.
const REPORT_EVERY: Duration = Duration::from_millis(8);

/// A solver thread. Dropping it stops the thread after the iteration under way.
pub struct Worker {
    requests: Arc<Mailbox<SolveRequest>>,
    reports: Arc<Mailbox<SolveReport>>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread. `wake` is called (from that thread) whenever a report is there to be taken.
    pub fn start(wake: impl Fn() + Send + 'static) -> std::io::Result<Worker> {
        let requests = Arc::new(Mailbox::new());
        let reports = Arc::new(Mailbox::new());
        let (inbox, outbox) = (requests.clone(), reports.clone());
        let thread = std::thread::Builder::new().name("solver".into()).spawn(move || {
            let send = |report| {
                outbox.put(report);
                wake();
            };
            // The only way out is the closed mailbox.
            let Err(Closed) = run(&inbox, send);
        })?;
        Ok(Worker { requests, reports, thread: Some(thread) })
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
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            log::error!("the solver thread ended by a panic");
        }
    }
}

enum Never {}

fn run(inbox: &Mailbox<SolveRequest>, send: impl Fn(SolveReport)) -> Result<Never, Closed> {
    let mut engine: Option<Engine> = None;
    loop {
        let is_busy = engine.as_ref().is_some_and(Engine::is_busy);
        let wish = if is_busy { inbox.take()? } else { Some(inbox.wait()?) };
        // A failed wish keeps its epoch and revision, so that the window can say what it belongs to.
        let about = wish.clone();
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
            let last = engine.take().map(|engine| engine.report());
            if let Some(report) = about.map(|wish| bare_report(&wish, failure(&*panic))).or(last) {
                send(SolveReport { state: failure(&*panic), pose: None, frame: None, ..report });
            }
        }
    }
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
