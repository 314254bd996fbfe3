//! Handles and anchors, as menus, keys and the inspector change them.

use std::sync::Arc;

use glam::Vec3;

use super::Session;
use crate::document::{Command, Group, GroupId, GroupKind, Placement, SelectMode};
use crate::tools::{Options, Pivot};

/// Part of the box around what is framed that stays free on each side, so that a single vertex is not looked at from
/// within (by eye).
const FRAME_MARGIN: f32 = 0.04;
/// Stretches that can be typed: a patch pressed flat cannot be pulled apart again.
const SCALES: (f64, f64) = (1e-3, 1e3);

/// Numbers as they were typed, for as long as the group is where they put it. Read from the motion they would jump: a
/// turn of 120° about y reads as three others.
pub(super) type Typed = Option<(Group, Placement)>;

impl Session {
    /// Carries out several commands as one step.
    pub fn apply_as(&mut self, step: &'static str, commands: Vec<Command>) {
        self.apply(Command::Begin(step));
        commands.into_iter().for_each(|command| self.apply(command));
        self.apply(Command::Commit);
    }

    /// The groups that are being worked on, the leading one last.
    pub fn active_groups(&self) -> Vec<Group> {
        self.document().map(|document| document.scene().active_groups().cloned().collect()).unwrap_or_default()
    }

    fn active_ids(&self) -> Vec<GroupId> {
        self.document().map(|document| document.scene().active.ids().to_vec()).unwrap_or_default()
    }

    fn selected(&self) -> Vec<pliant_solver::VertexId> {
        self.document().map(|document| document.scene().selection.vertices().to_vec()).unwrap_or_default()
    }

    /// Lets the active groups go.
    pub fn release_active(&mut self) {
        self.apply(Command::Release(self.active_ids()));
    }

    /// Puts the active groups back to the rest shape.
    pub fn return_active_to_rest(&mut self) {
        let ids = self.active_ids();
        self.apply_as("Return handle to rest", ids.into_iter().map(Command::ReturnToRest).collect());
    }

    /// Makes anchors of the active handles and handles of the active anchors.
    pub fn swap_active_kinds(&mut self) {
        let swapped = |group: &Group| {
            let kind = if group.kind == GroupKind::Handle { GroupKind::Anchor } else { GroupKind::Handle };
            Command::SetKind(group.id, kind)
        };
        let commands = self.active_groups().iter().map(swapped).collect();
        self.apply_as("Change handle kind", commands);
    }

    /// Makes one group of the active ones.
    pub fn merge_active(&mut self) {
        self.apply(Command::Merge(self.active_ids()));
    }

    /// Brings the selected vertices into the leading active group.
    pub fn add_selection_to_active(&mut self) {
        if let Some(&id) = self.active_ids().last() {
            self.apply(Command::AddToGroup(id, self.selected()));
        }
    }

    /// Lets the selected vertices of the active groups go.
    pub fn remove_selection_from_active(&mut self) {
        let selected = self.selected();
        let commands = self.active_ids().into_iter().map(|id| Command::RemoveFromGroup(id, selected.clone()));
        self.apply_as("Remove from handle", commands.collect());
    }

    /// Selects the vertices of the active groups.
    pub fn select_active_groups(&mut self) {
        let held = self.active_groups();
        let vertices = held.iter().flat_map(|group| group.vertices.iter().copied()).collect();
        self.apply(Command::Select(vertices, SelectMode::Replace));
    }

    /// Works on all groups.
    pub fn choose_all_groups(&mut self) {
        let ids = self.document().map(|document| document.scene().groups.iter().map(|group| group.id).collect());
        self.apply(Command::ActivateSeveral(ids.unwrap_or_default()));
    }

    /// Turns the camera so that the active groups fill the viewport, with some of the surface around them.
    pub fn frame_active_groups(&mut self) {
        let Some(open) = &mut self.open else { return };
        let positions = &open.surface.frame().positions;
        let held = open.document.scene().active_groups().flat_map(|group| group.vertices.iter());
        let points = held.map(|v| positions[v.index()]);
        if let Some((lo, hi)) = points.map(|p| (p, p)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) {
            let margin = Vec3::splat(FRAME_MARGIN * open.document.model().diagonal());
            open.camera.frame(lo - margin, hi + margin);
        }
    }

    /// Makes patches larger or smaller by some rings.
    pub fn resize_patch(&mut self, rings: i32) {
        let wanted = i32::from(self.options.patch_rings) + rings;
        self.options.patch_rings = wanted.clamp(0, i32::from(Options::MOST_PATCH_RINGS)) as u16;
    }

    fn lead_handle(&self) -> Option<&Group> {
        let groups = self.document()?.scene().active_groups();
        groups.filter(|group| group.kind == GroupKind::Handle).last()
    }

    /// Where the leading active handle is, relative to where it was placed.
    pub fn placement(&self) -> Option<Placement> {
        let lead = self.lead_handle()?;
        match &self.typed_placement {
            Some((group, typed)) if is_where(group, lead) => Some(*typed),
            _ => Some(Placement::of(lead)),
        }
    }

    /// Brings the leading active handle to where these numbers say, about the pivot of the gizmo; the other active
    /// handles follow by the same change.
    pub fn place_active(&mut self, mut wanted: Placement) {
        wanted.scale = wanted.scale.map(|factor| factor.clamp(SCALES.0, SCALES.1));
        let (Some(shown), Some(lead), Some(document)) = (self.placement(), self.lead_handle(), self.document()) else {
            return;
        };
        let (scene, settings) = (document.scene(), &self.options.gizmo);
        let change = shown.change_to(&wanted, lead);
        let Some(place) = settings.place(scene) else { return };
        let handles = scene.active_groups().filter(|group| group.kind == GroupKind::Handle);
        let moved = |group: &Group| (group.id, change.about(settings.pivot_of(group, place)) * group.motion);
        let (id, about_itself) = (lead.id, settings.pivot_of(lead, place) == lead.center());
        let motions = handles.map(moved).collect();
        self.apply(Command::MoveSeveral(motions));
        if let Some(lead) = self.document().and_then(|document| document.scene().group(id)).cloned() {
            if !about_itself && (wanted.degrees, wanted.scale) != (shown.degrees, shown.scale) {
                wanted.translation = Placement::of(&lead).translation;
            }
            self.typed_placement = Some((lead, wanted));
        }
    }

    /// Whether a pivot has been picked on the surface.
    pub fn has_picked_pivot(&self) -> bool {
        matches!(self.options.gizmo.pivot, Pivot::Point(_))
    }
}

fn is_where(a: &Group, b: &Group) -> bool {
    a.id == b.id && a.motion == b.motion && Arc::ptr_eq(&a.base, &b.base)
}
