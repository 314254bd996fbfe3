//! The strip of kept poses: kept, chosen, shown.

use super::Session;
use crate::document::{Command, KeptPose, PoseChange, PoseId};

/// What the session remembers of the strip besides the document's poses.
#[derive(Default)]
pub(super) struct Strip {
    is_open: bool,
    chosen: Option<PoseId>,
}

impl Session {
    /// The poses on the strip, in order.
    pub fn poses(&self) -> &[KeptPose] {
        self.document().map_or(&[], |document| &document.scene().poses)
    }

    /// Whether the strip is on screen.
    pub fn strip_is_open(&self) -> bool {
        self.strip.is_open && self.document().is_some()
    }

    /// Shows or hides the strip.
    pub fn toggle_strip(&mut self) {
        self.strip.is_open = !self.strip.is_open;
    }

    /// The strip comes up with a document that has poses, and goes with one that has none.
    pub(super) fn fit_strip(&mut self) {
        self.strip = Strip { is_open: !self.poses().is_empty(), chosen: None };
    }

    /// The pose that buttons of the strip act on: the last one clicked, or else the one that is shown.
    pub fn chosen_pose(&self) -> Option<&KeptPose> {
        let scene = self.document()?.scene();
        self.strip.chosen.and_then(|id| scene.kept_pose(id)).or_else(|| scene.pose_shown())
    }

    /// Keeps the current pose at the end of the strip, and brings the strip up.
    pub fn keep_pose(&mut self) {
        if self.document().is_none() {
            return;
        }
        self.strip.is_open = true;
        self.apply(Command::Poses(PoseChange::Keep));
        self.strip.chosen = self.poses().last().map(|kept| kept.id);
    }

    /// Chooses a pose and brings handles and surface back to it.
    pub fn show_pose(&mut self, id: PoseId) {
        self.strip.chosen = Some(id);
        self.apply(Command::Poses(PoseChange::Show(id)));
    }

    /// Shows the pose that stands so many places behind the chosen one, around the ends.
    pub fn step_pose(&mut self, by: isize) {
        let n = self.poses().len() as isize;
        let chosen = self.chosen_pose().map(|kept| kept.id);
        let place = self.poses().iter().position(|kept| Some(kept.id) == chosen);
        let next = match place {
            Some(place) => place as isize + by,
            None if by > 0 => 0,
            None => n - 1,
        };
        if n > 0 {
            let id = self.poses()[next.rem_euclid(n) as usize].id;
            self.show_pose(id);
        }
    }

    /// Moves the chosen pose along the strip.
    pub fn place_chosen_pose(&mut self, by: isize) {
        let Some(id) = self.chosen_pose().map(|kept| kept.id) else { return };
        let Some(place) = self.poses().iter().position(|kept| kept.id == id) else { return };
        let to = place.saturating_add_signed(by);
        self.apply(Command::Poses(PoseChange::Place(id, to)));
    }

    /// Makes the chosen pose what handles and surface are now.
    pub fn update_chosen_pose(&mut self) {
        if let Some(id) = self.chosen_pose().map(|kept| kept.id) {
            self.strip.chosen = Some(id);
            self.apply(Command::Poses(PoseChange::Update(id)));
        }
    }

    /// Takes the chosen pose off the strip.
    pub fn delete_chosen_pose(&mut self) {
        if let Some(id) = self.chosen_pose().map(|kept| kept.id) {
            self.strip.chosen = None;
            self.apply(Command::Poses(PoseChange::Delete(id)));
        }
    }
}
