//! The neighborhoods of a solver with all that depends on them alone.

use glam::DMat3;

use crate::analysis::Layout;
use crate::energy::FEW_EDGES;
use crate::neighborhoods::Neighborhoods;
use crate::nines::Nines;
use crate::parallel::chunks;
use crate::sums::{Computed, neighborhood_sum, prefix_sums};
use crate::transpose::Transpose;

/// What the sums run over: r-rings, their transpose, and what depends on them alone.
pub(crate) struct Rings {
    pub(crate) neighborhoods: Neighborhoods,
    pub(crate) transpose: Transpose,
    /// d_e w_e.
    pub(crate) stiffness: Vec<f64>,
    /// Σ |d_e w_e|.
    pub(crate) total_stiffness: f64,
    /// Whether any weight is negative, as raw ones may be.
    pub(crate) has_negative: bool,
    /// C_k = Σ_{e ∈ N(k)} w_e e eᵀ; empty where a small energy is summed directly.
    pub(crate) moments: Vec<DMat3>,
}

impl Rings {
    pub(crate) fn new(layout: &Layout, neighborhoods: Neighborhoods) -> Rings {
        let transpose = Transpose::new(layout, &neighborhoods);
        let counts = transpose.counts(layout, &neighborhoods.r);
        let stiffness: Vec<f64> = counts.iter().zip(&layout.weight).map(|(d, w)| d * w).collect();
        let is_large = counts.iter().sum::<f64>() > FEW_EDGES * layout.n_edges() as f64;
        let moments = if is_large { moments(layout, &neighborhoods, &stiffness) } else { Vec::new() };
        let total_stiffness = stiffness.iter().map(|s| s.abs()).sum();
        let has_negative = stiffness.iter().any(|&s| s < 0.0);
        Rings { neighborhoods, transpose, stiffness, total_stiffness, has_negative, moments }
    }
}

fn moments(layout: &Layout, neighborhoods: &Neighborhoods, stiffness: &[f64]) -> Vec<DMat3> {
    let rest = |e: usize| layout.edge_rest[e];
    let mut prefix = Nines::zeros(layout.n_edges() + layout.n_blocks());
    prefix_sums(
        (layout, stiffness),
        Computed(rest),
        &layout.slot_bounds(),
        &mut prefix,
        &mut vec![0.0; layout.n_blocks()],
    );
    let mut moments = vec![DMat3::ZERO; layout.n_vertices()];
    chunks(&mut moments, |first, moments| {
        for (k, moment) in (first..).zip(moments) {
            *moment = neighborhood_sum((layout, neighborhoods), rest, prefix.as_slices(), k);
        }
    });
    moments
}
