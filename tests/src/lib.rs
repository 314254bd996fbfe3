//! What the cross-crate tests share: shapes made by formula, an independent reference of the paper's energy, and a
//! way to run the command line inside the test's own process.
//!
//! | module | what |
//! |---|---|
//! | [`shapes`] | bars, sheets and bumpy balls, with the arc that bends a bar |
//! | [`reference`](mod@reference) | eq. (1) minimized slowly and plainly, sharing no code with the solver |
//! | [`program`] | `pliant …` as a function call |
//! | [`pose_sets`] | the sets of poses with known bones |

pub mod pose_sets;
pub mod program;
pub mod reference;
pub mod shapes;
