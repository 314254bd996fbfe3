//! The picture in the window: what it shows, and which mouse movement goes to the camera and which to the tool.

use std::sync::Arc;

use egui::{Event, PointerButton, Pos2, Rect};
use glam::{Vec2, Vec3};
use pliant_solver::{Mesh, Rigidity, VertexId};

use super::look::ramp_max;
use super::{Action, NoticeKind, Session, theme};
use crate::document::{GroupKind, Selection, rim};
use crate::solving::SolveState;
use crate::tools::{Cursor, Input, Label, Modifiers, Pointer, ToolKind};
use crate::viewport::{
    Camera, DeviceWatch, Dot, Line, Renderer, SurfaceFrame, TextureSet, ViewScene, samples_for, watch_device,
};

/// Larger groups show only some of their vertices: thousands of dots hide the surface (by eye).
const DOTS_PER_GROUP: usize = 100;
/// Groups of more vertices than this show dots along their rim only (by eye).
const RIM_ONLY: usize = 1000;
/// How long nothing may move before a processor draws the picture with smooth edges (by eye).
const REST_BEFORE_REFINING: std::time::Duration = std::time::Duration::from_millis(350);
/// Samples a pixel then.
const REFINED_SAMPLES: u32 = 4;
/// Zoom for one point of scrolling; a notch of a common wheel is 50 points or a factor of 1.13 (by eye).
const ZOOM_PER_POINT: f32 = 0.0025;

/// Which drag is under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gesture {
    Tool,
    Orbit,
    Pan,
    Zoom,
}

/// A set of vertices, out of how many, and one flag for each.
type Flags = Option<(Selection, usize, Arc<[bool]>)>;

/// What decides what a resting pointer means: the tool, the surface, the camera, and the stamp of everything else.
type Hovered = (ToolKind, *const SurfaceFrame, Camera, (u64, u64, usize));

/// Vertices of large groups, and of those the ones at the rim.
type Rims = Vec<(Arc<[VertexId]>, Arc<[VertexId]>)>;

/// Values that are made anew only when their source changed.
#[derive(Default)]
struct Cache {
    rigidity: Option<(Rigidity, Arc<[u16]>)>,
    selected: Flags,
    locked: Flags,
    bounds: Option<(Arc<SurfaceFrame>, (Vec3, Vec3))>,
    dots: Arc<[Dot]>,
    lines: Arc<[Line]>,
    rims: Rims,
}

/// The renderer, its texture in egui, and the drag under way.
pub(super) struct ViewportPanel {
    renderer: Renderer,
    render_state: eframe::egui_wgpu::RenderState,
    watch: DeviceWatch,
    has_told_of_loss: bool,
    /// Textures that cannot be shown here, once that was told.
    told_of: Option<Arc<TextureSet>>,
    texture: Option<(egui::TextureId, u64)>,
    gesture: Option<Gesture>,
    /// The button that began the gesture: only its release ends it.
    button: Option<PointerButton>,
    pointer: Option<Pos2>,
    /// Keys that were held when the tool last heard of a drag.
    keys: egui::Modifiers,
    /// What lay under the pointer when the tool last heard of it.
    hovered: Option<Hovered>,
    cache: Cache,
    /// What the last picture showed.
    shown: Option<ViewScene>,
    /// When something last moved, for pictures made by the processor.
    moved_at: std::time::Instant,
    /// Its widget, once it was shown.
    pub(super) id: Option<egui::Id>,
    /// Whether pictures are made by the processor.
    pub(super) is_software: bool,
    /// Time that the renderer took for the last picture, on this thread.
    pub(super) drawing: std::time::Duration,
}

impl ViewportPanel {
    pub(super) fn new(render_state: &eframe::egui_wgpu::RenderState) -> ViewportPanel {
        let info = render_state.adapter.get_info();
        ViewportPanel {
            renderer: Renderer::new(&render_state.device, &render_state.queue, samples_for(&info)),
            is_software: info.device_type == wgpu::DeviceType::Cpu,
            watch: watch_device(&render_state.device),
            has_told_of_loss: false,
            told_of: None,
            id: None,
            render_state: render_state.clone(),
            moved_at: std::time::Instant::now(),
            drawing: std::time::Duration::ZERO,
            texture: None,
            gesture: None,
            button: None,
            pointer: None,
            keys: egui::Modifiers::NONE,
            hovered: None,
            cache: Cache::default(),
            shown: None,
        }
    }

    /// What the last picture showed, for others beside it.
    pub(super) fn shown(&self) -> Option<&ViewScene> {
        self.shown.as_ref()
    }

