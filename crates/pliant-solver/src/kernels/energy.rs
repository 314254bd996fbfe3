//! The energy of eq. (1), with the digits that remain when it is small.
//!
//! The sums of an iteration give it for free: E = Σ_e d_e w_e (‖e'‖² + ‖e‖²) − 2 Σ_k tr(R_k S_k). But that is a small
//! difference of large sums as soon as the surface is hardly strained. Below a fraction of the first sum it is
//! therefore computed anew:
//!
//! - where neighborhoods are few edges, directly, one square at a time;
//! - otherwise seen from frames that turn with the components. With F the frame of a component, δ_e = Fᵀe' − e and
//!   D_k = FᵀR_k − I,
//!
//!   ```text
//!   E = Σ_e d_e w_e ‖δ_e‖² + Σ_k (tr(D_k C_k D_kᵀ) − 2 ⟨D_k, U_k⟩),  C_k = Σ_{e ∈ N(k)} w_e e eᵀ,  U_k = Σ_{e ∈ N(k)} w_e δ_e eᵀ
//!   ```
//!
//!   U_k comes from prefix sums as S_k does, and C_k never changes: the cost is the perimeter of the neighborhoods. Where
//!   little is strained, little is turned against its component, and all terms are about as small as E itself;
//! - directly after all, should they not be.

use glam::{DMat3, DQuat, DVec3, DVec4};

use crate::analysis::Layout;
use crate::kernels::iteration::Pose;
use crate::kernels::parallel::chunks;
use crate::kernels::sums::inner;
use crate::rings::neighborhoods::Neighborhoods;

/// Below this fraction of Σ d w (‖e'‖² + ‖e‖²) the difference keeps less than nine digits: it loses seven of the
/// sixteen, and the sums themselves are good to fifteen or so.
pub(crate) const DIRECT_BELOW: f64 = 1e-6;
/// Below this many unit roundoffs of Σ |d w| (‖e'‖² + ‖e‖²) the energy is that of rounding, and counts as 0: a strain of
/// 6e-8.
const ZERO_BELOW: f64 = 16.0 * f64::EPSILON;
/// A rise of up to this many unit roundoffs of the same sum is rounding, not a rise.
const NOISE: f64 = 64.0 * f64::EPSILON;

/// Edges are off by this many unit roundoffs of the largest coordinate, since their ends are rounded: three coordinates
/// of two ends, half a unit each, now and at rest.
const EDGE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// What of an energy may be rounding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Noise {
    /// Σ |d w| (‖e'‖² + ‖e‖²).
    pub(crate) sums: f64,
    /// Σ |d w| ‖ε‖², with ε the rounding of an edge: what counts far from the origin.
    pub(crate) coordinates: f64,
}

impl Noise {
    pub(crate) fn new(sums: f64, total_stiffness: f64, largest_coordinate: f64) -> Noise {
        let rounding = EDGE_ROUNDING * largest_coordinate;
        Noise { sums, coordinates: total_stiffness * rounding * rounding }
    }

    /// The energy up to which there may be none.
    pub(crate) fn floor(&self) -> f64 {
        ZERO_BELOW * self.sums + self.coordinates
    }

    /// By how much a given energy may seem to rise. Edges that are off by ε change ‖x‖² by 2 x·ε + ‖ε‖².
    pub(crate) fn rise(&self, energy: f64) -> f64 {
        NOISE * self.sums + 2.0 * (energy.abs() * self.coordinates).sqrt() + self.coordinates
    }
}

/// Neighborhoods of up to this many edges per edge of the mesh are summed directly as fast as from frames (r = 1 has 2,
/// r = 2 about 10).
pub(crate) const FEW_EDGES: f64 = 8.0;

/// E_k of every vertex, summed directly; raw weights may make it negative.
pub(crate) fn vertex_energies(layout: &Layout, neighborhoods: &Neighborhoods, pose: &Pose, out: &mut [f64]) {
    chunks(out, |first, out| {
        for (k, out) in (first..).zip(out) {
            let rotation = pose.rotation(k);
            let mut sum = 0.0;
            neighborhoods.for_each_edge(layout, k, |e| {
                let [i, j] = layout.edges[e];
                let now = pose.positions[i as usize] - pose.positions[j as usize];
                sum += layout.weight[e] * (now - rotation * layout.edge_rest[e]).length_squared();
            });
            *out = sum;
        }
    });
}

/// The frame of each component: the mean of its rotations.
pub(crate) fn component_frames(component: &[u32], turns: &[DQuat], frames: &mut Vec<DQuat>) {
    frames.clear();
    let mut first = 0;
    for members in component.chunk_by(|a, b| a == b) {
        let here = &turns[first..first + members.len()];
        first += members.len();
        // q and −q are the same rotation.
        let sum = here.iter().fold(DVec4::ZERO, |sum, &q| sum + DVec4::from(q) * q.dot(here[0]).signum());
        frames.push(sum.try_normalize().map_or(here[0], DQuat::from_vec4));
    }
}

/// The terms of vertex k: tr(D C Dᵀ) and −2 ⟨D, U⟩.
pub(crate) fn framed_terms(frame: DQuat, turn: DQuat, moment: DMat3, u: DMat3) -> [f64; 2] {
    let d = turn_less_identity(frame.conjugate() * turn);
    [inner(d * moment, d), -2.0 * inner(d, u)]
}

/// `R − I = 2 (w [v] + [v]²)`, which keeps its digits for the smallest turns.
fn turn_less_identity(q: DQuat) -> DMat3 {
    let v = DVec3::new(q.x, q.y, q.z);
    let cross = DMat3::from_cols(DVec3::new(0.0, v.z, -v.y), DVec3::new(-v.z, 0.0, v.x), DVec3::new(v.y, -v.x, 0.0));
    (cross * q.w + cross * cross) * 2.0
}
