//! The three big sums of an iteration, each costing the perimeter of the neighborhoods rather than their area.
//!
//! | symbol | shape | meaning |
//! |---|---|---|
//! | e, e' | 3 per edge | p_i − p_j at rest and now |
//! | P | 3 × 3 per slot | sum of w e' eᵀ over the edges of the block before the slot |
//! | T_k = S_kᵀ | 3 × 3 per vertex | Σ_{e ∈ N(k)} w_e e' eᵀ, as differences of P |
//! | Q_e | 3 × 3 per edge | Σ_k M_ke R_k, as a running sum |
//! | f_e | 3 per edge | w_e (Q_e e − d_e e'), the pull of an edge on its ends |

use glam::{DMat3, DQuat, DVec3};

use crate::analysis::Layout;
use crate::neighborhoods::Neighborhoods;
use crate::parallel::{chunks, chunks_summed, pieces};
use crate::quad::Quad;
use crate::transpose::Transpose;

/// e' of every edge; returns Σ_e d_e w_e (‖e'‖² + ‖e‖²).
pub(crate) fn edge_vectors(
    layout: &Layout,
    stiffness: &[f64],
    positions: &[DVec3],
    edge_now: &mut [DVec3],
    partial: &mut [f64],
) -> f64 {
    // A list of nothing stands in for the second output that is not needed here.
    let mut none = vec![(); edge_now.len()];
    chunks_summed(edge_now, &mut none, partial, |first, now, _| {
        let mut sum = 0.0;
        for (e, now) in (first..).zip(now) {
            let [i, j] = layout.edges[e];
            *now = positions[i as usize] - positions[j as usize];
            sum += stiffness[e] * (now.length_squared() + layout.edge_rest[e].length_squared());
        }
        sum
    })
}

/// δ_e = Fᵀe' − e in the place of e', with F the frame of the component; returns Σ_e d_e w_e ‖δ_e‖².
pub(crate) fn edge_deviations(
    layout: &Layout,
    stiffness: &[f64],
    frames: &[DQuat],
    edge_now: &mut [DVec3],
    partial: &mut [f64],
) -> f64 {
    let mut none = vec![(); edge_now.len()];
    chunks_summed(edge_now, &mut none, partial, |first, now, _| {
        let mut sum = 0.0;
        for (e, now) in (first..).zip(now) {
            let frame = frames[layout.component[layout.edges[e][0] as usize] as usize];
            *now = frame.conjugate() * *now - layout.edge_rest[e];
            sum += stiffness[e] * now.length_squared();
        }
        sum
    })
}

/// The prefix sums P. `bounds` are the first slots of the blocks.
pub(crate) fn prefix_sums(layout: &Layout, bounds: &[u32], edge_now: &[DVec3], prefix: &mut [DMat3]) {
    pieces(bounds, prefix, &|block, slots| {
        let mut running = DMat3::ZERO;
        slots[0] = running;
        let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
        for (e, slot) in edges.zip(&mut slots[1..]) {
            running += outer(edge_now[e], layout.edge_rest[e] * layout.weight[e]);
            *slot = running;
        }
    });
}

/// T_k of one vertex.
pub(crate) fn neighborhood_sum(
    layout: &Layout,
    neighborhoods: &Neighborhoods,
    edge_now: &[DVec3],
    prefix: &[DMat3],
    k: usize,
) -> DMat3 {
    let mut t = DMat3::ZERO;
    if neighborhoods.r[k] == 1 {
        for spoke in layout.spokes(k) {
            let e = spoke.edge as usize;
            t += outer(edge_now[e], layout.edge_rest[e] * layout.weight[e]);
        }
    } else {
        for &[from, to] in neighborhoods.runs(k) {
            t += prefix[to as usize] - prefix[from as usize];
        }
    }
    t
}

/// f_e = w_e (Q_e e − d_e e') of every edge.
pub(crate) fn edge_pulls(
    layout: &Layout,
    (transpose, r): (&Transpose, &[u16]),
    stiffness: &[f64],
    (positions, rotations): (&[DVec3], &[DMat3]),
    pulls: &mut [DVec3],
) {
    pieces(&layout.blocks, pulls, &|block, pulls| {
        let mut running = DMat3::ZERO;
        for (e, pull) in (layout.blocks[block] as usize..).zip(pulls) {
            if !transpose.is_empty() {
                transpose.at(e + block, |k, plus| {
                    if plus {
                        running += rotations[k];
                    } else {
                        running -= rotations[k];
                    }
                });
            }
            let [i, j] = layout.edges[e].map(|end| end as usize);
            let mut q = running;
            if r[i] == 1 {
                q += rotations[i];
            }
            if r[j] == 1 {
                q += rotations[j];
            }
            *pull = q * layout.edge_rest[e] * layout.weight[e] - (positions[i] - positions[j]) * stiffness[e];
        }
    });
}

/// Sums the pulls at every free vertex: b − A p', which is minus half the gradient of the energy.
pub(crate) fn vertex_pulls(layout: &Layout, is_fixed: &[bool], pulls: &[DVec3], out: &mut [Quad]) {
    chunks(out, |first, out| {
        for (i, out) in (first..).zip(out) {
            let mut sum = DVec3::ZERO;
            if !is_fixed[i] {
                for spoke in layout.spokes(i) {
                    let pull = pulls[spoke.edge as usize];
                    if (i as u32) < spoke.vertex { sum += pull } else { sum -= pull }
                }
            }
            *out = sum.into();
        }
    });
}

/// ⟨A, B⟩, the sum of products entry by entry.
#[inline]
pub(crate) fn inner(a: DMat3, b: DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}

/// a bᵀ.
#[inline]
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
