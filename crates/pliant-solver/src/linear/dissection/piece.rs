//! A part of the mesh graph, copied out so that its memory is compact.

use glam::DVec3;

use super::Graph;

/// Side of a vertex that belongs to neither half. The halves are 0 and 1.
pub(super) const SEPARATOR: u32 = u32::MAX;

/// Some vertices and the edges among them.
pub(super) struct Piece {
    /// Ascending vertices of the whole graph.
    pub(super) ids: Vec<u32>,
    /// x, y, z within the cube -1..1, and the length of the longest edge at this vertex in the whole graph.
    pub(super) points: Vec<[f32; 4]>,
    /// Neighbors of the piece's vertex v in the piece's numbering: `neighbors[offsets[v]..offsets[v + 1]]`.
    offsets: Vec<u32>,
    neighbors: Vec<u32>,
}

impl Piece {
    /// Everything.
    pub(super) fn whole(points: &[DVec3], graph: Graph<'_>) -> Piece {
        let lo = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let hi = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = lo.midpoint(hi);
        let half = (hi - middle).max_element();
        // All in one place, or nothing: the scale does not matter.
        let scale = if half > 0.0 { half.recip() } else { 0.0 };
        let scaled = |v: usize| ((points[v] - middle) * scale).as_vec3();
        let with_reach = |v: usize| {
            let p = scaled(v);
            let reach = graph.neighbors(v).iter().map(|&w| p.distance_squared(scaled(w as usize))).fold(0.0, f32::max);
            [p.x, p.y, p.z, reach.sqrt()]
        };
        Piece {
            ids: (0..points.len() as u32).collect(),
            points: (0..points.len()).map(with_reach).collect(),
            offsets: graph.offsets.to_vec(),
            neighbors: graph.neighbors.to_vec(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.ids.len()
    }

    pub(super) fn neighbors(&self, v: usize) -> &[u32] {
        &self.neighbors[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }

    pub(super) fn graph(&self) -> Graph<'_> {
        Graph { offsets: &self.offsets, neighbors: &self.neighbors }
    }

    /// The vertices of sides 0 and 1, each with the edges among them.
    pub(super) fn halves(&self, sides: &[u32]) -> (Piece, Piece) {
        let mut counts = [0u32; 2];
        let place: Vec<u32> = sides
            .iter()
            .map(|&side| {
                counts.get_mut(side as usize).map_or(SEPARATOR, |count| {
                    *count += 1;
                    *count - 1
                })
            })
            .collect();
        let half = |side: u32| {
            let n = counts[side as usize] as usize;
            let mut half = Piece {
                ids: Vec::with_capacity(n),
                points: Vec::with_capacity(n),
                offsets: Vec::with_capacity(n + 1),
                neighbors: Vec::with_capacity(n * self.neighbors.len() / self.len().max(1)),
            };
            half.offsets.push(0);
            for v in (0..self.len()).filter(|&v| sides[v] == side) {
                half.ids.push(self.ids[v]);
                half.points.push(self.points[v]);
                half.neighbors.extend(
                    self.neighbors(v).iter().filter(|&&w| sides[w as usize] == side).map(|&w| place[w as usize]),
                );
                half.offsets.push(half.neighbors.len() as u32);
            }
            half
        };
        (half(0), half(1))
    }

    /// The components shared out to two bins, the largest first and always to the lighter bin.
    pub(super) fn bins_of_components(&self) -> Vec<u32> {
        let mut component = vec![SEPARATOR; self.len()];
        let mut sizes = Vec::new();
        let mut stack = Vec::new();
        for seed in 0..self.len() {
            if component[seed] == SEPARATOR {
                let label = sizes.len() as u32;
                sizes.push((self.spread(seed, label, &mut component, &mut stack), label));
            }
        }
        sizes.sort_unstable_by_key(|&(size, label)| (std::cmp::Reverse(size), label));
        let mut bin_of = vec![0u32; sizes.len()];
        let mut filled = [0usize; 2];
        for (size, label) in sizes {
            let bin = usize::from(filled[1] < filled[0]);
            filled[bin] += size;
            bin_of[label as usize] = bin as u32;
        }
        component.iter_mut().for_each(|c| *c = bin_of[*c as usize]);
        component
    }

    /// Labels everything connected with `seed` and unlabeled; returns how much.
    fn spread(&self, seed: usize, label: u32, labels: &mut [u32], stack: &mut Vec<u32>) -> usize {
        let mut count = 1;
        labels[seed] = label;
        stack.push(seed as u32);
        while let Some(v) = stack.pop() {
            for &w in self.neighbors(v as usize) {
                if labels[w as usize] == SEPARATOR {
                    labels[w as usize] = label;
                    count += 1;
                    stack.push(w);
                }
            }
        }
        count
    }
}
