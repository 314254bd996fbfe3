//! Embedded deformation (Sumner, Schmid and Pauly 2007), to be compared with: some hundred nodes on the surface carry it.
//!
//! # Idea
//! Every node j turns, stretches and moves what is around it: p ↦ R_j (p − g_j) + g_j + t_j, with any 3 × 3 matrix R_j. A
//! vertex follows the k nodes nearest to it, v' = Σ_j w_j(v) [R_j (v − g_j) + g_j + t_j]. The nodes go where
//!
//! ```text
//! E = E_rot + 10 E_reg + 100 E_con
//! ```
//!
//! is least: R_j should be a rotation, linked nodes should agree about each other, and held vertices should be at their
//! targets. These are soft: [`Embedded::largest_handle_error`] says how far off they are.
//!
//! | symbol | meaning |
//! |---|---|
//! | g_j | place of node j at rest |
//! | k | nodes that carry a vertex, 4 |
//! | w_j(v) | (1 − ‖v − g_j‖ / d_max)², divided by the sum of the k, without which rest would not be reproduced |
//! | d_max | distance to the (k + 1)-th node |
//! | E_rot, E_reg, E_con | see `energy.rs`; in coordinates in which the surface fits into the unit box |
//!
//! | file | what it is | made or run |
//! |---|---|---|
//! | `sampling.rs`, `graph.rs` | nodes, weights, links | once a mesh |
//! | `energy.rs`, `quadratic.rs` | E, its gradient, the constant part of JᵀJ | the latter when held vertices change |
//! | `step.rs`, `direction.rs`, `frames.rs` | the step of Gauss–Newton: how far, which way, along rotations | every step |
//! | `apply.rs`, `surface.rs` | from nodes to vertices | when positions are asked for |
//!
//! # Differences from the paper
//! - Which nodes carry a vertex is decided along the surface, not through space (see `graph.rs`). The weights are the
//!   paper's.
//! - A step of Gauss–Newton moves R along rotations: R ← Q exp(ω) (Qᵀ R + …) with the turn ω of the step and Q the rotation
//!   nearest to R. To first order that is the sum of the paper, but large turns do not blow up the nodes. It is shortened
//!   until E falls.

mod affine;
mod apply;
mod direction;
mod energy;
mod frames;
mod graph;
mod pose;
mod quadratic;
mod sampling;
mod start;
mod step;
mod surface;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DQuat, DVec3};

pub use energy::EnergyWeights;
pub use graph::DeformationGraph;

use crate::held::Held;
use crate::linear::FactorError;
use crate::mesh::is_usable;
use crate::rigid_fit::RigidMotion;
use crate::{Analysis, LooseComponents, SolveError, StepReport, VertexId};
use affine::{Affine, IDENTITY};
use direction::Direction;
use energy::{HeldTerms, Terms};
use quadratic::Quadratic;

/// A deformation graph with handles, in the caller's numbering of vertices.
///
/// | call | cost |
/// |---|---|
/// | `new`, `set_held` | structure of the system, if other components are held; else copies |
/// | `set_targets`, `start` | copies; up to four steps for [`Start::Auto`](crate::Start::Auto) |
/// | `step` | some solves with six unknowns a node, at times a factorization; nothing depends on the number of vertices |
/// | `positions_into` | a pass over the vertices |
/// | `set_rest`, `set_pose` | a pass over the vertices |
pub struct Embedded {
    analysis: Arc<Analysis>,
    graph: Arc<DeformationGraph>,
    policy: LooseComponents,
    held: Held,
    /// Where vertices are when nothing moves, unless as in the mesh.
    rest: Option<Arc<[DVec3]>>,
    /// Nodes of components with held vertices, and the place of every node in that list.
    active: Vec<u32>,
    place_of: Vec<u32>,
    terms: Terms,
    quadratic: Quadratic,
    /// None before the first nodes are active.
    direction: Option<Direction>,
    /// What the active nodes do, in the unit box.
    x: Vec<Affine>,
    gradient: Vec<Affine>,
    change: Vec<Affine>,
    tried: Vec<Affine>,
    energy: f64,
    iteration: u64,
    report: StepReport,
}

/// Not an active node.
const INACTIVE: u32 = u32::MAX;

