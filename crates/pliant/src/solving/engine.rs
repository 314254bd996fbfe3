//! The solver as the worker holds it: compares each wish with what it has and does the least that is needed.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use pliant_geometry::VertexNormals;
use pliant_solver::{
    Analysis, LooseComponents, Minimizer, Neighborhoods, SolveError, Solver, Start, StepReport, VertexId,
};
use rayon::prelude::*;

use super::preview::{LIMITS, Limits, Previews};
use super::stillness::Stillness;
use super::{Measure, Measured, SolveReport, SolveRequest, SolveState};
use crate::document::{Pose, held_by};
use crate::viewport::SurfaceFrame;

/// Several times fewer iterations than the plain one, and hardly dearer.
const MINIMIZER: Minimizer = Minimizer::Lbfgs;
/// Rings to search, summed over the vertices, from which on the user is told and may change his mind. Below, nobody could
/// read it: with twice as many, the first build of 100,000 vertices takes 0.8 s (measured).
const LONG_SEARCH: u64 = 100_000;
/// Targets that jump farther than this fraction of the bounding box's diagonal are a new start, not a drag (by eye:
/// a fast mouse moves a tenth of the window in a frame).
const JUMP_FRACTION: f64 = 0.25;
/// Energies kept for the plot.
const PLOTTED_ENERGIES: usize = 300;
/// Positions per task: small meshes are not worth waking other threads.
const PER_TASK: usize = 4096;
/// Iteration times of which the median is shown.
const TIMED_ITERATIONS: usize = 32;

/// Is told how far a long search is, from 0 to 1, and may stop it. Called from the threads that search.
pub type Watch<'a> = dyn FnMut(f64) -> ControlFlow<()> + Send + 'a;

/// A prepared solver and the wish it was prepared for.
pub struct Engine {
    wish: SolveRequest,
    analysis: Arc<Analysis>,
    solver: Option<Solver>,
    held: Vec<VertexId>,
    targets: Vec<DVec3>,
    normals: VertexNormals,
    state: SolveState,
    /// Whether the pose is anything but the rest pose to the last bit. Iterating at rest would only add rounding.
    is_bent: bool,
    /// Whether the pose has changed since it was last reported.
    is_pose_new: bool,
    stillness: Stillness,
    previews: Previews,
    /// As last reported.
    measured: Option<Measured>,
    last: StepReport,
    energies: VecDeque<f64>,
    times_ms: VecDeque<f64>,
}

impl Engine {
    /// Analyzes the mesh of a wish; seconds on a large mesh. [`Engine::adopt`] then prepares for the wish.
    pub fn new(wish: &SolveRequest) -> Engine {
        Engine::with_previews(wish, LIMITS)
    }

    /// The same with other limits for previews.
    pub(super) fn with_previews(wish: &SolveRequest, limits: Limits) -> Engine {
        let model = wish.model.clone();
        let analysis = Arc::new(Analysis::new(model.mesh.clone(), wish.weights));
        Engine {
            previews: Previews::new(&analysis, limits),
            measured: None,
            analysis,
            normals: VertexNormals::new(model.mesh.n_vertices(), &model.triangles),
            solver: None,
            held: Vec::new(),
            targets: Vec::new(),
            state: SolveState::Resting,
            is_bent: false,
            is_pose_new: false,
            stillness: Stillness::default(),
            last: StepReport { energy: 0.0, iteration: 0, relative_decrease: 0.0 },
            energies: VecDeque::new(),
            times_ms: VecDeque::new(),
            wish: wish.clone(),
        }
    }

    /// Whether another wish concerns the same mesh and weights, so that the analysis serves.
    pub fn serves(&self, wish: &SolveRequest) -> bool {
        Arc::ptr_eq(&self.wish.model, &wish.model) && self.wish.weights == wish.weights
    }

