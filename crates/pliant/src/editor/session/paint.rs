//! Painting: locks, and what is prepared for brush and fill.

use std::sync::Arc;

use pliant_solver::VertexId;

use super::Session;
use crate::document::{Command, SelectMode};
use crate::tools::Mirror;

impl Session {
    /// Takes what was found in the background for the tools, and asks for what they need now.
    pub(super) fn prepare(&mut self) {
        if let Some(open) = &self.open {
            self.preparing.prepare(open.document.model(), &self.options, self.tool_kind);
        }
    }

    /// Whether something is being found for the tools.
    pub fn is_preparing(&self) -> bool {
        self.preparing.is_busy()
    }

    /// The other side of the mesh, once it is found, while painting is mirrored.
    pub fn mirror(&self) -> Option<&Arc<Mirror>> {
        self.preparing.ready.mirror.as_ref()
    }

    /// Changes with everything besides pose, camera and tool that changes what a resting pointer means.
    pub(in crate::editor) fn hover_stamp(&self) -> (u64, u64, usize) {
        let of_document = self
            .document()
            .map_or((0, 0), |document| (document.revision(), document.scene().selection.vertices().as_ptr() as usize));
        (of_document.0, self.preparing.n_answers(), of_document.1)
    }

    /// Whether the pointer is over the surface, as far as the tool in hand looks for that.
    pub fn is_over_surface(&self) -> bool {
        self.tool.is_over_surface()
    }

    /// Whether the tool in hand has more to do for the drag it was last told of.
    pub fn tool_is_behind(&self) -> bool {
        self.tool.is_behind()
    }

    /// Locks the selected vertices and, where painting is mirrored, their images; or unlocks them.
    pub fn lock_selection(&mut self, lock: bool) {
        let Some(document) = self.document() else { return };
        let vertices = document.scene().selection.vertices().to_vec();
        self.lock(vertices, lock);
    }

    /// Locks the vertices that have the current r, or unlocks them.
    pub fn lock_current_rigidity(&mut self, lock: bool) {
        let Some(document) = self.document() else { return };
        let current = self.options.rigidity;
        let of_r = (0..).zip(document.scene().rigidity.as_slice()).filter(|&(_, &r)| r == current);
        let vertices = of_r.map(|(v, _)| VertexId(v)).collect();
        self.lock(vertices, lock);
    }

    /// Locks every vertex, or none.
    pub fn lock_all(&mut self, lock: bool) {
        let Some(document) = self.document() else { return };
        let n = if lock { document.model().mesh.n_vertices() as u32 } else { 0 };
        self.apply(Command::Lock((0..n).map(VertexId).collect(), SelectMode::Replace));
    }

    fn lock(&mut self, mut vertices: Vec<VertexId>, lock: bool) {
        if let Some(mirror) = self.mirror() {
            mirror.clone().add_images(&mut vertices);
        }
        self.apply(Command::Lock(vertices, if lock { SelectMode::Add } else { SelectMode::Remove }));
    }

    /// The edge between the two selected vertices, if exactly its ends are selected.
    pub fn selected_edge(&self) -> Option<[VertexId; 2]> {
        let document = self.document()?;
        match document.scene().selection.vertices() {
            &[a, b] if document.model().mesh.neighbors(a).binary_search(&b.0).is_ok() => Some([a, b]),
            _ => None,
        }
    }

    /// Makes the selected edge the middle edge of the mirror.
    pub fn take_middle_edge(&mut self) {
        if let Some(edge) = self.selected_edge() {
            self.options.paint.mirror.edge = Some(edge.map(|v| v.0));
        }
    }
}
