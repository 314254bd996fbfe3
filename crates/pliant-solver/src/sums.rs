//! The big sums of an iteration where neighborhoods are larger than spokes, each costing the perimeter of the
//! neighborhoods rather than their area.
//!
//! | symbol | shape | meaning |
//! |---|---|---|
//! | e, e' | 3 per edge | p_i − p_j at rest and now |
//! | P | 3 × 3 per slot | sum of w e' eᵀ over the edges of the block before the slot |
//! | T_k = S_kᵀ | 3 × 3 per vertex | Σ_{e ∈ N(k)} w_e e' eᵀ, as differences of P |
//! | Q_e | 3 × 3 per edge | Σ_k M_ke R_k, as a running sum |
//! | f_e | 3 per edge | w_e (Q_e e − d_e e'), the pull of an edge on its ends |
//!
//! Loops are compiled for several processors, and the best for the one at hand is taken; sums are the same in all.

use glam::{DMat3, DVec3};
use pulp::Arch;

use crate::analysis::Layout;
use crate::gathers::Gathers;
use crate::neighborhoods::Neighborhoods;
use crate::nines::{Nine, Nines, NinesRef};
use crate::parallel::{chunks, pieces, pieces_with};
use crate::quad::Quad;
use crate::stars::Flat;

/// e' of an edge.
#[inline(always)]
pub(crate) fn edge_now(layout: &Layout, now: Flat<'_>, e: usize) -> [f64; 4] {
    let [i, j] = layout.edges[e];
    let (a, b) = (now.get(i as usize), now.get(j as usize));
    std::array::from_fn(|c| a[c] - b[c])
}

/// The prefix sums P for any vectors v_e instead of e'; `bounds` are the first slots of the blocks. Returns
/// Σ_e d_e w_e ‖v_e‖², for which `partial` must have an entry per block.
pub(crate) fn prefix_sums(
    (layout, stiffness): (&Layout, &[f64]),
    vector: impl Fn(usize) -> [f64; 4] + Sync,
    bounds: &[u32],
    prefix: &mut Nines,
    partial: &mut [f64],
) -> f64 {
    let slots = (&mut prefix.eights[..], &mut prefix.ninths[..]);
    pieces_with(bounds, slots, partial, |block, (eights, ninths)| {
        Arch::new().dispatch(
            #[inline(always)]
            || {
                let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
                let (mut running, mut squares) = (Nine::ZERO, [0.0; 4]);
                (eights[0], ninths[0]) = (running.eight, running.ninth);
                let slots = eights[1..].iter_mut().zip(&mut ninths[1..]);
                let constants = layout.stars.edges[edges.clone()].iter().zip(&stiffness[edges.clone()]);
                for ((e, (eight, ninth)), (&Quad(rest), &s)) in edges.zip(slots).zip(constants) {
                    let v = vector(e);
                    running = running.plus_outer(v, rest);
                    squares = std::array::from_fn(|c| squares[c] + v[c] * v[c] * s);
                    (*eight, *ninth) = (running.eight, running.ninth);
                }
                squares[0] + squares[1] + squares[2]
            },
        )
    });
    partial[..layout.n_blocks()].iter().sum()
}

#[inline(always)]
fn difference(prefix: NinesRef<'_>, [from, to]: [u32; 2]) -> Nine {
    prefix.get(to as usize).minus(prefix.get(from as usize))
}

/// T_k of a vertex with r > 1.
#[inline(always)]
pub(crate) fn run_sum(neighborhoods: &Neighborhoods, prefix: NinesRef<'_>, k: usize) -> Nine {
    let mut sums = [Nine::ZERO; 2];
    let (pairs, last) = neighborhoods.runs(k).as_chunks::<2>();
    for &[one, other] in pairs {
        sums[0] = sums[0].plus(difference(prefix, one));
        sums[1] = sums[1].plus(difference(prefix, other));
    }
    let mut sum = sums[0].plus(sums[1]);
    for &one in last {
        sum = sum.plus(difference(prefix, one));
    }
    sum
}

/// T_k of one vertex for any vectors instead of e'.
pub(crate) fn neighborhood_sum(
    (layout, neighborhoods): (&Layout, &Neighborhoods),
    vector: impl Fn(usize) -> [f64; 4],
    prefix: NinesRef<'_>,
    k: usize,
) -> DMat3 {
    if neighborhoods.r[k] == 1 {
        let edges = layout.spokes(k).iter().map(|spoke| spoke.edge as usize);
        edges.fold(Nine::ZERO, |sum, e| sum.plus_outer(vector(e), layout.stars.edges[e].0)).into()
    } else {
        run_sum(neighborhoods, prefix, k).into()
    }
}

/// f_e of every edge. Q is written to the slots of the prefix sums.
pub(crate) fn edge_pulls(
    (layout, stiffness): (&Layout, &[f64]),
    (gathers, r): (&Gathers, &[u16]),
    (now, rotations): (Flat<'_>, NinesRef<'_>),
    pulls: &mut [Quad],
    q: &mut Nines,
) {
    let m = pulls.len();
    let q = (&mut q.eights[..m], &mut q.ninths[..m]);
    pieces(&layout.blocks, (pulls, q.0, q.1), |block, (pulls, eights, ninths)| {
        Arch::new().dispatch(
            #[inline(always)]
            || {
                gathers.sum(block, rotations, (eights, ninths));
                let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
                let constants = layout.stars.edges[edges.clone()].iter().zip(&stiffness[edges.clone()]);
                let sums = eights.iter().zip(ninths.iter());
                for (((e, pull), (&eight, &ninth)), (&Quad(rest), &s)) in edges.zip(pulls).zip(sums).zip(constants) {
                    let mut q = Nine { eight, ninth };
                    for end in layout.edges[e].map(|end| end as usize) {
                        if r[end] == 1 {
                            q = q.plus(rotations.get(end));
                        }
                    }
                    let edge = edge_now(layout, now, e);
                    let DVec3 { x, y, z } = Nine::ZERO.plus_product(q, rest).folded();
                    *pull = Quad([x - edge[0] * s, y - edge[1] * s, z - edge[2] * s, 0.0]);
                }
            },
        );
    });
}

/// b − A p', which is minus half the gradient of the energy: `pull` of every free vertex, 0 at fixed ones.
pub(crate) fn vertex_pulls(is_fixed: &[bool], out: &mut [Quad], pull: impl Fn(usize) -> Quad + Sync) {
    chunks(out, |first, out| {
        Arch::new().dispatch(
            #[inline(always)]
            || {
                for (i, out) in (first..).zip(out) {
                    *out = if is_fixed[i] { Quad::ZERO } else { pull(i) };
                }
            },
        );
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
