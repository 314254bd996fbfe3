//! How an engine turns to a wish: what differs from the one before decides whether targets move, the system is factored
//! anew, or all is prepared anew.

use std::ops::ControlFlow;

use glam::DVec3;
use pliant_solver::{SolveError, Start, VertexId};

use super::{Engine, Watch};
use crate::document::held_by;
use crate::solving::bent::{Bent, Holds, Material};
use crate::solving::difference::{Difference, holds_at_rest, is_leap, is_rest};
use crate::solving::{SolveRequest, SolveState};

/// Rings to search, summed over the vertices, from which on the user is told and may change his mind. Below, nobody could
/// read it: with twice as many, the first build of 100,000 vertices takes 0.8 s (measured).
const LONG_SEARCH: u64 = 100_000;

impl Engine {
    /// Whether `adopt` would take so long that the user is better told before.
    pub fn takes_long(&self, wish: &SolveRequest) -> bool {
        if wish.groups.is_empty() {
            return false;
        }
        let sizes = wish.rigidity.as_slice();
        let rings: u64 = match (self.must_rebuild(wish), wish.method.kind.is_of_rings()) {
            (true, true) => sizes.iter().map(|&r| u64::from(r)).sum(),
            (true, false) => sizes.len() as u64,
            (false, true) if self.wish.rigidity != wish.rigidity => {
                let changed = sizes.iter().zip(self.wish.rigidity.as_slice()).filter(|(new, old)| new != old);
                changed.map(|(&r, _)| u64::from(r)).sum()
            }
            (false, _) => 0,
        };
        rings >= LONG_SEARCH
    }

    fn must_rebuild(&self, wish: &SolveRequest) -> bool {
        self.bent.is_none() || self.wish.loose != wish.loose || !self.wish.method.is_prepared_like(&wish.method)
    }

    /// Turns to a wish for the same mesh and weights with the least work. `watch` follows a long search for
    /// neighborhoods.
    ///
    /// # Errors
    /// Breaks if `watch` stopped the search. The engine is as it was, and should be given a newer wish.
    pub fn adopt(&mut self, wish: SolveRequest, watch: &mut Watch<'_>) -> ControlFlow<()> {
        debug_assert!(self.serves(&wish), "another mesh or other weights need a new engine");
        if wish.groups.is_empty() {
            self.rest(wish);
        } else if self.must_rebuild(&wish) || self.takes_long(&wish) {
            return self.rebuild(wish, watch);
        } else {
            self.update(wish);
        }
        ControlFlow::Continue(())
    }

    /// Nothing is held any more.
    fn rest(&mut self, wish: SolveRequest) {
        self.previews.leave();
        self.bent = None;
        self.figures.forget_energies();
        self.state = SolveState::Resting;
        (self.held, self.targets, self.wish) = (Vec::new(), Vec::new(), wish);
    }

    /// Changes the solver where the wish differs.
    fn update(&mut self, wish: SolveRequest) {
        let difference = Difference::between((&self.wish, &self.held, &self.targets), &wish);
        let is_another_system = difference.is_another_system();
        let is_nothing = difference.is_nothing();
        if is_another_system {
            self.leave_preview();
        }
        if difference.jumped {
            self.figures.forget_energies();
        }
        let Some(mut bent) = self.bent.take() else { return };
        match self.change(&mut bent, &wish, difference) {
            Ok(()) => {
                self.bent = Some(bent);
                if !is_nothing {
                    self.go_on(&wish);
                }
                if !is_nothing && !is_another_system && self.is_busy() && self.can_preview() {
                    self.preview(&wish);
                }
            }
            Err(error) => self.fail(&error),
        }
        self.wish = wish;
    }

    fn change(&mut self, bent: &mut Bent, wish: &SolveRequest, new: Difference) -> Result<(), SolveError> {
        let (held, targets) = new.to;
        let mut leaps = new.leaps;
        if new.jumped {
            bent.deformer_mut().set_pose(&wish.pose.positions)?;
            (self.is_bent, self.is_pose_new) = (!is_rest(wish), true);
        }
        if new.sizes
            && let Bent::Rings(solver) = bent
        {
            solver.set_rigidity(&wish.rigidity)?;
        }
        if new.held {
            bent.deformer_mut().set_held(&held)?;
            self.targets = positions_of(&held, &bent.pose(&self.ground).positions);
            self.held = held;
            leaps = is_leap(wish, &self.targets, &targets);
        }
        if new.targets {
            bent.deformer_mut().set_targets(&targets)?;
            if leaps && !new.jumped {
                bent.deformer_mut().start(Start::Auto);
                self.is_bent = true;
            }
            self.targets = targets;
        }
        Ok(())
    }

