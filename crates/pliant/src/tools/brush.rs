//! The rigidity brush: dabs of a radius that is seen on screen and measured along the surface.

use std::collections::HashSet;

use glam::{Vec2, Vec3};
use pliant_solver::{Mesh, Rigidity, VertexId};
use rayon::prelude::*;

use super::prompt::promptly;
use super::{BrushMode, BrushReach, Context, Cursor, Input, Marks, Mirror, Pick, Pointer, Reaction, Tool, ToolKey};
use crate::document::{Command, SelectMode};
use crate::viewport::{Line, Projection};

/// Segments of the drawn circle.
const CIRCLE_SEGMENTS: usize = 48;
/// White, and paler on the mirrored side.
pub(super) const CIRCLE: [u8; 4] = [255, 255, 255, 230];
const MIRRORED_CIRCLE: [u8; 4] = [255, 255, 255, 130];

/// A stroke under way.
struct Stroke {
    /// Where the last dab was, on screen.
    last_px: Vec2,
    /// Vertices that stiffer and softer have changed already: once a stroke is enough.
    touched: HashSet<VertexId>,
}

/// Paints r.
#[derive(Default)]
pub(super) struct BrushTool {
    hover: Option<Pick>,
    stroke: Option<Stroke>,
}

/// What a dab does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Paint {
    /// To r.
    Rigidity(BrushMode),
    /// To the locks.
    Lock(SelectMode),
}