    /// Whether `adopt` would take so long that the user is better told before.
    pub fn takes_long(&self, wish: &SolveRequest) -> bool {
        if wish.groups.is_empty() {
            return false;
        }
        let sizes = wish.rigidity.as_slice();
        let rings: u64 = if self.must_rebuild(wish) {
            sizes.iter().map(|&r| u64::from(r)).sum()
        } else if self.wish.rigidity == wish.rigidity {
            0
        } else {
            let changed = sizes.iter().zip(self.wish.rigidity.as_slice()).filter(|(new, old)| new != old);
            changed.map(|(&r, _)| u64::from(r)).sum()
        };
        rings >= LONG_SEARCH
    }

    fn must_rebuild(&self, wish: &SolveRequest) -> bool {
        self.solver.is_none() || self.wish.loose != wish.loose
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
        self.solver = None;
        self.energies.clear();
        self.state = SolveState::Resting;
        (self.held, self.targets, self.wish) = (Vec::new(), Vec::new(), wish);
    }

    /// Changes the solver where the wish differs.
    fn update(&mut self, wish: SolveRequest) {
        if self.is_another_system(&wish) {
            self.leave_preview();
        }
        let Some(mut solver) = self.solver.take() else { return };
        match self.change(&mut solver, &wish) {
            Ok(change) => {
                self.solver = Some(solver);
                if change != Change::None {
                    self.go_on(&wish);
                }
                if change == Change::Targets && self.is_busy() && self.can_preview() {
                    self.preview(wish.loose);
                }
            }
            Err(error) => self.fail(&error),
        }
        if wish.epoch != self.wish.epoch {
            self.energies.clear();
        }
        self.wish = wish;
    }

    /// Whether a wish wants more than other targets near the old ones.
    fn is_another_system(&self, wish: &SolveRequest) -> bool {
        let (held, targets) = held_by(&wish.groups);
        wish.epoch != self.wish.epoch
            || wish.rigidity != self.wish.rigidity
            || held != self.held
            || self.is_leap(wish, &targets)
    }

    /// Returns what differed.
    fn change(&mut self, solver: &mut Solver, wish: &SolveRequest) -> Result<Change, SolveError> {
        let jumped = wish.epoch != self.wish.epoch;
        let mut change = Change::None;
        if jumped {
            change = Change::More;
            solver.set_pose(&wish.pose.positions)?;
            self.is_bent = !is_rest(wish);
            self.is_pose_new = true;
        }
        if wish.rigidity != self.wish.rigidity {
            solver.set_rigidity(&wish.rigidity)?;
            change = Change::More;
        }
        let (held, targets) = held_by(&wish.groups);
        if held != self.held {
            solver.set_held(&held)?;
            self.targets = positions_of(&held, &solver.positions());
            self.held = held;
            change = Change::More;
        }
        if targets != self.targets {
            let leaps = !jumped && self.is_leap(wish, &targets);
            solver.set_targets(&targets)?;
            if leaps {
                solver.start(Start::Auto);
                self.is_bent = true;
            }
            self.targets = targets;
            change = if leaps || change == Change::More { Change::More } else { Change::Targets };
        }
        Ok(change)
    }

    /// Whether other targets can be followed by a preview, since iterations are too slow for that.
    pub fn can_preview(&self) -> bool {
        self.previews.serve(median(&self.times_ms))
    }

    /// Whether the surface is a preview, which is to be left when targets rest.
    pub fn is_previewing(&self) -> bool {
        self.previews.shown().is_some()
    }

    /// Shows a preview of the newest targets; where that cannot be had, iterations go on.
    fn preview(&mut self, loose: LooseComponents) {
        let Some(solver) = &self.solver else { return };
        let held = (&self.held[..], &self.targets[..]);
        match self.previews.show(&self.analysis, held, loose, || pose_of(solver)) {
            Ok(()) => (self.is_bent, self.is_pose_new) = (true, true),
            Err(error) => log::warn!("no preview: {error}"),
        }
    }

    /// Iterations go on from the preview, if one is shown.
    pub fn leave_preview(&mut self) {
        let Some(pose) = self.previews.leave() else { return };
        if let Some(solver) = &mut self.solver
            && let Err(error) = solver.set_pose(&pose.positions).and_then(|()| solver.set_targets(&self.targets))
        {
            self.fail(&error);
        }
    }

