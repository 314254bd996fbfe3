//! Where a mesh departs from a closed, consistently oriented surface. None of it is an error: the solver takes every
//! triangle list.
//!
//! Edges are told apart by how many faces with three different corners lie at them. A vertex is non-manifold when its
//! faces form more than one fan; fans are found by joining the corners of faces across their common edges.

use glam::DVec3;
use rayon::prelude::*;

use crate::analysis::topology::{HalfEdges, Side, sorted};
use crate::analysis::weights::unit_sides;
use crate::{Mesh, VertexId};

/// Twice the area over the longest side squared below which a face counts as without area. Rounding of coordinates
/// far from the origin gives 1e-13 or so.
const FLAT: f64 = 1e-12;

/// One way to depart from a closed, consistently oriented surface. Faces with a repeated corner are degenerate, and
/// count as faces of no edge and no vertex otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// An edge with one face.
    Boundary,
    /// An edge with more than two faces.
    NonManifoldEdge,
    /// A vertex whose faces do not hang together by their edges.
    NonManifoldVertex,
    /// An edge whose two faces run along it in the same direction.
    Inconsistent,
    /// A face with a repeated vertex or without area.
    Degenerate,
    /// A face whose three vertices occur in an earlier face.
    Duplicate,
    /// A vertex in no face.
    Unreferenced,
}

/// How often a mesh has each [`Defect`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Defects {
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Connected runs of such edges: the holes, or the outline of an open surface.
    pub borders: usize,
    /// Edges with more than two faces.
    pub non_manifold_edges: usize,
    /// Vertices whose faces do not hang together by their edges.
    pub non_manifold_vertices: usize,
    /// Edges whose two faces run along them in the same direction.
    pub inconsistent_edges: usize,
    /// Faces with a repeated vertex or without area.
    pub degenerate_faces: usize,
    /// Faces whose three vertices occur in an earlier face.
    pub duplicate_faces: usize,
    /// Vertices in no face.
    pub unreferenced_vertices: usize,
}

impl Defects {
    pub(crate) fn of(positions: &[DVec3], triangles: &[[u32; 3]], half_edges: &HalfEdges) -> Defects {
        let n = positions.len();
        let of_faces = || {
            let is_flat = |&&face: &&[u32; 3]| is_flat(positions, face);
            (triangles.par_iter().filter(is_flat).count(), duplicates(n, triangles).len())
        };
        let (fans, (edges, faces)) =
            rayon::join(|| n_fans(n, triangles, half_edges), || rayon::join(|| of_edges(n, half_edges), of_faces));
        Defects {
            non_manifold_vertices: fans.iter().filter(|&&n| n > 1).count(),
            degenerate_faces: faces.0,
            duplicate_faces: faces.1,
            unreferenced_vertices: unreferenced(n, triangles).count(),
            ..edges
        }
    }

    /// How often this one occurs.
    pub fn count(&self, defect: Defect) -> usize {
        match defect {
            Defect::Boundary => self.boundary_edges,
            Defect::NonManifoldEdge => self.non_manifold_edges,
            Defect::NonManifoldVertex => self.non_manifold_vertices,
            Defect::Inconsistent => self.inconsistent_edges,
            Defect::Degenerate => self.degenerate_faces,
            Defect::Duplicate => self.duplicate_faces,
            Defect::Unreferenced => self.unreferenced_vertices,
        }
    }
}

