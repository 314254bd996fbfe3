//! The solver as callers see it: a factored system with a pose, in the caller's numbering.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use crate::analysis::Analysis;
use crate::held::Held;
use crate::kernels::energy::vertex_energies;
use crate::kernels::iteration::{LocalOutcome, Pose, Workspace};
use crate::kernels::parallel::on_pool;
use crate::kernels::rotations::Ties;
use crate::lbfgs::{Lbfgs, Verdict};
use crate::linear::System;
use crate::matrix::explain;
use crate::mesh::is_usable;
use crate::rings::Rings;
use crate::{LooseComponents, Neighborhoods, Rigidity, SolveError, Start, VertexId};

/// How an iteration uses what the ones before have taught. E never rises with either.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Minimizer {
    /// Every iteration is a global step and a local step, as in the paper.
    #[default]
    LocalGlobal,
    /// L-BFGS with the factored system as preconditioner: hardly dearer than the plain iteration, and several times fewer.
    /// The first iteration after a change of targets or of the start is plain.
    Lbfgs,
}

/// What one iteration achieved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// Energy of eq. (1) after the local step. It is exactly 0 where it could not be told from rounding.
    pub energy: f64,
    /// Iterations since the last [`Solver::start`].
    pub iteration: u64,
    /// (E before − E after) / |E before| (3.2.3); 0 when E before = 0. The first iteration after a change of targets, held
    /// vertices, rigidity, pose or start has nothing to compare with and reports 1, or 0 when E = 0. The first iteration
    /// after [`Start::Auto`] is compared with the trial iteration of the candidate that won. One small value does not mean
    /// that the end is near: under [`Minimizer::Lbfgs`] a step may have been cut short.
    pub relative_decrease: f64,
}

/// A factored system with a pose. All inputs and outputs are in the caller's vertex numbering.
///
/// | call | cost |
/// |---|---|
/// | `new` | assembles and factors |
/// | `set_rigidity` | neighborhoods of changed vertices, numeric refactor, one local step |
/// | `set_held` | numeric refactor |
/// | `set_targets` | copies; a rigid fit per group if loose components follow |
/// | `set_pose` | copies; one local step, with a full search for the best rotation where vertices turned far |
/// | `start` | `Keep`, `Rest`: copies; `Auto`: up to four iterations and one solve |
/// | `set_minimizer` | memory of 248 bytes per vertex for L-BFGS |
/// | `step`, `step_while` | one iteration: one solve, one local step (seldom more under L-BFGS); no factorization, no allocation |
///
/// Every call that can fail leaves the solver as it was when it does.
///
/// While handles are dragged: `set_minimizer(Minimizer::Lbfgs)` once, then for every frame `set_targets` and as many `step`s
/// as there is time for, at least three if possible: the first spreads the motion of the handles, and only from the third
/// on do they know more than the plain iteration did. What they learn serves the next frames too, until `set_held`,
/// `set_rigidity`, `set_pose` or a `start` other than `Keep`. After a jump of the targets, `start(Start::Auto)` first.
pub struct Solver {
    pub(crate) analysis: Arc<Analysis>,
    pub(crate) rings: Rings,
    rigidity: Rigidity,
    policy: LooseComponents,
    pub(crate) held: Held,
    /// Values of the matrix that is factored.
    pub(crate) values: Vec<f64>,
    pub(crate) system: System,
    pub(crate) pose: Pose,
    pub(crate) workspace: Workspace,
    pub(crate) energy: f64,
    /// Energy of the previous iteration, if it belongs to the same targets, held vertices and rigidity.
    pub(crate) comparable: Option<f64>,
    /// Whether held vertices are at their targets.
    is_placed: bool,
    pub(crate) iteration: u64,
    /// Whether the last start was [`Start::Rest`]: then ties of the local step are left open as in the paper.
    pub(crate) from_rest: bool,
    /// The memory of [`Minimizer::Lbfgs`].
    lbfgs: Option<Box<Lbfgs>>,
}

