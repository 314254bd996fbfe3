//! Edges, components and defects of a triangle list, by sorting half-edges: no hash, so the same every time.

use glam::DVec3;
use rayon::prelude::*;

use crate::Mesh;
use crate::analysis::weights::unit_sides;

/// Twice the area over the longest side squared below which a face counts as without area. Rounding of coordinates
/// far from the origin gives 1e-13 or so.
const FLAT: f64 = 1e-12;

/// A side of a face between two vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    lower: u32,
    upper: u32,
    /// Whether the face has three vertices; one with a repeated corner is an edge or a point.
    is_whole: bool,
    /// Whether the face runs from lower to upper.
    ascends: bool,
}

/// The sides of all triangles, sorted by their ends.
pub(crate) struct HalfEdges {
    sides: Vec<Side>,
}

impl HalfEdges {
    pub(crate) fn new(triangles: &[[u32; 3]]) -> HalfEdges {
        let sides_of = |&[a, b, c]: &[u32; 3]| {
            let is_whole = a != b && b != c && c != a;
            let side = move |(a, b): (u32, u32)| Side { lower: a.min(b), upper: a.max(b), is_whole, ascends: a < b };
            [(a, b), (b, c), (c, a)].map(side)
        };
        let mut sides: Vec<Side> =
            triangles.iter().flat_map(sides_of).filter(|side| side.lower != side.upper).collect();
        sides.sort_unstable();
        HalfEdges { sides }
    }

    /// Each undirected edge once.
    pub(crate) fn edges(&self) -> Vec<[u32; 2]> {
        self.groups().map(|group| [group[0].lower, group[0].upper]).collect()
    }

    fn groups(&self) -> impl Iterator<Item = &[Side]> {
        self.sides.chunk_by(|a, b| (a.lower, a.upper) == (b.lower, b.upper))
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

/// How often a mesh departs from a closed, consistently oriented surface. None of it is an error. Faces with a repeated
/// vertex count as degenerate, and not as faces of their edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: usize,
    /// Faces with a repeated vertex or without area.
    pub degenerate_faces: usize,
    /// Faces whose three vertices occur in an earlier face.
    pub duplicate_faces: usize,
    /// Vertices in no face.
    pub unreferenced_vertices: usize,
    /// Edges whose two faces run along them in the same direction.
    pub inconsistent_edges: usize,
}

pub(crate) fn count_defects(positions: &[DVec3], triangles: &[[u32; 3]], half_edges: &HalfEdges) -> Defects {
    let mut defects = Defects::default();
    for group in half_edges.groups() {
        // Faces with a repeated corner come first, and bound nothing.
        match &group[group.partition_point(|side| !side.is_whole)..] {
            [] => {}
            [_] => defects.boundary_edges += 1,
            [one, other] => defects.inconsistent_edges += usize::from(one.ascends == other.ascends),
            _ => defects.non_manifold_edges += 1,
        }
    }
    let mut referenced = vec![false; positions.len()];
    for face in triangles {
        face.iter().for_each(|&v| referenced[v as usize] = true);
        defects.degenerate_faces += usize::from(is_flat(face.map(|v| positions[v as usize])));
    }
    defects.unreferenced_vertices = referenced.iter().filter(|&&seen| !seen).count();
    let mut sorted: Vec<_> = triangles
        .iter()
        .map(|&face| {
            let mut face = face;
            face.sort_unstable();
            face
        })
        .collect();
    sorted.sort_unstable();
    defects.duplicate_faces = sorted.windows(2).filter(|pair| pair[0] == pair[1]).count();
    defects
}

/// Whether a triangle has a repeated corner or no area worth the name.
fn is_flat(corners: [DVec3; 3]) -> bool {
    let [a, b, c] = unit_sides(corners);
    let longest = a.length_squared().max(b.length_squared()).max(c.length_squared());
    a.cross(b).length() <= FLAT * longest
}
