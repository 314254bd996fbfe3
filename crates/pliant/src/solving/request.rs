//! What is said between the document and the solver thread.

use std::sync::{Arc, Weak};

use pliant_solver::{LooseComponents, Rigidity, Weights};

use super::{Groundwork, Measure, Measured};
use crate::document::{Document, Group, Method, MethodKind, Model, Pose};
use crate::viewport::SurfaceFrame;

/// The whole wish: not what changed, but what should hold.
#[derive(Clone)]
pub struct SolveRequest {
    /// Goes up with everything that changes the surface.
    pub revision: u64,
    /// Goes up when the pose jumps; the worker then takes over `pose`.
    pub epoch: u64,
    /// The document's pose when the wish was made: where a solver starts that jumped or had to be built anew.
    pub pose: Pose,
    /// The surface.
    pub model: Arc<Model>,
    /// How the surface bends.
    pub method: Method,
    /// r of every surface point, as the method has it: 1 everywhere for ARAP; others than r-ring do not look at it.
    pub rigidity: Rigidity,
    /// Held vertices and where they must be.
    pub groups: Arc<[Group]>,
    /// Edge weights.
    pub weights: Weights,
    /// What parts without handles do.
    pub loose: LooseComponents,
    /// What reports should tell of every vertex.
    pub measure: Option<Measure>,
    /// Whether reports should tell the energy of every vertex as well.
    pub wants_energies: bool,
}

impl SolveRequest {
    /// All that a document wants now.
    pub fn of(document: &Document, measure: Option<Measure>) -> SolveRequest {
        let scene = document.scene();
        SolveRequest {
            revision: document.revision(),
            epoch: document.epoch(),
            pose: document.pose().clone(),
            model: document.model().clone(),
            method: scene.method,
            rigidity: match scene.method.kind {
                MethodKind::Arap => Rigidity::uniform(document.model().mesh.n_vertices(), 1),
                _ => scene.rigidity.clone(),
            },
            groups: scene.groups.clone(),
            weights: scene.weights,
            loose: scene.loose,
            measure,
            wants_energies: false,
        }
    }

    /// Whether what is being searched for an older wish would be of no use to this one.
    pub fn is_other_search(&self, older: &SolveRequest) -> bool {
        !Arc::ptr_eq(&self.model, &older.model)
            || self.weights != older.weights
            || self.rigidity != older.rigidity
            || !self.method.solves_like(&older.method)
            || self.groups.is_empty()
    }

    /// Whether it is for another method, other sizes or other held vertices than an older one, and not only for other
    /// targets, which the surface follows on the way.
    pub fn is_other_system(&self, older: &SolveRequest) -> bool {
        self.is_other_search(older)
            || self.epoch != older.epoch
            || self.groups.len() != older.groups.len()
            || self.groups.iter().zip(older.groups.iter()).any(|(new, old)| new.vertices != old.vertices)
    }
}

/// How the solver is doing.
#[derive(Clone, Debug, PartialEq)]
pub enum SolveState {
    /// Nothing is held, so there is nothing to solve.
    Resting,
    /// Building neighborhoods and factoring, where that takes long.
    Preparing {
        /// How far the search for neighborhoods is, from 0 to 1.
        progress: f64,
    },
    /// Energy is still falling.
    Iterating,
    /// Energy has stopped falling.
    Settled,
    /// It cannot be solved: why, and what to do.
    Failed(String),
}

/// The solver's answer.
#[derive(Clone)]
pub struct SolveReport {
    /// The surface it belongs to.
    pub model: Arc<Model>,
    /// The newest wish it knows of.
    pub revision: u64,
    /// The epoch it belongs to.
    pub epoch: u64,
    /// How it is doing.
    pub state: SolveState,
    /// New positions, unless they are as last reported.
    pub pose: Option<Pose>,
    /// The same in view space with normals, ready for the picture.
    pub frame: Option<Arc<SurfaceFrame>>,
    /// Energy of the method: eq. 1 of the paper for r-ring, in the file's units.
    pub energy: f64,
    /// Iterations since the solver was built or last started anew after a leap of the handles.
    pub iteration: u64,
    /// (E before − E after) / E before of the last iteration.
    pub relative_decrease: f64,
    /// Median time of the last iterations, milliseconds.
    pub iteration_ms: f64,
    /// Energies of the last iterations, oldest first.
    pub energies: Arc<[f64]>,
    /// What was asked for of every vertex, where there is something to tell.
    pub measured: Option<Measured>,
    /// Energy of every vertex, in the unit of `energy`, when asked for and something is held.
    pub vertex_energies: Option<Arc<[f64]>>,
    /// What the user should know: parts without a handle, for instance.
    pub remarks: Vec<String>,
    /// What the solver stands on, while it is there: others may stand on it too.
    pub ground: Weak<Groundwork>,
}
