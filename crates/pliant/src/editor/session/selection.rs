//! What can be done with the selection: changed as a whole, kept under a name, and made the region that bends.

use std::ops::RangeInclusive;

use pliant_solver::{Mesh, VertexId};

use super::Session;
use crate::document::{
    Alike, Command, GroupId, GroupKind, Model, Part, Scene, SelectMode, Selection, SetChange, alike, border, grown,
    inverted, of_parts, of_rigidity, part_of_triangle, shrunk,
};
use crate::editor::NoticeKind;

/// Name of the anchor that holds all but the region of interest: it is found again by it.
const THE_REST: &str = "Everything else";

impl Session {
    fn model_and_scene(&self) -> Option<(&Model, &Scene)> {
        self.document().map(|document| (&**document.model(), document.scene()))
    }

    fn select(&mut self, selection: &Selection, mode: SelectMode) {
        self.apply(Command::Select(selection.vertices().to_vec(), mode));
    }

    fn reselect(&mut self, change: impl FnOnce(&Mesh, &Selection) -> Selection) {
        let changed = self.model_and_scene().map(|(model, scene)| change(&model.mesh, &scene.selection));
        if let Some(selection) = changed {
            self.select(&selection, SelectMode::Replace);
        }
    }

    /// Selects every vertex, or none.
    pub fn select_all(&mut self, all: bool) {
        self.reselect(|mesh, _| {
            Selection::new((0..if all { mesh.n_vertices() as u32 } else { 0 }).map(VertexId).collect())
        });
    }

    /// Selects what is not selected, and nothing else.
    pub fn invert_selection(&mut self) {
        self.reselect(inverted);
    }

    /// Adds the vertices one edge away.
    pub fn grow_selection(&mut self) {
        self.reselect(grown);
    }

    /// Takes away the outermost ring of vertices.
    pub fn shrink_selection(&mut self) {
        self.reselect(shrunk);
    }

    /// Selects the vertices at the borders of the surface.
    pub fn select_border(&mut self) {
        self.reselect(|mesh, _| border(mesh));
    }

    /// Selects the vertices of the active handle or anchor.
    pub fn select_active_group(&mut self) {
        let group = self.model_and_scene().and_then(|(_, scene)| scene.active_group());
        if let Some(vertices) = group.map(|group| group.vertices.to_vec()) {
            self.apply(Command::Select(vertices, SelectMode::Replace));
        }
    }

    /// Adds everything that is like the vertex under the pointer, while the select tool points at one; else everything
    /// that is like some selected vertex.
    pub fn select_alike(&mut self, by: Alike) {
        let pointed = self.tool.pointed_at();
        let Some((model, scene)) = self.model_and_scene() else { return };
        let part =
            pointed.filter(|_| by == Alike::Part).and_then(|pick| part_of_triangle(model, pick.triangle as usize));
        let found = match (part, pointed) {
            (Some(part), _) => of_parts(model, parts_named(model, &part.name)),
            (None, Some(pick)) => alike(model, scene, &[pick.vertex], by),
            (None, None) => alike(model, scene, scene.selection.vertices(), by),
        };
        self.select(&found, SelectMode::Add);
    }

    /// Whether [`Session::select_alike`] has something to be like.
    pub fn can_select_alike(&self) -> bool {
        self.tool.pointed_at().is_some() || self.document().is_some_and(|it| !it.scene().selection.is_empty())
    }

    /// Brings the vertices with an r in this range into the selection.
    pub fn select_rigidity(&mut self, range: RangeInclusive<u16>, mode: SelectMode) {
        if let Some(found) = self.model_and_scene().map(|(_, scene)| of_rigidity(scene, range)) {
            self.select(&found, mode);
        }
    }

    /// Brings the vertices of all parts of this name into the selection.
    pub fn select_part(&mut self, name: &str, mode: SelectMode) {
        let found = self.model_and_scene().map(|(model, _)| of_parts(model, parts_named(model, name)));
        if let Some(found) = found {
            self.select(&found, mode);
        }
    }

    /// Keeps the selection under a name of its own.
    pub fn store_selection(&mut self) {
        self.apply(Command::Sets(SetChange::Store));
    }

    /// Holds the selected vertices.
    pub fn hold_selection(&mut self, kind: GroupKind) {
        if let Some(document) = self.document() {
            let vertices = document.scene().selection.vertices().to_vec();
            self.apply(Command::Hold { kind, vertices });
        }
    }

    /// Gives the selected vertices the current r.
    pub fn fill_selection(&mut self) {
        if let Some(document) = self.document() {
            let vertices = document.scene().selection.vertices().to_vec();
            self.apply(Command::Fill { vertices, r: self.options.rigidity });
        }
    }

    /// Makes the selection the region of interest: anchors every vertex that is neither selected nor held by a handle or
    /// an anchor of its own. Done again with another selection, the region moves there.
    pub fn hold_everything_else(&mut self) {
        let Some((model, scene)) = self.model_and_scene() else { return };
        let before = the_rest(scene);
        let mut is_free = scene.selection.flags(model.mesh.n_vertices());
        is_free.iter_mut().for_each(|flag| *flag = !*flag);
        let others = scene.groups.iter().filter(|group| Some(group.id) != before);
        others.flat_map(|group| group.vertices.iter()).for_each(|v| is_free[v.index()] = false);
        let rest = Selection::of_flags(&is_free);
        if rest.is_empty() {
            let text = "Everything is selected or held already: there is nothing else to hold";
            self.notices.push(NoticeKind::Warning, text);
            return;
        }
        if before.and_then(|id| scene.group(id)).is_some_and(|group| *group.vertices == *rest.vertices()) {
            return;
        }
        self.apply(Command::Begin("Hold everything else"));
        if let Some(id) = before {
            self.apply(Command::Release(vec![id]));
        }
        let id = self.document().map(|document| document.next_group());
        self.apply(Command::Hold { kind: GroupKind::Anchor, vertices: rest.vertices().to_vec() });
        if let Some(id) = id {
            self.apply(Command::Rename(id, THE_REST.into()));
        }
        // A gizmo or a selected row would say that the next drag is about the anchor.
        self.apply(Command::Activate(None));
        self.apply(Command::Commit);
    }

    /// Lets go of all handles and anchors in one step.
    pub fn release_everything(&mut self) {
        if let Some((_, scene)) = self.model_and_scene() {
            let ids = scene.groups.iter().map(|group| group.id).collect();
            self.apply(Command::Release(ids));
        }
    }

    /// Number of vertices that bend while everything else is held, if it is.
    pub fn region_of_interest(&self) -> Option<usize> {
        let (model, scene) = self.model_and_scene()?;
        let rest = scene.group(the_rest(scene)?)?;
        Some(model.mesh.n_vertices() - rest.vertices.len())
    }
}

/// The anchor that an earlier call of [`Session::hold_everything_else`] made.
fn the_rest(scene: &Scene) -> Option<GroupId> {
    let is_it = |kind: GroupKind, name: &str| kind == GroupKind::Anchor && name == THE_REST;
    scene.groups.iter().find(|group| is_it(group.kind, &group.name)).map(|group| group.id)
}

fn parts_named<'a>(model: &'a Model, name: &'a str) -> impl Iterator<Item = &'a Part> {
    model.file.parts.iter().filter(move |part| part.name == name)
}
