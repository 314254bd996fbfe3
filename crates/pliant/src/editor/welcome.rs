//! What the hints for a newcomer wait for.

/// What a newcomer has already done with the start sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Welcome {
    /// Has moved a handle.
    pub pulled: bool,
    /// Has changed r.
    pub painted: bool,
    /// Has taken something back.
    pub undone: bool,
}

impl Welcome {
    /// Whether nothing is left to hint at.
    pub fn all_done(self) -> bool {
        self.pulled && self.painted && self.undone
    }
}
