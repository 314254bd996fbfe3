//! Poses out of files: each against what can be computed by hand.

mod animation;
mod damaged;
mod formats;
mod matching;
pub(super) mod model;
mod morphs;
mod skins;
