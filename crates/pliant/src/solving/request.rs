//! What is said between the document and the solver thread.

use std::sync::Arc;

use pliant_solver::{LooseComponents, Rigidity, Weights};

use crate::document::{Document, Group, Model, Pose};
use crate::viewport::SurfaceFrame;

use super::{Measure, Measured};

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
    /// r of every surface point.
    pub rigidity: Rigidity,
    /// Held vertices and where they must be.
    pub groups: Arc<[Group]>,
    /// Edge weights.
    pub weights: Weights,
    /// What parts without handles do.
    pub loose: LooseComponents,
    /// What reports should tell of every vertex.
    pub measure: Option<Measure>,
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
            rigidity: scene.rigidity.clone(),
            groups: scene.groups.clone(),
            weights: scene.weights,
            loose: scene.loose,
            measure,
        }
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
    /// Energy (paper eq. 1), in the file's units.
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
    /// What the user should know: parts without a handle, for instance.
    pub remarks: Vec<String>,
}
