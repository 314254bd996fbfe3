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
//! Loops are compiled for several processors, and the best form for the one at hand is taken ([`dispatch`]).

use glam::{DMat3, DVec3};

use crate::analysis::Layout;
use crate::analysis::stars::Flat;
use crate::kernels::nines::{Eight, Nine, Nines, NinesRef};
use crate::kernels::parallel::{chunks, pieces, pieces_with};
use crate::kernels::quad::Quad;
use crate::kernels::wide::{Kernel, Wide, dispatch};
use crate::rings::neighborhoods::Neighborhoods;
use crate::rings::transpose::{GROUP, GroupSums, Transpose};

/// A vector per edge.
pub(crate) trait EdgeVectors: Copy + Sync {
    /// The vector of edge `e`, and a fourth number that means nothing.
    fn get<W: Wide>(self, wide: W, e: usize) -> W::Four;
}

/// e'.
#[derive(Clone, Copy)]
pub(crate) struct Now<'a> {
    pub(crate) layout: &'a Layout,
    pub(crate) positions: Flat<'a>,
    /// Those of the layout: not to be looked up there for every edge.
    edges: &'a [[u32; 2]],
}

impl<'a> Now<'a> {
    pub(crate) fn new(layout: &'a Layout, positions: &'a [DVec3]) -> Now<'a> {
        Now { layout, positions: Flat::new(positions), edges: &layout.edges }
    }

    pub(crate) fn vector(self, e: usize) -> DVec3 {
        let [a, b] = self.edges[e].map(|end| self.positions.vector(end as usize));
        a - b
    }
}

impl EdgeVectors for Now<'_> {
    #[inline(always)]
    fn get<W: Wide>(self, wide: W, e: usize) -> W::Four {
        let [i, j] = self.edges[e];
        wide.sub4(self.positions.get(wide, i as usize), self.positions.get(wide, j as usize))
    }
}

/// Whatever a function says.
#[derive(Clone, Copy)]
pub(crate) struct Computed<F>(pub(crate) F);

impl<F: Fn(usize) -> DVec3 + Copy + Sync> EdgeVectors for Computed<F> {
    #[inline(always)]
    fn get<W: Wide>(self, wide: W, e: usize) -> W::Four {
        let DVec3 { x, y, z } = (self.0)(e);
        wide.four([x, y, z, 0.0])
    }
}

/// The prefix sums P for any vectors v_e instead of e'; `bounds` are the first slots of the blocks. Returns
/// Σ_e d_e w_e ‖v_e‖², for which `partial` must have an entry per block.
pub(crate) fn prefix_sums(
    (layout, stiffness): (&Layout, &[f64]),
    vectors: impl EdgeVectors,
    bounds: &[u32],
    prefix: &mut Nines,
    partial: &mut [f64],
) -> f64 {
    let slots = (&mut prefix.eights[..], &mut prefix.ninths[..]);
    pieces_with(bounds, slots, partial, |block, (eights, ninths)| {
        dispatch(PrefixBlock { layout, stiffness, vectors, block, eights, ninths })
    });
    partial[..layout.n_blocks()].iter().sum()
}

/// P of one block.
struct PrefixBlock<'a, V> {
    layout: &'a Layout,
    stiffness: &'a [f64],
    vectors: V,
    block: usize,
    eights: &'a mut [Eight],
    ninths: &'a mut [f64],
}

impl<V: EdgeVectors> Kernel for PrefixBlock<'_, V> {
    type Output = f64;

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) -> f64 {
        let PrefixBlock { layout, stiffness, vectors, block, eights, ninths } = self;
        let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
        let (mut running, mut last, mut squares) = (wide.eight([0.0; 8]), wide.splat4(0.0), wide.splat4(0.0));
        (eights[0], ninths[0]) = (Eight::ZERO, 0.0);
        let slots = eights[1..].iter_mut().zip(&mut ninths[1..]);
        let constants = layout.stars.edges[edges.clone()].iter().zip(&stiffness[edges.clone()]);
        for ((e, (eight, ninth)), (&Quad(rest), &s)) in edges.zip(slots).zip(constants) {
            let (v, rest) = (vectors.get(wide, e), wide.four(rest));
            running = wide.fma8(wide.rows(v), wide.columns(rest), running);
            last = wide.fma4(v, rest, last);
            squares = wide.fma4(wide.mul4(v, v), wide.splat4(s), squares);
            (*eight, *ninth) = (Eight(wide.array8(running)), wide.array4(last)[2]);
        }
        let [x, y, z, _] = wide.array4(squares);
        x + y + z
    }
}

