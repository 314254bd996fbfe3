//! The solver as the worker holds it: turns to each wish with the least that is needed (see `turning.rs`), iterates, and
//! tells where things stand.

mod turning;

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use pliant_solver::{StepReport, VertexId};

use super::bent::{Bent, KeptGraph};
use super::figures::Figures;
use super::preview::{LIMITS, Limits, Previews};
use super::stillness::Stillness;
use super::{Groundwork, Measure, Measured, SolveReport, SolveRequest, SolveState, remarks};

/// Is told how far a long search is, from 0 to 1, and may stop it. Called from the threads that search.
pub type Watch<'a> = dyn FnMut(f64) -> ControlFlow<()> + Send + 'a;

/// Half of an iteration that takes longer can be felt: a frame of a screen at 60 Hz.
const SLOW_MS: f64 = 1000.0 / 60.0;

/// What a report tells anew.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    /// Where the surface is; energies and measures are those of the iteration before.
    Surface,
    /// And what was measured on it.
    All,
}

/// A prepared solver and the wish it was prepared for.
pub struct Engine {
    wish: SolveRequest,
    ground: Arc<Groundwork>,
    bent: Option<Bent>,
    /// Whether a surface at rest is not kept as the beginning.
    seeks_beginning: bool,
    held: Vec<VertexId>,
    targets: Vec<DVec3>,
    state: SolveState,
    /// Whether the pose is anything but the rest pose to the last bit. Iterating at rest would only add rounding.
    is_bent: bool,
    /// Whether the pose has changed since it was last reported.
    is_pose_new: bool,
    stillness: Stillness,
    previews: Previews,
    graphs: KeptGraph,
    figures: Figures,
    /// As last reported.
    measured: Option<Measured>,
    vertex_energies: Option<Arc<[f64]>>,
}

impl Engine {
    /// Analyzes the mesh of a wish; seconds on a large mesh. [`Engine::adopt`] then prepares for the wish.
    pub fn new(wish: &SolveRequest) -> Engine {
        Engine::with_previews(wish, LIMITS)
    }

    /// The same with other limits for previews.
    pub(super) fn with_previews(wish: &SolveRequest, limits: Limits) -> Engine {
        let ground = Arc::new(Groundwork::new(wish));
        let previews = Previews::new(&ground.analysis, limits);
        Engine::standing_on(ground, wish, previews)
    }

    /// On an analysis of the wish's mesh that is there already, and without previews: to be looked at, not dragged. From rest
    /// it looks for the best beginning, however near the handles are.
    pub fn beside(ground: Arc<Groundwork>, wish: &SolveRequest) -> Engine {
        let previews = Previews::none();
        Engine { seeks_beginning: true, ..Engine::standing_on(ground, wish, previews) }
    }

    fn standing_on(ground: Arc<Groundwork>, wish: &SolveRequest, previews: Previews) -> Engine {
        debug_assert!(ground.serves(wish), "another mesh or other weights need another analysis");
        Engine {
            ground,
            previews,
            bent: None,
            seeks_beginning: false,
            held: Vec::new(),
            targets: Vec::new(),
            state: SolveState::Resting,
            is_bent: false,
            is_pose_new: false,
            stillness: Stillness::default(),
            graphs: KeptGraph::default(),
            figures: Figures::default(),
            measured: None,
            vertex_energies: None,
            wish: wish.clone(),
        }
    }

    /// What it stands on.
    pub fn ground(&self) -> &Arc<Groundwork> {
        &self.ground
    }

    /// Whether another wish concerns the same mesh and weights, so that the analysis serves.
    pub fn serves(&self, wish: &SolveRequest) -> bool {
        self.ground.serves(wish)
    }

    /// Whether another iteration is worth while.
    pub fn is_busy(&self) -> bool {
        self.state == SolveState::Iterating
    }

    /// One iteration; returns how long it took. None if `is_wanted` said no before anything moved, which it is not asked in
    /// the first iteration after a change.
    pub fn step(&mut self, is_wanted: &mut (dyn FnMut() -> bool + Send)) -> Option<Duration> {
        let Some(bent) = &mut self.bent else { return Some(Duration::ZERO) };
        let start = Instant::now();
        let report = bent.deformer_mut().step_while(is_wanted)?;
        (self.is_bent, self.is_pose_new) = (true, true);
        let took = start.elapsed();
        self.stepped(report, took);
        Some(took)
    }

