//! A pane as the thread works on it: its engine, its newest wish, and how far it is.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::measures::{Measures, Yardstick};
use super::pane::News;
use crate::document::{Pose, held_by};
use crate::solving::{Engine, Groundwork, Measured, SolveRequest, SolveState};
use crate::viewport::SurfaceFrame;

/// A lane works so long before the next has its turn: two frames of the screen, as between surfaces in the viewport.
const TURN: Duration = Duration::from_millis(33);

/// Is asked whether a newer wish for this lane makes work on the way needless.
pub(super) type IsOverruled<'a> = dyn Fn(&SolveRequest) -> bool + Send + Sync + 'a;

pub(super) struct Lane {
    wish: SolveRequest,
    engine: Option<Engine>,
    /// The wish has not been turned to yet.
    is_new: bool,
    state: SolveState,
    pose: Option<Pose>,
    energy: f64,
    iterations: u64,
    spent: Duration,
    measured: Option<Measured>,
    measures: Option<Measures>,
}

impl Lane {
    pub(super) fn new(wish: SolveRequest) -> Lane {
        Lane {
            wish,
            engine: None,
            is_new: true,
            state: SolveState::Preparing { progress: 0.0 },
            pose: None,
            energy: 0.0,
            iterations: 0,
            spent: Duration::ZERO,
            measured: None,
            measures: None,
        }
    }

    /// Takes over a newer wish for the same surface.
    pub(super) fn wish(&mut self, wish: SolveRequest) {
        if wish.epoch != self.wish.epoch {
            // Anew from rest, with the search for a good beginning.
            (self.engine, self.pose) = (None, None);
        }
        // The document may have changed in what this pane does not look at: its method, for one.
        let is_same = !wish.is_other_system(&self.wish)
            && wish.loose == self.wish.loose
            && held_by(&wish.groups) == held_by(&self.wish.groups);
        if !is_same {
            (self.iterations, self.spent) = (0, Duration::ZERO);
        }
        self.measures = self.measures.filter(|_| is_same);
        (self.is_new, self.wish) = (true, wish);
    }

    /// Whether there is something to be done.
    pub(super) fn has_work(&self) -> bool {
        self.is_new || self.state == SolveState::Iterating || self.wants_measures()
    }

    fn wants_measures(&self) -> bool {
        self.state == SolveState::Settled && self.measures.is_none()
    }

    /// Makes room for the others: the next wish begins where this surface is.
    pub(super) fn free(&mut self) {
        self.engine = None;
    }

    /// Nothing can be said of an engine that was left halfway.
    pub(super) fn broke(&mut self, why: String) {
        (self.engine, self.is_new, self.state) = (None, false, SolveState::Failed(why));
    }

    /// Works for one turn: turns to the wish, iterates, or measures. Returns what there is to tell.
    pub(super) fn work(
        &mut self,
        (ground, yardstick): (&Arc<Groundwork>, &Yardstick),
        is_overruled: &IsOverruled<'_>,
    ) -> News {
        let begun = Instant::now();
        let mut frame = None;
        if self.is_new {
            if self.turn_to_wish(ground, is_overruled).is_continue() {
                self.is_new = false;
                // What has settled is only looked at again.
                self.spent += if self.measures.is_some() { Duration::ZERO } else { begun.elapsed() };
                frame = self.look();
            }
        } else if self.state == SolveState::Iterating {
            self.iterate(begun, is_overruled);
            self.spent += begun.elapsed();
            frame = self.look();
        } else if let Some(pose) = self.pose.clone() {
            let measured = yardstick.measure(ground, &pose, self.handle_error(&pose));
            match measured {
                Ok(measures) => self.measures = Some(measures),
                Err(error) => self.state = SolveState::Failed(error.to_string()),
            }
        }
        self.news(frame)
    }

    fn turn_to_wish(&mut self, ground: &Arc<Groundwork>, is_overruled: &IsOverruled<'_>) -> ControlFlow<()> {
        let mut wish = self.wish.clone();
        if self.engine.is_none()
            && let Some(pose) = &self.pose
        {
            wish.pose = pose.clone();
        }
        let engine = self.engine.get_or_insert_with(|| Engine::beside(ground.clone(), &wish));
        let about = self.wish.clone();
        engine.adopt(wish, &mut |_| {
            if is_overruled(&about) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }

    fn iterate(&mut self, begun: Instant, is_overruled: &IsOverruled<'_>) {
        let Some(engine) = &mut self.engine else { return };
        let about = &self.wish;
        while engine.is_busy() && begun.elapsed() < TURN {
            if engine.step(&mut || !is_overruled(about)).is_none() {
                return;
            }
            self.iterations += 1;
        }
    }

    /// Takes over where the engine stands. Returns the surface if it is a new one.
    fn look(&mut self) -> Option<Arc<SurfaceFrame>> {
        let report = self.engine.as_mut()?.report();
        (self.state, self.energy) = (report.state, report.energy);
        self.measured = report.measured;
        let is_first = self.pose.is_none();
        self.pose = report.pose.or(self.pose.take());
        if is_first && self.pose.is_none() && self.state != SolveState::Iterating {
            // Held at rest, or not at all: nothing will be reported.
            self.pose = Some(self.wish.pose.clone());
            let engine = self.engine.as_ref()?;
            return self.pose.as_ref().map(|pose| Arc::new(engine.ground().frame(pose)));
        }
        report.frame
    }

    fn handle_error(&self, pose: &Pose) -> f64 {
        let (held, targets) = held_by(&self.wish.groups);
        held.iter().zip(&targets).map(|(v, t)| pose.positions[v.index()].distance(*t)).fold(0.0, f64::max)
    }

    /// Where it stands, with a surface if it is a new one.
    pub(super) fn news(&self, frame: Option<Arc<SurfaceFrame>>) -> News {
        News {
            revision: self.wish.revision,
            state: if self.is_new { SolveState::Preparing { progress: 0.0 } } else { self.state.clone() },
            frame,
            measured: self.measured.clone(),
            energy: self.energy,
            iterations: self.iterations,
            spent: self.spent,
            measures: self.measures,
        }
    }
}
