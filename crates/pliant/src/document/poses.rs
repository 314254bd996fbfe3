//! Kept poses: handles with their targets and the surface they gave, to come back to, to play between and to export.
//!
//! Rigidity and method are properties of the material and not of a pose: a kept surface that was bent by others bends on
//! from where it was kept when it is shown again.

use std::sync::Arc;

use glam::DVec3;

use super::{CommandError, Group, Pose, Scene};

/// Names a kept pose within its document.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PoseId(pub u32);

/// A pose on the strip. Cheap to clone.
#[derive(Clone, Debug)]
pub struct KeptPose {
    /// Its lasting name for commands.
    pub id: PoseId,
    /// Its name for people.
    pub name: String,
    /// Handles and anchors where they were.
    pub groups: Arc<[Group]>,
    /// World position of every surface point.
    pub positions: Arc<[DVec3]>,
}

/// Poses share their lists with older states of the scene, so most comparisons end at the pointers.
impl PartialEq for KeptPose {
    fn eq(&self, other: &KeptPose) -> bool {
        (self.id, &self.name) == (other.id, &other.name)
            && (Arc::ptr_eq(&self.groups, &other.groups) || self.groups == other.groups)
            && (Arc::ptr_eq(&self.positions, &other.positions) || self.positions == other.positions)
    }
}

/// What can be done to the strip of poses.
#[derive(Clone, Debug, PartialEq)]
pub enum PoseChange {
    /// Keeps the current pose behind the others.
    Keep,
    /// Gives a pose another name.
    Rename(PoseId, String),
    /// Takes a pose off the strip.
    Delete(PoseId),
    /// Brings a pose to another place on the strip, counted from 0 without it.
    Place(PoseId, usize),
    /// Replaces what a pose keeps by the current pose.
    Update(PoseId),
    /// Brings handles and surface back to a pose.
    Show(PoseId),
}

impl PoseChange {
    /// Name of the step in the history.
    pub fn name(&self) -> &'static str {
        match self {
            PoseChange::Keep => "Keep pose",
            PoseChange::Rename(..) => "Rename pose",
            PoseChange::Delete(_) => "Delete pose",
            PoseChange::Place(..) => "Move pose",
            PoseChange::Update(_) => "Update pose",
            PoseChange::Show(_) => "Show pose",
        }
    }
}

impl Scene {
    /// The kept pose of that name, if it still exists.
    pub fn kept_pose(&self, id: PoseId) -> Option<&KeptPose> {
        self.poses.iter().find(|kept| kept.id == id)
    }

    /// The kept pose whose handles are where they are now, if there is one.
    pub fn pose_shown(&self) -> Option<&KeptPose> {
        let is_shown = |kept: &&KeptPose| Arc::ptr_eq(&kept.groups, &self.groups) || kept.groups == self.groups;
        self.poses.iter().find(is_shown)
    }

    /// Bytes of the poses that `other` does not share.
    pub(super) fn pose_bytes_beyond(&self, other: &Scene) -> usize {
        if Arc::ptr_eq(&self.poses, &other.poses) {
            return 0;
        }
        let shares = |kept: &KeptPose| other.poses.iter().any(|o| Arc::ptr_eq(&o.positions, &kept.positions));
        let own = self.poses.iter().filter(|kept| !shares(kept));
        size_of_val(&*self.poses) + own.map(|kept| size_of_val(&*kept.positions)).sum::<usize>()
    }
}

/// The scene after a change of the strip. Where a pose was shown, its surface is the second answer.
pub(super) fn changed(scene: &Scene, change: PoseChange, now: &Pose) -> Result<(Scene, Option<Pose>), CommandError> {
    let mut next = scene.clone();
    let mut poses = scene.poses.to_vec();
    let place_of = |id: PoseId| scene.poses.iter().position(|kept| kept.id == id).ok_or(CommandError::NoSuchPose);
    let mut shown = None;
    match change {
        PoseChange::Keep => {
            let id = PoseId(1 + scene.poses.iter().map(|kept| kept.id.0).max().unwrap_or(0));
            let (groups, positions) = (scene.groups.clone(), now.positions.clone());
            poses.push(KeptPose { id, name: free_name(scene), groups, positions });
        }
        PoseChange::Rename(id, name) => {
            let name = name.trim();
            let kept = &mut poses[place_of(id)?];
            if !name.is_empty() {
                kept.name = name.to_owned();
            }
        }
        PoseChange::Delete(id) => {
            poses.remove(place_of(id)?);
        }
        PoseChange::Place(id, place) => {
            let kept = poses.remove(place_of(id)?);
            poses.insert(place.min(poses.len()), kept);
        }
        PoseChange::Update(id) => {
            let kept = &mut poses[place_of(id)?];
            (kept.groups, kept.positions) = (scene.groups.clone(), now.positions.clone());
        }
        PoseChange::Show(id) => {
            let kept = &poses[place_of(id)?];
            next.groups = kept.groups.clone();
            let stays = |id| next.groups.iter().any(|group| group.id == id);
            next.active.retain(stays);
            shown = Some(Pose { positions: kept.positions.clone() });
            return Ok((next, shown));
        }
    }
    if *poses != *scene.poses {
        next.poses = poses.into();
    }
    Ok((next, shown))
}

/// 'Pose 3' for the third, or the next number that no pose is called by.
fn free_name(scene: &Scene) -> String {
    let is_free = |name: &String| scene.poses.iter().all(|kept| kept.name != *name);
    let first = scene.poses.len() + 1;
    (first..=2 * first).map(|n| format!("Pose {n}")).find(is_free).unwrap_or_else(|| "Pose".into())
}
