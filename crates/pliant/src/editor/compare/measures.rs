//! What every pane is judged by, whatever its method: the same measures of the surface that it came to.

use pliant_solver::{Mesh, SolveError, arap_energies};

use crate::comparing::Volume;
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
    volume: Volume,
}

impl Yardstick {
    pub(super) fn new(mesh: &Mesh) -> Yardstick {
        Yardstick { volume: Volume::of(mesh) }
    }

    /// Measures a pose; `off` is how far held vertices are from their targets.
    pub(super) fn measure(&self, ground: &Groundwork, pose: &Pose, off: f64) -> Result<Measures, SolveError> {
        let triangles = ground.analysis().mesh().triangles();
        Ok(Measures {
            strain: arap_energies(ground.analysis(), &pose.positions)?.iter().sum(),
            crossings: pliant_geometry::crossings(&pose.positions, triangles).len(),
            volume: self.volume.ratio(&pose.positions, triangles).ok(),
            handle_error: off,
        })
    }
}