/// T_k of a vertex with r > 1.
#[inline(always)]
pub(crate) fn run_sum<W: Wide>(
    wide: W,
    neighborhoods: &Neighborhoods,
    prefix: NinesRef<'_>,
    k: usize,
) -> (W::Eight, f64) {
    let prefix = prefix.of_one_length();
    let mut sums = [(wide.eight([0.0; 8]), 0.0); 2];
    let (pairs, last) = neighborhoods.runs(k).as_chunks::<2>();
    for &[one, other] in pairs {
        add_run(wide, &mut sums[0], prefix, one);
        add_run(wide, &mut sums[1], prefix, other);
    }
    for &one in last {
        add_run(wide, &mut sums[0], prefix, one);
    }
    (wide.add8(sums[0].0, sums[1].0), sums[0].1 + sums[1].1)
}

#[inline(always)]
fn add_run<W: Wide>(wide: W, sum: &mut (W::Eight, f64), prefix: NinesRef<'_>, [from, to]: [u32; 2]) {
    let (from, to) = (prefix.get(from as usize), prefix.get(to as usize));
    sum.0 = wide.add8(sum.0, wide.sub8(wide.eight(to.eight.0), wide.eight(from.eight.0)));
    sum.1 += to.ninth - from.ninth;
}

/// T_k of one vertex for any vectors instead of e'.
pub(crate) fn neighborhood_sum(
    (layout, neighborhoods): (&Layout, &Neighborhoods),
    vector: impl Fn(usize) -> DVec3,
    prefix: NinesRef<'_>,
    k: usize,
) -> DMat3 {
    if neighborhoods.r[k] == 1 {
        let edges = layout.spokes(k).iter().map(|spoke| spoke.edge as usize);
        edges.fold(DMat3::ZERO, |sum, e| sum + outer(vector(e), layout.edge_rest[e] * layout.weight[e]))
    } else {
        dispatch(RunSum { neighborhoods, prefix, k })
    }
}

/// T_k by itself.
struct RunSum<'a> {
    neighborhoods: &'a Neighborhoods,
    prefix: NinesRef<'a>,
    k: usize,
}

impl Kernel for RunSum<'_> {
    type Output = DMat3;

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) -> DMat3 {
        let (eight, ninth) = run_sum(wide, self.neighborhoods, self.prefix, self.k);
        Nine { eight: Eight(wide.array8(eight)), ninth }.into()
    }
}

/// f_e of every edge. `r` may be left out where all are larger than 1.
pub(crate) fn edge_pulls(
    (stiffness, r): (&[f64], Option<&[u16]>),
    now: Now<'_>,
    (transpose, rotations): (&Transpose, NinesRef<'_>),
    pulls: &mut [Quad],
) {
    pieces(&now.layout.blocks, pulls, |block, pulls| {
        dispatch(PullBlock { stiffness, r, now, transpose, rotations, block, pulls });
    });
}

/// f_e of one block.
struct PullBlock<'a> {
    stiffness: &'a [f64],
    r: Option<&'a [u16]>,
    now: Now<'a>,
    transpose: &'a Transpose,
    rotations: NinesRef<'a>,
    block: usize,
    pulls: &'a mut [Quad],
}

impl Kernel for PullBlock<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Wide>(mut self, wide: W) {
        let end = self.now.layout.blocks[self.block + 1] as usize + self.block;
        let mut slot = self.now.layout.blocks[self.block] as usize + self.block;
        let mut running = (wide.eight([0.0; 8]), 0.0);
        let mut sums = GroupSums::zeros();
        // Q goes no farther than the first cache.
        while slot < end {
            let next = (slot + 1).next_multiple_of(GROUP).min(end);
            self.transpose.sum(wide, slot..next, self.rotations, &mut running, &mut sums);
            self.pulls(wide, slot, next, &sums);
            slot = next;
        }
    }
}

