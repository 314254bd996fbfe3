//! What every pane is judged by, whatever its method: the same measures of the surface that it came to.

use glam::DVec3;
use pliant_solver::{Mesh, SolveError, arap_energies};

use crate::document::Pose;
use crate::solving::Groundwork;

/// Measures of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// ARAP energy of the surface (eq. 1 at r = 1 with the best rotations), whatever made it: how much edges are strained.
    pub strain: f64,
    /// Pairs of triangles without a common vertex that cross.
    pub crossings: usize,
    /// Volume over that at rest; none where the surface is open or encloses none.
    pub volume: Option<f64>,
    /// The largest distance of a held vertex from its target, in the file's units.
    pub handle_error: f64,
}

/// What a mesh needs once for its measures.
pub(super) struct Yardstick {
    /// Volume at rest, where that means anything.
    volume: Option<f64>,
}

/// Below this part of the bounding box's volume there is none: a closed surface that is folded flat (by eye).
const FLAT: f64 = 1e-6;

impl Yardstick {
    pub(super) fn new(mesh: &Mesh) -> Yardstick {
        let rest = mesh.positions();
        let size = rest.iter().fold((rest[0], rest[0]), |(low, high), &p| (low.min(p), high.max(p)));
        let enclosed = volume(rest, mesh.triangles());
        let is_solid = enclosed.abs() > FLAT * (size.1 - size.0).length().powi(3);
        let is_closed = is_solid && mesh.defects().boundary_edges == 0;
        Yardstick { volume: is_closed.then_some(enclosed) }
    }

    /// Measures a pose; `off` is how far held vertices are from their targets.
    pub(super) fn measure(&self, ground: &Groundwork, pose: &Pose, off: f64) -> Result<Measures, SolveError> {
        let triangles = ground.analysis().mesh().triangles();
        Ok(Measures {
            strain: arap_energies(ground.analysis(), &pose.positions)?.iter().sum(),
            crossings: pliant_geometry::crossings(&pose.positions, triangles).len(),
            volume: self.volume.map(|rest| volume(&pose.positions, triangles) / rest),
            handle_error: off,
        })
    }
}

/// Signed volume, seen from the first vertex: digits are lost far from the origin otherwise.
fn volume(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let origin = positions.first().copied().unwrap_or_default();
    let at = |v: u32| positions[v as usize] - origin;
    triangles.iter().map(|&[a, b, c]| at(a).dot(at(b).cross(at(c)))).sum::<f64>() / 6.0
}
