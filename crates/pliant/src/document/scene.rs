//! What the user has laid over the model: rigidity, handles and anchors, a selection.

use std::sync::Arc;

use pliant_solver::{LooseComponents, Rigidity, VertexId, Weights};

use super::{ActiveGroups, Group, GroupId, KeptPose, Method, Model, Selection, SetId, StoredSet, sets};

/// Everything the user can change and undo. Cheap to clone: Arcs and small values.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// r of every surface point.
    pub rigidity: Rigidity,
    /// Handles and anchors in the order of their placing.
    pub groups: Arc<[Group]>,
    /// Selected surface points.
    pub selection: Selection,
    /// Surface points whose r no brush, fill or learning changes.
    pub locked: Selection,
    /// The groups that are being worked on.
    pub active: ActiveGroups,
    /// Selections kept under a name.
    pub sets: Arc<[StoredSet]>,
    /// Edge weights of the energy.
    pub weights: Weights,
    /// What parts without handles do.
    pub loose: LooseComponents,
    /// How the surface bends.
    pub method: Method,
    /// Poses on the strip, in their order.
    pub poses: Arc<[KeptPose]>,
}

impl Scene {
    /// The scene of a freshly opened model: its own r, nothing held.
    pub fn new(model: &Model) -> Scene {
        Scene {
            rigidity: model.rigidity.clone(),
            groups: Arc::new([]),
            selection: Selection::default(),
            locked: Selection::default(),
            active: ActiveGroups::default(),
            sets: Arc::new([]),
            weights: Weights::default(),
            // Eyes and buttons are parts of their own in most files, and nobody wants them left behind.
            loose: LooseComponents::FollowNearest,
            method: Method::default(),
            poses: Arc::new([]),
        }
    }

    /// The group of that name, if it still exists.
    pub fn group(&self, id: GroupId) -> Option<&Group> {
        self.groups.iter().find(|group| group.id == id)
    }

    /// The stored set of that name, if it still exists.
    pub fn set(&self, id: SetId) -> Option<&StoredSet> {
        self.sets.iter().find(|set| set.id == id)
    }

    /// The leading active group, if any.
    pub fn active_group(&self) -> Option<&Group> {
        self.group(self.active.lead()?)
    }

    /// All active groups, the leading one last.
    pub fn active_groups(&self) -> impl Iterator<Item = &Group> {
        self.active.ids().iter().filter_map(|&id| self.group(id))
    }

    /// The group that holds `v`, if any. O(groups · log vertices).
    pub fn group_holding(&self, v: VertexId) -> Option<&Group> {
        self.groups.iter().find(|group| group.holds(v))
    }

    /// Whether the solver would be asked for the same: selection, names and the like do not matter to it.
    pub(super) fn solves_like(&self, other: &Scene) -> bool {
        let same_group = |(a, b): (&Group, &Group)| {
            a.motion == b.motion
                && (Arc::ptr_eq(&a.vertices, &b.vertices) || a.vertices == b.vertices)
                && (Arc::ptr_eq(&a.base, &b.base) || a.base == b.base)
        };
        self.method.solves_like(&other.method)
            && (!self.method.kind.uses_rigidity() || self.rigidity == other.rigidity)
            && self.weights == other.weights
            && self.loose == other.loose
            && self.groups.len() == other.groups.len()
            && (Arc::ptr_eq(&self.groups, &other.groups) || self.groups.iter().zip(&*other.groups).all(same_group))
    }

    /// Whether nothing is lost when one of them takes the place of the other: selections and what is active count little.
    pub(super) fn is_alike(&self, other: &Scene) -> bool {
        let mut same = other.clone();
        same.selection = self.selection.clone();
        same.active = self.active.clone();
        *self == same
    }

    /// Approximate size of what this scene does not share with `other`, in bytes.
    pub(super) fn bytes_beyond(&self, other: &Scene) -> usize {
        let mut bytes = size_of::<Scene>();
        if !std::ptr::eq(self.rigidity.as_slice(), other.rigidity.as_slice()) {
            bytes += size_of_val(self.rigidity.as_slice());
        }
        if !Arc::ptr_eq(&self.groups, &other.groups) {
            bytes += size_of_val(&*self.groups);
            let shares = |group: &Group| other.group(group.id).is_some_and(|o| Arc::ptr_eq(&o.base, &group.base));
            let own = self.groups.iter().filter(|group| !shares(group));
            bytes += own.map(|group| size_of_val(&*group.vertices) + size_of_val(&*group.base)).sum::<usize>();
        }
        if !std::ptr::eq(self.selection.vertices(), other.selection.vertices()) {
            bytes += size_of_val(self.selection.vertices());
        }
        if !std::ptr::eq(self.locked.vertices(), other.locked.vertices()) {
            bytes += size_of_val(self.locked.vertices());
        }
        bytes + sets::bytes_beyond(&self.sets, &other.sets) + self.pose_bytes_beyond(other)
    }
}
