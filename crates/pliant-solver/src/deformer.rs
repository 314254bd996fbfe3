//! One way to run any of the methods: prepared once, iterated in steps.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    Analysis, DeformationGraph, Embedded, LooseComponents, Minimizer, Neighborhoods, Rigidity, SolveError, Solver,
    SrArap, Start, StepReport, VertexId,
};

/// A surface with handles that some method bends. All is in the caller's numbering; see [`Solver`] for what each call does.
pub trait Deformer: Send {
    /// One target per held vertex.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`.
    fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError>;

    /// Other held vertices; the pose stays.
    ///
    /// # Errors
    /// [`SolveError::NoHandles`], `HeldOutOfRange`, `HeldTwice`, `Indefinite`, `TooLarge`. All is as it was then.
    fn set_held(&mut self, held: &[VertexId]) -> Result<(), SolveError>;

    /// Replaces the current pose: positions of all vertices. Embedded deformation comes as near to them as it can.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`. All is as it was then.
    fn set_pose(&mut self, positions: &[DVec3]) -> Result<(), SolveError>;

    /// Begins anew.
    fn start(&mut self, start: Start);

    /// The first half of an iteration. Embedded deformation has no halves: this is all of it.
    fn global_step(&mut self);

    /// Whether the first half of the next iteration takes the surface where the whole iteration will: the second half
    /// shortens no step that is plain, as those after a change are.
    fn is_next_plain(&self) -> bool;

    /// The second half, and what the iteration achieved.
    fn local_step(&mut self) -> StepReport;

    /// One iteration; the energy of the method never rises.
    fn step(&mut self) -> StepReport {
        self.global_step();
        self.local_step()
    }

    /// One iteration, unless `is_wanted` says no while nothing has moved yet: then none is returned. Methods that cannot
    /// give way do not ask.
    fn step_while(&mut self, is_wanted: &mut (dyn FnMut() -> bool + Send)) -> Option<StepReport> {
        let _ = is_wanted;
        Some(self.step())
    }

    /// Positions of all vertices written into `out`; entries beyond the vertices stay.
    fn positions_into(&self, out: &mut [DVec3]);

    /// The share of each vertex in the energy. None where vertices have none: with embedded deformation it is the nodes'.
    fn vertex_energies(&self) -> Option<Vec<f64>>;

    /// Components without a held vertex: (vertex count, first vertex), by first vertex.
    fn loose_components(&self) -> &[(usize, VertexId)];
}

/// The methods there are, with their parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum Method {
    /// The r-ring energy of the paper; with r = 1 everywhere it is ARAP (Sorkine and Alexa 2007).
    RRing(Rigidity),
    /// Levi and Gotsman 2015.
    SrArap {
        /// How much turning alike counts; at least 0.
        alpha: f64,
    },
    /// Sumner, Schmid and Pauly 2007.
    Embedded {
        /// Nodes of the deformation graph.
        nodes: usize,
        /// Nodes that carry a vertex.
        neighbors: usize,
    },
}

impl Method {
    /// α of Levi and Gotsman as other implementations have it.
    pub const ALPHA: f64 = 0.02;
    /// Enough nodes for limbs and fingers, few enough for 60 steps a second.
    pub const NODES: usize = 500;
    /// Nodes that carry a vertex, from the paper.
    pub const NODE_NEIGHBORS: usize = 4;

    /// A surface at rest, to be bent by this method. For neighborhoods that are long in the making, see
    /// [`Neighborhoods::with_progress`].
    ///
    /// # Errors
    /// Those of [`Neighborhoods::new`], [`Solver::new`], [`SrArap::new`], [`Embedded::new`].
    pub fn prepare(
        &self,
        analysis: Arc<Analysis>,
        held: &[VertexId],
        loose: LooseComponents,
        minimizer: Minimizer,
    ) -> Result<Box<dyn Deformer>, SolveError> {
        Ok(match self {
            Method::RRing(rigidity) => {
                let neighborhoods = Neighborhoods::new(&analysis, rigidity)?;
                let mut solver = Solver::new(analysis, neighborhoods, rigidity, held, loose)?;
                solver.set_minimizer(minimizer);
                Box::new(solver)
            }
            &Method::SrArap { alpha } => {
                let mut solver = SrArap::new(analysis, alpha, held, loose)?;
                solver.set_minimizer(minimizer);
                Box::new(solver)
            }
            &Method::Embedded { nodes, neighbors } => {
                let graph = Arc::new(DeformationGraph::new(&analysis, nodes, neighbors));
                Box::new(Embedded::new(analysis, graph, held, loose)?)
            }
        })
    }
}

