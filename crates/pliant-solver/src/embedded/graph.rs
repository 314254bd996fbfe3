//! The deformation graph: nodes on the surface, which nodes carry which vertex, and which nodes are linked.
//!
//! A vertex is carried by the k nodes nearest to it in a straight line, out of those that are near along the surface: the
//! surface is divided into cells, one around every node, by distances along edges, and a vertex looks at the nodes of its
//! own cell, of those around it, and of those around them. So two limbs side by side are not tied together, which is
//! where this differs from the paper, and neither are two components.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::RangeInclusive;

use glam::DVec3;
use rayon::prelude::*;

use super::sampling::farthest_points;
use crate::Analysis;
use crate::analysis::Layout;
use crate::kernels::parallel::{CHUNK, on_pool};

/// Steps from cell to cell within which nodes are looked at: there are some 18 nodes within two.
const STEPS: usize = 2;
/// The most nodes that may carry a vertex.
const MOST_NEIGHBORS: usize = *DeformationGraph::NEIGHBORS.end();

/// Nodes, what they carry and how they are linked: depends on the mesh alone, and can be shared.
pub struct DeformationGraph {
    /// Internal numbers of the vertices that are nodes.
    pub(super) nodes: Vec<u32>,
    /// Nodes that carry one vertex.
    pub(super) k: usize,
    /// Vertex v (the caller's) is carried by `carriers[k v..k (v + 1)]` with `weights` whose sum is 1.
    pub(super) carriers: Vec<u32>,
    pub(super) weights: Vec<f64>,
    /// Pairs (lower, upper) of nodes that carry a vertex together or have cells side by side, ascending.
    pub(super) links: Vec<[u32; 2]>,
    /// Unit-box coordinates are (p − center) / size.
    pub(super) center: DVec3,
    pub(super) size: f64,
}

impl DeformationGraph {
    /// How many nodes there may be, were it not for more components: with that many, sampling a million vertices takes
    /// half a minute, and a step some seconds.
    pub const NODES: RangeInclusive<usize> = 1..=20_000;
    /// How many nodes may carry a vertex: with one there would be no transition, and more than some change little.
    pub const NEIGHBORS: RangeInclusive<usize> = 2..=16;

    /// `n_nodes` nodes (not more than there are vertices or [`DeformationGraph::NODES`] allows, and at least one for every
    /// component), `k` of which carry a
    /// vertex, brought into [`DeformationGraph::NEIGHBORS`].
    pub fn new(analysis: &Analysis, n_nodes: usize, k: usize) -> DeformationGraph {
        let layout = &analysis.layout;
        let k = k.clamp(*Self::NEIGHBORS.start(), MOST_NEIGHBORS);
        let n_nodes = n_nodes.min(*Self::NODES.end());
        let nodes = on_pool(layout.n_vertices(), || farthest_points(layout, n_nodes));
        let cells = cells(layout, &nodes);
        let pairs = touching(layout, &cells);
        let candidates = candidates(&pairs, nodes.len(), k);
        let n = layout.n_vertices();
        let (mut carriers, mut weights) = (vec![0u32; n * k], vec![0.0; n * k]);
        let pieces = carriers.par_chunks_mut(CHUNK * k).zip(weights.par_chunks_mut(CHUNK * k));
        pieces.enumerate().for_each(|(piece, (carriers, weights))| {
            for (i, (carriers, weights)) in carriers.chunks_exact_mut(k).zip(weights.chunks_exact_mut(k)).enumerate() {
                let v = layout.to_internal[piece * CHUNK + i] as usize;
                let candidates = &candidates[cells[v] as usize];
                let at = |node: u32| layout.rest[nodes[node as usize] as usize].distance(layout.rest[v]);
                carry(candidates.iter().map(|&node| (at(node), node)), carriers, weights);
            }
        });
        let links = links(layout, &pairs, (&carriers, &weights), k);
        let (low, high) = layout.rest.iter().fold((layout.rest[0], layout.rest[0]), |(a, b), &p| (a.min(p), b.max(p)));
        let size = (high - low).max_element();
        let size = if size > 0.0 { size } else { 1.0 };
        DeformationGraph { nodes, k, carriers, weights, links, center: low.midpoint(high), size }
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// The nodes of a vertex of the caller, with their weights.
    pub(super) fn carriers_of(&self, v: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = v * self.k..(v + 1) * self.k;
        self.carriers[range.clone()].iter().copied().zip(self.weights[range].iter().copied())
    }
}

/// For every vertex the node nearest along edges.
fn cells(layout: &Layout, nodes: &[u32]) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut cell = vec![NONE; layout.n_vertices()];
    let mut reached = vec![f64::INFINITY; layout.n_vertices()];
    // Lengths are positive, and their bits ascend with them.
    let mut next: BinaryHeap<Reverse<(u64, u32, u32)>> = BinaryHeap::new();
    for (node, &v) in nodes.iter().enumerate() {
        reached[v as usize] = 0.0;
        next.push(Reverse((0, v, node as u32)));
    }
    while let Some(Reverse((bits, v, node))) = next.pop() {
        let here = f64::from_bits(bits);
        if cell[v as usize] != NONE || here > reached[v as usize] {
            continue;
        }
        cell[v as usize] = node;
        for spoke in layout.spokes(v as usize) {
            let there = here + layout.edge_rest[spoke.edge as usize].length();
            let w = spoke.vertex as usize;
            if cell[w] == NONE && there < reached[w] {
                reached[w] = there;
                next.push(Reverse((there.to_bits(), spoke.vertex, node)));
            }
        }
    }
    cell
}

