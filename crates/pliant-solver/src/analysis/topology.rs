//! Edges and components of a triangle list, by sorting half-edges: no hash, so the same every time.
//!
//! What is sorted here begins with a vertex, and few items begin with the same one. So they are put behind each other by
//! their first vertex without comparing them, and only the few of each vertex are sorted.

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
    /// Of triangles over vertices below `n`.
    pub(crate) fn new(n: usize, triangles: &[[u32; 3]]) -> HalfEdges {
        let sides_of = |(begin, &[a, b, c]): (u32, &[u32; 3])| {
            let is_whole = a != b && b != c && c != a;
            let side = move |(k, a, b): (u32, u32, u32)| {
                let begin = begin + k;
                Side { lower: a.min(b), upper: a.max(b), is_whole, ascends: a < b, begin }
            };
            [(0, a, b), (1, b, c), (2, c, a)].map(side)
        };
        let sides = (0..).step_by(3).zip(triangles).flat_map(sides_of).filter(|side| side.lower != side.upper);
        HalfEdges { sides: sorted(n, sides, |side| side.lower) }
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

/// Items of one vertex from which on more than one thread sorts them: a fan of so many triangles.
const MANY: usize = 1 << 14;

/// Items in ascending order, which begins with the order of a vertex below `n` that each of them names. For the six million
/// sides of two million faces this was measured to take a third of the time of comparing them all, on one thread, and four
/// fifths where vertices are numbered at random.
///
/// Items that are equal are not told apart: the result is the same for any number of threads.
pub(crate) fn sorted<T: Copy + Ord + Send>(
    n: usize,
    items: impl Iterator<Item = T> + Clone,
    vertex: impl Fn(&T) -> u32 + Sync,
) -> Vec<T> {
    let mut ends = vec![0u32; n];
    items.clone().for_each(|item| ends[vertex(&item) as usize] += 1);
    let mut n_items = 0;
    for end in &mut ends {
        n_items += *end;
        *end = n_items;
    }
    let Some(any) = items.clone().next() else { return Vec::new() };
    let mut sorted = vec![any; n_items as usize];
    for item in items {
        let end = &mut ends[vertex(&item) as usize];
        *end -= 1;
        sorted[*end as usize] = item;
    }
    sorted.par_chunk_by_mut(|a, b| vertex(a) == vertex(b)).for_each(|of_one| match of_one.len() {
        0..MANY => of_one.sort_unstable(),
        _ => of_one.par_sort_unstable(),
    });
    sorted
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_sorted_as_by_comparing_them_all() {
        // A fan large enough for several threads, and scattered pairs.
        let mut state = 7u32;
        let mut number = |below: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) % below
        };
        let mut items: Vec<[u32; 2]> =
            (0..40_000).map(|i| [if i % 2 == 0 { 3 } else { number(100) }, number(50)]).collect();
        let got = sorted(100, items.iter().copied(), |item| item[0]);
        items.sort_unstable();
        assert!(got == items);
        assert!(sorted(5, std::iter::empty::<[u32; 2]>(), |item| item[0]).is_empty());
    }
}
