//! SR-ARAP (Levi and Gotsman 2015), to be compared with: neighbors should also turn alike.
//!
//! # Theory
//! ```text
//! E(p', R) = Σ_i Σ_j [ w_ij ‖e'_ij − R_i e_ij‖² + α A v_i ‖R_i − R_j‖² ]
//! ```
//!
//! over the neighbors j of every vertex i; the norm of a matrix is the root of the sum of its squares.
//!
//! | symbol | meaning |
//! |---|---|
//! | e, e' | p_i − p_j at rest and now |
//! | A | area of the surface at rest |
//! | v_i | 1 / number of neighbors of i |
//! | α | how much turning alike counts, 0.02 |
//! | T_i | Σ_j w_ij e' eᵀ + α A Σ_j (v_i + v_j) R_j |
//!
//! Two steps alternate: the global step of r = 1, and a local step in which each R_i maximizes ⟨R_i, T_i⟩ with its
//! neighbors as they are, one color of vertices after the other. Both can only lower E.
//!
//! # Practice
//! In the local step a turn spreads by an edge a sweep, but the second term is so strong that turns depend on each other
//! across many edges, the more the finer the mesh. So before the sweep all rotations are turned at once by R_i ← exp(ω_i)
//! R_i with (D + 2 L) ω = torque: L is the Laplacian with α A (v_i + v_j) for its weights, D the mean resistance of the
//! first term at rest. This is Newton's method with a constant matrix, factored once, with the order that the global
//! step has. It is taken back should E not fall. With rotations nearly the best for p', E is a function of p' alone, and
//! L-BFGS serves as it does for r-ring.

mod colors;
mod field;
mod pose;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DMat3, DQuat, DVec3};

use crate::analysis::Layout;
use crate::held::Held;
use crate::kernels::parallel::{CHUNK, chunks, on_pool};
use crate::kernels::quad::Quad;
use crate::lbfgs::{Lbfgs, Verdict};
use crate::linear::System;
use crate::matrix::{assemble, explain};
use crate::start::{blended_turns, component_turns};
use crate::{Analysis, LooseComponents, Minimizer, SolveError, Start, StepReport, VertexId};
use colors::Colors;
use field::{Constants, Field, Turn};

/// A surface that bends by SR-ARAP. All inputs and outputs are in the caller's vertex numbering.
///
/// | call | cost |
/// |---|---|
/// | `new`, `set_held` | numeric factorization |
/// | `set_targets` | copies |
/// | `set_pose` | three local steps |
/// | `start` | copies; up to four steps for [`Start::Auto`] |
/// | `step` | two solves, a sweep, three passes over the edges |
pub struct SrArap {
    analysis: Arc<Analysis>,
    policy: LooseComponents,
    held: Held,
    constants: Constants,
    /// 2 w of every edge, as the global step has it.
    stiffness: Vec<f64>,
    system: System,
    /// D + 2 L.
    smoother: System,
    positions: Vec<DVec3>,
    /// By place, see [`Colors`].
    turns: Vec<Turn>,
    /// Those before the step, and those before all were turned at once.
    before: [Vec<Turn>; 2],
    rhs: Vec<Quad>,
    parts: Vec<f64>,
    lbfgs: Option<Box<Lbfgs>>,
    energy: f64,
    comparable: Option<f64>,
    iteration: u64,
}

