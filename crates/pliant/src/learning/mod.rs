//! Rigidity learned from poses: what editor and command line share beyond the solver's learning.
//!
//! | module | what |
//! |---|---|
//! | [`gather`] | poses out of files into a table of energies |
//! | [`sources`] | all poses out of all files, one at a time |
//! | [`leave_one_out`] | does learned rigidity predict a pose that it was not learned from? |
//! | `patches` | where such a prediction is held |

pub mod gather;
pub mod leave_one_out;
mod patches;
pub mod sources;

use std::ops::ControlFlow;

/// Told the fraction that is done, ascending; stops everything by answering [`ControlFlow::Break`].
pub type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + Send + 'a;
