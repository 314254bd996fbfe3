//! Poses of a mesh out of files: what rigidity is learned from.
//!
//! **Idea.** A pose is a place for every surface point of a *reference*. It may come from a file of its own in any
//! format, from a morph target, or from a frame of an animation; all are streams here that give one pose after the
//! other, compute it when it is asked for, and keep none.
//!
//! - A file's faces must be the reference's, vertex for vertex or, through welding, corner for corner; otherwise it is
//!   refused with the first difference (`matching`).
//! - Vertices that are one surface point in the reference may part in a pose (a seam of texture coordinates whose two
//!   sides are bound to different joints). The point is then put in their middle, and how far they parted is told.
//! - Frames that show the same shape as one taken before teach nothing twice (`alike`): they are passed over.
//! - A file in another unit has another size: on request its scale is found and divided out (`scale`).

mod alike;
mod error;
mod matching;
mod scale;
mod stream;

pub use error::{PoseError, PoseFault};
pub use stream::{Found, Parted, Pose, Poses};

/// How poses are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoseOptions {
    /// Frames taken of each animation, evenly from its first key to its last; at least 1.
    pub frames: usize,
    /// Whether files with as many vertices as the reference but other faces are taken to be the reference's vertices in
    /// the same order.
    pub reference_faces: bool,
    /// Whether another unit of length is divided out of a file's poses.
    pub match_scale: bool,
}

impl Default for PoseOptions {
    /// 24 frames of each animation: a second of film. A walk of two steps is then seen at every 15° of its cycle.
    fn default() -> Self {
        PoseOptions { frames: 24, reference_faces: false, match_scale: false }
    }
}