/// Pairs of cells that an edge joins, both ways around, ascending.
fn touching(layout: &Layout, cells: &[u32]) -> Vec<[u32; 2]> {
    let ends = layout.edges.iter().map(|edge| edge.map(|v| cells[v as usize])).filter(|[a, b]| a != b);
    let mut pairs: Vec<[u32; 2]> = ends.flat_map(|[a, b]| [[a, b], [b, a]]).collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// For every cell the nodes within some steps, itself first; as many steps more as it takes to find k + 1, if there are.
fn candidates(pairs: &[[u32; 2]], n_nodes: usize, k: usize) -> Vec<Vec<u32>> {
    let begin: Vec<usize> = (0..=n_nodes as u32).map(|node| pairs.partition_point(|pair| pair[0] < node)).collect();
    let around = |node: u32| &pairs[begin[node as usize]..begin[node as usize + 1]];
    let mut seen = vec![u32::MAX; n_nodes];
    (0..n_nodes as u32)
        .map(|node| {
            seen[node as usize] = node;
            let mut found = vec![node];
            let (mut from, mut steps) = (0, 0);
            while from < found.len() && (steps < STEPS || found.len() <= k) {
                let to = found.len();
                for at in from..to {
                    for &[_, other] in around(found[at]) {
                        if seen[other as usize] != node {
                            seen[other as usize] = node;
                            found.push(other);
                        }
                    }
                }
                (from, steps) = (to, steps + 1);
            }
            found
        })
        .collect()
}

/// The nearest of some nodes and their weights (1 − d / d_max)², d_max being the distance of the next nearest after them.
/// Where there are no more nodes, d_max is twice the distance of the farthest. Places left over have no weight.
fn carry(candidates: impl Iterator<Item = (f64, u32)>, carriers: &mut [u32], weights: &mut [f64]) {
    let k = carriers.len();
    let mut nearest = [(f64::INFINITY, u32::MAX); MOST_NEIGHBORS + 1];
    let nearest = &mut nearest[..=k];
    for candidate in candidates {
        if candidate < nearest[k] {
            let place = nearest.partition_point(|other| *other < candidate);
            nearest[place..].rotate_right(1);
            nearest[place] = candidate;
        }
    }
    let n = nearest[..k].iter().filter(|node| node.1 != u32::MAX).count();
    let d_max = if nearest[k].1 == u32::MAX { 2.0 * nearest[n - 1].0 } else { nearest[k].0 };
    let mut sum = 0.0;
    for (i, (carrier, weight)) in carriers.iter_mut().zip(weights.iter_mut()).enumerate() {
        (*carrier, *weight) = (nearest[0].1, 0.0);
        if i < n {
            let (d, node) = nearest[i];
            *carrier = node;
            *weight = if d_max > 0.0 { (1.0 - d / d_max).powi(2) } else { 0.0 };
            sum += *weight;
        }
    }
    // All are equally far: none is nearer than the next.
    let equal = 1.0 / n as f64;
    weights[..n].iter_mut().for_each(|weight| *weight = if sum > 0.0 { *weight / sum } else { equal });
}

/// Nodes that carry a vertex together, and those of cells side by side, so that no part of a component comes loose.
fn links(layout: &Layout, pairs: &[[u32; 2]], (carriers, weights): (&[u32], &[f64]), k: usize) -> Vec<[u32; 2]> {
    let mut links: Vec<[u32; 2]> = pairs.iter().copied().filter(|[a, b]| a < b).collect();
    let mut last: &[u32] = &[];
    // Along the curve neighbors follow one another, and mostly have the same nodes.
    for &v in &layout.to_caller {
        let range = v as usize * k..(v as usize + 1) * k;
        let (nodes, weights) = (&carriers[range.clone()], &weights[range]);
        if nodes == last {
            continue;
        }
        last = if weights.iter().all(|&weight| weight > 0.0) { nodes } else { &[] };
        let used = || nodes.iter().zip(weights).filter(|(_, weight)| **weight > 0.0).map(|(&node, _)| node);
        links.extend(used().flat_map(|a| used().filter(move |&b| a < b).map(move |b| [a, b])));
    }
    links.sort_unstable();
    links.dedup();
    links
}
