//! The sparse symmetric positive definite system of the global step: order, factor, solve.
//!
//! | object | made | cost |
//! |---|---|---|
//! | [`Pattern`] | once per mesh | fill-reducing order, symbolic factorization, plan of the work |
//! | [`System::factor`] | when d, w or the fixed vertices change | numeric factorization of the parts that changed |
//! | [`System::solve_in_place`] | every global step | two triangular solves, three right-hand sides |
//!
//! The matrix A = L Lᵀ is that of a graph on a surface. Cut the surface in two along a curve, put the vertices on the
//! curve last, and go on likewise on both sides: eliminated in this order, few zeros fill in, and the two sides have
//! nothing to do with each other until the curve. All work is therefore a tree of [tasks](plan): whole subtrees of the
//! elimination tree at the bottom, single separators above, run in parallel where they are independent. What a task
//! leaves to those above it is small and is kept, so that a local change of the matrix costs a few tasks only.
//!
//! Results do not depend on the number of threads: the tasks do not, and every sum is taken in a fixed order.

#[cfg(feature = "measure")]
mod beside;
mod dense;
mod dissection;
mod elimination;
mod factor;
mod panels;
mod pattern;
mod plan;
mod solve;
mod symbolic;
mod system;

#[cfg(feature = "measure")]
pub(crate) use beside::ByFaer;
pub(crate) use pattern::{Ordered, Pattern};
pub(crate) use system::{FactorError, System};
