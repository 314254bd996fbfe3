//! C_k = Σ_{e ∈ N(k)} w_e e eᵀ, for energies that are small (see [`energy`](crate::kernels::energy)): by prefix sums as all sums
//! over neighborhoods, of the six different numbers of a symmetric matrix.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use crate::analysis::Layout;
use crate::rings::neighborhoods::{Neighborhoods, block_of_slot};

/// xx, xy, xz, yy, yz, zz.
type Symmetric = [f64; 6];

/// C_k of every vertex.
pub(crate) fn moments(layout: &Layout, neighborhoods: &Neighborhoods) -> Vec<DMat3> {
    let mut prefix = empty_prefix(layout, neighborhoods);
    if neighborhoods.has_runs() {
        let bounds = layout.slot_bounds();
        let mut rest = &mut prefix[..];
        let mut blocks = Vec::with_capacity(layout.n_blocks());
        for block in 0..layout.n_blocks() {
            let (slots, others) = rest.split_at_mut((bounds[block + 1] - bounds[block]) as usize);
            blocks.push(slots);
            rest = others;
        }
        blocks.par_iter_mut().enumerate().for_each(|(block, slots)| sum_block(layout, block, slots));
    }
    (0..layout.n_vertices()).into_par_iter().map(|k| moment_of(layout, neighborhoods, &prefix, k)).collect()
}

/// C_k of a few vertices: sums only the blocks that they need.
pub(crate) fn update_moments(layout: &Layout, neighborhoods: &Neighborhoods, vertices: &[u32], moments: &mut [DMat3]) {
    let mut is_needed = vec![false; layout.n_blocks()];
    for &k in vertices {
        for &[from, _] in neighborhoods.runs(k as usize) {
            is_needed[block_of_slot(layout, from)] = true;
        }
    }
    let bounds = layout.slot_bounds();
    // The system hands out zeros page by page, when they are first touched.
    let mut prefix = empty_prefix(layout, neighborhoods);
    for block in (0..layout.n_blocks()).filter(|&block| is_needed[block]) {
        sum_block(layout, block, &mut prefix[bounds[block] as usize..bounds[block + 1] as usize]);
    }
    let fresh: Vec<DMat3> =
        vertices.par_iter().map(|&k| moment_of(layout, neighborhoods, &prefix, k as usize)).collect();
    for (&k, moment) in vertices.iter().zip(fresh) {
        moments[k as usize] = moment;
    }
}

fn empty_prefix(layout: &Layout, neighborhoods: &Neighborhoods) -> Vec<Symmetric> {
    let n_slots = if neighborhoods.has_runs() { layout.n_edges() + layout.n_blocks() } else { 0 };
    vec![[0.0; 6]; n_slots]
}

/// Running sums of a block of edges; the first slot stays 0.
fn sum_block(layout: &Layout, block: usize, slots: &mut [Symmetric]) {
    let mut running = [0.0; 6];
    let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
    for (e, slot) in edges.zip(&mut slots[1..]) {
        running = plus(running, moment_of_edge(layout, e));
        *slot = running;
    }
}

fn moment_of(layout: &Layout, neighborhoods: &Neighborhoods, prefix: &[Symmetric], k: usize) -> DMat3 {
    let mut sum = [0.0; 6];
    if neighborhoods.r[k] == 1 {
        for spoke in layout.spokes(k) {
            sum = plus(sum, moment_of_edge(layout, spoke.edge as usize));
        }
    }
    for &[from, to] in neighborhoods.runs(k) {
        let (before, after) = (prefix[from as usize], prefix[to as usize]);
        sum = std::array::from_fn(|i| sum[i] + (after[i] - before[i]));
    }
    let [xx, xy, xz, yy, yz, zz] = sum;
    DMat3::from_cols(DVec3::new(xx, xy, xz), DVec3::new(xy, yy, yz), DVec3::new(xz, yz, zz))
}

fn moment_of_edge(layout: &Layout, e: usize) -> Symmetric {
    let (rest, w) = (layout.edge_rest[e], layout.weight[e]);
    let weighed = rest * w;
    [
        weighed.x * rest.x,
        weighed.x * rest.y,
        weighed.x * rest.z,
        weighed.y * rest.y,
        weighed.y * rest.z,
        weighed.z * rest.z,
    ]
}

fn plus(a: Symmetric, b: Symmetric) -> Symmetric {
    std::array::from_fn(|i| a[i] + b[i])
}
