//! A document with its picture: what is shown of it, and from where.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use pliant_geometry::VertexNormals;

use super::Sample;
use super::jobs::Opened;
use crate::document::Document;
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
    /// Where it is written by *save*, once that is known.
    pub save_path: Option<PathBuf>,
    normals: VertexNormals,
    shown_epoch: u64,
}

impl Open {
    /// A model as opened, seen whole, with the anchors its sample comes with.
    pub(super) fn new(opened: Opened, sample: Option<Sample>) -> Open {
        let Opened { model, surface, normals } = opened;
        let camera = Camera::framing(model.bounds.0, model.bounds.1);
        let mut document = Document::new(model);
        if let Some(sample) = sample {
            sample.prepare(&mut document);
        }
        Open { document, surface, camera, save_path: None, normals, shown_epoch: 0 }
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