impl Solver {
    /// `held`: vertices with a prescribed position, targets at rest until [`Solver::set_targets`]. The pose is the rest
    /// pose.
    ///
    /// # Errors
    /// [`SolveError::NoHandles`], `HeldOutOfRange`, `HeldTwice` for `held`; `WrongLength` for `rigidity`;
    /// `Indefinite` with raw weights; `TooLarge` if the factor does not fit into memory.
    pub fn new(
        analysis: Arc<Analysis>,
        neighborhoods: Neighborhoods,
        rigidity: &Rigidity,
        held: &[VertexId],
        loose: LooseComponents,
    ) -> Result<Solver, SolveError> {
        let layout = &analysis.layout;
        if neighborhoods.r.len() != layout.n_vertices() {
            let (got, expected) = (neighborhoods.r.len(), layout.n_vertices());
            return Err(SolveError::WrongLength { what: "neighborhoods", got, expected });
        }
        let rings = Rings::new(layout, neighborhoods.updated(&analysis, rigidity)?);
        let held = Held::new(layout, held, &layout.rest, loose)?;
        let system = System::new(analysis.pattern.clone()).map_err(|error| explain(&analysis, error))?;
        let mut workspace = Workspace::new(layout);
        workspace.fit(layout, &rings, &Vec::from_iter(0..layout.n_blocks()));
        let mut solver = Solver {
            rigidity: rigidity.clone(),
            policy: loose,
            values: Vec::new(),
            system,
            pose: Pose::at_rest(&layout.rest),
            workspace,
            energy: 0.0,
            comparable: None,
            is_placed: true,
            iteration: 0,
            from_rest: false,
            lbfgs: None,
            rings,
            held,
            analysis,
        };
        let values = solver.assemble(&solver.rings.stiffness, &solver.held.is_fixed);
        solver.factor(values)?;
        Ok(solver)
    }

    /// Another way to minimize, from the pose as it is. What the other had learned is forgotten.
    pub fn set_minimizer(&mut self, minimizer: Minimizer) {
        if minimizer != self.minimizer() {
            self.lbfgs = match minimizer {
                Minimizer::LocalGlobal => None,
                Minimizer::Lbfgs => Some(Box::new(Lbfgs::new(&self.analysis.layout.rest))),
            };
        }
    }

    /// The way to minimize.
    pub fn minimizer(&self) -> Minimizer {
        if self.lbfgs.is_some() { Minimizer::Lbfgs } else { Minimizer::LocalGlobal }
    }

    /// Pairs that L-BFGS remembers.
    #[cfg(test)]
    pub(crate) fn n_pairs(&self) -> usize {
        self.lbfgs.as_ref().map_or(0, |lbfgs| lbfgs.n_pairs())
    }

    /// Other neighborhood sizes. Positions stay; rotations and energy become those of the new neighborhoods.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `Indefinite`, `TooLarge`. On error the solver is as it was.
    pub fn set_rigidity(&mut self, rigidity: &Rigidity) -> Result<(), SolveError> {
        if *rigidity == self.rigidity {
            return Ok(());
        }
        let touched = self.rings.repaint(&self.analysis, rigidity)?;
        if !touched.is_empty() {
            let values = self.repainted(&touched);
            if let Err(error) = self.factor(values) {
                // The sizes from before were there, so they fit.
                self.rings.repaint(&self.analysis, &self.rigidity)?;
                return Err(error);
            }
        }
        self.rigidity = rigidity.clone();
        self.workspace.fit(&self.analysis.layout, &self.rings, &touched);
        self.refresh();
        Ok(())
    }

    /// Other held vertices. The pose stays, and the targets are the current positions of the vertices until
    /// [`Solver::set_targets`].
    ///
    /// # Errors
    /// [`SolveError::NoHandles`], `HeldOutOfRange`, `HeldTwice`, `Indefinite`. On error the solver is as it was.
    pub fn set_held(&mut self, held: &[VertexId]) -> Result<(), SolveError> {
        let held = Held::new(&self.analysis.layout, held, &self.pose.positions, self.policy)?;
        if held.is_fixed != self.held.is_fixed {
            let values = self.refixed(&held.is_fixed);
            self.factor(values)?;
        }
        self.held = held;
        self.comparable = None;
        self.forget();
        Ok(())
    }

    /// One target per held vertex, in the order given to `set_held`/`new`. The vertices move with the next global step.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`. On error the solver is as it was.
    pub fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError> {
        self.held.set_targets(&self.analysis.layout.rest, targets)?;
        self.comparable = None;
        self.is_placed = false;
        Ok(())
    }

