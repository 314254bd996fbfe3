//! Edges and components of a triangle list, by sorting half-edges: no hash, so the same every time.

use rayon::prelude::*;

use crate::Mesh;

/// A side of a face between two vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Side {
    pub(crate) lower: u32,
    pub(crate) upper: u32,
    /// Whether the face has three vertices; one with a repeated corner is an edge or a point.
    pub(crate) is_whole: bool,
    /// Whether the face runs from lower to upper.
    pub(crate) ascends: bool,
    /// Three times the face, plus the corner at which the side begins.
    pub(crate) begin: u32,
}

impl Side {
    /// The corners of the face at the lower and at the upper end, numbered as `begin`.
    pub(crate) fn corners(&self) -> [u32; 2] {
        let end = if self.begin % 3 == 2 { self.begin - 2 } else { self.begin + 1 };
        if self.ascends { [self.begin, end] } else { [end, self.begin] }
    }
}

/// The sides of all triangles, sorted by their ends.
pub(crate) struct HalfEdges {
    sides: Vec<Side>,
}

impl HalfEdges {
    pub(crate) fn new(triangles: &[[u32; 3]]) -> HalfEdges {
        let sides_of = |(begin, &[a, b, c]): (u32, &[u32; 3])| {
            let is_whole = a != b && b != c && c != a;
            let side = move |(k, a, b): (u32, u32, u32)| {
                let begin = begin + k;
                Side { lower: a.min(b), upper: a.max(b), is_whole, ascends: a < b, begin }
            };
            [(0, a, b), (1, b, c), (2, c, a)].map(side)
        };
        let mut sides: Vec<Side> =
            (0..).step_by(3).zip(triangles).flat_map(sides_of).filter(|side| side.lower != side.upper).collect();
        // No two sides are equal: the order is the same for any number of threads.
        sides.par_sort_unstable();
        HalfEdges { sides }
    }

    /// Each undirected edge once.
    pub(crate) fn edges(&self) -> Vec<[u32; 2]> {
        self.groups().map(|group| [group[0].lower, group[0].upper]).collect()
    }

    /// The sides at each edge, those of faces with a repeated corner first.
    fn groups(&self) -> impl Iterator<Item = &[Side]> {
        self.sides.chunk_by(|a, b| (a.lower, a.upper) == (b.lower, b.upper))
    }

    /// The sides of whole faces at each edge that has any.
    pub(crate) fn whole(&self) -> impl Iterator<Item = &[Side]> {
        self.groups()
            .map(|group| &group[group.partition_point(|side| !side.is_whole)..])
            .filter(|group| !group.is_empty())
    }
}

/// In place of an edge: the two corners at this side of a face are one vertex.
pub(crate) const NO_EDGE: u32 = u32::MAX;

/// The edges at the three sides of every face: from its first corner to the second, to the third, and back.
pub(crate) fn sides_of_faces(mesh: &Mesh) -> Vec<[u32; 3]> {
    // Edges are sorted by their lower end: those of vertex v begin at `first[v]`.
    let mut first = vec![0usize; mesh.n_vertices() + 1];
    mesh.edges().iter().for_each(|&[lower, _]| first[lower as usize + 1] += 1);
    (0..mesh.n_vertices()).for_each(|v| first[v + 1] += first[v]);
    let edge = |a: u32, b: u32| {
        let (lower, upper) = (a.min(b) as usize, a.max(b));
        let place = mesh.edges()[first[lower]..first[lower + 1]].binary_search_by_key(&upper, |edge| edge[1]);
        place.map_or(NO_EDGE, |place| (first[lower] + place) as u32)
    };
    mesh.triangles().par_iter().map(|&[a, b, c]| [edge(a, b), edge(b, c), edge(c, a)]).collect()
}

/// Component of each vertex, numbered by first vertex, and their number.
pub(crate) fn components(offsets: &[u32], neighbors: &[u32]) -> (Vec<u32>, usize) {
    let n = offsets.len() - 1;
    let mut component = vec![u32::MAX; n];
    let mut n_components = 0;
    let mut stack = Vec::new();
    for first in 0..n {
        if component[first] != u32::MAX {
            continue;
        }
        component[first] = n_components;
        stack.push(first);
        while let Some(v) = stack.pop() {
            for &w in &neighbors[offsets[v] as usize..offsets[v + 1] as usize] {
                if component[w as usize] == u32::MAX {
                    component[w as usize] = n_components;
                    stack.push(w as usize);
                }
            }
        }
        n_components += 1;
    }
    (component, n_components as usize)
}