    /// Whether the next iteration is better shown halfway, as a slow one after a change: its second half only turns and finds
    /// the energy. Where iterations are quick, three of them make a better surface.
    pub fn is_shown_halfway(&self) -> bool {
        let moves_first = |bent: &Bent| !bent.is_quick() && bent.deformer().is_next_plain();
        self.figures.iteration_ms() > SLOW_MS && self.bent.as_ref().is_some_and(moves_first)
    }

    /// One iteration whose surface is shown halfway; returns how long the second half took. Only where
    /// [`Engine::is_shown_halfway`] says so.
    pub fn step_shown_halfway(&mut self, show: impl FnOnce(SolveReport)) -> Duration {
        let Some(bent) = &mut self.bent else { return Duration::ZERO };
        let start = Instant::now();
        bent.deformer_mut().global_step();
        let first = start.elapsed();
        (self.is_bent, self.is_pose_new) = (true, true);
        show(self.report_of(Told::Surface));
        let Some(bent) = &mut self.bent else { return Duration::ZERO };
        let start = Instant::now();
        let report = bent.deformer_mut().local_step();
        let second = start.elapsed();
        self.stepped(report, first + second);
        second
    }

    fn stepped(&mut self, report: StepReport, took: Duration) {
        self.figures.stepped(report, took);
        if self.stillness.is_reached(report.energy) {
            self.state = SolveState::Settled;
        }
    }

    /// Where things stand, with the surface ready for the picture unless it is as last reported.
    pub fn report(&mut self) -> SolveReport {
        self.report_of(Told::All)
    }

    fn report_of(&mut self, told: Told) -> SolveReport {
        let is_new = std::mem::take(&mut self.is_pose_new);
        let exact = || self.bent.as_ref().map(|bent| bent.pose(&self.ground));
        let pose = if is_new { self.previews.shown().cloned().or_else(exact) } else { None };
        let frame = pose.as_ref().map(|pose| Arc::new(self.ground.frame(pose)));
        // Those of a preview would be of no use, and take longer than the preview.
        if told == Told::All && !self.is_previewing() {
            self.measured = self.measure();
            let bent = self.bent.as_ref().filter(|_| self.wish.wants_energies);
            self.vertex_energies = bent.map(|bent| bent.vertex_energies(&self.ground).into());
        }
        let loose = self.bent.as_ref().map_or(&[][..], |bent| bent.deformer().loose_components());
        SolveReport {
            model: self.wish.model.clone(),
            revision: self.wish.revision,
            epoch: self.wish.epoch,
            state: self.state.clone(),
            frame,
            pose,
            energy: self.figures.last.energy,
            iteration: self.figures.last.iteration,
            relative_decrease: self.figures.last.relative_decrease,
            iteration_ms: self.figures.iteration_ms(),
            energies: self.figures.energies(),
            measured: self.measured.clone(),
            vertex_energies: self.vertex_energies.clone(),
            remarks: remarks::about_loose(loose, self.wish.loose),
            ground: Arc::downgrade(&self.ground),
        }
    }

    /// What the wish asks for of every vertex. Without handles nothing has an energy.
    fn measure(&self) -> Option<Measured> {
        let (measure, model) = (self.wish.measure?, &self.wish.model);
        match (measure, &self.bent) {
            (Measure::Stretch, Some(bent)) => Some(Measured::stretch(model, &bent.pose(&self.ground).positions)),
            (Measure::Stretch, None) => Some(Measured::stretch(model, &self.wish.pose.positions)),
            (_, bent) => Some(Measured::energies(model, measure, bent.as_ref()?.vertex_energies(&self.ground))),
        }
    }

    /// As if iterations had taken so long.
    #[cfg(test)]
    pub(super) fn pretend_iterations_took(&mut self, took: Duration) {
        let last = self.figures.last;
        self.figures.forget_all();
        self.figures.stepped(last, took);
    }

    /// Waits until previews can be had.
    #[cfg(test)]
    pub(super) fn wait_for_previews(&self) {
        self.previews.wait();
    }

    /// Where the surface is, if anything is held.
    #[cfg(test)]
    pub(super) fn positions(&self) -> Option<Vec<DVec3>> {
        self.bent.as_ref().map(|bent| bent.pose(&self.ground).positions.to_vec())
    }
}
