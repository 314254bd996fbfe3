//! The solver on a thread of its own.
//!
//! The window states its whole wish as a [`SolveRequest`]; the worker compares it with what it holds and chooses to
//! move targets, refactor or rebuild, by whichever method the document names. Both directions are mailboxes that keep only
//! the newest letter, so nothing piles up and no order can be wrong.

mod bent;
mod difference;
mod engine;
mod figures;
mod groundwork;
pub(crate) mod mailbox;
mod measures;
mod pace;
mod preview;
mod remarks;
mod request;
mod stillness;
#[cfg(test)]
mod tests;
mod worker;

pub use engine::{Engine, Watch};
pub use groundwork::Groundwork;
pub use measures::{Measure, Measured};
pub use request::{SolveReport, SolveRequest, SolveState};
pub use worker::Worker;