impl SrArap {
    /// `held`: vertices with a prescribed position, targets at rest until [`SrArap::set_targets`]. The pose is the rest
    /// pose. `alpha`: at least 0; 0.02 is usual.
    ///
    /// # Errors
    /// [`SolveError::NoHandles`], `HeldOutOfRange`, `HeldTwice`; `Indefinite` with raw weights; `TooLarge`.
    pub fn new(
        analysis: Arc<Analysis>,
        alpha: f64,
        held: &[VertexId],
        loose: LooseComponents,
    ) -> Result<SrArap, SolveError> {
        let layout = &analysis.layout;
        let n = layout.n_vertices();
        let held = Held::new(layout, held, &layout.rest, loose)?;
        let coupling = alpha.max(0.0) * area(&analysis);
        let degree = |v: usize| layout.spokes(v).len().max(1) as f64;
        let constants =
            Constants { colors: Colors::new(layout), share: (0..n).map(|v| coupling / degree(v)).collect() };
        let mut smoother = System::new(analysis.pattern.clone()).map_err(|error| explain(&analysis, error))?;
        smoother.factor(&smoothing(&analysis, &constants)).map_err(|error| explain(&analysis, error))?;
        let rest = Turn::new(DQuat::IDENTITY);
        let mut new = SrArap {
            policy: loose,
            stiffness: layout.weight.iter().map(|w| 2.0 * w).collect(),
            system: System::new(analysis.pattern.clone()).map_err(|error| explain(&analysis, error))?,
            smoother,
            positions: layout.rest.clone(),
            turns: vec![rest; n],
            before: [vec![rest; n], vec![rest; n]],
            rhs: vec![Quad::ZERO; n],
            parts: vec![0.0; n.div_ceil(CHUNK)],
            lbfgs: None,
            energy: 0.0,
            comparable: None,
            iteration: 0,
            constants,
            held,
            analysis,
        };
        new.factor()?;
        Ok(new)
    }

    /// Another way to minimize. What the other had learned is forgotten.
    pub fn set_minimizer(&mut self, minimizer: Minimizer) {
        if minimizer == Minimizer::LocalGlobal {
            self.lbfgs = None;
        } else if self.lbfgs.is_none() {
            self.lbfgs = Some(Box::new(Lbfgs::new(&self.analysis.layout.rest)));
        }
    }

    /// Other held vertices. The pose stays, and the targets are the current positions of the vertices until
    /// [`SrArap::set_targets`].
    ///
    /// # Errors
    /// As [`SrArap::new`]. On error all is as it was.
    pub fn set_held(&mut self, held: &[VertexId]) -> Result<(), SolveError> {
        let held = Held::new(&self.analysis.layout, held, &self.positions, self.policy)?;
        let before = std::mem::replace(&mut self.held, held);
        if let Err(error) = self.factor() {
            self.held = before;
            // It was factored before.
            self.factor()?;
            return Err(error);
        }
        self.comparable = None;
        self.forget();
        Ok(())
    }

    fn factor(&mut self) -> Result<(), SolveError> {
        let values = assemble(&self.analysis, &self.stiffness, &self.held.is_fixed);
        self.system.factor(&values).map_err(|error| explain(&self.analysis, error))
    }

    /// One target per held vertex, in the order given to `set_held`/`new`.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`.
    pub fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError> {
        self.held.set_targets(&self.analysis.layout.rest, targets)?;
        self.comparable = None;
        Ok(())
    }

    /// Begins anew from a [`Start`]; the iteration count returns to 0.
    pub fn start(&mut self, start: Start) {
        self.comparable = None;
        if start != Start::Keep {
            self.forget();
        }
        match start {
            Start::Keep => {}
            Start::Rest => {
                self.positions.copy_from_slice(&self.analysis.layout.rest);
                self.turns.fill(Turn::new(DQuat::IDENTITY));
            }
            Start::Auto => self.start_auto(),
        }
        self.iteration = 0;
    }