macro_rules! deformer {
    ($type:ty { $($own:item)* }) => {
        impl Deformer for $type {
            fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError> {
                self.set_targets(targets)
            }

            fn set_held(&mut self, held: &[VertexId]) -> Result<(), SolveError> {
                self.set_held(held)
            }

            fn set_pose(&mut self, positions: &[DVec3]) -> Result<(), SolveError> {
                self.set_pose(positions)
            }

            fn start(&mut self, start: Start) {
                self.start(start);
            }

            fn global_step(&mut self) {
                self.global_step();
            }

            fn local_step(&mut self) -> StepReport {
                self.local_step()
            }

            fn positions_into(&self, out: &mut [DVec3]) {
                self.positions_into(out);
            }

            fn loose_components(&self) -> &[(usize, VertexId)] {
                self.loose_components()
            }

            $($own)*
        }
    };
}

deformer!(Solver {
    fn step_while(&mut self, is_wanted: &mut (dyn FnMut() -> bool + Send)) -> Option<StepReport> {
        self.step_while(is_wanted)
    }

    fn is_next_plain(&self) -> bool {
        self.is_next_plain()
    }

    fn vertex_energies(&self) -> Option<Vec<f64>> {
        Some(self.vertex_energies())
    }
});
deformer!(SrArap {
    fn is_next_plain(&self) -> bool {
        self.is_next_plain()
    }

    fn vertex_energies(&self) -> Option<Vec<f64>> {
        Some(self.vertex_energies())
    }
});
deformer!(Embedded {
    fn is_next_plain(&self) -> bool {
        true
    }

    fn vertex_energies(&self) -> Option<Vec<f64>> {
        None
    }
});

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Weights;
    use crate::test_support::{arc, box_bar, farthest};

    fn methods() -> [Method; 3] {
        let sizes = Rigidity::uniform(354, 2);
        [
            Method::RRing(sizes),
            Method::SrArap { alpha: Method::ALPHA },
            Method::Embedded { nodes: 60, neighbors: Method::NODE_NEIGHBORS },
        ]
    }

    /// A bar bent by 100 degrees, prepared by a method.
    fn bent(method: &Method) -> Box<dyn Deformer> {
        let mesh = box_bar([20, 4, 4], DVec3::new(5.0, 1.0, 1.0));
        assert_eq!(mesh.n_vertices(), 354, "as many as have sizes");
        let (held, targets) = arc(&mesh, 5.0, 100f64.to_radians());
        let analysis = Arc::new(Analysis::new(Arc::new(mesh), Weights::Clamped));
        let prepared = method.prepare(analysis, &held, LooseComponents::KeepAtRest, Minimizer::Lbfgs);
        let mut deformer = prepared.expect("solvable");
        deformer.set_targets(&targets).expect("finite");
        deformer.start(Start::Auto);
        deformer
    }

    fn positions(deformer: &dyn Deformer) -> Vec<DVec3> {
        let mut out = vec![DVec3::ZERO; 354];
        deformer.positions_into(&mut out);
        out
    }

    #[test]
    fn every_method_goes_on_from_a_pose_that_is_given_back_to_it() {
        for method in methods() {
            let mut deformer = bent(&method);
            let settled = (0..80).map(|_| deformer.step().energy).last().expect("steps");
            let pose = positions(&*deformer);
            deformer.start(Start::Rest);
            deformer.set_pose(&pose).expect("as many");
            let first = deformer.step().energy;
            // Rotations and nodes are found anew from positions alone: near the end, not at it.
            assert!(first < 1.1 * settled, "{method:?}: {first} after {settled}");
            let last = (0..80).map(|_| deformer.step().energy).last().expect("steps");
            assert!((last - settled).abs() < 1e-3 * settled, "{method:?}: {last}, expected {settled}");
            let (v, off) = farthest(&positions(&*deformer), &pose);
            assert!(off < 0.02, "{method:?}: vertex {v} is off by {off}");
        }
    }

    #[test]
    fn a_pose_of_another_method_is_where_the_next_one_begins() {
        let mut deformers = methods().map(|method| bent(&method));
        deformers.iter_mut().for_each(|deformer| (0..20).for_each(|_| _ = deformer.step()));
        let pose = positions(&*deformers[0]);
        for deformer in &mut deformers[1..] {
            deformer.start(Start::Rest);
            deformer.set_pose(&pose).expect("as many");
            let (v, off) = farthest(&positions(&**deformer), &pose);
            // Sixty nodes on a bar of five: each carries what lies within half of its thickness.
            assert!(off < 0.15, "vertex {v} is off by {off}");
            assert!(deformer.set_pose(&pose[1..]).is_err());
        }
    }

    #[test]
    fn energies_of_vertices_add_up_to_that_of_the_whole() {
        for method in methods() {
            let mut deformer = bent(&method);
            let energy = deformer.step().energy;
            if let Some(shares) = deformer.vertex_energies() {
                let sum: f64 = shares.iter().sum();
                assert!((sum - energy).abs() < 1e-9 * energy, "{method:?}: {sum}, expected {energy}");
            }
        }
    }
}
