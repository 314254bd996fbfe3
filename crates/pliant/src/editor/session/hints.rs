//! The hints for a newcomer: wanted once, followed or dismissed, and wanted again on request.

use crate::editor::{Sample, Session, Welcome};

impl Session {
    /// Hints for a newcomer, while they are wanted.
    pub fn welcome(&self) -> Option<Welcome> {
        self.welcome
    }

    /// No more hints, at later starts neither.
    pub fn dismiss_welcome(&mut self) {
        self.welcome = None;
        self.habits.has_seen_hints = true;
    }

    /// The hints again, from the first.
    pub fn show_hints(&mut self) {
        self.welcome = Some(Welcome::default());
    }

    /// The start sample comes with hints, until they have been seen.
    pub(super) fn welcome_to(&mut self, sample: Option<Sample>) {
        let is_wanted = sample == Some(Sample::Creature) && !self.habits.has_seen_hints;
        self.welcome = is_wanted.then(Welcome::default);
    }

    /// Sees whether the view was turned since the hints came.
    pub(in crate::editor) fn watch_view(&mut self) {
        if let (Some(welcome), Some(open)) = (&mut self.welcome, &self.open) {
            let first = welcome.first_view.get_or_insert(open.camera.orientation);
            welcome.turned |= *first != open.camera.orientation;
        }
    }
}
