//! The two half steps on plain arrays: the memory they work in, and their order of sums.

use glam::{DMat3, DQuat, DVec3};

use crate::analysis::Layout;
use crate::energy::{DIRECT_BELOW, FEW_EDGES, Noise, component_frames, framed_terms, vertex_energies};
use crate::linear::System;
use crate::neighborhoods::Neighborhoods;
use crate::parallel::{CHUNK, chunks, chunks_summed};
use crate::quad::Quad;
use crate::rotations::{Ties, best_rotation};
use crate::sums::{edge_deviations, edge_pulls, edge_vectors, inner, neighborhood_sum, prefix_sums, vertex_pulls};
use crate::transpose::Transpose;

/// p' and R of every vertex, internal numbering.
pub(crate) struct Pose {
    pub(crate) positions: Vec<DVec3>,
    /// R_k as matrices, kept equal to `turns`.
    pub(crate) rotations: Vec<DMat3>,
    /// R_k as unit quaternions.
    pub(crate) turns: Vec<DQuat>,
}

impl Clone for Pose {
    fn clone(&self) -> Pose {
        let Pose { positions, rotations, turns } = self;
        Pose { positions: positions.clone(), rotations: rotations.clone(), turns: turns.clone() }
    }

    /// Into the same memory, which a derived one would not use.
    fn clone_from(&mut self, other: &Pose) {
        self.positions.clone_from(&other.positions);
        self.rotations.clone_from(&other.rotations);
        self.turns.clone_from(&other.turns);
    }
}

impl Pose {
    pub(crate) fn at_rest(rest: &[DVec3]) -> Pose {
        let n = rest.len();
        Pose { positions: rest.to_vec(), rotations: vec![DMat3::IDENTITY; n], turns: vec![DQuat::IDENTITY; n] }
    }

    pub(crate) fn set_turns(&mut self, turn: impl Fn(usize) -> DQuat) {
        for k in 0..self.turns.len() {
            self.turns[k] = turn(k);
            self.rotations[k] = DMat3::from_quat(self.turns[k]);
        }
    }
}

/// What the sums run over: r-rings, their transpose, and what depends on them alone.
pub(crate) struct Rings {
    pub(crate) neighborhoods: Neighborhoods,
    pub(crate) transpose: Transpose,
    /// d_e w_e.
    pub(crate) stiffness: Vec<f64>,
    /// Σ |d_e w_e|.
    total_stiffness: f64,
    /// Whether any weight is negative, as raw ones may be.
    has_negative: bool,
    /// C_k = Σ_{e ∈ N(k)} w_e e eᵀ; empty where a small energy is summed directly.
    moments: Vec<DMat3>,
}

impl Rings {
    pub(crate) fn new(layout: &Layout, neighborhoods: Neighborhoods) -> Rings {
        let transpose = Transpose::new(layout, &neighborhoods);
        let counts = transpose.counts(layout, &neighborhoods.r);
        let stiffness: Vec<f64> = counts.iter().zip(&layout.weight).map(|(d, w)| d * w).collect();
        let is_large = counts.iter().sum::<f64>() > FEW_EDGES * layout.n_edges() as f64;
        let moments = if is_large { moments(layout, &neighborhoods) } else { Vec::new() };
        let total_stiffness = stiffness.iter().map(|s| s.abs()).sum();
        let has_negative = stiffness.iter().any(|&s| s < 0.0);
        Rings { neighborhoods, transpose, stiffness, total_stiffness, has_negative, moments }
    }
}

fn moments(layout: &Layout, neighborhoods: &Neighborhoods) -> Vec<DMat3> {
    let mut prefix = vec![DMat3::ZERO; layout.n_edges() + layout.n_blocks()];
    prefix_sums(layout, &slot_bounds(layout), &layout.edge_rest, &mut prefix);
    let mut moments = vec![DMat3::ZERO; layout.n_vertices()];
    chunks(&mut moments, |first, moments| {
        for (k, moment) in (first..).zip(moments) {
            *moment = neighborhood_sum(layout, neighborhoods, &layout.edge_rest, &prefix, k);
        }
    });
    moments
}

