//! Promises of the whole solver.

mod figures;