    /// Whether other targets can be followed by a preview, since iterations are too slow for that.
    pub fn can_preview(&self) -> bool {
        let is_quick = self.bent.as_ref().is_none_or(Bent::is_quick);
        !is_quick && self.previews.serve(self.figures.iteration_ms())
    }

    /// Whether the surface is a preview, which is to be left when targets rest.
    pub fn is_previewing(&self) -> bool {
        self.previews.shown().is_some()
    }

    /// Shows a preview of the newest targets; where that cannot be had, iterations go on.
    fn preview(&mut self, wish: &SolveRequest) {
        let Some(bent) = &self.bent else { return };
        let held = (&self.held[..], &self.targets[..]);
        match self.previews.show(&self.ground.analysis, held, wish.loose, || bent.pose(&self.ground)) {
            Ok(()) => (self.is_bent, self.is_pose_new) = (true, true),
            Err(error) => log::warn!("no preview: {error}"),
        }
    }

    /// Iterations go on from the preview, if one is shown.
    pub fn leave_preview(&mut self) {
        let Some(pose) = self.previews.leave() else { return };
        let Some(bent) = &mut self.bent else { return };
        let deformer = bent.deformer_mut();
        if let Err(error) = deformer.set_pose(&pose.positions).and_then(|()| deformer.set_targets(&self.targets)) {
            self.fail(&error);
        }
    }

    /// Prepares anew. It goes on where the old one was, unless the document's pose jumped.
    fn rebuild(&mut self, wish: SolveRequest, watch: &mut Watch<'_>) -> ControlFlow<()> {
        let material = Material::gather(&self.ground, &wish, &mut self.graphs, watch)?;
        self.leave_preview();
        // The old factor goes before the new one comes.
        let old = self.bent.take().map(|bent| bent.pose(&self.ground));
        let goes_on = old.is_some() && wish.epoch == self.wish.epoch;
        let pose = old.filter(|_| goes_on).unwrap_or_else(|| wish.pose.clone());
        if !goes_on {
            self.is_bent = !is_rest(&wish);
        }
        let (held, targets) = held_by(&wish.groups);
        let before = positions_of(&held, &pose.positions);
        if wish.method.is_prepared_like(&self.wish.method) {
            self.figures.forget_energies();
        } else {
            self.figures.forget_all();
        }
        let holds = Holds { vertices: &held, targets: &targets };
        match material.and_then(|material| Bent::new(material, &self.ground, &wish, holds, &pose.positions)) {
            Ok(mut bent) => {
                let seeks = self.seeks_beginning && !self.is_bent && before != targets;
                if seeks || (goes_on || self.seeks_beginning) && is_leap(&wish, &before, &targets) {
                    bent.deformer_mut().start(Start::Auto);
                    (self.is_bent, self.is_pose_new) = (true, true);
                }
                self.bent = Some(bent);
                self.go_on(&wish);
            }
            Err(error) => self.fail(&error),
        }
        (self.held, self.targets, self.wish) = (held, targets, wish);
        ControlFlow::Continue(())
    }

    /// After a change: iterates again, unless nothing is bent.
    fn go_on(&mut self, wish: &SolveRequest) {
        self.stillness.changed();
        self.state = SolveState::Iterating;
        if !self.is_bent && holds_at_rest(wish) {
            self.state = SolveState::Settled;
            self.figures.forget_energies();
        }
    }

    fn fail(&mut self, error: &SolveError) {
        self.bent = None;
        self.state = SolveState::Failed(error.to_string());
    }
}

fn positions_of(vertices: &[VertexId], positions: &[DVec3]) -> Vec<DVec3> {
    vertices.iter().map(|v| positions[v.index()]).collect()
}