impl Mesh {
    /// The vertices that have the defect, or are ends of such edges or corners of such faces, ascending. O(n log n).
    pub fn vertices_with(&self, defect: Defect) -> Vec<VertexId> {
        let (n, triangles) = (self.n_vertices(), self.triangles());
        let mut vertices: Vec<u32> = match defect {
            Defect::Boundary | Defect::NonManifoldEdge | Defect::Inconsistent => HalfEdges::new(n, triangles)
                .whole()
                .filter(|&group| of_edge(group) == Some(defect))
                .flat_map(|group| [group[0].lower, group[0].upper])
                .collect(),
            Defect::NonManifoldVertex => {
                let n_fans = n_fans(n, triangles, &HalfEdges::new(n, triangles));
                (0..).zip(n_fans).filter(|&(_, fans)| fans > 1).map(|(v, _)| v).collect()
            }
            Defect::Degenerate => {
                triangles.iter().filter(|&&face| is_flat(self.positions(), face)).flatten().copied().collect()
            }
            Defect::Duplicate => duplicates(n, triangles).into_iter().flatten().collect(),
            Defect::Unreferenced => unreferenced(n, triangles).collect(),
        };
        vertices.sort_unstable();
        vertices.dedup();
        vertices.into_iter().map(VertexId).collect()
    }
}

/// What is unusual about edges.
fn of_edges(n: usize, half_edges: &HalfEdges) -> Defects {
    let mut defects = Defects::default();
    let mut border = Vec::new();
    for group in half_edges.whole() {
        match of_edge(group) {
            Some(Defect::Boundary) => border.push([group[0].lower, group[0].upper]),
            Some(Defect::NonManifoldEdge) => defects.non_manifold_edges += 1,
            Some(_) => defects.inconsistent_edges += 1,
            None => {}
        }
    }
    Defects { boundary_edges: border.len(), borders: runs(n, &border), ..defects }
}

/// What is unusual about an edge, given the sides of the whole faces at it.
fn of_edge(sides: &[Side]) -> Option<Defect> {
    match sides {
        [] => None,
        [_] => Some(Defect::Boundary),
        [one, other] => (one.ascends == other.ascends).then_some(Defect::Inconsistent),
        _ => Some(Defect::NonManifoldEdge),
    }
}

/// Number of connected pieces that edges of some of `n` vertices form.
fn runs(n: usize, edges: &[[u32; 2]]) -> usize {
    let mut sets = Sets::new(n);
    let (mut touched, mut n_touched, mut n_joined) = (vec![false; n], 0, 0);
    for &[a, b] in edges {
        n_touched += [a, b].iter().filter(|&&v| !std::mem::replace(&mut touched[v as usize], true)).count();
        n_joined += usize::from(sets.join(a, b));
    }
    n_touched - n_joined
}

/// How many fans the faces around each vertex form.
fn n_fans(n: usize, triangles: &[[u32; 3]], half_edges: &HalfEdges) -> Vec<u32> {
    let mut corners = Sets::new(3 * triangles.len());
    for group in half_edges.whole() {
        let [lower, upper] = group[0].corners();
        for side in &group[1..] {
            let [a, b] = side.corners();
            corners.join(lower, a);
            corners.join(upper, b);
        }
    }
    let mut n_fans = vec![0; n];
    for (corner, &v) in (0..).zip(triangles.as_flattened()) {
        let [a, b, c] = triangles[corner as usize / 3];
        n_fans[v as usize] += u32::from(a != b && b != c && c != a && corners.first(corner) == corner);
    }
    n_fans
}

/// Faces whose three vertices, all below `n`, occur in an earlier face; their vertices ascending.
fn duplicates(n: usize, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let ascending = |&face: &[u32; 3]| {
        let mut face = face;
        face.sort_unstable();
        face
    };
    let sorted = sorted(n, triangles.iter().map(ascending), |face| face[0]);
    sorted.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect()
}

fn unreferenced(n: usize, triangles: &[[u32; 3]]) -> impl Iterator<Item = u32> {
    let mut referenced = vec![false; n];
    triangles.as_flattened().iter().for_each(|&v| referenced[v as usize] = true);
    (0..).zip(referenced).filter(|&(_, referenced)| !referenced).map(|(v, _)| v)
}

/// Whether a face has a repeated corner or no area worth the name.
fn is_flat(positions: &[DVec3], face: [u32; 3]) -> bool {
    let [a, b, c] = unit_sides(face.map(|v| positions[v as usize]));
    let longest = a.length_squared().max(b.length_squared()).max(c.length_squared());
    a.cross(b).length() <= FLAT * longest
}

