//! Kept poses in motion: what lies between two of them, how it is played, and how it goes into files.
//!
//! Between poses the *handles* are interpolated and the surface is solved: vertices are never blended. What both poses hold
//! moves rigidly along a screw, its stretch changes by equal factors in equal times. What only one of them holds goes to, or
//! comes from, where the other pose's surface has it: so at either end nothing pulls that was not there.

mod export;
mod frames;
mod motion;
mod plan;
mod player;
mod segment;
mod solve;
#[cfg(test)]
mod tests;

pub use export::{Canceled, Export, export};
pub use frames::{Frames, Source};
pub use motion::between;
pub use plan::{Kind, MAX_BETWEEN, MAX_SIDE_PX, Plan, numbered};
pub use player::{Player, Repeat};
pub use segment::Segment;
pub use solve::{Solved, inbetweens};
