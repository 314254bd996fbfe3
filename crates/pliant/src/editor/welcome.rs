//! What the hints for a newcomer wait for.

use glam::Quat;

/// What a newcomer has already done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Welcome {
    /// Has moved a handle.
    pub pulled: bool,
    /// Has changed r.
    pub painted: bool,
    /// Has taken something back.
    pub undone: bool,
    /// Has turned the view.
    pub turned: bool,
    /// How the view was when the hints came.
    pub(super) first_view: Option<Quat>,
}

impl Welcome {
    /// Whether nothing is left to hint at.
    pub fn all_done(self) -> bool {
        self.pulled && self.painted && self.undone && self.turned
    }
}