impl PullBlock<'_> {
    /// f_e of the edges of some slots of one group.
    #[inline(always)]
    fn pulls<W: Wide>(&mut self, wide: W, slot: usize, end: usize, q: &GroupSums) {
        let PullBlock { stiffness, r, now, rotations, block, pulls, .. } = self;
        let (layout, edges) = (now.layout, slot - *block..end - *block);
        let places = slot % GROUP..slot % GROUP + edges.len();
        let first = layout.blocks[*block] as usize;
        let pulls = &mut pulls[edges.start - first..edges.end - first];
        let constants = layout.stars.edges[edges.clone()].iter().zip(&stiffness[edges.clone()]);
        let sums = q.eights[places.clone()].iter().zip(&q.ninths[places]);
        for (((e, pull), (&Eight(eight), &ninth)), (&Quad(rest), &s)) in edges.zip(pulls).zip(sums).zip(constants) {
            let (mut eight, mut ninth) = (wide.eight(eight), ninth);
            if let Some(r) = *r {
                // Not an iterator with closures: it made the whole gradient 6 % slower.
                for end in layout.edges[e] {
                    let end = end as usize;
                    if r[end] == 1 {
                        let own = rotations.get(end);
                        (eight, ninth) = (wide.add8(eight, wide.eight(own.eight.0)), ninth + own.ninth);
                    }
                }
            }
            let rest = wide.four(rest);
            let turned = wide.folded(wide.mul8(eight, wide.columns(rest)), wide.mul4(wide.splat4(ninth), rest));
            let drift = wide.mul4(now.get(wide, e), wide.splat4(s));
            *pull = Quad(wide.array4(wide.sub4(turned, drift)));
        }
    }
}

/// What pulls at a vertex.
pub(crate) trait VertexPull: Copy + Sync {
    /// Three coordinates and a fourth number that means nothing.
    fn get<W: Wide>(self, wide: W, i: usize) -> W::Four;
}

/// b − A p' where r = 1 everywhere.
#[derive(Clone, Copy)]
pub(crate) struct StarPull<'a> {
    pub(crate) now: Now<'a>,
    pub(crate) rotations: NinesRef<'a>,
}

impl VertexPull for StarPull<'_> {
    #[inline(always)]
    fn get<W: Wide>(self, wide: W, i: usize) -> W::Four {
        let layout = self.now.layout;
        layout.stars.pull(wide, (layout, self.now.positions), self.rotations, i)
    }
}

/// b − A p' as the sum of the pulls of edges.
#[derive(Clone, Copy)]
pub(crate) struct GatheredPull<'a> {
    pub(crate) layout: &'a Layout,
    pub(crate) pulls: &'a [Quad],
}

impl VertexPull for GatheredPull<'_> {
    #[inline(always)]
    fn get<W: Wide>(self, wide: W, i: usize) -> W::Four {
        self.layout.stars.gathered(wide, self.layout, self.pulls, i)
    }
}

/// b − A p', which is minus half the gradient of the energy: `pull` of every free vertex, 0 at fixed ones.
pub(crate) fn vertex_pulls(is_fixed: &[bool], pull: impl VertexPull, out: &mut [Quad]) {
    chunks(out, |first, out| dispatch(PullChunk { is_fixed, pull, first, out }));
}

/// b − A p' of consecutive vertices.
struct PullChunk<'a, P> {
    is_fixed: &'a [bool],
    pull: P,
    first: usize,
    out: &'a mut [Quad],
}

impl<P: VertexPull> Kernel for PullChunk<'_, P> {
    type Output = ();

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) {
        let is_fixed = &self.is_fixed[self.first..][..self.out.len()];
        for ((i, out), &is_fixed) in (self.first..).zip(self.out).zip(is_fixed) {
            *out = Quad::ZERO;
            if !is_fixed {
                let [x, y, z, _] = wide.array4(self.pull.get(wide, i));
                *out = Quad([x, y, z, 0.0]);
            }
        }
    }
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
