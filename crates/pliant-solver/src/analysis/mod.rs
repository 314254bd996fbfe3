//! What depends on the mesh and the weights alone.
//!
//! Vertices are renumbered along a Hilbert curve and edges along strips of faces, component by component, so that every
//! later pass walks memory nearly in order. Callers never see this numbering: [`Solver`](crate::Solver) translates at its border.

pub(crate) mod defects;
pub(crate) mod edge_order;
pub(crate) mod hilbert;
pub(crate) mod stars;
pub(crate) mod topology;
pub(crate) mod weights;

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::analysis::edge_order::edge_order;
use crate::analysis::hilbert::Curve;
use crate::analysis::stars::Stars;
use crate::analysis::topology::sides_of_faces;
use crate::analysis::weights::edge_weights;
use crate::linear::{Ordered, Pattern};
use crate::{Mesh, Weights};

/// Edges per block of prefix sums. Short enough that a difference of two sums within a block keeps twelve digits of a
/// neighborhood's own sum: rounding of 2048 sums is some 50 unit roundoffs of their last, which is a hundred times a
/// neighborhood of twenty edges. Long enough that few runs are cut: 512 has 3 % more ends of runs at r = 10 and 7 % at
/// r = 20, 8192 has 1 % fewer.
const BLOCK: usize = 2048;

/// Locality (Hilbert) order, edge weights, rest edge vectors, fill-reducing order and symbolic factorization.
/// O(n log n); once per mesh and kind of weights.
pub struct Analysis {
    mesh: Arc<Mesh>,
    weights: Weights,
    pub(crate) layout: Layout,
    pub(crate) pattern: Arc<Pattern>,
    /// Place of each edge's value in the pattern.
    pub(crate) slots: Vec<u32>,
}

/// One edge as seen from one of its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spoke {
    /// The vertex at the other end.
    pub(crate) vertex: u32,
    /// The edge.
    pub(crate) edge: u32,
}

/// The mesh in the internal numbering.
pub(crate) struct Layout {
    /// Internal number of each of the caller's vertices, and back.
    pub(crate) to_internal: Vec<u32>,
    pub(crate) to_caller: Vec<u32>,
    /// Rest positions p.
    pub(crate) rest: Vec<DVec3>,
    /// Component of each vertex, as numbered by the mesh.
    pub(crate) component: Vec<u32>,
    /// Ends (i, j) with i < j.
    pub(crate) edges: Vec<[u32; 2]>,
    /// e = p_i − p_j and w_ij of each edge.
    pub(crate) edge_rest: Vec<DVec3>,
    pub(crate) weight: Vec<f64>,
    /// Spokes of vertex v: `spokes[offsets[v]..offsets[v + 1]]`, by ascending edge.
    pub(crate) offsets: Vec<u32>,
    pub(crate) spokes: Vec<Spoke>,
    /// Block b has edges `blocks[b]..blocks[b + 1]`; no block has edges of two components.
    pub(crate) blocks: Vec<u32>,
    pub(crate) block_of_edge: Vec<u32>,
    /// Constants of spokes and edges.
    pub(crate) stars: Stars,
}

impl Analysis {
    /// Orders, weighs and analyzes. The costly parts are the fill-reducing order and the order of the edges.
    pub fn new(mesh: Arc<Mesh>, weights: Weights) -> Analysis {
        let curve = Curve::around(mesh.positions());
        let numbering = Numbering::new(&mesh, &curve);
        let ends: Vec<[u32; 2]> = mesh.edges().iter().map(|&edge| numbering.ends(edge)).collect();
        let ((ordered, slots), (sides, order)) = rayon::join(
            || Ordered::new(&numbering.rest, &ends),
            || {
                let sides = sides_of_faces(&mesh);
                let order = edge_order(&mesh, &sides, &curve);
                (sides, order)
            },
        );
        // The symbolic factorization is the longest of what has no parallel parts of its own.
        let (pattern, (layout, slots)) = rayon::join(
            || ordered.analyzed(),
            || {
                let mesh_weights = edge_weights(&mesh, &sides, weights);
                let layout = Layout::new(numbering, &order, (&ends, &mesh_weights));
                (layout, order.iter().map(|&e| slots[e as usize]).collect())
            },
        );
        Analysis { mesh, weights, layout, pattern: Arc::new(pattern), slots }
    }

    /// The mesh that was analyzed.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// The kind of weights in use.
    pub fn weights(&self) -> Weights {
        self.weights
    }
}