/// `scale` is Σ d w (‖e'‖² + ‖e‖²).
fn noise_of(layout: &Layout, rings: &Rings, (positions, edge_now): (&[DVec3], &[DVec3]), scale: f64) -> Noise {
    let sums = if rings.has_negative {
        let squares =
            edge_now.iter().zip(&layout.edge_rest).map(|(now, rest)| now.length_squared() + rest.length_squared());
        rings.stiffness.iter().zip(squares).map(|(s, squares)| s.abs() * squares).sum()
    } else {
        scale
    };
    let largest = positions.iter().fold(DVec3::ZERO, |most, p| most.max(p.abs())).max_element();
    Noise::new(sums, rings.total_stiffness, largest)
}

/// First slot of every block.
fn slot_bounds(layout: &Layout) -> Vec<u32> {
    layout.blocks.iter().enumerate().map(|(block, &edge)| edge + block as u32).collect()
}

/// What a local step found out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalOutcome {
    /// Eq. (1).
    pub(crate) energy: f64,
    pub(crate) noise: Noise,
}

/// Memory of the half steps, reserved once.
pub(crate) struct Workspace {
    edge_now: Vec<DVec3>,
    pulls: Vec<DVec3>,
    prefix: Vec<DMat3>,
    /// First slot of every block.
    slot_bounds: Vec<u32>,
    /// Right-hand side and solution of the system.
    pub(crate) rhs: Vec<Quad>,
    /// Two numbers per vertex: terms of its energy.
    terms: Vec<[f64; 2]>,
    energies: Vec<f64>,
    /// One rotation per component.
    frames: Vec<DQuat>,
    partial: Vec<f64>,
}

impl Workspace {
    pub(crate) fn new(layout: &Layout) -> Workspace {
        let (n, m) = (layout.n_vertices(), layout.n_edges());
        Workspace {
            edge_now: vec![DVec3::ZERO; m],
            pulls: vec![DVec3::ZERO; m],
            prefix: Vec::new(),
            slot_bounds: slot_bounds(layout),
            rhs: vec![Quad::ZERO; n],
            terms: vec![[0.0; 2]; n],
            energies: vec![0.0; n],
            frames: Vec::with_capacity(layout.component.iter().max().map_or(0, |&last| last as usize + 1)),
            partial: vec![0.0; n.max(m).div_ceil(CHUNK)],
        }
    }

    /// Reserves what these rings need; r = 1 everywhere needs no prefix sums.
    pub(crate) fn fit(&mut self, layout: &Layout, rings: &Rings) {
        let n_slots = if rings.neighborhoods.has_runs() { layout.n_edges() + layout.n_blocks() } else { 0 };
        self.prefix.resize(n_slots, DMat3::ZERO);
    }

    /// b − A p' into `rhs`: minus half the gradient of E for the given R, 0 at fixed vertices.
    pub(crate) fn gradient(&mut self, layout: &Layout, rings: &Rings, is_fixed: &[bool], pose: &Pose) {
        let r = &rings.neighborhoods.r[..];
        let now = (&pose.positions[..], &pose.rotations[..]);
        edge_pulls(layout, (&rings.transpose, r), &rings.stiffness, now, &mut self.pulls);
        vertex_pulls(layout, is_fixed, &self.pulls, &mut self.rhs);
    }

