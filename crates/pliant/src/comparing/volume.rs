//! How much space a surface encloses, where that means anything.

use glam::DVec3;
use pliant_solver::Mesh;

/// Why no volume can be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoVolume {
    /// Nothing separates inside from outside.
    #[error("the surface is open ({edges} edges have a face on one side only)")]
    Open {
        /// Edges with one face.
        edges: usize,
    },
    /// Faces disagree on which side is outside.
    #[error("its faces disagree on which side is outside (along {edges} edges)")]
    Unoriented {
        /// Edges whose faces disagree.
        edges: usize,
    },
    /// Closed, but as flat as a sheet of paper folded over.
    #[error("the surface is closed but flat: it encloses nothing")]
    Flat,
}

/// The space that a surface encloses at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    at_rest: Result<f64, NoVolume>,
}

/// Below this part of the bounding box's volume there is none: a closed surface that is folded flat (by eye).
const FLAT: f64 = 1e-6;

impl Volume {
    /// That of the mesh at rest; parts count together.
    pub fn of(mesh: &Mesh) -> Volume {
        let rest = mesh.positions();
        let size = rest.iter().fold((rest[0], rest[0]), |(low, high), &p| (low.min(p), high.max(p)));
        let enclosed = enclosed(rest, mesh.triangles());
        let is_solid = enclosed.abs() > FLAT * (size.1 - size.0).length().powi(3);
        let defects = mesh.defects();
        let at_rest = match () {
            () if defects.boundary_edges > 0 => Err(NoVolume::Open { edges: defects.boundary_edges }),
            () if defects.inconsistent_edges > 0 => Err(NoVolume::Unoriented { edges: defects.inconsistent_edges }),
            () if !is_solid => Err(NoVolume::Flat),
            () => Ok(enclosed),
        };
        Volume { at_rest }
    }

    /// Volume of the same triangles with other positions over that at rest.
    ///
    /// # Errors
    /// Why there is none at rest.
    pub fn ratio(&self, positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<f64, NoVolume> {
        self.at_rest.map(|rest| enclosed(positions, triangles) / rest)
    }

    /// That at rest, in the file's units.
    ///
    /// # Errors
    /// Why there is none.
    pub fn at_rest(&self) -> Result<f64, NoVolume> {
        self.at_rest
    }
}

/// Signed volume, seen from the first vertex: digits are lost far from the origin otherwise.
fn enclosed(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let origin = positions.first().copied().unwrap_or_default();
    let at = |v: u32| positions[v as usize] - origin;
    triangles.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c)))).sum::<f64>() / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron(faces: &[[u32; 3]]) -> (Volume, Mesh) {
        let mesh = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], faces.to_vec()).expect("sound indices");
        (Volume::of(&mesh), mesh)
    }

    #[test]
    fn volume_goes_with_the_cube_of_size_and_is_negative_inside_out() {
        let (volume, mesh) = tetrahedron(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
        assert_eq!(volume.at_rest(), Ok(1.0 / 6.0));
        let scaled = |by: f64| mesh.positions().iter().map(|&p| p * by + 1e3).collect::<Vec<_>>();
        for by in [2.0, -1.0] {
            let got = volume.ratio(&scaled(by), mesh.triangles()).expect("closed");
            // Coordinates of a thousand, differences of one: three digits less than the 16 of double precision.
            assert!((got - f64::powi(by, 3)).abs() < 1e-11, "by {by}: {got}");
        }
    }

    #[test]
    fn where_there_is_no_volume_the_reason_is_told() {
        assert_eq!(tetrahedron(&[[0, 2, 1], [0, 1, 3]]).0.at_rest(), Err(NoVolume::Open { edges: 4 }));
        let disagreeing = tetrahedron(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2]]).0.at_rest();
        assert_eq!(disagreeing, Err(NoVolume::Unoriented { edges: 3 }));
        assert_eq!(tetrahedron(&[[0, 1, 2], [0, 2, 1]]).0.at_rest(), Err(NoVolume::Flat));
    }
}