/// Disjoint sets of numbers, each known by its smallest.
struct Sets {
    parent: Vec<u32>,
}

impl Sets {
    fn new(n: usize) -> Sets {
        Sets { parent: (0..n as u32).collect() }
    }

    /// The smallest of the set, with the way there shortened.
    fn first(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let parent = self.parent[x as usize];
            self.parent[x as usize] = self.parent[parent as usize];
            x = parent;
        }
        x
    }

    /// Makes one set of two; whether they were two.
    fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.first(a), self.first(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(n: usize) -> Vec<DVec3> {
        (0..n).map(|i| DVec3::new(i as f64, (i * i % 7) as f64, (i * i % 3) as f64)).collect()
    }

    fn mesh(n: usize, faces: &[[u32; 3]]) -> Mesh {
        Mesh::new(points(n), faces.to_vec()).expect("valid")
    }

    fn with(mesh: &Mesh, defect: Defect) -> Vec<u32> {
        mesh.vertices_with(defect).into_iter().map(|v| v.0).collect()
    }

    #[test]
    fn defects_are_counted_and_found() {
        let p = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Y, DVec3::X * 2.0, DVec3::X * 3.0, DVec3::ONE];
        let faces = vec![
            [0, 1, 2],
            [0, 1, 3], // the same direction along edge 0-1, and with the next a third face on it
            [1, 0, 4],
            [2, 0, 1], // the first again
            [1, 5, 6], // collinear, and tied to the others by vertex 1 alone
        ];
        let mesh = Mesh::new(p, faces).expect("valid");
        let expected = Defects {
            boundary_edges: 7,
            borders: 1,
            non_manifold_edges: 1,
            non_manifold_vertices: 1,
            inconsistent_edges: 2,
            degenerate_faces: 1,
            duplicate_faces: 1,
            unreferenced_vertices: 1,
        };
        assert_eq!(mesh.defects(), expected);
        assert_eq!(with(&mesh, Defect::Boundary), [0, 1, 3, 4, 5, 6]);
        assert_eq!(with(&mesh, Defect::NonManifoldEdge), [0, 1]);
        assert_eq!(with(&mesh, Defect::NonManifoldVertex), [1]);
        assert_eq!(with(&mesh, Defect::Inconsistent), [0, 1, 2]);
        assert_eq!(with(&mesh, Defect::Degenerate), [1, 5, 6]);
        assert_eq!(with(&mesh, Defect::Duplicate), [0, 1, 2]);
        assert_eq!(with(&mesh, Defect::Unreferenced), [7]);
    }

    #[test]
    fn a_face_with_a_repeated_corner_is_degenerate_and_changes_nothing_else() {
        let faces = vec![[0, 1, 2], [1, 0, 4]];
        let without = mesh(5, &faces);
        let with = mesh(5, &[faces, vec![[0, 0, 1], [2, 1, 2], [3, 3, 3], [2, 3, 2]]].concat());
        let expected = Defects { degenerate_faces: 4, unreferenced_vertices: 0, ..without.defects() };
        assert_eq!(with.defects(), expected);
        assert_eq!(with.n_edges(), without.n_edges() + 1, "they are edges none the less");
    }

    #[test]
    fn borders_are_counted_by_run_and_a_closed_surface_has_none() {
        let closed = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        assert_eq!(mesh(4, &closed).defects(), Defects::default());
        assert_eq!(mesh(4, &closed[1..]).defects().borders, 1);
        let two = mesh(6, &[[0, 1, 2], [3, 4, 5]]).defects();
        assert_eq!((two.borders, two.boundary_edges, two.non_manifold_vertices), (2, 6, 0));
        let a_bow_tie = mesh(5, &[[0, 1, 2], [2, 3, 4]]).defects();
        assert_eq!((a_bow_tie.borders, a_bow_tie.non_manifold_vertices), (1, 1));
    }
}