    /// The beginnings of r-ring, each by one step, and the lowest energy goes on.
    fn start_auto(&mut self) {
        let kept = (self.positions.clone(), self.turns.clone());
        let SrArap { analysis, held, stiffness, system, rhs, .. } = self;
        let rigid = component_turns(&analysis.layout, held);
        let blended = blended_turns((&analysis.layout, held), &rigid, stiffness, system, rhs);
        let identity = vec![DQuat::IDENTITY; rigid.len()];
        let mut best: Option<(f64, Vec<DVec3>, Vec<Turn>)> = None;
        for turns in [None, Some(identity), Some(rigid), blended] {
            self.positions.copy_from_slice(&kept.0);
            match &turns {
                None => self.turns.copy_from_slice(&kept.1),
                Some(turns) => {
                    let places = self.turns.iter_mut().zip(&self.constants.colors.vertices);
                    places.for_each(|(turn, &v)| *turn = Turn::new(turns[v as usize]));
                }
            }
            self.comparable = None;
            self.forget();
            let energy = self.step().energy;
            if best.as_ref().is_none_or(|(lowest, ..)| energy < *lowest) {
                best = Some((energy, self.positions.clone(), self.turns.clone()));
            }
            if energy == 0.0 {
                break;
            }
        }
        if let Some((energy, positions, turns)) = best {
            (self.positions, self.turns) = (positions, turns);
            (self.energy, self.comparable) = (energy, Some(energy));
        }
    }

    /// Global, then local; E never rises.
    pub fn step(&mut self) -> StepReport {
        on_pool(self.positions.len(), || {
            self.global_step();
            self.local_step()
        })
    }

    /// Held vertices go to their targets and the others to where E is least for these rotations, or where L-BFGS proposes.
    pub fn global_step(&mut self) {
        let SrArap { analysis, held, constants, system, positions, turns, rhs, .. } = self;
        held.place(&analysis.layout.rest, positions);
        self.iteration += 1;
        Field { layout: &analysis.layout, constants, positions }.pulls(turns, &held.is_fixed, rhs);
        if let Some(lbfgs) = &mut self.lbfgs {
            if let Some(energy) = lbfgs.basis(self.comparable) {
                lbfgs.take_gradient(rhs);
                system.solve_in_place(rhs);
                lbfgs.propose(rhs, energy, positions);
                return;
            }
            lbfgs.interrupt();
        }
        system.solve_in_place(rhs);
        let (rhs, is_fixed) = (&*rhs, &held.is_fixed);
        chunks(positions, |first, positions| {
            let free = (first..).zip(positions).filter(|(i, _)| !is_fixed[*i]);
            free.for_each(|(i, p)| *p += rhs[i].xyz());
        });
    }

    /// Whether the next global step is a plain one, whatever the minimizer, so that the local step leaves its positions alone.
    pub fn is_next_plain(&self) -> bool {
        self.lbfgs.as_ref().is_none_or(|lbfgs| lbfgs.basis(self.comparable).is_none())
    }

    /// Better rotations for these positions, and E.
    pub fn local_step(&mut self) -> StepReport {
        self.before[0].copy_from_slice(&self.turns);
        let floor = self.floor();
        let mut energy = self.turn_all();
        while let Some(lbfgs) = &mut self.lbfgs {
            match lbfgs.judge(energy, floor, &mut self.positions) {
                Verdict::Taken => break,
                Verdict::Again => {
                    self.turns.copy_from_slice(&self.before[0]);
                    energy = self.turn_all();
                }
            }
        }
        if energy <= floor {
            energy = 0.0;
        }
        let relative_decrease = match self.comparable {
            Some(0.0) => 0.0,
            Some(before) => (before - energy) / before,
            None => f64::from(u8::from(energy != 0.0)),
        };
        (self.energy, self.comparable) = (energy, Some(energy));
        StepReport { energy, iteration: self.iteration, relative_decrease }
    }

    /// All at once where that helps, then a sweep. Returns E.
    fn turn_all(&mut self) -> f64 {
        let SrArap { analysis, constants, smoother, positions, turns, rhs, parts, .. } = self;
        let field = Field { layout: &analysis.layout, constants, positions };
        let before = field.energy(turns, parts);
        field.torques(turns, rhs);
        smoother.solve_in_place(rhs);
        let kept = &mut self.before[1];
        kept.copy_from_slice(turns);
        let (omega, vertices) = (&*rhs, &constants.colors.vertices);
        chunks(turns, |first, turns| {
            for (turn, &v) in turns.iter_mut().zip(&vertices[first..]) {
                *turn = Turn::new((DQuat::from_scaled_axis(omega[v as usize].xyz()) * turn.q).normalize());
            }
        });
        if !field.energy(turns, parts).le(&before) {
            turns.copy_from_slice(kept);
        }
        field.sweep(turns);
        field.energy(turns, parts)
    }