    /// Whether targets are so far from those before that the pose is no good beginning.
    fn is_leap(&self, wish: &SolveRequest, targets: &[DVec3]) -> bool {
        farthest(&self.targets, targets) > JUMP_FRACTION * f64::from(wish.model.diagonal())
    }

    /// A new solver. It goes on where the old one was, unless the document's pose jumped.
    fn rebuild(&mut self, wish: SolveRequest, watch: &mut Watch<'_>) -> ControlFlow<()> {
        let neighborhoods = Neighborhoods::with_progress(&self.analysis, &wish.rigidity, &mut |done| watch(done));
        if neighborhoods.as_ref().is_err_and(|error| *error == SolveError::Canceled) {
            return ControlFlow::Break(());
        }
        self.leave_preview();
        // The old factor goes before the new one comes.
        let old = self.solver.take().map(|solver| solver.positions());
        let goes_on = old.is_some() && wish.epoch == self.wish.epoch;
        let pose = match old.filter(|_| goes_on) {
            Some(positions) => positions.into(),
            None => {
                self.is_bent = !is_rest(&wish);
                wish.pose.positions.clone()
            }
        };
        let (held, targets) = held_by(&wish.groups);
        self.targets = positions_of(&held, &pose);
        self.energies.clear();
        match neighborhoods.and_then(|neighborhoods| self.build(neighborhoods, &wish, (&held, &targets), &pose)) {
            Ok(mut solver) => {
                if goes_on && self.is_leap(&wish, &targets) {
                    solver.start(Start::Auto);
                    self.is_bent = true;
                }
                self.solver = Some(solver);
                self.go_on(&wish);
            }
            Err(error) => self.fail(&error),
        }
        (self.held, self.targets, self.wish) = (held, targets, wish);
        ControlFlow::Continue(())
    }

    fn build(
        &self,
        neighborhoods: Neighborhoods,
        wish: &SolveRequest,
        (held, targets): (&[VertexId], &[DVec3]),
        pose: &[DVec3],
    ) -> Result<Solver, SolveError> {
        let mut solver = Solver::new(self.analysis.clone(), neighborhoods, &wish.rigidity, held, wish.loose)?;
        solver.set_minimizer(MINIMIZER);
        solver.set_pose(pose)?;
        solver.set_targets(targets)?;
        Ok(solver)
    }

    /// After a change: iterates again, unless nothing is bent.
    fn go_on(&mut self, wish: &SolveRequest) {
        self.stillness.changed();
        self.state = SolveState::Iterating;
        if !self.is_bent && holds_at_rest(wish) {
            self.state = SolveState::Settled;
            self.energies.clear();
        }
    }

    fn fail(&mut self, error: &SolveError) {
        self.solver = None;
        self.state = SolveState::Failed(error.to_string());
    }

    /// Whether another iteration is worth while.
    pub fn is_busy(&self) -> bool {
        self.state == SolveState::Iterating
    }

    /// One iteration; returns how long it took. None if `is_wanted` said no before anything moved, which it is not asked in
    /// the first iteration after a change.
    pub fn step(&mut self, is_wanted: &mut (dyn FnMut() -> bool + Send)) -> Option<Duration> {
        let Some(solver) = &mut self.solver else { return Some(Duration::ZERO) };
        let start = Instant::now();
        self.last = solver.step_while(is_wanted)?;
        (self.is_bent, self.is_pose_new) = (true, true);
        let took = start.elapsed();
        remember(&mut self.times_ms, TIMED_ITERATIONS, took.as_secs_f64() * 1e3);
        remember(&mut self.energies, PLOTTED_ENERGIES, self.last.energy);
        if self.stillness.is_reached(self.last.energy) {
            self.state = SolveState::Settled;
        }
        Some(took)
    }

