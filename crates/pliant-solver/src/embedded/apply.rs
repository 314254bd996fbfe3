//! From nodes to vertices: v' = v + Σ_j w_j [(R_j − I) (v − g_j) + t_j], which leaves v as it is to the last bit where
//! nothing moves.

use glam::{DMat3, DVec3};
use pulp::NullaryFnOnce;

use super::affine::{Affine, ZERO, affine};
use super::graph::DeformationGraph;
use crate::kernels::parallel::{chunks, on_pool};

/// (R − I, t − (R − I) g) of every node, on v less the center, in the caller's units.
pub(super) fn displacement(r: DMat3, shift: DVec3, node: DVec3) -> Affine {
    let d = r - DMat3::IDENTITY;
    affine(d, shift - d * node)
}

/// Moves `rest`, in the caller's numbering, into `out`.
pub(super) fn apply(graph: &DeformationGraph, nodes: &[Affine], rest: &[DVec3], out: &mut [DVec3]) {
    on_pool(out.len(), || {
        chunks(out, |first, out| {
            let range = first..first + out.len();
            let places = first * graph.k..range.end * graph.k;
            let (carriers, weights) = (&graph.carriers[places.clone()], &graph.weights[places]);
            let work = Work { k: graph.k, carriers, weights, nodes, center: graph.center, rest: &rest[range], out };
            pulp::Arch::new().dispatch(work);
        });
    });
}

/// A type of its own, since a closure would not be compiled for the vector unit at hand.
struct Work<'a> {
    k: usize,
    carriers: &'a [u32],
    weights: &'a [f64],
    nodes: &'a [Affine],
    center: DVec3,
    rest: &'a [DVec3],
    out: &'a mut [DVec3],
}

impl NullaryFnOnce for Work<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        match self.k {
            4 => self.run::<4>(),
            _ => self.run_any(),
        }
    }
}

impl Work<'_> {
    /// For as many nodes a vertex as is usual.
    #[inline(always)]
    fn run<const K: usize>(self) {
        let Work { carriers, weights, nodes, center, rest, out, .. } = self;
        let vertices = carriers.as_chunks::<K>().0.iter().zip(weights.as_chunks::<K>().0).zip(rest).zip(out);
        for (((carriers, weights), &v), out) in vertices {
            let mut sum = ZERO;
            for (&node, &weight) in carriers.iter().zip(weights) {
                add_weighted(&mut sum, weight, &nodes[node as usize]);
            }
            *out = v + moved(&sum, v - center);
        }
    }

    #[inline(always)]
    fn run_any(self) {
        let Work { k, carriers, weights, nodes, center, rest, out } = self;
        let vertices = carriers.chunks_exact(k).zip(weights.chunks_exact(k)).zip(rest).zip(out);
        for (((carriers, weights), &v), out) in vertices {
            let mut sum = ZERO;
            for (&node, &weight) in carriers.iter().zip(weights) {
                add_weighted(&mut sum, weight, &nodes[node as usize]);
            }
            *out = v + moved(&sum, v - center);
        }
    }
}

#[inline(always)]
fn add_weighted(sum: &mut Affine, weight: f64, node: &Affine) {
    for (sum, row) in sum.iter_mut().zip(node) {
        for (sum, x) in sum.iter_mut().zip(row) {
            *sum += weight * x;
        }
    }
}

#[inline(always)]
fn moved(a: &Affine, v: DVec3) -> DVec3 {
    let row = |c: usize| a[c][0] * v.x + a[c][1] * v.y + (a[c][2] * v.z + a[c][3]);
    DVec3::new(row(0), row(1), row(2))
}