impl Embedded {
    /// `held`: vertices that are to be near given positions, targets at rest until [`Embedded::set_targets`].
    ///
    /// # Errors
    /// [`SolveError::NoHandles`], `HeldOutOfRange`, `HeldTwice`; `TooLarge`.
    pub fn new(
        analysis: Arc<Analysis>,
        graph: Arc<DeformationGraph>,
        held: &[VertexId],
        loose: LooseComponents,
    ) -> Result<Embedded, SolveError> {
        let held = Held::new(&analysis.layout, held, &analysis.layout.rest, loose)?;
        let weights = EnergyWeights::default();
        let terms = Terms { nodes: Vec::new(), links: Vec::new(), held: HeldTerms::default(), weights };
        let mut new = Embedded {
            place_of: vec![INACTIVE; graph.n_nodes()],
            policy: loose,
            rest: None,
            active: Vec::new(),
            terms,
            quadratic: Quadratic::default(),
            direction: None,
            x: Vec::new(),
            gradient: Vec::new(),
            change: Vec::new(),
            tried: Vec::new(),
            energy: 0.0,
            iteration: 0,
            report: StepReport { energy: 0.0, iteration: 0, relative_decrease: 0.0 },
            analysis,
            graph,
            held,
        };
        new.activate()?;
        new.take_held();
        new.refresh();
        Ok(new)
    }

    /// Other held vertices. What the nodes do stays, nearly so in components that were not held; the targets are the current
    /// positions until [`Embedded::set_targets`].
    ///
    /// # Errors
    /// As [`Embedded::new`]. On error all is as it was.
    pub fn set_held(&mut self, vertices: &[VertexId]) -> Result<(), SolveError> {
        let held = Held::new(&self.analysis.layout, vertices, &self.analysis.layout.rest, self.policy)?;
        let pose = self.positions();
        let before = std::mem::replace(&mut self.held, held);
        match self.activate() {
            // Nodes of a component that nothing held until now take over what it did.
            Ok(is_new) if is_new.contains(&true) => self.fit_nodes(&pose, |place| is_new[place]),
            Ok(_) => {}
            Err(error) => {
                self.held = before;
                return Err(error);
            }
        }
        let table = self.table();
        let mut targets = vec![DVec3::ZERO; vertices.len()];
        for (target, v) in targets.iter_mut().zip(vertices) {
            *target = self.moved(&table, v.index());
        }
        self.held.targets = targets;
        self.take_held();
        self.refresh();
        Ok(())
    }

    /// One target per held vertex, in the order given to `set_held`/`new`.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`.
    pub fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError> {
        self.held.set_targets(&self.analysis.layout.rest, targets)?;
        for (mine, &target) in self.terms.held.targets.iter_mut().zip(targets) {
            *mine = (target - self.graph.center) / self.graph.size;
        }
        self.refresh();
        Ok(())
    }

    /// Other positions at which the surface is when nothing moves, one per vertex: from here on, nodes bend these. Weights
    /// and links stay, and the targets too.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`.
    pub fn set_rest(&mut self, rest: Arc<[DVec3]>) -> Result<(), SolveError> {
        let (got, expected) = (rest.len(), self.analysis.layout.n_vertices());
        if got != expected {
            return Err(SolveError::WrongLength { what: "positions", got, expected });
        }
        if let Some(bad) = rest.iter().position(|&p| !is_usable(p)) {
            return Err(SolveError::TargetNotFinite { vertex: bad as u32 });
        }
        self.rest = Some(rest);
        self.x.fill(IDENTITY);
        for (i, &node) in self.active.iter().enumerate() {
            self.terms.nodes[i] = (self.rest_of_node(node) - self.graph.center) / self.graph.size;
        }
        self.take_held();
        self.refresh();
        Ok(())
    }

    /// Other weights of the energies; each must be finite and above 0, and otherwise stays as it is. The pose stays.
    pub fn set_weights(&mut self, weights: EnergyWeights) {
        let good = |new: f64, old: f64| if new.is_finite() && new > 0.0 { new } else { old };
        let old = self.terms.weights;
        self.terms.weights = EnergyWeights {
            regularity: good(weights.regularity, old.regularity),
            constraint: good(weights.constraint, old.constraint),
        };
        self.quadratic.assemble(&self.terms);
        if let Some(direction) = &mut self.direction {
            direction.forget();
        }
        self.refresh();
    }

