//! Held vertices in groups: what belongs to one, and which groups are being worked on.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_solver::VertexId;

use super::GroupColor;

/// Names a group for as long as the document lives; never used twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GroupId(pub u32);

/// What a group of held vertices is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupKind {
    /// Moved by the user.
    Handle,
    /// Holds the surface where it is.
    Anchor,
}

/// Vertices whose positions are prescribed together.
#[derive(Clone, Debug)]
pub struct Group {
    /// Its lasting name for commands.
    pub id: GroupId,
    /// Its name for people.
    pub name: String,
    /// Handle or anchor.
    pub kind: GroupKind,
    /// Color of its dots.
    pub color: GroupColor,
    /// Whether its dots are shown.
    pub dots: bool,
    /// Held surface points, sorted; no vertex is in two groups.
    pub vertices: Arc<[VertexId]>,
    /// World positions of `vertices` when the group was placed.
    pub base: Arc<[DVec3]>,
    /// Motion of `base` since then, world space.
    pub motion: DAffine3,
}

/// Groups share their lists with older states of the scene, so most comparisons end at the pointers.
impl PartialEq for Group {
    fn eq(&self, other: &Group) -> bool {
        self.id == other.id
            && self.kind == other.kind
            && (self.color, self.dots) == (other.color, other.dots)
            && self.motion == other.motion
            && self.name == other.name
            && (Arc::ptr_eq(&self.vertices, &other.vertices) || self.vertices == other.vertices)
            && (Arc::ptr_eq(&self.base, &other.base) || self.base == other.base)
    }
}

impl Group {
    /// World position that the solver must give to each of `vertices`.
    pub fn targets(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.base.iter().map(|&p| if self.motion == DAffine3::IDENTITY { p } else { self.motion.transform_point3(p) })
    }

    /// Mean of the base positions: the pivot of rotations and scalings.
    pub fn base_center(&self) -> DVec3 {
        self.base.iter().sum::<DVec3>() / self.base.len().max(1) as f64
    }

    /// Where the middle of the group is now, world space.
    pub fn center(&self) -> DVec3 {
        self.motion.transform_point3(self.base_center())
    }

    /// Whether it holds `v`. O(log vertices).
    pub fn holds(&self, v: VertexId) -> bool {
        self.vertices.binary_search(&v).is_ok()
    }
}

/// Held vertices and the world positions they must take, group by group.
pub fn held_by(groups: &[Group]) -> (Vec<VertexId>, Vec<DVec3>) {
    let vertices = groups.iter().flat_map(|group| group.vertices.iter().copied()).collect();
    (vertices, groups.iter().flat_map(Group::targets).collect())
}

/// The groups that drags, gizmo and inspector act on, in the order of choosing: the last one leads. Cheap to clone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ActiveGroups(Arc<[GroupId]>);

impl ActiveGroups {
    /// In this order; what comes twice counts where it comes last.
    pub fn new(mut ids: Vec<GroupId>) -> ActiveGroups {
        let mut seen = std::collections::HashSet::new();
        ids.reverse();
        ids.retain(|&id| seen.insert(id));
        ids.reverse();
        ActiveGroups(ids.into())
    }

    /// The one whose numbers are shown and whose axes are local.
    pub fn lead(&self) -> Option<GroupId> {
        self.0.last().copied()
    }

    /// All of them.
    pub fn ids(&self) -> &[GroupId] {
        &self.0
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether `id` is among them.
    pub fn contains(&self, id: GroupId) -> bool {
        self.0.contains(&id)
    }

    /// The same without `id` if it is among them, else with it as the lead.
    pub fn toggled(&self, id: GroupId) -> Vec<GroupId> {
        let mut ids: Vec<GroupId> = self.0.iter().copied().filter(|&other| other != id).collect();
        if ids.len() == self.0.len() {
            ids.push(id);
        }
        ids
    }

    /// Only those for which `keep` says so.
    pub(super) fn retain(&mut self, keep: impl Fn(GroupId) -> bool) {
        if !self.0.iter().all(|&id| keep(id)) {
            self.0 = self.0.iter().copied().filter(|&id| keep(id)).collect();
        }
    }
}
