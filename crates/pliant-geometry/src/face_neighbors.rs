//! Which triangle lies beyond each edge of a triangle.

use crate::incidence::Incidence;

/// No triangle, or no single one: a border, or an edge of three triangles and more.
pub(crate) const NONE: u32 = u32::MAX;

/// For each triangle the neighbors across its edges: entry k is across the edge from corner k to corner k + 1.
#[derive(Clone, Debug)]
pub(crate) struct FaceNeighbors {
    across: Vec<[u32; 3]>,
}

impl FaceNeighbors {
    /// O(n) while few triangles meet at a vertex. A triangle that is absent or names a vertex twice has no neighbors and
    /// is nobody's.
    pub(crate) fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> FaceNeighbors {
        let incidence = Incidence::new(n_vertices, triangles);
        let is_whole =
            |t: [u32; 3]| t.iter().all(|&v| (v as usize) < n_vertices) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        let beyond = |face: usize, a: u32, b: u32| {
            // The rarer end of the edge: the middle of a fan has as many triangles as the fan.
            let around = |v: u32| incidence.around(v as usize);
            let (at, other) = if around(a).len() <= around(b).len() { (a, b) } else { (b, a) };
            let holds = |&&f: &&u32| f as usize != face && triangles[f as usize].contains(&other);
            let mut others = around(at).iter().filter(holds).filter(|&&f| is_whole(triangles[f as usize]));
            match (others.next(), others.next()) {
                (Some(&only), None) => only,
                _ => NONE,
            }
        };
        let of_face = |(face, &t): (usize, &[u32; 3])| {
            if !is_whole(t) {
                return [NONE; 3];
            }
            [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| beyond(face, a, b))
        };
        FaceNeighbors { across: triangles.iter().enumerate().map(of_face).collect() }
    }

    /// Across the edge from corner k to corner k + 1, for each k.
    pub(crate) fn of(&self, face: u32) -> [u32; 3] {
        self.across[face as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbors_are_across_single_shared_edges_only() {
        // Two triangles share 1–2; three share 0–1; one names a vertex twice, one a vertex that does not exist.
        let triangles = [[0, 1, 2], [2, 1, 3], [1, 0, 4], [0, 1, 5], [1, 1, 3], [3, 1, 9]];
        let neighbors = FaceNeighbors::new(6, &triangles);
        let got: Vec<[u32; 3]> = (0..6).map(|f| neighbors.of(f)).collect();
        let none = [NONE; 3];
        assert_eq!(got, [[NONE, 1, NONE], [0, NONE, NONE], none, none, none, none]);
    }
}
