//! What every solver of a mesh stands on, whatever the method: made once for a mesh and a kind of weights, and shared.

use std::sync::Arc;

use pliant_geometry::VertexNormals;
use pliant_solver::{Analysis, Weights};
use rayon::prelude::*;

use super::SolveRequest;
use crate::document::{Model, Pose};
use crate::viewport::SurfaceFrame;

/// Positions per task: small meshes are not worth waking other threads.
const PER_TASK: usize = 4096;

/// A model's analysis for one kind of weights, and what its normals need.
pub struct Groundwork {
    pub(super) model: Arc<Model>,
    weights: Weights,
    pub(super) analysis: Arc<Analysis>,
    normals: VertexNormals,
}

impl Groundwork {
    /// Analyzes the mesh of a wish; seconds on a large mesh.
    pub fn new(wish: &SolveRequest) -> Groundwork {
        let model = wish.model.clone();
        Groundwork {
            analysis: Arc::new(Analysis::new(model.mesh.clone(), wish.weights)),
            normals: VertexNormals::new(model.mesh.n_vertices(), &model.triangles),
            weights: wish.weights,
            model,
        }
    }

    /// Whether it is of the same mesh and weights as a wish.
    pub fn serves(&self, wish: &SolveRequest) -> bool {
        Arc::ptr_eq(&self.model, &wish.model) && self.weights == wish.weights
    }

    /// The analyzed mesh.
    pub fn analysis(&self) -> &Arc<Analysis> {
        &self.analysis
    }

    /// View-space positions and normals of a pose of the mesh.
    pub fn frame(&self, pose: &Pose) -> SurfaceFrame {
        let model = &self.model;
        let positions = pose.positions.par_iter().with_min_len(PER_TASK);
        let positions: Vec<_> = positions.map(|&p| model.to_view(p)).collect();
        let mut normals = Vec::new();
        self.normals.compute(&positions, &model.triangles, &mut normals);
        SurfaceFrame { positions, normals }
    }
}
