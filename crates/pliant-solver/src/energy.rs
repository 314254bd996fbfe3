//! The energy of eq. (1), with the digits that remain when it is small.
//!
//! The sums of an iteration give it for free: E = Σ_e d_e w_e (‖e'‖² + ‖e‖²) − 2 Σ_k tr(R_k S_k). But that is a small
//! difference of large sums as soon as the surface is hardly strained. Below a fraction of the first sum it is
//! therefore summed directly, one square at a time, at the cost of one pass over all neighborhoods.

use glam::{DMat3, DVec3};

use crate::analysis::Layout;
use crate::neighborhoods::Neighborhoods;
use crate::parallel::chunks;

/// Below this fraction of Σ d w (‖e'‖² + ‖e‖²) the difference keeps less than nine digits: it loses seven of the
/// sixteen, and the sums themselves are good to fifteen or so.
pub(crate) const DIRECT_BELOW: f64 = 1e-6;
/// Below this many unit roundoffs of the same sum the energy is that of rounded coordinates, and counts as 0: a strain
/// of 6e-8.
pub(crate) const ZERO_BELOW: f64 = 16.0 * f64::EPSILON;
/// A rise of up to this many unit roundoffs of the same sum is rounding, not a rise.
pub(crate) const NOISE: f64 = 64.0 * f64::EPSILON;

/// E_k of every vertex, summed directly; raw weights may make it negative.
pub(crate) fn vertex_energies(
    layout: &Layout,
    neighborhoods: &Neighborhoods,
    (positions, rotations): (&[DVec3], &[DMat3]),
    out: &mut [f64],
) {
    chunks(out, |first, out| {
        for (k, out) in (first..).zip(out) {
            let rotation = rotations[k];
            let mut sum = 0.0;
            neighborhoods.for_each_edge(layout, k, |e| {
                let [i, j] = layout.edges[e];
                let now = positions[i as usize] - positions[j as usize];
                sum += layout.weight[e] * (now - rotation * layout.edge_rest[e]).length_squared();
            });
            *out = sum;
        }
    });
}
