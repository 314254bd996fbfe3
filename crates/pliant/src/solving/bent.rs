//! A surface prepared by one of the methods. What takes long and can be stopped comes first, as [`Material`], while what was
//! prepared before is still there; then the rest, for which the old one makes room.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec3;
use pliant_solver::{
    Analysis, DeformationGraph, Deformer, Embedded, LooseComponents, Minimizer, Neighborhoods, SolveError, Solver,
    SrArap, VertexId, arap_energies,
};

use super::engine::Watch;
use super::{Groundwork, SolveRequest};
use crate::document::{MethodKind, Pose};

/// Several times fewer iterations than the plain one, and hardly dearer.
const MINIMIZER: Minimizer = Minimizer::Lbfgs;

/// What a method needs besides the analysis.
pub(super) enum Material {
    Rings(Neighborhoods),
    SrArap { alpha: f64 },
    Nodes(Arc<DeformationGraph>),
}

/// The last deformation graph: it does not depend on handles.
#[derive(Default)]
pub(super) struct KeptGraph(Option<(usize, usize, Arc<DeformationGraph>)>);

impl KeptGraph {
    fn get(&mut self, analysis: &Analysis, nodes: usize, neighbors: usize) -> Arc<DeformationGraph> {
        match &self.0 {
            Some((n, k, graph)) if (*n, *k) == (nodes, neighbors) => graph.clone(),
            _ => {
                let graph = Arc::new(DeformationGraph::new(analysis, nodes, neighbors));
                self.0 = Some((nodes, neighbors, graph.clone()));
                graph
            }
        }
    }
}

impl Material {
    /// Gathers what the method of a wish needs. Breaks if `watch` stopped it.
    pub(super) fn gather(
        ground: &Groundwork,
        wish: &SolveRequest,
        graphs: &mut KeptGraph,
        watch: &mut Watch<'_>,
    ) -> ControlFlow<(), Result<Material, SolveError>> {
        let method = wish.method;
        ControlFlow::Continue(match method.kind {
            MethodKind::RRing | MethodKind::Arap => {
                let found = Neighborhoods::with_progress(&ground.analysis, &wish.rigidity, &mut |done| watch(done));
                if found.as_ref().is_err_and(|error| *error == SolveError::Canceled) {
                    return ControlFlow::Break(());
                }
                found.map(Material::Rings)
            }
            MethodKind::SrArap => Ok(Material::SrArap { alpha: method.alpha }),
            MethodKind::Embedded => Ok(Material::Nodes(graphs.get(&ground.analysis, method.nodes, method.neighbors))),
        })
    }
}

/// Where held vertices are, and must be.
#[derive(Clone, Copy)]
pub(super) struct Holds<'a> {
    pub(super) vertices: &'a [VertexId],
    pub(super) targets: &'a [DVec3],
}

/// A prepared surface.
pub(super) enum Bent {
    /// The only one whose sizes can be changed.
    Rings(Box<Solver>),
    SrArap(Box<SrArap>),
    Embedded(Box<Embedded>),
}

impl Bent {
    /// In a pose, with its targets.
    pub(super) fn new(
        material: Material,
        ground: &Groundwork,
        wish: &SolveRequest,
        holds: Holds<'_>,
        pose: &[DVec3],
    ) -> Result<Bent, SolveError> {
        let (analysis, loose): (_, LooseComponents) = (ground.analysis.clone(), wish.loose);
        let mut bent = match material {
            Material::Rings(neighborhoods) => {
                let mut solver = Solver::new(analysis, neighborhoods, &wish.rigidity, holds.vertices, loose)?;
                solver.set_minimizer(MINIMIZER);
                Bent::Rings(Box::new(solver))
            }
            Material::SrArap { alpha } => {
                let mut solver = SrArap::new(analysis, alpha, holds.vertices, loose)?;
                solver.set_minimizer(MINIMIZER);
                Bent::SrArap(Box::new(solver))
            }
            Material::Nodes(graph) => {
                let mut solver = Embedded::new(analysis, graph, holds.vertices, loose)?;
                solver.set_weights(wish.method.weights());
                Bent::Embedded(Box::new(solver))
            }
        };
        let deformer = bent.deformer_mut();
        deformer.set_pose(pose)?;
        deformer.set_targets(holds.targets)?;
        Ok(bent)
    }

    pub(super) fn deformer(&self) -> &dyn Deformer {
        match self {
            Bent::Rings(solver) => &**solver,
            Bent::SrArap(solver) => &**solver,
            Bent::Embedded(solver) => &**solver,
        }
    }

    pub(super) fn deformer_mut(&mut self) -> &mut dyn Deformer {
        match self {
            Bent::Rings(solver) => &mut **solver,
            Bent::SrArap(solver) => &mut **solver,
            Bent::Embedded(solver) => &mut **solver,
        }
    }

    /// Whether its steps cost the same for any mesh, and need no preview.
    pub(super) fn is_quick(&self) -> bool {
        matches!(self, Bent::Embedded(_))
    }

    /// Where all vertices are, written where it stays.
    pub(super) fn pose(&self, ground: &Groundwork) -> Pose {
        let mut positions: Arc<[DVec3]> = std::iter::repeat_n(DVec3::ZERO, ground.model.mesh.n_vertices()).collect();
        if let Some(positions) = Arc::get_mut(&mut positions) {
            self.deformer().positions_into(positions);
        }
        Pose { positions }
    }

    /// The share of every vertex in the energy; where vertices have none, how strained it is (the energy at r = 1).
    pub(super) fn vertex_energies(&self, ground: &Groundwork) -> Vec<f64> {
        self.deformer().vertex_energies().unwrap_or_else(|| {
            arap_energies(&ground.analysis, &self.pose(ground).positions).unwrap_or_else(|_| {
                // A surface that is not finite has no colors.
                vec![0.0; ground.model.mesh.n_vertices()]
            })
        })
    }
}
