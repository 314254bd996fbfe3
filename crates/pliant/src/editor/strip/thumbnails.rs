//! Small pictures of kept poses, drawn by a thread and kept as long as their poses are on the strip.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use glam::DVec3;
use pliant_geometry::VertexNormals;

use super::super::viewport_panel::ViewportPanel;
use super::card::PICTURE;
use crate::document::{KeptPose, Model};
use crate::editor::Session;
use crate::viewport::{Camera, Coloring, Renderer, SurfaceFrame, ViewScene};

/// Pixels of a picture for one point on the strip: enough for screens of today.
const PIXELS_PER_POINT: u32 = 2;

struct Drawn {
    positions: Arc<[DVec3]>,
    /// None where it could not be drawn: trying again and again would help nobody.
    picture: Option<image::RgbaImage>,
}

/// Pictures by the positions they show.
pub(super) struct Thumbnails {
    ready: Vec<(Arc<[DVec3]>, Option<TextureHandle>)>,
    is_drawing: bool,
    sender: Sender<Drawn>,
    receiver: Receiver<Drawn>,
}

impl Default for Thumbnails {
    fn default() -> Thumbnails {
        let (sender, receiver) = channel();
        Thumbnails { ready: Vec::new(), is_drawing: false, sender, receiver }
    }
}

impl Thumbnails {
    /// Takes what was drawn, and lets go of pictures of poses that are gone.
    pub(super) fn poll(&mut self, ctx: &Context, poses: &[KeptPose]) {
        while let Ok(drawn) = self.receiver.try_recv() {
            self.is_drawing = false;
            let texture = drawn.picture.map(|picture| {
                let size = [picture.width() as usize, picture.height() as usize];
                let image = ColorImage::from_rgba_unmultiplied(size, picture.as_raw());
                ctx.load_texture("pose", image, TextureOptions::LINEAR)
            });
            self.ready.push((drawn.positions, texture));
        }
        self.ready.retain(|(shown, _)| poses.iter().any(|kept| Arc::ptr_eq(&kept.positions, shown)));
    }

    /// The picture of a pose, once it is drawn; begins to draw it if nothing else is being drawn.
    pub(super) fn picture_of(
        &mut self,
        ctx: &Context,
        kept: &KeptPose,
        session: &Session,
        viewport: &ViewportPanel,
    ) -> Option<TextureId> {
        if let Some((_, texture)) = self.ready.iter().find(|(shown, _)| Arc::ptr_eq(shown, &kept.positions)) {
            return texture.as_ref().map(TextureHandle::id);
        }
        let (model, look) = (session.document()?.model().clone(), viewport.shown()?.clone());
        if self.is_drawing || look.frame.positions.len() != kept.positions.len() {
            return None;
        }
        let (renderer, positions) = (viewport.sibling(), kept.positions.clone());
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        let work = move || {
            let draw = || draw(renderer, &model, &positions, look);
            let picture = std::panic::catch_unwind(std::panic::AssertUnwindSafe(draw)).ok().flatten();
            // Nobody listens any more once the window is closed.
            let _ = sender.send(Drawn { positions, picture });
            ctx.request_repaint();
        };
        self.is_drawing = std::thread::Builder::new().name("pose picture".into()).spawn(work).is_ok();
        None
    }
}

fn draw(mut renderer: Renderer, model: &Model, positions: &[DVec3], look: ViewScene) -> Option<image::RgbaImage> {
    let frame = frame_of(model, positions);
    let (lo, hi) =
        frame.positions.iter().fold((frame.positions[0], frame.positions[0]), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let scene = ViewScene {
        base_colors: model.base_colors.clone(),
        coloring: Coloring::Plain,
        theme: look.theme,
        ..ViewScene::plain(look.triangles, Arc::new(frame), Camera::framing(lo, hi), (lo, hi))
    };
    renderer.render(&scene, PICTURE.map(|side| side * PIXELS_PER_POINT));
    renderer.try_read_pixels().map_err(|error| log::warn!("no picture of a pose: {error}")).ok()
}

fn frame_of(model: &Model, positions: &[DVec3]) -> SurfaceFrame {
    let positions: Vec<_> = positions.iter().map(|&p| model.to_view(p)).collect();
    let mut normals = Vec::new();
    VertexNormals::new(positions.len(), &model.triangles).compute(&positions, &model.triangles, &mut normals);
    SurfaceFrame { positions, normals }
}