/// The internal numbering of the vertices: by component, then along the curve, then by number.
struct Numbering {
    to_internal: Vec<u32>,
    to_caller: Vec<u32>,
    rest: Vec<DVec3>,
    component: Vec<u32>,
}

impl Numbering {
    fn new(mesh: &Mesh, curve: &Curve) -> Numbering {
        let along = curve.positions(mesh.n_vertices(), |v| mesh.positions()[v]);
        let mut keyed: Vec<(u32, u64, u32)> =
            (0u32..).zip(mesh.components()).zip(along).map(|((v, &component), along)| (component, along, v)).collect();
        keyed.par_sort_unstable();
        let to_caller: Vec<u32> = keyed.into_iter().map(|key| key.2).collect();
        let mut to_internal = vec![0u32; to_caller.len()];
        for (internal, &caller) in to_caller.iter().enumerate() {
            to_internal[caller as usize] = internal as u32;
        }
        let rest = to_caller.iter().map(|&v| mesh.positions()[v as usize]).collect();
        let component = to_caller.iter().map(|&v| mesh.components()[v as usize]).collect();
        Numbering { to_internal, to_caller, rest, component }
    }

    /// Internal numbers of the ends of an edge, ascending.
    fn ends(&self, edge: [u32; 2]) -> [u32; 2] {
        let [a, b] = edge.map(|v| self.to_internal[v as usize]);
        [a.min(b), a.max(b)]
    }
}

impl Layout {
    /// `order`: the edges of the mesh in the internal order, whose ends and weights are given in that of the mesh.
    fn new(numbering: Numbering, order: &[u32], (ends, weights): (&[[u32; 2]], &[f64])) -> Layout {
        let Numbering { to_internal, to_caller, rest, component } = numbering;
        let edges: Vec<[u32; 2]> = order.iter().map(|&e| ends[e as usize]).collect();
        let weight: Vec<f64> = order.iter().map(|&e| weights[e as usize]).collect();
        let edge_rest: Vec<DVec3> = edges.iter().map(|&[i, j]| rest[i as usize] - rest[j as usize]).collect();
        let (offsets, spokes) = spokes(rest.len(), &edges);
        let (blocks, block_of_edge) = blocks(&edges, &component);
        let stars = Stars::new((&edges, &edge_rest, &weight), &spokes);
        Layout {
            stars,
            to_internal,
            to_caller,
            rest,
            component,
            edges,
            edge_rest,
            weight,
            offsets,
            spokes,
            blocks,
            block_of_edge,
        }
    }

    pub(crate) fn n_vertices(&self) -> usize {
        self.rest.len()
    }

    pub(crate) fn n_edges(&self) -> usize {
        self.edges.len()
    }

    pub(crate) fn n_blocks(&self) -> usize {
        self.blocks.len() - 1
    }

    /// First slot of every block, see [`neighborhoods`](crate::rings::neighborhoods).
    pub(crate) fn slot_bounds(&self) -> Vec<u32> {
        self.blocks.iter().enumerate().map(|(block, &edge)| edge + block as u32).collect()
    }

    /// The edges at vertex `v`.
    pub(crate) fn spokes(&self, v: usize) -> &[Spoke] {
        &self.spokes[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }
}

fn spokes(n_vertices: usize, edges: &[[u32; 2]]) -> (Vec<u32>, Vec<Spoke>) {
    let mut offsets = vec![0u32; n_vertices + 1];
    for end in edges.iter().flatten() {
        offsets[*end as usize + 1] += 1;
    }
    for v in 0..n_vertices {
        offsets[v + 1] += offsets[v];
    }
    let mut next = offsets.clone();
    let mut spokes = vec![Spoke { vertex: 0, edge: 0 }; 2 * edges.len()];
    for (edge, &[i, j]) in edges.iter().enumerate() {
        for (here, there) in [(i, j), (j, i)] {
            spokes[next[here as usize] as usize] = Spoke { vertex: there, edge: edge as u32 };
            next[here as usize] += 1;
        }
    }
    (offsets, spokes)
}

fn blocks(edges: &[[u32; 2]], component: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut bounds = vec![0u32];
    let mut block_of_edge = Vec::with_capacity(edges.len());
    for e in 0..edges.len() {
        let first = bounds[bounds.len() - 1] as usize;
        let component_of = |e: usize| component[edges[e][0] as usize];
        if e - first == BLOCK || component_of(e) != component_of(first) {
            bounds.push(e as u32);
        }
        block_of_edge.push(bounds.len() as u32 - 1);
    }
    if !edges.is_empty() {
        bounds.push(edges.len() as u32);
    }
    (bounds, block_of_edge)
}