    /// What rounding can make of E where it should be zero, some ten operations on numbers of the size of the coordinates.
    fn floor(&self) -> f64 {
        let reach = self.positions.iter().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let couplings: f64 = self.constants.share.iter().sum();
        let weights: f64 = self.stiffness.iter().map(|w| w.abs()).sum();
        weights * (16.0 * f64::EPSILON * reach).powi(2) + couplings * (64.0 * f64::EPSILON).powi(2)
    }

    /// E after the last step.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// Positions of all vertices written into `out`; entries beyond the vertices stay.
    pub fn positions_into(&self, out: &mut [DVec3]) {
        for (out, &internal) in out.iter_mut().zip(&self.analysis.layout.to_internal) {
            *out = self.positions[internal as usize];
        }
    }

    /// Positions of all vertices.
    pub fn positions(&self) -> Vec<DVec3> {
        let mut positions = vec![DVec3::ZERO; self.positions.len()];
        self.positions_into(&mut positions);
        positions
    }

    /// R of all vertices.
    pub fn rotations(&self) -> Vec<DMat3> {
        let places = self.analysis.layout.to_internal.iter().map(|&v| self.constants.colors.place_of[v as usize]);
        places.map(|place| self.turns[place as usize].r).collect()
    }

    /// The held vertices, in the order given.
    pub fn held(&self) -> &[VertexId] {
        &self.held.vertices
    }

    /// Components without a held vertex: (vertex count, first vertex), by first vertex.
    pub fn loose_components(&self) -> &[(usize, VertexId)] {
        &self.held.loose_reported
    }

    fn forget(&mut self) {
        if let Some(lbfgs) = &mut self.lbfgs {
            lbfgs.forget();
        }
    }
}

/// Area of the surface at rest.
fn area(analysis: &Analysis) -> f64 {
    let mesh = analysis.mesh();
    let corners = mesh.triangles().iter().map(|t| t.map(|v| mesh.positions()[v as usize]));
    corners.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
}

/// D + 2 L. D is ⅔ Σ_j w ‖e‖², a third of the trace of what resists a turn; at least a little, so that there is a factor.
fn smoothing(analysis: &Analysis, constants: &Constants) -> Vec<f64> {
    let Analysis { layout, pattern, slots, .. } = analysis;
    let mut values = vec![0.0; pattern.n_values()];
    for v in 0..layout.n_vertices() {
        let own = resistance(layout, v);
        let coupled: f64 = layout.spokes(v).iter().map(|spoke| pair(constants, v, spoke.vertex as usize)).sum();
        let sum = own + coupled;
        values[pattern.diagonal(v)] = if sum > 0.0 { sum.max(coupled * (1.0 + 1e-9)) } else { 1.0 };
    }
    for (&slot, &[i, j]) in slots.iter().zip(&layout.edges) {
        values[slot as usize] = -pair(constants, i as usize, j as usize);
    }
    values
}

/// 2 α A (v_i + v_j).
fn pair(constants: &Constants, i: usize, j: usize) -> f64 {
    2.0 * (constants.share[i] + constants.share[j])
}

fn resistance(layout: &Layout, v: usize) -> f64 {
    let spokes = layout.spokes(v).iter().map(|spoke| spoke.edge as usize);
    (2.0 / 3.0 * spokes.map(|e| layout.weight[e] * layout.edge_rest[e].length_squared()).sum::<f64>()).max(0.0)
}
