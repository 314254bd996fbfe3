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

    /// Begins anew.
    fn start(&mut self, start: Start);

    /// The first half of an iteration. Embedded deformation has no halves: this is all of it.
    fn global_step(&mut self);

    /// The second half, and what the iteration achieved.
    fn local_step(&mut self) -> StepReport;

    /// One iteration; the energy of the method never rises.
    fn step(&mut self) -> StepReport {
        self.global_step();
        self.local_step()
    }

    /// Positions of all vertices written into `out`; entries beyond the vertices stay.
    fn positions_into(&self, out: &mut [DVec3]);

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
    ($type:ty) => {
        impl Deformer for $type {
            fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError> {
                self.set_targets(targets)
            }

            fn set_held(&mut self, held: &[VertexId]) -> Result<(), SolveError> {
                self.set_held(held)
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
        }
    };
}

deformer!(Solver);
deformer!(SrArap);
deformer!(Embedded);
