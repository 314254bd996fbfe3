//! The two half steps on plain arrays: the memory they work in, and their order of sums.

use glam::{DMat3, DQuat, DVec3};

use crate::analysis::Layout;
use crate::energy::{DIRECT_BELOW, vertex_energies};
use crate::neighborhoods::Neighborhoods;
use crate::parallel::{CHUNK, chunks, chunks_summed};
use crate::rotations::{Ties, best_rotation};
use crate::sums::{edge_pulls, edge_vectors, neighborhood_sum, prefix_sums, vertex_pulls};
use crate::system::System;
use crate::transpose::Transpose;

/// p' and R of every vertex, internal numbering.
#[derive(Clone)]
pub(crate) struct Pose {
    pub(crate) positions: Vec<DVec3>,
    /// R_k as matrices, kept equal to `turns`.
    pub(crate) rotations: Vec<DMat3>,
    /// R_k as unit quaternions.
    pub(crate) turns: Vec<DQuat>,
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

/// What the sums run over: r-rings, their transpose, and d w.
pub(crate) struct Rings {
    pub(crate) neighborhoods: Neighborhoods,
    pub(crate) transpose: Transpose,
    /// d_e w_e.
    pub(crate) stiffness: Vec<f64>,
}

impl Rings {
    pub(crate) fn new(layout: &Layout, neighborhoods: Neighborhoods) -> Rings {
        let transpose = Transpose::new(layout, &neighborhoods);
        let counts = transpose.counts(layout, &neighborhoods.r);
        let stiffness = counts.iter().zip(&layout.weight).map(|(d, w)| d * w).collect();
        Rings { neighborhoods, transpose, stiffness }
    }
}

/// What a local step found out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalOutcome {
    /// Eq. (1).
    pub(crate) energy: f64,
    /// Σ d w (‖e'‖² + ‖e‖²): what rounding is measured against.
    pub(crate) scale: f64,
}

/// Memory of the half steps, reserved once.
pub(crate) struct Workspace {
    edge_now: Vec<DVec3>,
    pulls: Vec<DVec3>,
    prefix: Vec<DMat3>,
    /// First slot of every block.
    slot_bounds: Vec<u32>,
    vertex_pulls: Vec<DVec3>,
    /// Three columns, x, y, z.
    pub(crate) columns: Vec<f64>,
    energies: Vec<f64>,
    partial: Vec<f64>,
}

impl Workspace {
    pub(crate) fn new(layout: &Layout) -> Workspace {
        let (n, m) = (layout.n_vertices(), layout.n_edges());
        let slot_bounds = layout.blocks.iter().enumerate().map(|(block, &edge)| edge + block as u32).collect();
        Workspace {
            edge_now: vec![DVec3::ZERO; m],
            pulls: vec![DVec3::ZERO; m],
            prefix: Vec::new(),
            slot_bounds,
            vertex_pulls: vec![DVec3::ZERO; n],
            columns: vec![0.0; 3 * n],
            energies: vec![0.0; n],
            partial: vec![0.0; n.max(m).div_ceil(CHUNK)],
        }
    }

    /// Reserves what these rings need; r = 1 everywhere needs no prefix sums.
    pub(crate) fn fit(&mut self, layout: &Layout, rings: &Rings) {
        let n_slots = if rings.neighborhoods.has_runs() { layout.n_edges() + layout.n_blocks() } else { 0 };
        self.prefix.resize(n_slots, DMat3::ZERO);
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
        let r = &rings.neighborhoods.r[..];
        let now = (&pose.positions[..], &pose.rotations[..]);
        edge_pulls(layout, (&rings.transpose, r), &rings.stiffness, now, &mut self.pulls);
        vertex_pulls(layout, is_fixed, &self.pulls, &mut self.vertex_pulls);
        let n = layout.n_vertices();
        let (x, yz) = self.columns.split_at_mut(n);
        let (y, z) = yz.split_at_mut(n);
        for (i, pull) in self.vertex_pulls.iter().enumerate() {
            (x[i], y[i], z[i]) = (pull.x, pull.y, pull.z);
        }
        system.solve_in_place(&mut self.columns);
        let columns = &self.columns;
        chunks(&mut pose.positions, |first, positions| {
            for (i, p) in (first..).zip(positions).filter(|(i, _)| !is_fixed[*i]) {
                *p += DVec3::new(columns[i], columns[n + i], columns[2 * n + i]);
            }
        });
    }

    /// Given p', the R of least energy (3.2.2).
    pub(crate) fn local(&mut self, layout: &Layout, rings: &Rings, pose: &mut Pose, ties: Ties) -> LocalOutcome {
        let Workspace { edge_now, prefix, slot_bounds, partial, .. } = self;
        let scale = edge_vectors(layout, &rings.stiffness, &pose.positions, edge_now, partial);
        if !prefix.is_empty() {
            prefix_sums(layout, slot_bounds, edge_now, prefix);
        }
        let gain = chunks_summed(&mut pose.rotations, &mut pose.turns, partial, |first, rotations, turns| {
            let mut gain = 0.0;
            for (k, (rotation, turn)) in (first..).zip(rotations.iter_mut().zip(turns)) {
                let t = neighborhood_sum(layout, &rings.neighborhoods, edge_now, prefix, k);
                *turn = best_rotation(t, *turn, ties);
                *rotation = DMat3::from_quat(*turn);
                gain += rotation.x_axis.dot(t.x_axis) + rotation.y_axis.dot(t.y_axis) + rotation.z_axis.dot(t.z_axis);
            }
            gain
        });
        let mut energy = scale - 2.0 * gain;
        if energy.abs() < DIRECT_BELOW * scale.abs() {
            energy = self.direct_energy(layout, rings, pose);
        }
        LocalOutcome { energy, scale }
    }

    /// Eq. (1) summed square by square.
    pub(crate) fn direct_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose) -> f64 {
        let now = (&pose.positions[..], &pose.rotations[..]);
        vertex_energies(layout, &rings.neighborhoods, now, &mut self.energies);
        self.energies.chunks(CHUNK).map(|chunk| chunk.iter().sum::<f64>()).sum()
    }
}
