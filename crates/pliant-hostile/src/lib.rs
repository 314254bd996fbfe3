//! x
pub mod exercise;
pub mod random;
