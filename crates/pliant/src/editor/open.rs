//! A document with its picture: what is shown of it, and from where.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use pliant_geometry::VertexNormals;

use super::jobs::Opened;
use super::{Origin, ProjectFile, Restored, Sample};
use crate::document::{Document, Snapshot};
use crate::tools::Surface;
use crate::viewport::{Camera, SurfaceFrame};

/// A document with what the window needs to show and pick it.
pub struct Open {
    /// The truth.
    pub document: Document,
    /// The surface as it is on screen.
    pub surface: Surface,
    /// The eye.
    pub camera: Camera,
    /// The project it is written to by *save*, once that is known.
    pub project: Option<ProjectFile>,
    /// Where the mesh was last exported to, and what was.
    pub exported: Option<(PathBuf, Snapshot)>,
    rest: Arc<SurfaceFrame>,
    normals: VertexNormals,
    shown_epoch: u64,
}

impl Open {
    /// A model as opened, seen whole, with the anchors its sample comes with.
    pub(super) fn new(opened: Opened, sample: Option<Sample>) -> Open {
        let Opened { model, surface, normals, restored } = opened;
        let camera = Camera::framing(model.bounds.0, model.bounds.1);
        let mut open = Open {
            document: Document::new(model),
            // Nothing has moved it yet.
            rest: surface.frame().clone(),
            surface,
            camera,
            project: None,
            exported: None,
            normals,
            shown_epoch: 0,
        };
        if let Some(sample) = sample {
            sample.prepare(&mut open.document);
        }
        if let Some(restored) = restored {
            open.restore(*restored);
        }
        open
    }

    /// Takes over what a project holds.
    fn restore(&mut self, restored: Restored) {
        let Restored { snapshot, next_group, camera, origin, .. } = restored;
        self.document = Document::reopened(self.document.model().clone(), snapshot, next_group);
        self.camera = camera.unwrap_or(self.camera);
        match origin {
            Origin::Project(project) => self.project = Some(project),
            // Saving asks where: recovery never writes over the original.
            Origin::Leftover(_) => self.document.mark_unsaved(),
        }
        self.show_pose();
    }

    /// Name for the title: the project's, or else the mesh's.
    pub fn name(&self) -> String {
        let stem = self.project.as_ref().and_then(|project| project.path.file_stem());
        stem.map_or_else(|| self.document.model().name.clone(), |stem| stem.to_string_lossy().into_owned())
    }

    /// The file that holds the bent mesh as it is now, if it was exported and not changed since.
    pub fn is_exported(&self) -> Option<&PathBuf> {
        let (path, then) = self.exported.as_ref()?;
        let is_same = Arc::ptr_eq(&then.pose.positions, &self.document.pose().positions)
            && then.scene.rigidity == self.document.scene().rigidity;
        is_same.then_some(path)
    }

    /// The surface before it was bent.
    pub fn rest(&self) -> &Arc<SurfaceFrame> {
        &self.rest
    }

    /// Shows a pose that has jumped since the last look, without waiting for the solver.
    pub(super) fn catch_up(&mut self) {
        if self.document.epoch() != self.shown_epoch {
            self.shown_epoch = self.document.epoch();
            self.show_pose();
        }
    }

    /// Turns the camera so that the selection, or else the whole surface, fills the viewport.
    pub(super) fn frame(&mut self) {
        let positions = &self.surface.frame().positions;
        let selection = self.document.scene().selection.vertices();
        let bounds = if selection.is_empty() {
            bounds(positions.iter().copied())
        } else {
            bounds(selection.iter().map(|v| positions[v.index()]))
        };
        if let Some((lo, hi)) = bounds {
            self.camera.frame(lo, hi);
        }
    }

    /// Smallest and largest corner of the surface on screen, view space.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        bounds(self.surface.frame().positions.iter().copied()).unwrap_or_default()
    }

    fn show_pose(&mut self) {
        let model = self.document.model();
        let positions: Vec<_> = self.document.pose().positions.iter().map(|&p| model.to_view(p)).collect();
        let mut normals = Vec::new();
        self.normals.compute(&positions, &model.triangles, &mut normals);
        self.surface.set_frame(Arc::new(SurfaceFrame { positions, normals }));
    }
}

fn bounds(points: impl Iterator<Item = Vec3>) -> Option<(Vec3, Vec3)> {
    points.map(|p| (p, p)).reduce(|(lo, hi), (p, _)| (lo.min(p), hi.max(p)))
}