    /// Where things stand, with the surface ready for the picture unless it is as last reported.
    pub fn report(&mut self) -> SolveReport {
        let is_new = std::mem::take(&mut self.is_pose_new);
        let exact = || self.solver.as_ref().map(pose_of);
        let pose = if is_new { self.previews.shown().cloned().or_else(exact) } else { None };
        let frame = pose.as_ref().map(|pose| Arc::new(self.frame(pose)));
        // Those of a preview would be of no use, and take longer than the preview.
        if !self.is_previewing() {
            self.measured = self.measure();
        }
        SolveReport {
            model: self.wish.model.clone(),
            revision: self.wish.revision,
            epoch: self.wish.epoch,
            state: self.state.clone(),
            frame,
            pose,
            energy: self.last.energy,
            iteration: self.last.iteration,
            relative_decrease: self.last.relative_decrease,
            iteration_ms: median(&self.times_ms),
            energies: self.energies.iter().copied().collect(),
            measured: self.measured.clone(),
            remarks: self.remarks(),
        }
    }

    /// What the wish asks for of every vertex. Without handles nothing has an energy.
    fn measure(&self) -> Option<Measured> {
        let (measure, model) = (self.wish.measure?, &self.wish.model);
        match (measure, &self.solver) {
            (Measure::Stretch, Some(solver)) => Some(Measured::stretch(model, &solver.positions())),
            (Measure::Stretch, None) => Some(Measured::stretch(model, &self.wish.pose.positions)),
            (_, solver) => Some(Measured::energies(model, measure, solver.as_ref()?.vertex_energies())),
        }
    }

    /// Waits until previews can be had.
    #[cfg(test)]
    pub(super) fn wait_for_previews(&self) {
        self.previews.wait();
    }

    /// Where the surface is, if anything is held.
    #[cfg(test)]
    pub(super) fn positions(&self) -> Option<Vec<DVec3>> {
        self.solver.as_ref().map(Solver::positions)
    }

    /// View-space positions and normals of a pose of this engine's mesh.
    pub fn frame(&self, pose: &Pose) -> SurfaceFrame {
        let model = &self.wish.model;
        let positions = pose.positions.par_iter().with_min_len(PER_TASK);
        let positions: Vec<_> = positions.map(|&p| model.to_view(p)).collect();
        let mut normals = Vec::new();
        self.normals.compute(&positions, &model.triangles, &mut normals);
        SurfaceFrame { positions, normals }
    }

    fn remarks(&self) -> Vec<String> {
        let Some(solver) = &self.solver else { return Vec::new() };
        let (they, it) = match self.wish.loose {
            LooseComponents::KeepAtRest => ("stay", "stays"),
            LooseComponents::FollowNearest => ("follow the nearest", "follows the nearest"),
        };
        match solver.loose_components() {
            [] => Vec::new(),
            [(n, _)] => vec![format!("a part of {n} vertices has no handle and {it}")],
            parts => vec![format!("{} parts have no handle and {they}", parts.len())],
        }
    }
}

/// What a wish changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    None,
    /// Targets alone, as in a drag.
    Targets,
    /// The pose, sizes, held vertices, or targets far away.
    More,
}

/// The pose of a solver, written where it stays.
fn pose_of(solver: &Solver) -> Pose {
    let n = solver.rigidity().as_slice().len();
    let mut positions: Arc<[DVec3]> = std::iter::repeat_n(DVec3::ZERO, n).collect();
    if let Some(positions) = Arc::get_mut(&mut positions) {
        solver.positions_into(positions);
    }
    Pose { positions }
}

fn is_rest(wish: &SolveRequest) -> bool {
    *wish.pose.positions == *wish.model.mesh.positions()
}

/// Whether every held vertex is held at rest. The first target that moved ends the search.
fn holds_at_rest(wish: &SolveRequest) -> bool {
    let rest = wish.model.mesh.positions();
    wish.groups.iter().all(|group| group.vertices.iter().zip(group.targets()).all(|(v, p)| p == rest[v.index()]))
}

fn positions_of(vertices: &[VertexId], positions: &[DVec3]) -> Vec<DVec3> {
    vertices.iter().map(|v| positions[v.index()]).collect()
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f64::max).sqrt()
}

fn remember(queue: &mut VecDeque<f64>, keep: usize, value: f64) {
    if queue.len() == keep {
        queue.pop_front();
    }
    queue.push_back(value);
}

fn median(values: &VecDeque<f64>) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}
