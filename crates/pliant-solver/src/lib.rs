//! Rigidity-controllable as-rigid-as-possible deformation of triangle meshes.
//!
//! # Theory
//! A surface at rest has vertices p, edges e = p_i − p_j and weights w_ij. Some vertices are held at given positions; the
//! others go where the energy
//!
//! ```text
//! E(p', R) = Σ_k Σ_{(i,j) ∈ N(k, r_k)} w_ij ‖(p'_i − p'_j) − R_k (p_i − p_j)‖²        (1)
//! ```
//!
//! is least: every neighborhood N(k, r_k) should only have been turned, by some R_k. The larger r_k, the more the
//! neighborhoods overlap and the stiffer the surface; r = 1 everywhere is the classical method.
//!
//! | symbol | meaning |
//! |---|---|
//! | p, p' | positions at rest and now |
//! | e, e' | edge vectors at rest and now |
//! | w_e | weight of an edge (eq. 2), see [`Weights`] |
//! | r_k | size of the neighborhood of vertex k, see [`Rigidity`] |
//! | N(k, r) | edges with an end within r − 1 edges of k, see [`Neighborhoods`] |
//! | R_k | rotation of the neighborhood of vertex k |
//! | d_e | number of neighborhoods that contain e |
//! | Q_e | sum of their rotations |
//! | S_k | Σ_{e ∈ N(k)} w_e e e'ᵀ |
//!
//! Two steps alternate, and neither can raise E:
//!
//! - *global* (3.2.1): for every free vertex i, Σ_j d_ij w_ij (p'_i − p'_j) = Σ_j w_ij Q_ij (p_i − p_j), a sparse linear
//!   system whose matrix is factored once;
//! - *local* (3.2.2): R_k = argmax tr(R S_k) over the rotations.
//!
//! # Learning r from poses (3.4)
//! Where a surface is given in several poses, the r of each vertex can be found: as large as its surroundings were rigid.
//! [`PoseLearner`] takes one pose after the other, and [`EnergyTable`] keeps, for every vertex k and r, the mean over the
//! poses m of
//!
//! ```text
//! Ẽ(k, r, m) = min_R Σ_{(i,j) ∈ N(k, r)} w_ij ‖(p_i^m − p_j^m) − R (p_i − p_j)‖² / A(k, r)
//! ```
//!
//! with A(k, r) the mixed Voronoi areas of all vertices within r edges of k. Then r_k = argmin Ẽ(k, r) + ω (r_max − r),
//! for any ω without looking at the poses again ([`EnergyTable::learn`]). [`Rigidity::smoothed`] removes specks.
//!
//! # Other methods
//! [`SrArap`] and [`Embedded`] are there to be compared with; [`Method`] prepares any of them for the same steps, and
//! [`arap_energies`] judges what they come to by one measure.
//!
//! # Differences from the paper
//! - Equations (4) and (5) print a factor 2 on the left side only, with which R = I would shrink the rest pose by half.
//!   The line above is the zero gradient of (1).
//! - Weights are clamped by default, because unequal d_e can make the raw system indefinite; the raw ones are there.
//! - Rotations come from Newton's method on quaternions and the top eigenvector of a 4 × 4 matrix instead of a singular
//!   value decomposition. They maximize over rotations only, so no sign has to be mended.
//! - Where the local step is a tie, the paper takes what rounding decides, and so does [`Start::Rest`]. Otherwise the
//!   previous rotation decides.
//! - Besides the two alternating steps there is L-BFGS on p', preconditioned by the factored system: the same minima in
//!   several times fewer iterations ([`Minimizer`]). The alternating steps are the default of [`Solver`].
//! - With learning, ω can be chosen from the energies ([`EnergyTable::auto_omega`]): the paper's 0.3 makes nearly
//!   everything stiff with the formulas as printed, on all poses that were tried. Weights are those of the [`Analysis`]; the
//!   raw ones may make energies negative, which then count as they are. Where A(k, r) = 0, energies are 0. Of equally
//!   good r the larger one is taken.
//! - Iterations begin from the current pose ([`Start::Keep`]) or from the best of several candidates ([`Start::Auto`]);
//!   [`Start::Rest`] is the paper's beginning.
//!
//! # Practice
//! ```
//! use std::sync::Arc;
//! use glam::DVec3;
//! use pliant_solver::*;
//!
//! // A strip of six vertices; the left end is held, the right end lifted.
//! let points = (0..6).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
//! let mesh = Arc::new(Mesh::new(points, vec![[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]])?);
//! let analysis = Arc::new(Analysis::new(mesh, Weights::Clamped));
//! let rigidity = Rigidity::uniform(6, 2);
//! let neighborhoods = Neighborhoods::new(&analysis, &rigidity)?;
//! let held = [0, 1, 4, 5].map(VertexId);
//! let mut solver = Solver::new(analysis, neighborhoods, &rigidity, &held, LooseComponents::KeepAtRest)?;
//!
//! let up = DVec3::new(0.0, 0.0, 0.5);
//! let rest = solver.positions();
//! solver.set_targets(&[rest[0], rest[1], rest[4] + up, rest[5] + up])?;
//! while solver.step().relative_decrease >= 1e-3 {}
//! assert_eq!(solver.positions()[5], rest[5] + up);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Lifetimes and costs
//! | object | lives as long as | cost to make |
//! |---|---|---|
//! | [`Mesh`] | the file | O(n log n) |
//! | [`Analysis`] | mesh and kind of weights | fill-reducing order, symbolic factorization |
//! | [`Neighborhoods`] | r | a search around every vertex with r > 1 |
//! | [`PoseLearner`] | the range of r | a search around every vertex; a microsecond per vertex and pose for each pose |
//! | [`EnergyTable`] | as long as wanted; any ω and r within | reading it once for each ω |
//! | [`Solver`] | as long as wanted; r and held vertices can be changed | numeric factorization |
//! | [`DeformationGraph`] | mesh, number of nodes and k | 2 µs a vertex |
//! | [`SrArap`], [`Embedded`] | as long as wanted; held vertices can be changed | factorizations |
//!
//! Nothing here reads files or clocks. Loops over many elements are shared among rayon's threads, and results do not
//! depend on how many there are.

mod analysis;
mod deformer;
mod embedded;
mod error;
mod held;
mod ids;
mod kernels;
mod lbfgs;
mod learning;
mod linear;
mod matrix;
#[cfg(feature = "measure")]
#[doc(hidden)]
pub mod measure;
mod mesh;
mod rigid_fit;
mod rigidity;
mod rings;
mod solver;
mod sr_arap;
mod start;
mod strain;
#[cfg(test)]
mod test_support;
#[cfg(test)]
mod tests;

pub use analysis::Analysis;
pub use analysis::defects::{Defect, Defects};
pub use analysis::weights::Weights;
pub use deformer::{Deformer, Method};
pub use embedded::{DeformationGraph, Embedded, EnergyWeights};
pub use error::{LearnError, MeshError, RigidityError, SolveError};
pub use held::LooseComponents;
pub use ids::VertexId;
pub use learning::{EnergyTable, Learned, PoseLearner};
pub use mesh::{LARGEST_COORDINATE, Mesh};
pub use rigidity::Rigidity;
pub use rings::neighborhoods::Neighborhoods;
pub use solver::{Minimizer, Solver, StepReport};
pub use sr_arap::SrArap;
pub use start::Start;
pub use strain::arap_energies;