    /// Replaces the current pose (undo, load): positions of all vertices. The rotations become the best ones for them,
    /// whatever the pose was before. Targets stay.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`. On error the solver is as it was.
    pub fn set_pose(&mut self, positions: &[DVec3]) -> Result<(), SolveError> {
        let layout = &self.analysis.layout;
        if positions.len() != layout.n_vertices() {
            let (got, expected) = (positions.len(), layout.n_vertices());
            return Err(SolveError::WrongLength { what: "positions", got, expected });
        }
        if let Some(bad) = positions.iter().position(|&p| !is_usable(p)) {
            return Err(SolveError::TargetNotFinite { vertex: bad as u32 });
        }
        self.pose = Pose::at_rest(&layout.rest);
        for (p, &caller) in self.pose.positions.iter_mut().zip(&layout.to_caller) {
            *p = positions[caller as usize];
        }
        self.is_placed = false;
        self.refresh();
        Ok(())
    }

    /// Begins anew from a [`Start`]; the iteration count returns to 0. The next half step is global.
    pub fn start(&mut self, start: Start) {
        self.iteration = 0;
        self.from_rest = start == Start::Rest;
        if start != Start::Keep {
            self.forget();
        }
        match start {
            Start::Keep => {}
            Start::Rest => {
                self.pose = Pose::at_rest(&self.analysis.layout.rest);
                self.is_placed = false;
                self.energy = 0.0;
            }
            Start::Auto => return self.start_auto(),
        }
        self.comparable = None;
    }

    /// Global then local (3.2.1, 3.2.2). Energy is that of eq. (1) after the local step.
    pub fn step(&mut self) -> StepReport {
        on_pool(self.pose.positions.len(), || {
            self.global_step();
            self.local_step()
        })
    }

    /// As [`Solver::step`], but gives way where that helps: nothing is returned, and the pose is as before, if `is_wanted`
    /// says no before the step has moved anything. It is asked between the parts of the global step, from the thread that
    /// works. The first step after a change of any kind is always taken. What L-BFGS has learned is lost with the step.
    pub fn step_while(&mut self, is_wanted: &mut (dyn FnMut() -> bool + Send)) -> Option<StepReport> {
        let is_first = self.comparable.is_none();
        on_pool(self.pose.positions.len(), || {
            let moved = self.move_all(&mut || is_first || is_wanted());
            moved.then(|| self.local_step())
        })
    }

    /// Held vertices go exactly to their targets and the free ones to where the energy is least for the current
    /// rotations (3.2.1), or under [`Minimizer::Lbfgs`] to where it is thought to be least with the best rotations.
    pub fn global_step(&mut self) {
        on_pool(self.pose.positions.len(), || self.move_all(&mut || true));
    }

    /// Whether the next global step is a plain one, whatever the minimizer, so that the local step leaves its positions alone.
    pub fn is_next_plain(&self) -> bool {
        self.lbfgs.as_ref().is_none_or(|lbfgs| lbfgs.basis(self.comparable).is_none())
    }

    /// Whether it came to that.
    fn move_all(&mut self, is_wanted: &mut dyn FnMut() -> bool) -> bool {
        let layout = &self.analysis.layout;
        self.held.place(&layout.rest, &mut self.pose.positions);
        self.is_placed = true;
        if self.from_rest && self.iteration == 0 {
            // The paper's p' = A⁻¹ b, with the rounding that decides its ties: a correction of nothing.
            let free = self.pose.positions.iter_mut().zip(&self.held.is_fixed).filter(|(_, is_fixed)| !**is_fixed);
            free.for_each(|(p, _)| *p = DVec3::ZERO);
        }
        let moved = self.move_free(is_wanted);
        self.iteration += u64::from(moved);
        moved
    }

    /// The free vertices' part of a global step: plain, or as L-BFGS proposes where E at the current pose is known.
    fn move_free(&mut self, is_wanted: &mut dyn FnMut() -> bool) -> bool {
        let Solver { rings, system, pose, workspace, .. } = self;
        let (layout, is_fixed) = (&self.analysis.layout, &self.held.is_fixed);
        workspace.gradient(layout, rings, is_fixed, pose);
        if !is_wanted() {
            return false;
        }
        let mut lbfgs = self.lbfgs.as_mut();
        if let Some(lbfgs) = &mut lbfgs {
            if let Some(energy) = lbfgs.basis(self.comparable) {
                lbfgs.take_gradient(&workspace.rhs);
                system.solve_in_place(&mut workspace.rhs);
                if is_wanted() {
                    lbfgs.propose(&workspace.rhs, energy, &mut pose.positions);
                    return true;
                }
                // A gradient was taken in that no step will follow.
                lbfgs.forget();
                return false;
            }
            lbfgs.interrupt();
        }
        system.solve_in_place(&mut workspace.rhs);
        let is_wanted = is_wanted();
        if is_wanted {
            workspace.correct(is_fixed, pose);
        }
        is_wanted
    }

