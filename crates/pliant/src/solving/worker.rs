//! The thread that iterates.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::mailbox::{Closed, Mailbox};
use super::pace::{Next, Pace};
use super::{Engine, SolveReport, SolveRequest, SolveState};

/// Progress is told this often: a number that changes faster cannot be read (by eye).
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// Handles that have not moved for so long rest, and iterations go on from a preview: longer than between two moves of a
/// slow hand, shorter than what is felt as a wait (by eye).
const PATIENCE: Duration = Duration::from_millis(100);

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
            let send = move |report| {
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

fn run(inbox: &Mailbox<SolveRequest>, mut send: impl FnMut(SolveReport) + Send) -> Result<Never, Closed> {
    let mut engine: Option<Engine> = None;
    let mut newest: Option<SolveRequest> = None;
    let mut pace = Pace::default();
    loop {
        let is_busy = engine.as_ref().is_some_and(Engine::is_busy);
        let is_previewing = engine.as_ref().is_some_and(Engine::is_previewing);
        let wish = match is_busy {
            _ if is_previewing => inbox.wait_for(PATIENCE)?,
            true => inbox.take()?,
            false => Some(inbox.wait()?),
        };
        let is_resting = wish.is_none();
        newest = wish.clone().or(newest);
        let round = catch_unwind(AssertUnwindSafe(|| {
            if let Some(wish) = wish {
                let begun = Instant::now();
                if turn_to(&mut engine, wish, inbox, &mut send).is_break() {
                    return;
                }
                pace.turned(begun.elapsed());
            }
            let Some(engine) = &mut engine else { return };
            if is_previewing && is_resting {
                engine.leave_preview();
            }
            if engine.is_busy() && !engine.is_previewing() {
                let took = if engine.is_shown_halfway() {
                    engine.step_shown_halfway(|report| {
                        send(report);
                        pace.reported(Duration::ZERO);
                    })
                } else {
                    let about = newest.as_ref();
                    let previews = engine.can_preview();
                    let other =
                        |newer: &SolveRequest| previews || about.is_none_or(|about| newer.is_other_system(about));
                    // What an iteration on the way would find is of no use to a newer wish for another system.
                    let Some(took) = engine.step(&mut || !inbox.has(other)) else { return };
                    took
                };
                if pace.stepped(took) == Next::GoOn && engine.is_busy() {
                    return;
                }
            }
            let begun = Instant::now();
            send(engine.report());
            pace.reported(begun.elapsed());
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

/// Breaks if a newer wish made it needless.
fn turn_to(
    engine: &mut Option<Engine>,
    wish: SolveRequest,
    inbox: &Mailbox<SolveRequest>,
    send: &mut (impl FnMut(SolveReport) + Send),
) -> ControlFlow<()> {
    let known = engine.take().filter(|engine| engine.serves(&wish)); // another one is freed before a new one is made
    if known.as_ref().is_none_or(|known| known.takes_long(&wish)) {
        send(bare_report(&wish, SolveState::Preparing { progress: 0.0 }));
    }
    let engine = engine.insert(known.unwrap_or_else(|| Engine::new(&wish)));
    let mut told = Instant::now();
    let about = wish.clone();
    engine.adopt(wish, &mut |progress| {
        if inbox.has(|newer| newer.is_other_search(&about)) {
            return ControlFlow::Break(());
        }
        if told.elapsed() >= PROGRESS_EVERY {
            told = Instant::now();
            send(bare_report(&about, SolveState::Preparing { progress }));
        }
        ControlFlow::Continue(())
    })
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
        measured: None,
        vertex_energies: None,
        remarks: Vec::new(),
        ground: std::sync::Weak::new(),
    }
}

fn failure(panic: &(dyn std::any::Any + Send)) -> SolveState {
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    let what = text.unwrap_or("unknown cause");
    SolveState::Failed(format!("the solver stopped unexpectedly ({what}); the last good pose is kept, undo to go on"))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use pliant_solver::VertexId;

    use super::*;
    use crate::document::{Command, Document, GroupKind};
    use crate::test_scenes::flat_sheet;

    /// A flat sheet of `n` by `n` cells, held at a corner.
    fn sheet(n: u32) -> Document {
        let mut document = flat_sheet(n + 1);
        hold(&mut document, 0);
        document
    }

    fn hold(document: &mut Document, v: u32) {
        let command = Command::Hold { kind: GroupKind::Handle, vertices: vec![VertexId(v)] };
        document.apply(command).expect("the vertex exists");
    }

    fn wish(document: &Document) -> SolveRequest {
        SolveRequest::of(document, None)
    }

    /// Turns to a wish as the worker does. Returns whether a newer one made it needless, and the states that were told.
    fn turn(
        engine: &mut Option<Engine>,
        to: SolveRequest,
        inbox: &Mailbox<SolveRequest>,
    ) -> (ControlFlow<()>, Vec<SolveState>) {
        let mut told = Vec::new();
        let outcome = turn_to(engine, to, inbox, &mut |report: SolveReport| told.push(report.state));
        (outcome, told)
    }

    #[test]
    fn a_newer_wish_for_other_sizes_stops_the_search_for_the_older() {
        let mut document = sheet(30);
        let inbox = Mailbox::new();
        let mut engine = None;
        document.apply(Command::FillAll(3)).expect("a good size");
        let older = wish(&document);
        document.apply(Command::FillAll(2)).expect("a good size");
        inbox.put(wish(&document));
        assert!(turn(&mut engine, older, &inbox).0.is_break(), "the older search ran to its end");
        let newer = inbox.take().expect("open").expect("still there to be taken");
        assert!(turn(&mut engine, newer, &inbox).0.is_continue());
        let report = engine.as_mut().expect("kept").report();
        assert_eq!((report.revision, report.state), (document.revision(), SolveState::Settled));
    }

    #[test]
    fn a_newer_wish_for_other_handles_leaves_the_search_alone() {
        let mut document = sheet(30);
        let inbox = Mailbox::new();
        document.apply(Command::FillAll(3)).expect("a good size");
        let older = wish(&document);
        hold(&mut document, 40);
        inbox.put(wish(&document));
        assert!(turn(&mut None, older, &inbox).0.is_continue());
    }

    #[test]
    fn an_iteration_gives_way_to_other_handles_and_sizes_but_not_to_other_targets() {
        let mut document = sheet(5);
        hold(&mut document, 20);
        let group = document.scene().groups[1].id;
        let older = wish(&document);
        let motion = glam::DAffine3::from_translation(DVec3::Z);
        document.apply(Command::Move { group, motion }).expect("finite");
        assert!(!wish(&document).is_other_system(&older), "a drag");
        let dragged = wish(&document);
        document.apply(Command::Paint { values: vec![(VertexId(3), 2)] }).expect("a good size");
        assert!(wish(&document).is_other_system(&dragged), "a dab");
        let painted = wish(&document);
        hold(&mut document, 10);
        assert!(wish(&document).is_other_system(&painted), "a handle");
    }

    #[test]
    fn the_first_iteration_after_a_change_is_taken_in_any_case_and_later_ones_give_way_without_a_trace() {
        let mut document = sheet(30);
        hold(&mut document, 960);
        let group = document.scene().groups[1].id;
        let motion = glam::DAffine3::from_translation(DVec3::Z);
        document.apply(Command::Move { group, motion }).expect("finite");
        let mut engine = None;
        assert!(turn(&mut engine, wish(&document), &Mailbox::new()).0.is_continue());
        let engine = engine.as_mut().expect("new");
        assert!(engine.step(&mut || false).is_some(), "the first");
        for parts_done in 0..3 {
            let (mut before, mut asked) = (engine.positions(), 0);
            let gave_way = engine.step(&mut || {
                asked += 1;
                asked <= parts_done
            });
            assert_eq!(gave_way.is_none(), parts_done < 2, "after {parts_done} parts");
            if gave_way.is_some() {
                before = engine.positions();
            }
            assert_eq!(engine.positions(), before, "after {parts_done} parts");
        }
    }

    #[test]
    fn a_worker_that_is_dropped_gives_up_its_search() {
        let mut document = sheet(30);
        let inbox = Mailbox::new();
        document.apply(Command::FillAll(3)).expect("a good size");
        inbox.close();
        assert!(turn(&mut None, wish(&document), &inbox).0.is_break());
    }

    #[test]
    fn preparing_is_told_for_a_new_mesh_and_for_sizes_everywhere_but_not_for_a_dab_or_a_handle() {
        let preparing = SolveState::Preparing { progress: 0.0 };
        let mut document = sheet(150); // 22,801 vertices
        let inbox = Mailbox::new();
        let mut engine = None;
        assert_eq!(turn(&mut engine, wish(&document), &inbox).1.first(), Some(&preparing));
        hold(&mut document, 40);
        assert_eq!(turn(&mut engine, wish(&document), &inbox).1, []);
        let values = (0..500).map(|v| (VertexId(v), 6)).collect();
        document.apply(Command::Paint { values }).expect("good sizes");
        assert_eq!(turn(&mut engine, wish(&document), &inbox).1, []);
        document.apply(Command::FillAll(6)).expect("a good size");
        assert_eq!(turn(&mut engine, wish(&document), &inbox).1.first(), Some(&preparing));
    }

    #[test]
    fn progress_is_told_in_ascending_order_and_ends_with_a_surface() {
        let mut document = sheet(30);
        document.apply(Command::FillAll(4)).expect("a good size");
        let mut told = Vec::new();
        let mut engine = Engine::new(&wish(&document));
        let outcome = engine.adopt(wish(&document), &mut |progress| {
            told.push(progress);
            ControlFlow::Continue(())
        });
        assert!(told.is_sorted() && told.last() == Some(&1.0), "{told:?}");
        assert!(outcome.is_continue() && engine.report().state == SolveState::Settled);
    }

    #[test]
    fn a_new_handle_that_leaps_at_once_begins_anew_instead_of_folding_the_surface() {
        // Another handle and its motion in one wish, as when something else kept the solver busy.
        let lowest = |leap: bool| {
            let mut document = sheet(12);
            let mut engine = None;
            assert!(turn(&mut engine, wish(&document), &Mailbox::new()).0.is_continue());
            hold(&mut document, 168);
            let group = document.scene().groups[1].id;
            if !leap {
                assert!(turn(&mut engine, wish(&document), &Mailbox::new()).0.is_continue());
            }
            // Half a turn about the corner that is held: with one handle and one anchor, no strain at all.
            let motion = glam::DAffine3::from_rotation_z(std::f64::consts::PI);
            document.apply(Command::Move { group, motion }).expect("finite");
            assert!(turn(&mut engine, wish(&document), &Mailbox::new()).0.is_continue());
            let engine = engine.as_mut().expect("new");
            engine.step(&mut || true);
            engine.report().energy
        };
        assert_eq!((lowest(true), lowest(false)), (0.0, 0.0));
    }

    #[test]
    fn sizes_everywhere_do_not_move_a_bent_surface() {
        let mut document = sheet(200); // 40,401 vertices: a new solver for r = 3
        hold(&mut document, 40_400);
        let group = document.scene().groups[1].id;
        let motion = glam::DAffine3::from_translation(DVec3::Z);
        document.apply(Command::Move { group, motion }).expect("finite");
        let inbox = Mailbox::new();
        let mut engine = None;
        assert!(turn(&mut engine, wish(&document), &inbox).0.is_continue());
        engine.as_mut().expect("new").step(&mut || true);
        let before = engine.as_mut().expect("new").report();
        document.apply(Command::FillAll(3)).expect("a good size");
        assert!(turn(&mut engine, wish(&document), &inbox).0.is_continue());
        let engine = engine.expect("kept");
        assert!(engine.is_busy(), "other sizes are another energy");
        assert_eq!(engine.positions(), before.pose.map(|pose| pose.positions.to_vec()));
    }
}
