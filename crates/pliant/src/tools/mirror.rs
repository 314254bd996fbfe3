//! Painting both sides at once.

use pliant_geometry::{MirrorMap, Plane, Seam};
use pliant_solver::VertexId;
use serde::{Deserialize, Serialize};

use super::Context;
use crate::document::Model;
use crate::viewport::Dot;

/// Where the sides differ: a magenta that no ramp has (by eye).
const UNEVEN: [u8; 4] = [230, 60, 200, 255];

/// How the other side is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MirrorKind {
    /// Not at all.
    Off,
    /// By places at rest: right for any triangulation of a symmetric shape.
    Plane,
    /// By how the mesh hangs together: right for a symmetric mesh in any pose.
    Topology,
}

/// Whether painting is mirrored, and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct MirrorOptions {
    /// How the other side is found.
    pub kind: MirrorKind,
    /// 0, 1 or 2: the plane is at a right angle to x, y or z.
    pub axis: usize,
    /// Where the plane cuts its axis, world space; `None`: through the model's middle.
    pub at: Option<f64>,
    /// How far from its mirrored place a vertex may be, model units.
    pub tolerance: f64,
    /// For [`MirrorKind::Topology`]: an edge of the middle, else one is looked for near the plane.
    pub edge: Option<[u32; 2]>,
}

impl Default for MirrorOptions {
    fn default() -> MirrorOptions {
        MirrorOptions { kind: MirrorKind::Off, axis: 0, at: None, tolerance: 1e-3, edge: None }
    }
}

impl MirrorOptions {
    /// Suits a mesh whose edges have this length on average, and forgets what was said about another mesh.
    pub(super) fn fit(&mut self, mean_edge: f64) {
        // Where the sides are triangulated differently, the nearest vertex is half an edge away or less.
        *self = MirrorOptions { tolerance: 0.6 * mean_edge, at: None, edge: None, ..self.clone() };
    }

    pub(super) fn in_range(mut self) -> MirrorOptions {
        self.axis = self.axis.min(2);
        self.at = self.at.filter(|at| at.is_finite());
        if !self.tolerance.is_finite() || self.tolerance < 0.0 {
            self.tolerance = MirrorOptions::default().tolerance;
        }
        self
    }

    /// The plane in world space.
    pub fn plane(&self, model: &Model) -> Plane {
        let axis = self.axis.min(2);
        Plane { axis, at: self.at.unwrap_or(model.origin[axis]) }
    }
}

/// The other side of a mesh. Computed once for a mesh and its options.
#[derive(Clone, Debug)]
pub struct Mirror {
    /// Who is whose image.
    pub map: MirrorMap,
    /// Two vertices that would have to be images of each other where the sides first differ.
    pub uneven: Option<[VertexId; 2]>,
}

impl Mirror {
    /// Finds the other side. Takes 4 to 14 seconds for a million vertices: call it off the window's thread.
    pub fn find(model: &Model, options: &MirrorOptions) -> Mirror {
        let (positions, plane) = (model.mesh.positions(), options.plane(model));
        match options.kind {
            MirrorKind::Off | MirrorKind::Plane => {
                Mirror { map: MirrorMap::by_plane(positions, plane, options.tolerance), uneven: None }
            }
            MirrorKind::Topology => {
                let seam = Seam { edge: options.edge, plane, tolerance: options.tolerance };
                let (map, uneven) = MirrorMap::by_topology(positions, &model.triangles, seam);
                Mirror { map, uneven: uneven.map(|pair| pair.map(VertexId)) }
            }
        }
    }

    /// Dots where the sides first differ.
    pub(super) fn dots(&self, context: &Context<'_>) -> Vec<Dot> {
        let positions = &context.surface.frame().positions;
        let at = |v: &VertexId| positions.get(v.index()).copied();
        let dot = |position| Dot { position, color: UNEVEN, radius_px: 4.0 };
        self.uneven.iter().flatten().filter_map(at).map(dot).collect()
    }

    /// Adds what takes after `vertices`; sorted, each once.
    pub fn add_images(&self, vertices: &mut Vec<VertexId>) {
        let images: Vec<VertexId> =
            vertices.iter().flat_map(|v| self.map.across(v.0)).map(|&image| VertexId(image)).collect();
        vertices.extend(images);
        vertices.sort_unstable();
        vertices.dedup();
    }
}
