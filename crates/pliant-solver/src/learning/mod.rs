//! Rigidity learned from poses (paper 3.4): how large a neighborhood has moved as one piece.
//!
//! | file | what |
//! |---|---|
//! | `areas` | mixed Voronoi areas |
//! | `shells` | neighborhoods ring by ring, and A(k, r) |
//! | `energies` | E(k, r, m) of one pose |
//! | `learner` | their sums over poses |
//! | `table` | their means, and r_k for an ω |
//! | `omega` | an ω from the means |
//! | `smoothing` | specks removed |
//!
//! Neighborhoods are nested, so sums grow from r to r by a shell of edges: together some 8.7 r_max² edges a vertex,
//! which is also about what differences of prefix sums would read for all r up to r_max (their cost is the perimeter of
//! each neighborhood), but without their loss of digits and with each vertex seen from its own frame.

mod areas;
mod energies;
mod learner;
mod omega;
mod shells;
mod smoothing;
mod table;
#[cfg(test)]
mod tests;

pub use learner::PoseLearner;
pub use table::{EnergyTable, Learned};
