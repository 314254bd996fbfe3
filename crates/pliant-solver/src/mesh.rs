//! The surface, validated once: everything behind it may trust its indices and numbers.

use glam::DVec3;

use crate::analysis::defects::Defects;
use crate::analysis::topology::{HalfEdges, components};
use crate::{MeshError, VertexId};

/// Coordinates beyond this would overflow when squared and summed.
pub const LARGEST_COORDINATE: f64 = 1e100;

/// Surface points and triangles in the caller's numbering, validated (finite, indices in range), with its edges and
/// connected components. Degenerate, duplicate and non-manifold faces and unreferenced vertices are allowed.
#[derive(Debug)]
pub struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    /// Neighbors of vertex v: `neighbors[offsets[v]..offsets[v + 1]]`, ascending.
    offsets: Vec<u32>,
    neighbors: Vec<u32>,
    components: Vec<u32>,
    n_components: usize,
    defects: Defects,
}

impl Mesh {
    /// The largest number of vertices or faces: a third of the range in which an edge index leaves one bit free.
    pub const MAX_ELEMENTS: usize = (i32::MAX as usize) / 3;

    /// Checks positions and triangles and finds edges, neighbors, components and defects. O(n log n).
    ///
    /// # Errors
    /// Any [`MeshError`]: an empty list, a coordinate that is not finite, an index out of range, too many elements.
    pub fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Mesh, MeshError> {
        validate(&positions, &triangles)?;
        let half_edges = HalfEdges::new(positions.len(), &triangles);
        let edges = half_edges.edges();
        let (offsets, neighbors) = adjacency(positions.len(), &edges);
        let (components, n_components) = components(&offsets, &neighbors);
        let defects = Defects::of(&positions, &triangles, &half_edges);
        Ok(Mesh { positions, triangles, edges, offsets, neighbors, components, n_components, defects })
    }

    /// Number of surface points.
    pub fn n_vertices(&self) -> usize {
        self.positions.len()
    }

    /// Number of triangles.
    pub fn n_faces(&self) -> usize {
        self.triangles.len()
    }

    /// Number of undirected edges.
    pub fn n_edges(&self) -> usize {
        self.edges.len()
    }

    /// Number of connected components; an unreferenced vertex is one of its own.
    pub fn n_components(&self) -> usize {
        self.n_components
    }

    /// Rest positions, one per vertex.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Vertex indices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Undirected edges, each once, lower end first, in ascending order.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Component number of each vertex (an unreferenced vertex is a component of its own). Components are numbered by
    /// their first vertex.
    pub fn components(&self) -> &[u32] {
        &self.components
    }

    /// Vertices joined to `v` by an edge, ascending. Panics if `v` is not of this mesh.
    pub fn neighbors(&self, v: VertexId) -> &[u32] {
        &self.neighbors[self.offsets[v.index()] as usize..self.offsets[v.index() + 1] as usize]
    }

    /// What is unusual about the mesh, for reports.
    pub fn defects(&self) -> Defects {
        self.defects
    }
}

/// Whether a point can be computed with: every coordinate finite and small enough to be squared.
pub(crate) fn is_usable(p: DVec3) -> bool {
    p.abs().cmple(DVec3::splat(LARGEST_COORDINATE)).all()
}

fn validate(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<(), MeshError> {
    let (n_vertices, n_faces, max) = (positions.len(), triangles.len(), Mesh::MAX_ELEMENTS);
    if n_vertices == 0 {
        return Err(MeshError::NoVertices);
    }
    if n_faces == 0 {
        return Err(MeshError::NoFaces);
    }
    if n_vertices > max || n_faces > max {
        return Err(MeshError::TooLarge { n_vertices, n_faces, max });
    }
    if let Some(vertex) = positions.iter().position(|&p| !is_usable(p)) {
        return Err(MeshError::NotFinite { vertex: vertex as u32 });
    }
    for (face, corners) in triangles.iter().enumerate() {
        if let Some(&index) = corners.iter().find(|&&v| v as usize >= n_vertices) {
            return Err(MeshError::IndexOutOfRange { face, index, n_vertices });
        }
    }
    Ok(())
}

/// Offsets and neighbor lists from sorted edges.
fn adjacency(n_vertices: usize, edges: &[[u32; 2]]) -> (Vec<u32>, Vec<u32>) {
    let mut offsets = vec![0u32; n_vertices + 1];
    for &[a, b] in edges {
        offsets[a as usize + 1] += 1;
        offsets[b as usize + 1] += 1;
    }
    for v in 0..n_vertices {
        offsets[v + 1] += offsets[v];
    }
    let mut next = offsets.clone();
    let mut neighbors = vec![0u32; 2 * edges.len()];
    // Lower neighbors first, then higher ones: each list comes out ascending because the edges are sorted.
    for &[a, b] in edges {
        neighbors[next[b as usize] as usize] = a;
        next[b as usize] += 1;
    }
    for &[a, b] in edges {
        neighbors[next[a as usize] as usize] = b;
        next[a as usize] += 1;
    }
    (offsets, neighbors)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(n: usize) -> Vec<DVec3> {
        (0..n).map(|i| DVec3::new(i as f64, (i * i % 7) as f64, (i % 3) as f64)).collect()
    }

    #[test]
    fn bad_input_is_refused_with_its_place() {
        assert_eq!(Mesh::new(vec![], vec![]).err(), Some(MeshError::NoVertices));
        assert_eq!(Mesh::new(points(3), vec![]).err(), Some(MeshError::NoFaces));
        let mut bad = points(3);
        bad[2].y = f64::NAN;
        assert_eq!(Mesh::new(bad, vec![[0, 1, 2]]).err(), Some(MeshError::NotFinite { vertex: 2 }));
        assert_eq!(
            Mesh::new(points(3), vec![[0, 1, 2], [0, 1, 3]]).err(),
            Some(MeshError::IndexOutOfRange { face: 1, index: 3, n_vertices: 3 })
        );
    }

    #[test]
    fn a_face_with_a_repeated_corner_still_gives_its_edge() {
        let mesh = Mesh::new(points(4), vec![[0, 1, 2], [2, 2, 3]]).expect("valid");
        assert_eq!(mesh.edges(), &[[0, 1], [0, 2], [1, 2], [2, 3]]);
        assert_eq!(mesh.n_components(), 1);
        assert_eq!(mesh.neighbors(VertexId(2)), &[0, 1, 3]);
    }

    #[test]
    fn components_are_numbered_by_first_vertex() {
        let mesh = Mesh::new(points(7), vec![[4, 5, 6], [0, 2, 3]]).expect("valid");
        assert_eq!(mesh.components(), &[0, 1, 0, 0, 2, 2, 2]);
        assert_eq!(mesh.defects().unreferenced_vertices, 1);
    }
}
