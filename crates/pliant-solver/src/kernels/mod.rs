//! The half steps of an iteration and the arithmetic below them.
//!
//! | file | what |
//! |---|---|
//! | `iteration` | the half steps: their memory and order |
//! | `sums` | S, Q and the pull on every vertex, at the cost of the perimeter of the neighborhoods |
//! | `turning`, `rotations` | the best rotations: many at once, and one at a time where that fails |
//! | `energy` | E with the digits that remain when it is small |
//! | `wide`, `lanes` | registers of four and eight numbers, whatever the processor has |
//! | `nines`, `quad` | 3 × 3 matrices and vectors in the form in which they load |
//! | `parallel` | loops shared between threads with the same results for any number of them |

pub(crate) mod energy;
pub(crate) mod iteration;
pub(crate) mod lanes;
pub(crate) mod nines;
pub(crate) mod parallel;
pub(crate) mod quad;
pub(crate) mod rotations;
pub(crate) mod sums;
pub(crate) mod turning;
pub(crate) mod wide;
