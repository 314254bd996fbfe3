//! What bent surfaces are compared by, whatever bent them: measures that ask only where the vertices were and are, and
//! pictures from one camera.
//!
//! | | what it tells | better |
//! |---|---|---|
//! | [`Volume`] | how much of the enclosed space is left | near 1 |
//! | [`stretches`] | how edges changed in length | near 0 |
//! | [`Hinges`] | how the angles between neighboring faces changed | spread out rather than in one place |
//! | [`Spread`] | many such numbers as a few: mean, worst, histograms whose axes can be shared | |
//! | [`Stage`] | the same light and camera for every surface | |

mod bending;
mod spread;
mod stage;
mod stretch;
mod volume;

pub use bending::{Bending, FOLDED_DEGREES, Hinges};
pub use spread::{Axis, Ruler, Spread};
pub use stage::{Marks, PICTURE_PX, Placed, Stage, pointed_out};
pub use stretch::stretches;
pub use volume::{NoVolume, Volume};