    /// A renderer for a picture beside this one.
    pub(super) fn sibling(&self) -> Renderer {
        self.renderer.sibling()
    }

    /// The device, and what egui draws with.
    pub(super) fn render_state(&self) -> &eframe::egui_wgpu::RenderState {
        &self.render_state
    }

    /// Takes input and shows the picture; fills the rest of `ui`.
    pub(super) fn show(&mut self, ui: &mut egui::Ui, session: &mut Session) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "viewport"));
        self.id = Some(response.id);
        if response.clicked() || response.drag_started() {
            response.request_focus(); // takes the keyboard away from text fields
        }
        session.set_viewport_size(to_vec(rect.size()));
        self.tell_of_trouble(session);
        self.take_input(ui, &response, rect, session);
        self.paint(ui, rect, session);
        if let Some(cursor) = session.with_tool(|tool, _| tool.cursor())
            && response.hovered()
        {
            ui.set_cursor_icon(match (self.gesture, cursor) {
                (Some(Gesture::Orbit | Gesture::Pan | Gesture::Zoom), _) => egui::CursorIcon::Move,
                (_, Cursor::Arrow) => egui::CursorIcon::Default,
                (_, Cursor::Cross) => egui::CursorIcon::Crosshair,
                (_, Cursor::Grab) => egui::CursorIcon::Grab,
                (_, Cursor::Grabbing) => egui::CursorIcon::Grabbing,
            });
        }
    }

    /// The mesh lives on the CPU, so that it can be saved even when the picture cannot be drawn any more.
    fn tell_of_trouble(&mut self, session: &mut Session) {
        if let Some(error) = self.watch.take_error() {
            session.notices.push(NoticeKind::Warning, format!("The picture may be wrong: {error}"));
        }
        if !self.has_told_of_loss
            && let Some(why) = self.watch.lost()
        {
            self.has_told_of_loss = true;
            let text = format!("The graphics device was lost ({why}). Save your work (Ctrl+S) and start Pliant again");
            session.notices.push(NoticeKind::Error, text);
        }
    }

    /// Says once that textures cannot be shown on this device; the menu goes on saying so.
    fn tell_of_textures(&mut self, scene: &ViewScene, session: &mut Session) {
        session.textures_obstacle = self.renderer.textures_obstacle(scene);
        let (Some(why), Some(set)) = (session.textures_obstacle, &scene.textures) else { return };
        if !self.told_of.as_ref().is_some_and(|told| Arc::ptr_eq(told, set)) {
            self.told_of = Some(set.clone());
            session.notices.push(NoticeKind::Warning, format!("Textures are not shown: {why}"));
        }
    }

    /// Goes through the events one by one, so that a press, a move and a release within a frame keep their order.
    fn take_input(&mut self, ui: &egui::Ui, response: &egui::Response, rect: Rect, session: &mut Session) {
        let is_over = response.contains_pointer() && ui.is_enabled();
        let (events, scroll, pinch) =
            ui.input(|input| (input.events.clone(), input.smooth_scroll_delta().y, input.zoom_delta()));
        for event in events {
            match event {
                Event::PointerButton { pos, button, pressed: true, modifiers } if is_over => {
                    self.press(pos, button, modifiers, rect, session);
                }
                Event::PointerButton { pos, button, pressed: false, modifiers } if self.button == Some(button) => {
                    let ended = self.gesture.take();
                    self.button = None;
                    if ended == Some(Gesture::Tool) {
                        session.input(Input::Release(pointer(pos, modifiers, rect)));
                    }
                }
                Event::PointerMoved(pos) => {
                    let modifiers = ui.input(|input| input.modifiers);
                    self.moved(pos, modifiers, is_over, rect, session);
                }
                Event::PointerGone => {
                    self.pointer = None;
                    session.input(Input::Leave);
                }
                _ => {}
            }
        }
        if response.double_clicked_by(PointerButton::Primary)
            && let Some(pos) = response.interact_pointer_pos()
            && !ui.input(|input| input.modifiers.alt)
        {
            session.input(Input::DoubleClick(pointer(pos, ui.input(|input| input.modifiers), rect)));
        }
        if !is_over && self.gesture.is_none() {
            session.input(Input::Leave);
        }
        if is_over {
            self.hover_again(ui.input(|input| input.modifiers), rect, session);
        }
        // A key that is pressed while the pointer rests acts at once.
        let keys = ui.input(|input| input.modifiers);
        let are_other = std::mem::replace(&mut self.keys, keys) != keys;
        if self.gesture == Some(Gesture::Tool)
            && (are_other || session.tool_is_behind())
            && let Some(pos) = self.pointer
        {
            session.input(Input::Drag(pointer(pos, keys, rect)));
            ui.ctx().request_repaint();
        }
        let factor = (scroll * ZOOM_PER_POINT).exp() * pinch;
        // A drag of the tool measures from where it began, under the camera of that moment.
        if is_over
            && self.gesture != Some(Gesture::Tool)
            && factor != 1.0
            && let (Some(pos), Some(open)) = (self.pointer, session.open_mut())
        {
            open.camera.zoom(factor, to_vec(pos - rect.min), to_vec(rect.size()));
        }
    }

    /// The pointer rests, but what is under it changed: another tool, a turned camera, a surface that came to rest. (While
    /// the surface still moves the hover may lag behind: looking for it costs a refit of the hierarchy.)
    fn hover_again(&mut self, keys: egui::Modifiers, rect: Rect, session: &mut Session) {
        let (None, Some(pos), Some(open)) = (self.gesture, self.pointer, session.open()) else { return };
        let report = session.status.report.as_ref();
        let now = (session.tool_kind(), Arc::as_ptr(open.surface.frame()), open.camera, session.hover_stamp());
        if self.hovered != Some(now) && report.is_none_or(|report| report.state != SolveState::Iterating) {
            self.hovered = Some(now);
            session.input(Input::Hover(pointer(pos, keys, rect)));
        }
    }

    fn press(&mut self, pos: Pos2, button: PointerButton, keys: egui::Modifiers, rect: Rect, session: &mut Session) {
        if self.gesture.is_some() {
            return;
        }
        self.pointer = Some(pos);
        self.gesture = match (button, keys.alt, keys.shift) {
            // What a tool would take at rest is elsewhere in the pose.
            (PointerButton::Primary, false, _) if session.shows_rest() => None,
            (PointerButton::Primary, false, _) => Some(Gesture::Tool),
            (PointerButton::Primary, true, _) => Some(Gesture::Orbit),
            (PointerButton::Middle, true, _) | (PointerButton::Middle, _, true) => Some(Gesture::Pan),
            (PointerButton::Secondary, true, _) => Some(Gesture::Zoom),
            (PointerButton::Secondary, _, true) => Some(Gesture::Pan),
            (PointerButton::Middle | PointerButton::Secondary, _, _) => Some(Gesture::Orbit),
            _ => None,
        };
        self.button = self.gesture.map(|_| button);
        if self.gesture == Some(Gesture::Tool) {
            session.input(Input::Press(pointer(pos, keys, rect)));
        }
    }

    fn moved(&mut self, pos: Pos2, keys: egui::Modifiers, is_over: bool, rect: Rect, session: &mut Session) {
        let delta = self.pointer.replace(pos).map_or(Vec2::ZERO, |last| to_vec(pos - last));
        let size = to_vec(rect.size());
        match self.gesture {
            Some(Gesture::Tool) => session.input(Input::Drag(pointer(pos, keys, rect))),
            None if is_over => session.input(Input::Hover(pointer(pos, keys, rect))),
            None => {}
            Some(gesture) => {
                let Some(open) = session.open_mut() else {
                    return;
                };
                match gesture {
                    Gesture::Orbit => open.camera.orbit(delta),
                    Gesture::Pan => open.camera.pan(delta, size),
                    Gesture::Zoom => open.camera.zoom((-delta.y * 0.01).exp(), size * 0.5, size),
                    Gesture::Tool => {}
                }
            }
        }
    }

    fn paint(&mut self, ui: &egui::Ui, rect: Rect, session: &mut Session) {
        let pixels_per_point = ui.pixels_per_point();
        let Some(scene) = self.scene(session, pixels_per_point) else {
            ui.painter().rect_filled(rect, 0.0, theme::palette(session.look.theme).well);
            return;
        };
        self.tell_of_textures(&scene, session);
        self.shown = Some(scene.clone());
        let size = (rect.size() * pixels_per_point).round().max(egui::Vec2::splat(1.0));
        let begun = std::time::Instant::now();
        if self.is_software {
            let samples = self.samples_now(ui, session);
            self.renderer.set_samples(samples);
        }
        let (view, generation) = self.renderer.render(&scene, [size.x as u32, size.y as u32]);
        self.drawing = begun.elapsed();
        let mut egui_renderer = self.render_state.renderer.write();
        let device = &self.render_state.device;
        let id = match self.texture {
            Some((id, shown)) if shown == generation => id,
            Some((id, _)) => {
                egui_renderer.update_egui_texture_from_wgpu_texture(device, view, wgpu::FilterMode::Linear, id);
                id
            }
            None => egui_renderer.register_native_texture(device, view, wgpu::FilterMode::Linear),
        };
        self.texture = Some((id, generation));
        drop(egui_renderer);
        let whole = Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
        ui.painter().image(id, rect, whole, egui::Color32::WHITE);
        if session.shows_rest() {
            let key = session.habits.shortcuts.text(Action::TOGGLE_REST, ui.ctx());
            let words =
                if key.is_empty() { "Rest shape".to_owned() } else { format!("Rest shape – {key} shows the pose") };
            let color = theme::palette(session.look.theme).text;
            let font = egui::FontId::proportional(13.0);
            ui.painter().text(
                rect.center_bottom() - egui::vec2(0.0, 24.0),
                egui::Align2::CENTER_CENTER,
                words,
                font,
                color,
            );
            return;
        }
        let marks = session.marks();
        if let Some(label) = &marks.label {
            self.write(ui, rect, label, session.look.theme);
        }
        let outline = marks.outline;
        if outline.len() > 1 {
            let points: Vec<Pos2> = outline.iter().map(|p| rect.min + egui::vec2(p.x, p.y)).collect();
            ui.painter().add(egui::Shape::closed_line(points, egui::Stroke::new(1.5, theme::ACCENT)));
        }
    }

    /// Words beside what they are about, on a ground of their own so that they can be read over any surface.
    fn write(&self, ui: &egui::Ui, rect: Rect, label: &Label, theme: crate::viewport::Theme) {
        let palette = theme::palette(theme);
        let font = egui::TextStyle::Monospace.resolve(ui.style());
        let text = ui.painter().layout_no_wrap(label.text.clone(), font, palette.text);
        let at = rect.min + egui::vec2(label.px.x + 18.0, label.px.y + 18.0);
        let ground = Rect::from_min_size(at, text.size()).expand2(egui::vec2(6.0, 3.0));
        // Beside the pointer, but never beyond the viewport.
        let inside = (rect.max - ground.max).min(egui::Vec2::ZERO);
        let inside = inside.max(rect.min - ground.min);
        ui.painter().rect_filled(ground.translate(inside), 4.0, palette.panel.gamma_multiply(0.9));
        ui.painter().galley(at + inside, text, palette.text);
    }

    /// A processor draws one sample a pixel while things move, and smooth edges once they have rested for a moment.
    fn samples_now(&mut self, ui: &egui::Ui, session: &Session) -> u32 {
        let report = session.status.report.as_ref();
        let is_iterating = report.is_some_and(|report| report.state == SolveState::Iterating)
            || session.player().is_some_and(crate::posing::Player::is_playing);
        let is_used = ui.input(|input| !input.events.is_empty() || input.pointer.any_down());
        if self.gesture.is_some() || is_iterating || is_used {
            self.moved_at = std::time::Instant::now();
        }
        let rested = self.moved_at.elapsed();
        if rested >= REST_BEFORE_REFINING {
            return REFINED_SAMPLES;
        }
        ui.ctx().request_repaint_after(REST_BEFORE_REFINING - rested);
        1
    }

    /// What the picture shows now; cheap where nothing changed.
    fn scene(&mut self, session: &mut Session, pixels_per_point: f32) -> Option<ViewScene> {
        let marks = session.marks();
        let look = session.look.clone();
        let (coloring, values) = session.coloring();
        let flaws = session.crossing_faces();
        // Handles and what a tool draws belong to the pose.
        let shows_rest = session.shows_rest();
        let played = session.played().filter(|_| !shows_rest);
        let is_own = !shows_rest && played.is_none();
        let marks = if is_own { marks } else { Default::default() };
        let open = session.open()?;
        let (scene, model) = (open.document.scene(), open.document.model());
        let mut dots = if look.handles && is_own { group_dots(session, &mut self.cache.rims) } else { Vec::new() };
        dots.extend(marks.dots);
        keep(&mut self.cache.dots, dots);
        keep(&mut self.cache.lines, marks.lines);
        let frame = played.or_else(|| session.shown_frame().cloned())?;
        let rigidity = session.shown_rigidity().unwrap_or(&scene.rigidity);
        Some(ViewScene {
            triangles: model.triangles.clone(),
            rigidity: self.cache.rigidity(rigidity),
            values,
            selected: flags(&mut self.cache.selected, &scene.selection, frame.positions.len()),
            locked: flags(&mut self.cache.locked, &scene.locked, frame.positions.len()),
            preview: marks.preview,
            textures: model.textures.clone(),
            flaws,
            base_colors: model.base_colors.clone(),
            dots: self.cache.dots.clone(),
            lines: self.cache.lines.clone(),
            coloring,
            ramp_max: ramp_max(rigidity),
            color_opacity: look.opacity,
            shading: look.shading,
            wireframe: look.wireframe,
            unmarked_edges: model.cut_edges.clone(),
            see_through: look.see_through,
            grid: look.grid,
            theme: look.theme,
            camera: open.camera,
            bounds: self.cache.bounds(&frame),
            frame,
            pixels_per_point,
        })
    }
}

