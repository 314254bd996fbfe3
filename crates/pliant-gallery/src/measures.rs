//! What the eye sees in the paper's figures, as numbers.

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_solver::Mesh;

/// Pairs of triangles without a common vertex that cross.
pub(crate) fn crossings(mesh: &Mesh, posed: &[DVec3]) -> usize {
    pliant_geometry::crossings(posed, mesh.triangles()).len()
}

/// Enclosed volume over that at rest.
pub(crate) fn volume_ratio(mesh: &Mesh, posed: &[DVec3]) -> f64 {
    let volume = |at: &[DVec3]| -> f64 {
        let corner = |v: u32| at[v as usize] - at[0];
        mesh.triangles().iter().map(|&[a, b, c]| corner(a).dot(corner(b).cross(corner(c)))).sum()
    };
    volume(posed) / volume(mesh.positions())
}

/// Diagonal of the bounding box.
pub(crate) fn diagonal(positions: &[DVec3]) -> f64 {
    let low = positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let high = positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
    low.distance(high)
}

/// Mean distance of a vertex from where it should be, in diagonals of the shape at rest.
pub(crate) fn distance(mesh: &Mesh, posed: &[DVec3], truth: &[DVec3]) -> f64 {
    let sum: f64 = posed.iter().zip(truth).map(|(p, q)| p.distance(*q)).sum();
    sum / posed.len() as f64 / diagonal(mesh.positions())
}

/// The share of the whole that the largest tenth of the values has: 0.1 where all are the same, 1 where all is there.
pub(crate) fn share_of_largest_tenth(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(|a, b| b.total_cmp(a));
    let whole: f64 = sorted.iter().sum();
    let largest: f64 = sorted[..sorted.len().div_ceil(10)].iter().sum();
    if whole > 0.0 { largest / whole } else { 0.1 }
}

/// Edges with both of their faces, and what becomes of them.
pub(crate) struct Hinges<'a> {
    mesh: &'a Mesh,
    /// Ends, then faces.
    hinges: Vec<([u32; 2], [u32; 2])>,
}

impl<'a> Hinges<'a> {
    pub(crate) fn new(mesh: &'a Mesh) -> Hinges<'a> {
        let mut faces: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
        for (face, &[a, b, c]) in mesh.triangles().iter().enumerate() {
            for [i, j] in [[a, b], [b, c], [c, a]] {
                faces.entry([i.min(j), i.max(j)]).or_default().push(face as u32);
            }
        }
        let hinges = faces.into_iter().filter_map(|(edge, faces)| Some((edge, faces.try_into().ok()?)));
        Hinges { mesh, hinges: hinges.collect() }
    }

    /// Edges both ends of which are wanted.
    pub(crate) fn within(&self, wanted: impl Fn(usize) -> bool) -> Hinges<'a> {
        let inside = |&&([a, b], _): &&([u32; 2], _)| wanted(a as usize) && wanted(b as usize);
        Hinges { mesh: self.mesh, hinges: self.hinges.iter().filter(inside).copied().collect() }
    }

    /// Mean change of length, |length now / length at rest − 1|.
    pub(crate) fn stretch(&self, posed: &[DVec3]) -> f64 {
        let length = |at: &[DVec3], [a, b]: [u32; 2]| at[a as usize].distance(at[b as usize]);
        self.mean(|edge, _| (length(posed, edge) / length(self.mesh.positions(), edge) - 1.0).abs())
    }

    /// Mean change of the angle between the faces, in degrees.
    pub(crate) fn bending(&self, posed: &[DVec3]) -> f64 {
        self.mean(|_, faces| (self.angle(posed, faces) - self.angle(self.mesh.positions(), faces)).abs())
    }

    /// The largest angle between the normals of two neighboring faces, in degrees: a fold from 150° on.
    pub(crate) fn sharpest(&self, posed: &[DVec3]) -> f64 {
        self.hinges.iter().map(|&(_, faces)| self.angle(posed, faces)).fold(0.0, f64::max)
    }

    fn mean(&self, value: impl Fn([u32; 2], [u32; 2]) -> f64) -> f64 {
        let sum: f64 = self.hinges.iter().map(|&(edge, faces)| value(edge, faces)).sum();
        sum / self.hinges.len().max(1) as f64
    }

    fn angle(&self, at: &[DVec3], faces: [u32; 2]) -> f64 {
        let [first, second] = faces.map(|face| {
            let [a, b, c] = self.mesh.triangles()[face as usize].map(|v| at[v as usize]);
            (b - a).cross(c - a)
        });
        // Without area there is no normal.
        if first.length_squared() * second.length_squared() > 0.0 {
            first.angle_between(second).to_degrees()
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron with a corner at the origin.
    fn corner() -> Mesh {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        Mesh::new(points, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).expect("valid")
    }

    #[test]
    fn what_only_grew_is_stretched_and_not_bent() {
        let mesh = corner();
        let grown: Vec<DVec3> = mesh.positions().iter().map(|&p| 1.1 * p + DVec3::ONE).collect();
        let hinges = Hinges::new(&mesh);
        assert!((hinges.stretch(&grown) - 0.1).abs() < 1e-12, "{}", hinges.stretch(&grown));
        assert!(hinges.bending(&grown) < 1e-9, "{}", hinges.bending(&grown));
        assert!((volume_ratio(&mesh, &grown) - 1.331).abs() < 1e-12);
        // Between two sides through the corner a right angle; to the fourth side 125.3°.
        assert!((hinges.sharpest(&grown) - 125.264).abs() < 1e-3, "{}", hinges.sharpest(&grown));
        assert!((hinges.within(|v| v != 3).sharpest(&grown) - 125.264).abs() < 1e-3);
        assert_eq!(hinges.within(|v| v == 0).stretch(&grown), 0.0, "no edges");
    }

    #[test]
    fn the_largest_tenth_has_all_or_its_part() {
        assert_eq!(share_of_largest_tenth(&[1.0; 20]), 0.1);
        let mut one = [0.0; 20];
        one[7] = 3.0;
        assert_eq!(share_of_largest_tenth(&one), 1.0);
        assert_eq!(share_of_largest_tenth(&[]), 0.1);
    }
}