    /// E after the last change or step; exactly 0 where it cannot be told from rounding. In coordinates in which the largest
    /// extent of the surface is 1.
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// The largest distance of a held vertex from its target.
    pub fn largest_handle_error(&self) -> f64 {
        self.terms.largest_error(&self.x) * self.graph.size
    }

    /// The graph in use.
    pub fn graph(&self) -> &Arc<DeformationGraph> {
        &self.graph
    }

    /// The held vertices, in the order given.
    pub fn held(&self) -> &[VertexId] {
        &self.held.vertices
    }

    /// Components without a held vertex: (vertex count, first vertex), by first vertex.
    pub fn loose_components(&self) -> &[(usize, VertexId)] {
        &self.held.loose_reported
    }

    /// The rigid motion that fits the held vertices at these places in the list best.
    fn fit(&self, places: &[u32], otherwise: DQuat) -> RigidMotion {
        let (rest, held) = (self.rest_positions(), &self.held);
        let pair = |&i: &u32| (rest[held.vertices[i as usize].index()], held.targets[i as usize]);
        RigidMotion::fit(places.iter().map(pair), otherwise)
    }

    /// Finds the nodes that held vertices have a hold on; where they are others than before, begins anew with those. Returns
    /// which of the active nodes are new, if any can be.
    fn activate(&mut self) -> Result<Vec<bool>, SolveError> {
        let layout = &self.analysis.layout;
        let is_held = |component: u32| !self.held.by_component.list(component as usize).is_empty();
        let is_active = |node: &u32| is_held(layout.component[self.graph.nodes[*node as usize] as usize]);
        let active: Vec<u32> = (0..self.graph.n_nodes() as u32).filter(is_active).collect();
        if active == self.active {
            return Ok(Vec::new());
        }
        let mut place_of = vec![INACTIVE; self.graph.n_nodes()];
        active.iter().enumerate().for_each(|(place, &node)| place_of[node as usize] = place as u32);
        let nodes: Vec<DVec3> =
            active.iter().map(|&node| (self.rest_of_node(node) - self.graph.center) / self.graph.size).collect();
        // Links join nodes of one component.
        let links = self.graph.links.iter().map(|link| link.map(|node| place_of[node as usize]));
        let links = links.filter(|link| link[0] != INACTIVE).collect();
        let terms = Terms { nodes, links, held: HeldTerms::default(), weights: self.terms.weights };
        self.direction = Some(Direction::new(&terms).map_err(explain)?);
        let state = |&node: &u32| self.place_of[node as usize];
        let is_new = active.iter().map(|node| state(node) == INACTIVE).collect();
        self.x = active.iter().map(|node| self.x.get(state(node) as usize).copied().unwrap_or(IDENTITY)).collect();
        self.quadratic = Quadratic::new(&terms);
        for buffer in [&mut self.gradient, &mut self.change, &mut self.tried] {
            *buffer = vec![affine::ZERO; active.len()];
        }
        (self.active, self.place_of, self.terms) = (active, place_of, terms);
        Ok(is_new)
    }

    /// The terms of the held vertices.
    fn take_held(&mut self) {
        let (center, size, k) = (self.graph.center, self.graph.size, self.graph.k);
        let mut terms = HeldTerms { k, ..HeldTerms::default() };
        for (v, &target) in self.held.vertices.iter().zip(&self.held.targets) {
            let p = (self.rest_positions()[v.index()] - center) / size;
            let mut constant = DVec3::ZERO;
            for (node, w) in self.graph.carriers_of(v.index()) {
                let place = self.place_of[node as usize];
                let g = self.terms.nodes[place as usize];
                let arm = (p - g) * w;
                terms.entries.push((place, [arm.x, arm.y, arm.z, w]));
                constant += g * w;
            }
            terms.constants.push(constant);
            terms.targets.push((target - center) / size);
        }
        self.terms.held = terms;
        self.quadratic.assemble(&self.terms);
        if let Some(direction) = &mut self.direction {
            direction.forget();
        }
    }

    fn refresh(&mut self) {
        let energy = self.terms.energy(&self.x);
        self.energy = if energy <= self.terms.floor() { 0.0 } else { energy };
    }
}

fn explain(_: FactorError) -> SolveError {
    SolveError::TooLarge { what: "the deformation graph" }
}
