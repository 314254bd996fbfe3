//! The picture of a pane: what the document's picture shows, of another surface.

use std::sync::Arc;

use egui::{PointerButton, Rect, Ui};
use glam::{Vec2, Vec3};
use pliant_solver::{Rigidity, VertexId};

use crate::editor::{Pane, PaneKind, Session};
use crate::viewport::{Coloring, Dot, Renderer, SurfaceFrame, ViewScene};

/// Larger groups show only some of their vertices: the panes are small (by eye).
const DOTS_PER_GROUP: usize = 30;
/// Zoom for one point of scrolling, as in the viewport.
const ZOOM_PER_POINT: f32 = 0.0025;

/// A renderer with its texture in egui, and what is made anew only when its source changed.
pub(super) struct PanePicture {
    renderer: Renderer,
    texture: Option<(egui::TextureId, u64)>,
    sizes: Option<(SizesOf, Arc<[u16]>)>,
    surface: Option<Surface>,
}

/// Where r of a pane comes from.
#[derive(Clone, PartialEq)]
enum SizesOf {
    Painted(Rigidity),
    Same(u16, usize),
}

/// What follows from a surface.
struct Surface {
    frame: Arc<SurfaceFrame>,
    revision: u64,
    bounds: (Vec3, Vec3),
    dots: Arc<[Dot]>,
}

impl PanePicture {
    pub(super) fn new(renderer: Renderer) -> PanePicture {
        PanePicture { renderer, texture: None, sizes: None, surface: None }
    }

    /// Lets egui forget the texture.
    pub(super) fn free(self, state: &eframe::egui_wgpu::RenderState) {
        if let Some((id, _)) = self.texture {
            state.renderer.write().free_texture(&id);
        }
    }

    /// Draws the pane as the document's own picture `shown` is drawn; that of another surface until it has one.
    pub(super) fn paint(
        &mut self,
        ui: &Ui,
        rect: Rect,
        (state, shown): (&eframe::egui_wgpu::RenderState, &ViewScene),
        (kind, session): (PaneKind, &Session),
    ) {
        let Some(pane) = session.compare().and_then(|compare| compare.panes().iter().find(|pane| pane.kind == kind))
        else {
            return;
        };
        let Some(scene) = self.scene(shown, pane, session) else { return };
        let size = (rect.size() * ui.pixels_per_point()).round().max(egui::Vec2::splat(1.0));
        let (view, generation) = self.renderer.render(&scene, [size.x as u32, size.y as u32]);
        let mut egui_renderer = state.renderer.write();
        let id = match self.texture {
            Some((id, known)) if known == generation => id,
            Some((id, _)) => {
                let filter = wgpu::FilterMode::Linear;
                egui_renderer.update_egui_texture_from_wgpu_texture(&state.device, view, filter, id);
                id
            }
            None => egui_renderer.register_native_texture(&state.device, view, wgpu::FilterMode::Linear),
        };
        self.texture = Some((id, generation));
        drop(egui_renderer);
        let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(id, rect, whole, egui::Color32::WHITE);
    }

    fn scene(&mut self, shown: &ViewScene, pane: &Pane, session: &Session) -> Option<ViewScene> {
        let frame = pane.frame.clone()?;
        let document = session.document()?;
        let uniform = session.compare()?.uniform();
        let n = frame.positions.len();
        let of = match pane.kind {
            PaneKind::Painted => SizesOf::Painted(document.scene().rigidity.clone()),
            PaneKind::Uniform => SizesOf::Same(uniform, n),
            PaneKind::Arap | PaneKind::SrArap | PaneKind::Embedded => SizesOf::Same(1, n),
        };
        let rigidity = self.sizes(of);
        let wanted = session.look.color_by.measure();
        let measured = pane.measured.as_ref().filter(|measured| Some(measured.measure) == wanted);
        let (coloring, values) = match (&shown.coloring, measured) {
            (Coloring::Rigidity | Coloring::SoftStiff { .. }, _) if pane.kind.method().is_of_rings() => {
                (shown.coloring.clone(), None)
            }
            (Coloring::Energy | Coloring::Stretch, Some(measured)) => {
                (shown.coloring.clone(), Some(measured.values.clone()))
            }
            _ => (Coloring::Plain, None),
        };
        let surface = self.surface(frame, session);
        Some(ViewScene {
            frame: surface.frame.clone(),
            bounds: surface.bounds,
            dots: surface.dots.clone(),
            lines: Arc::new([]),
            // Those of the document's pose.
            flaws: None,
            selected: None,
            ramp_max: shown.ramp_max.max(uniform),
            rigidity,
            coloring,
            values,
            ..shown.clone()
        })
    }

