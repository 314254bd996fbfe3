//! A surface in patches: pieces bounded by its sharp edges.
//!
//! Two triangles belong to one patch if a way leads from one to the other over edges at which the surface turns by less
//! than an angle. The angle does not depend on the order of their corners: what matters is how far the two half-planes at
//! the edge are from being one plane.

use crate::face_neighbors::{FaceNeighbors, NONE};
use glam::DVec3;

/// A corner nearer to the opposite edge than this, in lengths of its side, is on it but for rounding.
const NO_HEIGHT: f64 = 1e-12;

/// Which patch each triangle is in. Patches are numbered by their first triangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FacePatches {
    of_face: Vec<u32>,
    n_patches: u32,
}

impl FacePatches {
    /// Patches bounded by edges at which the surface turns by more than `sharpest` (radians), by borders, and by edges of
    /// three triangles and more. A triangle without area bounds nothing: no angle can be measured at it. O(n).
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]], sharpest: f64) -> FacePatches {
        let neighbors = FaceNeighbors::new(positions.len(), triangles);
        let mut of_face = vec![NONE; triangles.len()];
        let mut n_patches = 0;
        let mut open = Vec::new();
        for first in 0..triangles.len() as u32 {
            if of_face[first as usize] != NONE {
                continue;
            }
            of_face[first as usize] = n_patches;
            open.push(first);
            while let Some(face) = open.pop() {
                for next in neighbors.of(face) {
                    if next != NONE
                        && of_face[next as usize] == NONE
                        && !is_sharp(positions, [triangles[face as usize], triangles[next as usize]], sharpest)
                    {
                        of_face[next as usize] = n_patches;
                        open.push(next);
                    }
                }
            }
            n_patches += 1;
        }
        FacePatches { of_face, n_patches }
    }

    /// The patch of each triangle.
    pub fn of_face(&self) -> &[u32] {
        &self.of_face
    }

    /// How many patches there are.
    pub fn len(&self) -> usize {
        self.n_patches as usize
    }

    /// Whether there are no triangles.
    pub fn is_empty(&self) -> bool {
        self.n_patches == 0
    }
}

/// Whether the surface turns by more than `sharpest` between two triangles that share an edge.
fn is_sharp(positions: &[DVec3], [t, u]: [[u32; 3]; 2], sharpest: f64) -> bool {
    let corner = (0..3).find(|&k| !u.contains(&t[k])).unwrap_or(0);
    let other = u.into_iter().find(|v| !t.contains(v)).unwrap_or(u[0]);
    let [a, b] = [t[(corner + 1) % 3], t[(corner + 2) % 3]].map(|v| positions[v as usize]);
    let edge = (b - a).normalize_or_zero();
    let away = |v: u32| {
        let side = positions[v as usize] - a;
        let height = side - edge * side.dot(edge);
        if height.length() > NO_HEIGHT * side.length() { height.normalize_or_zero() } else { DVec3::ZERO }
    };
    // Both at a right angle to the edge, within their triangles; opposite to each other where the surface is flat.
    let (here, there) = (away(t[corner]), away(other));
    let turn = here.angle_between(-there);
    turn.is_finite() && turn > sharpest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of 1 × 1 × 1, each side two triangles, every second one turned inside out.
    fn cube() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let positions =
            (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2 & 1))).collect();
        let sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [c, a, d]]).collect();
        (positions, triangles)
    }

    #[test]
    fn a_cube_has_six_sides_or_one_surface_by_the_angle() {
        let (positions, triangles) = cube();
        let at = |degrees: f64| FacePatches::new(&positions, &triangles, degrees.to_radians());
        assert_eq!(at(89.0).len(), 6);
        assert!(at(89.0).of_face().chunks(2).all(|side| side[0] == side[1]));
        assert_eq!(at(91.0).len(), 1);
        assert_eq!(at(0.001).len(), 6, "the diagonals are flat");
    }

    #[test]
    fn slivers_do_not_bound_and_broken_triangles_are_patches_of_their_own() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.5, 0.5, 0.0), DVec3::new(1.0, 1.0, 0.0)];
        // A sliver 1–3–2 between two triangles of one plane, then a triangle that names a vertex twice.
        let triangles = [[0, 1, 2], [1, 3, 2], [1, 4, 3], [0, 0, 1]];
        let patches = FacePatches::new(&positions, &triangles, 0.1);
        assert_eq!((patches.of_face(), patches.len()), (&[0, 0, 0, 1][..], 2));
        assert!(FacePatches::new(&[], &[], 0.1).is_empty());
    }
}