    /// Given R, the p' of least energy (3.2.1): solves for the correction, p' ← p' + A⁻¹ (b − A p'), so that rounding of
    /// one solve is mended by the next and distance from the origin costs nothing.
    pub(crate) fn global(
        &mut self,
        layout: &Layout,
        rings: &Rings,
        system: &mut System,
        is_fixed: &[bool],
        pose: &mut Pose,
    ) {
        self.gradient(layout, rings, is_fixed, pose);
        system.solve_in_place(&mut self.rhs);
        let corrections = &self.rhs;
        chunks(&mut pose.positions, |first, positions| {
            for (i, p) in (first..).zip(positions).filter(|(i, _)| !is_fixed[*i]) {
                *p += corrections[i].xyz();
            }
        });
    }

    /// Given p', the R of least energy (3.2.2).
    pub(crate) fn local(&mut self, layout: &Layout, rings: &Rings, pose: &mut Pose, ties: Ties) -> LocalOutcome {
        let Workspace { edge_now, prefix, slot_bounds, partial, .. } = self;
        let scale = edge_vectors(layout, &rings.stiffness, &pose.positions, edge_now, partial);
        let noise = noise_of(layout, rings, (&pose.positions, edge_now), scale);
        if !prefix.is_empty() {
            prefix_sums(layout, slot_bounds, edge_now, prefix);
        }
        let gain = chunks_summed(&mut pose.rotations, &mut pose.turns, partial, |first, rotations, turns| {
            let mut gain = 0.0;
            for (k, (rotation, turn)) in (first..).zip(rotations.iter_mut().zip(turns)) {
                let t = neighborhood_sum(layout, &rings.neighborhoods, edge_now, prefix, k);
                *turn = best_rotation(t, *turn, ties);
                *rotation = DMat3::from_quat(*turn);
                gain += inner(*rotation, t);
            }
            gain
        });
        let mut energy = scale - 2.0 * gain;
        if energy.abs() < DIRECT_BELOW * scale.abs() {
            energy = self.small_energy(layout, rings, pose, noise);
        }
        LocalOutcome { energy, noise }
    }

    /// Eq. (1) where the difference of large sums says too little; `edge_now` are those of the pose.
    fn small_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose, noise: Noise) -> f64 {
        if rings.moments.is_empty() {
            return self.direct_energy(layout, rings, pose);
        }
        let (energy, size) = self.framed_energy(layout, rings, pose);
        // What will count as 0 needs no digits.
        let uncertain = DIRECT_BELOW * size;
        if energy.abs() >= uncertain || uncertain <= noise.floor() {
            energy
        } else {
            self.direct_energy(layout, rings, pose)
        }
    }

    /// Eq. (1) seen from the frames of the components, and the sum of what was added up. Overwrites `edge_now`.
    fn framed_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose) -> (f64, f64) {
        let Workspace { edge_now, prefix, slot_bounds, frames, terms, partial, .. } = self;
        component_frames(&layout.component, &pose.turns, frames);
        let strained = edge_deviations(layout, &rings.stiffness, frames, edge_now, partial);
        if !prefix.is_empty() {
            prefix_sums(layout, slot_bounds, edge_now, prefix);
        }
        chunks(terms, |first, terms| {
            for (k, terms) in (first..).zip(terms) {
                let u = neighborhood_sum(layout, &rings.neighborhoods, edge_now, prefix, k);
                let frame = frames[layout.component[k] as usize];
                *terms = framed_terms(frame, pose.turns[k], rings.moments[k], u);
            }
        });
        let mut sums = [strained, strained.abs()];
        for chunk in terms.chunks(CHUNK) {
            sums[0] += chunk.iter().map(|[a, b]| a + b).sum::<f64>();
            sums[1] += chunk.iter().map(|[a, b]| a.abs() + b.abs()).sum::<f64>();
        }
        (sums[0], sums[1])
    }

    /// Eq. (1) summed square by square.
    pub(crate) fn direct_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose) -> f64 {
        let now = (&pose.positions[..], &pose.rotations[..]);
        vertex_energies(layout, &rings.neighborhoods, now, &mut self.energies);
        self.energies.chunks(CHUNK).map(|chunk| chunk.iter().sum::<f64>()).sum()
    }
}