impl BrushTool {
    fn stroke_to(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Vec<Command> {
        let Some(stroke) = &mut self.stroke else {
            return Vec::new();
        };
        let spacing = spacing_px(stroke.last_px, context);
        let mut covered: Vec<VertexId> = Vec::new();
        while stroke.last_px.distance(pointer.px) >= spacing {
            stroke.last_px += (pointer.px - stroke.last_px).normalize_or_zero() * spacing;
            covered.extend(cover(stroke.last_px, context));
        }
        // Dabs overlap: each vertex once.
        covered.sort_unstable();
        covered.dedup();
        paint(covered, what(pointer, context), &mut stroke.touched, context)
    }
}

/// Way between dabs where the pointer is, in points; one at least.
pub(super) fn spacing_px(px: Vec2, context: &mut Context<'_>) -> f32 {
    let radius_px = match context.options.paint.unit {
        super::BrushUnit::Screen => context.options.brush_radius_px,
        super::BrushUnit::Model => {
            let at = context.surface.pick(px, &context.view).map_or(context.view.camera.target, |pick| pick.position);
            context.options.paint.radius
                / context.view.camera.world_per_px(at, context.view.size).max(f32::MIN_POSITIVE)
        }
    };
    (context.options.paint.spacing * radius_px).max(1.0)
}

fn what(pointer: Pointer, context: &Context<'_>) -> Paint {
    match (context.options.brush_mode, pointer.modifiers) {
        (BrushMode::Lock, m) if m.ctrl => Paint::Lock(SelectMode::Remove),
        (BrushMode::Lock, _) => Paint::Lock(SelectMode::Add),
        (_, m) if m.shift => Paint::Rigidity(BrushMode::Smooth),
        (_, m) if m.ctrl => Paint::Rigidity(BrushMode::Softer),
        (mode, _) => Paint::Rigidity(mode),
    }
}

/// Vertices under one dab, and their images where painting is mirrored.
fn cover(px: Vec2, context: &mut Context<'_>) -> Vec<VertexId> {
    let Some(pick) = context.surface.pick(px, &context.view) else {
        return Vec::new();
    };
    let mut covered = match context.options.paint.reach {
        BrushReach::Surface => along_surface(&pick, context),
        BrushReach::Front => {
            let mut covered = along_surface(&pick, context);
            covered.retain(|&v| faces_eye(v, context));
            covered
        }
        BrushReach::Through => under_circle(px, &pick, context),
    };
    if covered.is_empty() {
        covered.push(pick.vertex); // a brush smaller than a face still paints
    }
    if let Some(mirror) = &context.prepared.mirror {
        mirror.add_images(&mut covered);
    }
    covered
}

fn along_surface(pick: &Pick, context: &mut Context<'_>) -> Vec<VertexId> {
    let radius = radius_at(pick, context);
    context.surface.within(pick, radius)
}

fn faces_eye(v: VertexId, context: &Context<'_>) -> bool {
    let (frame, camera) = (context.surface.frame(), &context.view.camera);
    let away = match camera.projection {
        Projection::Perspective => frame.positions[v.index()] - camera.eye(),
        Projection::Orthographic => camera.forward(),
    };
    frame.normals.get(v.index()).is_none_or(|normal| normal.dot(away) < 0.0)
}

/// All vertices nearer to the line of sight than the radius: a pass over the whole mesh, in parallel.
fn under_circle(px: Vec2, pick: &Pick, context: &Context<'_>) -> Vec<VertexId> {
    let ray = context.view.camera.ray(px, context.view.size);
    let sight = ray.direction.normalize_or_zero();
    let most = radius_at(pick, context).powi(2);
    let positions = &context.surface.frame().positions;
    let is_under = |&(_, p): &(usize, &Vec3)| {
        let from_pick = *p - pick.position;
        (from_pick - sight * from_pick.dot(sight)).length_squared() <= most
    };
    promptly(|| positions.par_iter().enumerate().filter(is_under).map(|(v, _)| VertexId(v as u32)).collect())
}

/// The command for covered vertices, if it has any effect.
fn paint(covered: Vec<VertexId>, what: Paint, touched: &mut HashSet<VertexId>, context: &Context<'_>) -> Vec<Command> {
    if covered.is_empty() {
        return Vec::new();
    }
    match what {
        Paint::Lock(mode) => vec![Command::Lock(covered, mode)],
        Paint::Rigidity(mode) => {
            let old = context.document.scene().rigidity.as_slice();
            let mesh = &context.document.model().mesh;
            let mut new = |v: VertexId| {
                let value = match mode {
                    BrushMode::Set | BrushMode::Lock => context.options.rigidity,
                    BrushMode::Stiffer | BrushMode::Softer if !touched.insert(v) => return None,
                    BrushMode::Stiffer => old[v.index()].saturating_add(1).min(Rigidity::MAX),
                    BrushMode::Softer => old[v.index()].saturating_sub(1).max(1),
                    BrushMode::Smooth => mean_around(mesh, old, v),
                };
                Some((v, value))
            };
            let values: Vec<_> = covered.into_iter().filter_map(&mut new).collect();
            if values.is_empty() { Vec::new() } else { vec![Command::Paint { values }] }
        }
    }
}

/// Mean r of a vertex and its neighbors, rounded.
fn mean_around(mesh: &Mesh, r: &[u16], v: VertexId) -> u16 {
    let ring = mesh.neighbors(v);
    let sum: u32 = ring.iter().map(|&w| u32::from(r[w as usize])).sum::<u32>() + u32::from(r[v.index()]);
    let n = ring.len() as u32 + 1;
    ((sum + n / 2) / n) as u16
}

pub(super) fn radius_at(pick: &Pick, context: &Context<'_>) -> f32 {
    context.options.brush_radius(context.view.camera.world_per_px(pick.position, context.view.size))
}

/// A circle on the surface.
pub(super) fn circle(center: Vec3, normal: Vec3, radius: f32, color: [u8; 4]) -> impl Iterator<Item = Line> {
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let lift = normal * radius * 0.02;
    let at = move |k: usize| -> Vec3 {
        let angle = k as f32 / CIRCLE_SEGMENTS as f32 * std::f32::consts::TAU;
        center + lift + (u * angle.cos() + v * angle.sin()) * radius
    };
    (0..CIRCLE_SEGMENTS).map(move |k| Line { a: at(k), b: at(k + 1), color, width_px: 1.5, on_top: true })
}

/// Where the brush is on the other side, and which way the surface faces there.
fn image_of(pick: &Pick, mirror: &Mirror, context: &Context<'_>) -> Option<(Vec3, Vec3)> {
    let v = mirror.map.across(pick.vertex.0).first()?;
    let frame = context.surface.frame();
    Some((frame.positions[*v as usize], frame.normals.get(*v as usize)?.try_normalize()?))
}

impl Tool for BrushTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match input {
            Input::Hover(pointer) => self.hover = context.surface.pick(pointer.px, &context.view),
            Input::Leave => self.hover = None,
            Input::Press(pointer) => {
                self.hover = context.surface.pick(pointer.px, &context.view);
                let (mut touched, what) = (HashSet::new(), what(pointer, context));
                let covered = cover(pointer.px, context);
                let name = match what {
                    Paint::Rigidity(_) => "Paint rigidity",
                    Paint::Lock(SelectMode::Remove) => "Unlock rigidity",
                    Paint::Lock(_) => "Lock rigidity",
                };
                let mut commands = vec![Command::Begin(name)];
                commands.extend(paint(covered, what, &mut touched, context));
                self.stroke = Some(Stroke { last_px: pointer.px, touched });
                return commands.into();
            }
            Input::Drag(pointer) => {
                self.hover = context.surface.pick(pointer.px, &context.view);
                return self.stroke_to(pointer, context).into();
            }
            Input::Release(pointer) if self.stroke.is_some() => {
                let mut commands = self.stroke_to(pointer, context);
                commands.push(Command::Commit);
                self.stroke = None;
                return commands.into();
            }
            Input::Key(ToolKey::Escape) if self.stroke.take().is_some() => {
                return vec![Command::Cancel].into();
            }
            Input::Key(ToolKey::Eyedropper) => {
                let r = self.hover.map(|pick| context.document.scene().rigidity.as_slice()[pick.vertex.index()]);
                return Reaction { rigidity: r, ..Reaction::default() };
            }
            Input::Release(_) | Input::DoubleClick(_) | Input::Key(_) => {}
        }
        Reaction::default()
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let r = context.options.rigidity;
        let locks = context.options.brush_mode == BrushMode::Lock;
        match (&self.stroke, self.hover) {
            (Some(_), _) => "Esc takes the stroke back".into(),
            (None, Some(_)) if locks => {
                "Lock rigidity: nothing changes it then · Ctrl unlocks · [ ] or F radius".into()
            }
            (None, Some(pick)) => {
                let scene = context.document.scene();
                let here = scene.rigidity.as_slice()[pick.vertex.index()];
                let lock = if scene.locked.contains(pick.vertex) { ", locked" } else { "" };
                format!(
                    "Paint rigidity {r} (here {here}{lock}) · Ctrl softer · Shift smooth · I takes {here} · [ ] or F radius"
                )
            }
            (None, None) if locks => "Drag over the surface to lock its rigidity · Ctrl unlocks".into(),
            (None, None) => {
                format!("Drag over the surface to paint rigidity {r} · number keys choose it")
            }
        }
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        let Some(pick) = self.hover else {
            return Marks::default();
        };
        let radius = radius_at(&pick, context);
        let mut lines: Vec<Line> = circle(pick.position, pick.normal, radius, CIRCLE).collect();
        let mirror = context.prepared.mirror.as_ref();
        let dots = mirror.map_or_else(Vec::new, |mirror| mirror.dots(context));
        if let Some((center, normal)) = mirror.and_then(|mirror| image_of(&pick, mirror, context)) {
            lines.extend(circle(center, normal, radius, MIRRORED_CIRCLE));
        }
        Marks { lines, dots, ..Marks::default() }
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    fn is_active(&self) -> bool {
        self.stroke.is_some()
    }

    fn is_over_surface(&self) -> bool {
        self.hover.is_some()
    }
}