impl Cache {
    fn rigidity(&mut self, rigidity: &Rigidity) -> Arc<[u16]> {
        match &self.rigidity {
            Some((known, values)) if std::ptr::eq(known.as_slice(), rigidity.as_slice()) => values.clone(),
            _ => {
                let values: Arc<[u16]> = rigidity.as_slice().into();
                self.rigidity = Some((rigidity.clone(), values.clone()));
                values
            }
        }
    }

    fn bounds(&mut self, frame: &Arc<SurfaceFrame>) -> (Vec3, Vec3) {
        match &self.bounds {
            Some((known, bounds)) if Arc::ptr_eq(known, frame) => *bounds,
            _ => {
                let points = frame.positions.iter().map(|&p| (p, p));
                let bounds = points.reduce(|(lo, hi), (p, _)| (lo.min(p), hi.max(p))).unwrap_or_default();
                self.bounds = Some((frame.clone(), bounds));
                bounds
            }
        }
    }
}

/// One flag a vertex of a set, the same allocation as long as the set is; `None` for an empty one.
fn flags(kept: &mut Flags, set: &Selection, n: usize) -> Option<Arc<[bool]>> {
    if set.is_empty() {
        *kept = None;
        return None;
    }
    match kept {
        Some((known, of, flags)) if *of == n && std::ptr::eq(known.vertices(), set.vertices()) => Some(flags.clone()),
        _ => {
            let flags: Arc<[bool]> = set.flags(n).into();
            *kept = Some((set.clone(), n, flags.clone()));
            Some(flags)
        }
    }
}

