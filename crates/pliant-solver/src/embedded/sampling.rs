//! Farthest-point sampling: the next node is the vertex farthest from all nodes so far.
//!
//! Distances are straight ones, as in the paper, but only to nodes of the same component: every component has a node, the
//! vertex farthest from its center, and the others go where they are farthest from those.

use std::ops::Range;

use glam::DVec3;

use crate::analysis::Layout;
use crate::kernels::parallel::{CHUNK, chunks_with};

/// The vertices (internal numbers) that become nodes: `n` of them, or one for every component if those are more, or fewer
/// if there are no more places.
pub(super) fn farthest_points(layout: &Layout, n: usize) -> Vec<u32> {
    let mut parts = Vec::new();
    let mut nodes = Vec::new();
    let mut distances = vec![f64::INFINITY; layout.n_vertices()];
    let mut first = 0;
    for members in layout.component.chunk_by(|a, b| a == b) {
        let range = first..first + members.len();
        first = range.end;
        let mut part = Part { range, farthest: 0.0, place: 0 };
        let points = &layout.rest[part.range.clone()];
        let center = points.iter().map(|&p| p / points.len() as f64).sum();
        // From the center first, and then all over again from the vertex found.
        part.add(&layout.rest, &mut distances, center);
        distances[part.range.clone()].fill(f64::INFINITY);
        nodes.push(part.place as u32);
        part.add(&layout.rest, &mut distances, layout.rest[part.place]);
        parts.push(part);
    }
    while nodes.len() < n {
        let best = parts.iter_mut().reduce(|a, b| if b.farthest > a.farthest { b } else { a });
        let Some(part) = best.filter(|part| part.farthest > 0.0) else { break };
        nodes.push(part.place as u32);
        part.add(&layout.rest, &mut distances, layout.rest[part.place]);
    }
    nodes
}

/// A component: its vertices, and the farthest of them from the nodes so far with its squared distance.
struct Part {
    range: Range<usize>,
    farthest: f64,
    place: usize,
}

impl Part {
    fn add(&mut self, rest: &[DVec3], distances: &mut [f64], node: DVec3) {
        let (rest, distances) = (&rest[self.range.clone()], &mut distances[self.range.clone()]);
        let mut farthest = vec![(0.0, 0); rest.len().div_ceil(CHUNK)];
        chunks_with(rest.len(), distances, &mut farthest, |first, distances| {
            let mut most = (-1.0, 0);
            for (i, (distance, p)) in distances.iter_mut().zip(&rest[first..]).enumerate() {
                *distance = distance.min(p.distance_squared(node));
                if *distance > most.0 {
                    most = (*distance, first + i);
                }
            }
            most
        });
        let most = farthest.into_iter().fold((-1.0, 0), |a, b| if b.0 > a.0 { b } else { a });
        (self.farthest, self.place) = (most.0, self.range.start + most.1);
    }
}
