//! The sparse symmetric positive definite system of the global step: order, factor, solve.

mod system;

pub(crate) use system::{FactorError, Pattern, System};