/// Keeps the old allocation, and with it its identity, when the content is the same.
fn keep<T: PartialEq>(kept: &mut Arc<[T]>, new: Vec<T>) {
    if **kept != *new {
        *kept = new.into();
    }
}

/// Vertices of a large group that stand for it: those at its rim, where what is held meets what bends.
fn rim_of(rims: &mut Rims, mesh: &Mesh, vertices: &Arc<[VertexId]>) -> Arc<[VertexId]> {
    if let Some((_, rim)) = rims.iter().find(|(of, _)| Arc::ptr_eq(of, vertices)) {
        return rim.clone();
    }
    let rim: Arc<[VertexId]> = rim(mesh, vertices).into();
    let rim = if rim.is_empty() { vertices.clone() } else { rim };
    rims.push((vertices.clone(), rim.clone()));
    rim
}

fn group_dots(session: &Session, rims: &mut Rims) -> Vec<Dot> {
    let Some(open) = session.open() else {
        return Vec::new();
    };
    let scene = open.document.scene();
    let positions = &open.surface.frame().positions;
    let mut dots = Vec::new();
    rims.retain(|(of, _)| scene.groups.iter().any(|group| Arc::ptr_eq(&group.vertices, of)));
    for group in scene.groups.iter().filter(|group| group.dots) {
        let [red, green, blue] = group.color.rgb();
        let color = [red, green, blue, 255];
        let dot = |v: &VertexId| Dot { position: positions[v.index()], color, radius_px: 2.5 };
        let shown = match group.vertices.len() {
            0..RIM_ONLY => group.vertices.clone(),
            _ => rim_of(rims, &open.document.model().mesh, &group.vertices),
        };
        dots.extend(shown.iter().step_by(shown.len().div_ceil(DOTS_PER_GROUP).max(1)).map(dot));
        let radius_px = if scene.active.contains(group.id) { 8.0 } else { 6.0 };
        // The middle of anchors may lie far from all of them; a handle is taken there.
        if group.kind == GroupKind::Handle {
            let position = open.document.model().to_view(group.center());
            dots.push(Dot { position, color, radius_px });
        }
    }
    dots
}

fn pointer(pos: Pos2, keys: egui::Modifiers, rect: Rect) -> Pointer {
    Pointer {
        px: to_vec(pos - rect.min),
        modifiers: Modifiers { shift: keys.shift, ctrl: keys.command, alt: keys.alt },
    }
}

fn to_vec(v: egui::Vec2) -> Vec2 {
    Vec2::new(v.x, v.y)
}
