//! Fill-reducing elimination order by nested dissection of a mesh.
//!
//! # Idea
//! A few vertices S that separate the others into halves A and B are eliminated last: then eliminating A and B fills
//! nothing between them, and both can be done at the same time. A and B are dissected likewise. On a surface
//! |S| ~ √n, so the factor has O(n log n) entries.
//!
//! | step | file |
//! |---|---|
//! | recursion over pieces and components | here |
//! | a piece: vertices with their own numbering, points and adjacency | `piece.rs` |
//! | where to cut: keys along the longest axis, or breadth-first levels | `cut.rs` |
//! | the fewest vertices that cut within a band around the middle key: a maximal flow | `flow.rs` |
//! | small pieces: minimum degree on bit sets, the surroundings included | `leaf.rs` |
//!
//! Nothing depends on the number of threads: every piece is ordered from its own contents alone.

mod cut;
mod flow;
mod leaf;
mod piece;

use glam::DVec3;

use piece::{Piece, SEPARATOR};

/// Pieces of at most this many vertices are not cut but ordered by minimum degree.
const LEAF: usize = 100;
/// Pieces of more vertices than this are worth a task of their own (about 0.1 ms).
const TASK: usize = 2000;

/// The order in which to eliminate the vertices of a mesh graph: entry k is the k-th to go. The neighbors of vertex v
/// are `neighbors[offsets[v]..offsets[v + 1]]`. Points only guide the cuts; any values will do.
pub(crate) fn nested_dissection(points: &[DVec3], offsets: &[u32], neighbors: &[u32]) -> Vec<u32> {
    let graph = Graph { offsets, neighbors };
    let mut order = vec![0u32; points.len()];
    dissect(graph, Piece::whole(points, graph), &mut order);
    order
}

/// A graph as lists of neighbors, one after the other.
#[derive(Clone, Copy)]
struct Graph<'a> {
    offsets: &'a [u32],
    neighbors: &'a [u32],
}

impl<'a> Graph<'a> {
    fn neighbors(&self, v: usize) -> &'a [u32] {
        &self.neighbors[self.offsets[v] as usize..self.offsets[v + 1] as usize]
    }
}

