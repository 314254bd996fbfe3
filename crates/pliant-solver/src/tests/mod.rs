//! Promises of the whole solver.

mod facts;
mod fewer;
mod figures;
mod robustness;
