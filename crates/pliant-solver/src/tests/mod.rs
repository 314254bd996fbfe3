//! Promises of the whole solver.

mod facts;
mod figures;
mod robustness;