/// Fills `order`, which is as long as the piece.
fn dissect(graph: Graph<'_>, piece: Piece, order: &mut [u32]) {
    if piece.len() <= LEAF {
        return leaf::minimum_degree(graph, &piece.ids, order);
    }
    let Some(sides) = cut::separate(&piece) else {
        return leaf::approximate_minimum_degree(&piece, order);
    };
    let (a, b) = piece.halves(&sides);
    let both = a.len() + b.len();
    let (rest, last) = order.split_at_mut(both);
    let separator = piece.ids.iter().zip(&sides).filter(|&(_, &side)| side == SEPARATOR);
    last.iter_mut().zip(separator).for_each(|(slot, (&id, _))| *slot = id);
    drop((piece, sides));
    let (first, second) = rest.split_at_mut(a.len());
    if both > TASK {
        rayon::join(|| dissect(graph, a, first), || dissect(graph, b, second));
    } else {
        dissect(graph, a, first);
        dissect(graph, b, second);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    fn lists(n: usize, edges: impl IntoIterator<Item = [u32; 2]>) -> (Vec<u32>, Vec<u32>) {
        let mut ends: Vec<[u32; 2]> = edges.into_iter().flat_map(|[a, b]| [[a, b], [b, a]]).collect();
        ends.sort_unstable();
        ends.dedup();
        let offsets = (0..=n as u32).map(|v| ends.partition_point(|end| end[0] < v) as u32).collect();
        (offsets, ends.into_iter().map(|end| end[1]).collect())
    }

    /// A torus of `around` × `across` vertices, every quad cut by the same diagonal.
    fn torus(around: u32, across: u32) -> (Vec<DVec3>, Vec<u32>, Vec<u32>) {
        let angle = |i: u32, n: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        let points = (0..around * across)
            .map(|v| {
                let (a, b) = (angle(v / across, around), angle(v % across, across));
                let r = 3.0 + b.cos();
                DVec3::new(r * a.cos(), r * a.sin(), b.sin())
            })
            .collect();
        let at = |i: u32, j: u32| (i % around) * across + j % across;
        let edges = (0..around)
            .flat_map(|i| (0..across).map(move |j| (i, j)))
            .flat_map(|(i, j)| [(1, 0), (0, 1), (1, 1)].map(|(di, dj)| [at(i, j), at(i + di, j + dj)]));
        let (offsets, neighbors) = lists((around * across) as usize, edges);
        (points, offsets, neighbors)
    }

    /// Entries of the factor with its diagonal, by merging the structure of each column into its parent's.
    fn fill(order: &[u32], offsets: &[u32], neighbors: &[u32]) -> usize {
        let graph = Graph { offsets, neighbors };
        let mut place = vec![0u32; order.len()];
        order.iter().enumerate().for_each(|(k, &v)| place[v as usize] = k as u32);
        let mut waiting: Vec<Vec<u32>> = vec![Vec::new(); order.len()];
        let mut entries = 0;
        for (k, &v) in order.iter().enumerate() {
            let mut below = std::mem::take(&mut waiting[k]);
            below.extend(graph.neighbors(v as usize).iter().map(|&w| place[w as usize]));
            below.retain(|&row| row > k as u32);
            below.sort_unstable();
            below.dedup();
            entries += 1 + below.len();
            if let Some(&parent) = below.first() {
                waiting[parent as usize].extend_from_slice(&below);
            }
        }
        entries
    }

    fn assert_permutation(order: &[u32], what: &str) {
        let mut sorted = order.to_vec();
        sorted.sort_unstable();
        for (expected, &got) in sorted.iter().enumerate() {
            assert_eq!(got as usize, expected, "{what}: {} vertices", order.len());
        }
    }

    fn amd_order(offsets: &[u32], neighbors: &[u32]) -> Vec<u32> {
        let n = offsets.len() - 1;
        let piece = Piece::whole(&vec![DVec3::ZERO; n], Graph { offsets, neighbors });
        let mut order = vec![0; n];
        leaf::approximate_minimum_degree(&piece, &mut order);
        order
    }

    #[test]
    fn a_torus_fills_less_than_with_minimum_degree() {
        let (points, offsets, neighbors) = torus(160, 60);
        let order = nested_dissection(&points, &offsets, &neighbors);
        assert_permutation(&order, "torus");
        let (got, amd) =
            (fill(&order, &offsets, &neighbors), fill(&amd_order(&offsets, &neighbors), &offsets, &neighbors));
        assert!(got < amd, "{got} entries against {amd} by minimum degree");
    }

    #[test]
    fn any_graph_at_any_points_gets_a_permutation() {
        let mut random = Random::new(3);
        let star = lists(5000, (1..5000).map(|v| [0, v]));
        let fan = lists(3000, (1..2999).flat_map(|v| [[0, v], [v, v + 1]]));
        let path = lists(4000, (1..4000).map(|v| [v - 1, v]));
        let alone = lists(1000, []);
        let complete = lists(300, (0..300).flat_map(|a| (0..a).map(move |b| [b, a])));
        let triangles =
            lists(3000, (0..1000).flat_map(|t| [[3 * t, 3 * t + 1], [3 * t, 3 * t + 2], [3 * t + 1, 3 * t + 2]]));
        let random_edges = lists(
            2000,
            (0..6000)
                .map(|_| {
                    let mut end = || ((random.signed() * 0.5 + 0.5) * 1999.0) as u32;
                    [end(), end()]
                })
                .filter(|[a, b]| a != b)
                .collect::<Vec<_>>(),
        );
        let torus = torus(40, 50);
        let graphs = [
            ("nothing", lists(0, [])),
            ("one vertex", lists(1, [])),
            ("star", star),
            ("fan", fan),
            ("path", path),
            ("isolated vertices", alone),
            ("complete graph", complete),
            ("separate triangles", triangles),
            ("random edges", random_edges),
            ("torus", (torus.1, torus.2)),
        ];
        for (what, (offsets, neighbors)) in &graphs {
            let n = offsets.len() - 1;
            let same = vec![DVec3::ONE; n];
            let line = (0..n).map(|v| DVec3::X * v as f64).collect();
            let pairs = (0..n).map(|v| DVec3::new((v / 2) as f64, 0.0, 1.0)).collect();
            let scattered = (0..n).map(|_| random.vector() * 1e100).collect();
            let far = (0..n).map(|v| DVec3::new(if v == 0 { 1e12 } else { v as f64 * 1e-9 }, 0.0, 0.0)).collect();
            for points in [same, line, pairs, scattered, far] {
                assert_permutation(&nested_dissection(&points, offsets, neighbors), what);
            }
        }
    }

    #[test]
    fn the_order_is_the_same_for_any_number_of_threads() {
        let (points, offsets, neighbors) = torus(160, 60);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| nested_dissection(&points, &offsets, &neighbors))
        };
        assert_eq!(with(1), with(2));
        assert_eq!(with(1), with(3));
    }
}