    fn sizes(&mut self, of: SizesOf) -> Arc<[u16]> {
        match &self.sizes {
            Some((known, sizes)) if *known == of => sizes.clone(),
            _ => {
                let sizes: Arc<[u16]> = match &of {
                    SizesOf::Painted(rigidity) => rigidity.as_slice().into(),
                    SizesOf::Same(r, n) => std::iter::repeat_n(*r, *n).collect(),
                };
                self.sizes = Some((of, sizes.clone()));
                sizes
            }
        }
    }

    fn surface(&mut self, frame: Arc<SurfaceFrame>, session: &Session) -> &Surface {
        let revision = session.document().map_or(0, crate::document::Document::revision);
        let known = self.surface.take();
        let known = known.filter(|known| Arc::ptr_eq(&known.frame, &frame) && known.revision == revision);
        self.surface.insert(known.unwrap_or_else(|| {
            let first = frame.positions.first().copied().unwrap_or_default();
            let bounds = frame.positions.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
            Surface { dots: dots(&frame, session), bounds, frame, revision }
        }))
    }
}

/// Held vertices, where this surface has them.
fn dots(frame: &SurfaceFrame, session: &Session) -> Arc<[Dot]> {
    let groups = session.document().filter(|_| session.look.handles).map(|document| document.scene().groups.clone());
    let dots = groups.iter().flat_map(|groups| groups.iter()).filter(|group| group.dots).flat_map(|group| {
        let [red, green, blue] = group.color.rgb();
        let color = [red, green, blue, 255];
        let some = group.vertices.iter().step_by(group.vertices.len().div_ceil(DOTS_PER_GROUP));
        some.map(move |v: &VertexId| Dot { position: frame.positions[v.index()], color, radius_px: 2.0 })
    });
    dots.collect()
}

/// Turns, moves and zooms the camera of all pictures by a drag in this one. There is no tool here, so that the left button
/// turns as well.
pub(super) fn turn(ui: &mut Ui, rect: Rect, kind: PaneKind, session: &mut Session) {
    let response = ui.interact(rect, ui.scope_id().with(("pane", kind)), egui::Sense::drag());
    let title = session.method().map(|method| kind.title(&method, session.compare().map_or(1, |all| all.uniform())));
    let name = format!("picture: {}", title.unwrap_or_default());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &name));
    let (scroll, pinch, keys) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta(), input.modifiers));
    let delta = to_vec(response.drag_delta());
    let factor = (scroll * ZOOM_PER_POINT).exp() * pinch;
    let pointer = response.hover_pos();
    let Some(open) = session.open_mut() else { return };
    let size = to_vec(rect.size());
    if delta != Vec2::ZERO {
        let zooms = response.dragged_by(PointerButton::Secondary) && keys.alt;
        match (zooms, keys.shift) {
            (true, _) => open.camera.zoom((-delta.y * 0.01).exp(), size * 0.5, size),
            (false, true) => open.camera.pan(delta, size),
            (false, false) => open.camera.orbit(delta),
        }
    }
    if factor != 1.0
        && let Some(pos) = pointer
    {
        open.camera.zoom(factor, to_vec(pos - rect.min), size);
    }
    if delta != Vec2::ZERO || (factor != 1.0 && pointer.is_some()) {
        // The pictures before this one were drawn with the camera as it was.
        ui.ctx().request_repaint();
    }
}

fn to_vec(v: egui::Vec2) -> Vec2 {
    Vec2::new(v.x, v.y)
}