    /// The best rotations for the current positions, and the energy; where L-BFGS went too far, first shorter steps.
    fn turn_all(&mut self) -> LocalOutcome {
        let ties = if self.from_rest { Ties::Rounding } else { Ties::Nudged };
        loop {
            let outcome = self.workspace.local(&self.analysis.layout, &self.rings, &mut self.pose, ties);
            let Some(lbfgs) = &mut self.lbfgs else { return outcome };
            let rounding = outcome.noise.rise(self.comparable.unwrap_or(0.0));
            match lbfgs.judge(outcome.energy, rounding, &mut self.pose.positions) {
                Verdict::Taken => return outcome,
                Verdict::Again => {}
            }
        }
    }

    /// The best rotations for the current positions (3.2.2), and the energy. Under [`Minimizer::Lbfgs`] the step before is
    /// shortened, should the energy demand it.
    pub fn local_step(&mut self) -> StepReport {
        let LocalOutcome { mut energy, noise } = on_pool(self.pose.positions.len(), || self.turn_all());
        if energy.abs() <= noise.floor() {
            energy = 0.0;
        }
        let relative_decrease = match self.comparable {
            Some(before) => {
                if energy > before && energy - before <= noise.rise(before) {
                    energy = before;
                }
                if before == 0.0 { 0.0 } else { (before - energy) / before.abs() }
            }
            None if energy == 0.0 => 0.0,
            None => 1.0,
        };
        self.energy = energy;
        // An energy with held vertices away from their targets is another one's.
        self.comparable = Some(energy).filter(|_| self.is_placed);
        StepReport { energy, iteration: self.iteration, relative_decrease }
    }

    /// Energy of eq. (1) after the last local step.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// Positions of all vertices written into `out` (caller's numbering); entries beyond the vertices stay.
    pub fn positions_into(&self, out: &mut [DVec3]) {
        for (out, &internal) in out.iter_mut().zip(&self.analysis.layout.to_internal) {
            *out = self.pose.positions[internal as usize];
        }
    }

    /// Positions of all vertices.
    pub fn positions(&self) -> Vec<DVec3> {
        self.in_callers_order(&self.pose.positions)
    }

    /// R_k of all vertices.
    pub fn rotations(&self) -> Vec<DMat3> {
        self.analysis.layout.to_internal.iter().map(|&v| self.pose.rotation(v as usize)).collect()
    }

    /// E_k, the share of each vertex in the energy (eq. 1), summed directly: costs as much as all neighborhoods have
    /// edges.
    pub fn vertex_energies(&self) -> Vec<f64> {
        let mut energies = vec![0.0; self.analysis.layout.n_vertices()];
        vertex_energies(&self.analysis.layout, &self.rings.neighborhoods, &self.pose, &mut energies);
        self.in_callers_order(&energies)
    }

    /// Neighborhood sizes in use.
    pub fn rigidity(&self) -> &Rigidity {
        &self.rigidity
    }

    /// The held vertices, in the order given.
    pub fn held(&self) -> &[VertexId] {
        &self.held.vertices
    }

    /// Components without a held vertex: (vertex count, first vertex), by first vertex.
    pub fn loose_components(&self) -> &[(usize, VertexId)] {
        &self.held.loose_reported
    }

    fn in_callers_order<T: Copy>(&self, internal: &[T]) -> Vec<T> {
        self.analysis.layout.to_internal.iter().map(|&v| internal[v as usize]).collect()
    }

    /// What was learned concerns another system or another pose.
    pub(crate) fn forget(&mut self) {
        if let Some(lbfgs) = &mut self.lbfgs {
            lbfgs.forget();
        }
    }

    /// Rotations and energy for positions or neighborhoods that were replaced.
    fn refresh(&mut self) {
        self.forget();
        self.comparable = None;
        self.local_step();
        self.comparable = None;
    }
}
