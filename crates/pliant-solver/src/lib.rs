//! Rigidity-controllable as-rigid-as-possible deformation of triangle meshes.

mod analysis;
mod edge_set;
mod energy;
mod error;
mod held;
mod hilbert;
mod ids;
mod iteration;
mod mesh;
mod neighborhoods;
mod parallel;
mod rigid_fit;
mod rigidity;
mod rotations;
mod solver;
mod start;
mod sums;
mod system;
#[cfg(test)]
mod test_support;
#[cfg(test)]
mod tests;
mod topology;
mod transpose;
mod weights;

pub use analysis::Analysis;
pub use error::{MeshError, RigidityError, SolveError};
pub use held::LooseComponents;
pub use ids::{ComponentId, EdgeId, FaceId, VertexId};
pub use mesh::{Defects, LARGEST_COORDINATE, Mesh};
pub use neighborhoods::Neighborhoods;
pub use rigidity::Rigidity;
pub use solver::{Solver, StepReport};
pub use start::Start;
pub use weights::Weights;
