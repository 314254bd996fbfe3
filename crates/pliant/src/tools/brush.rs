//! The rigidity brush: dabs of a radius that is seen on screen and measured along the surface.

use std::collections::HashSet;

use glam::{Vec2, Vec3};
use pliant_solver::{Mesh, Rigidity, VertexId};

use super::{BrushMode, Context, Cursor, Input, Marks, Pick, Pointer, Reaction, Tool, ToolKey};
use crate::document::Command;
use crate::viewport::Line;

/// Dabs along a stroke are this fraction of the radius apart, so that its edge looks smooth (by eye).
const SPACING: f32 = 0.25;
/// Segments of the drawn circle.
const CIRCLE_SEGMENTS: usize = 48;

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

impl BrushTool {
    fn stroke_to(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Vec<Command> {
        let Some(stroke) = &mut self.stroke else {
            return Vec::new();
        };
        let spacing = (SPACING * context.options.brush_radius_px).max(1.0);
        let mode = mode(pointer, context);
        let mut values: Vec<(VertexId, u16)> = Vec::new();
        while stroke.last_px.distance(pointer.px) >= spacing {
            stroke.last_px += (pointer.px - stroke.last_px).normalize_or_zero() * spacing;
            values.extend(dab(stroke.last_px, mode, &mut stroke.touched, context));
        }
        if values.is_empty() { Vec::new() } else { vec![Command::Paint { values }] }
    }
}

fn mode(pointer: Pointer, context: &Context<'_>) -> BrushMode {
    match pointer.modifiers {
        m if m.shift => BrushMode::Smooth,
        m if m.ctrl => BrushMode::Softer,
        _ => context.options.brush_mode,
    }
}

/// Vertices under one dab and their new r.
fn dab(px: Vec2, mode: BrushMode, touched: &mut HashSet<VertexId>, context: &mut Context<'_>) -> Vec<(VertexId, u16)> {
    let Some(pick) = context.surface.pick(px, &context.view) else {
        return Vec::new();
    };
    let radius = radius_at(&pick, context);
    let mut covered: Vec<VertexId> = context.surface.within(&pick, radius).iter().map(|&(v, _)| VertexId(v)).collect();
    if covered.is_empty() {
        covered.push(pick.vertex); // a brush smaller than a face still paints
    }
    let old = context.document.scene().rigidity.as_slice();
    let mesh = &context.document.model().mesh;
    let mut new = |v: VertexId| {
        let value = match mode {
            BrushMode::Set => context.options.rigidity,
            BrushMode::Stiffer | BrushMode::Softer if !touched.insert(v) => return None,
            BrushMode::Stiffer => old[v.index()].saturating_add(1).min(Rigidity::MAX),
            BrushMode::Softer => old[v.index()].saturating_sub(1).max(1),
            BrushMode::Smooth => mean_around(mesh, old, v),
        };
        Some((v, value))
    };
    covered.into_iter().filter_map(&mut new).collect()
}

/// Mean r of a vertex and its neighbors, rounded.
fn mean_around(mesh: &Mesh, r: &[u16], v: VertexId) -> u16 {
    let ring = mesh.neighbors(v);
    let sum: u32 = ring.iter().map(|&w| u32::from(r[w as usize])).sum::<u32>() + u32::from(r[v.index()]);
    let n = ring.len() as u32 + 1;
    ((sum + n / 2) / n) as u16
}

fn radius_at(pick: &Pick, context: &Context<'_>) -> f32 {
    context.options.brush_radius_px * context.view.camera.world_per_px(pick.position, context.view.size)
}

impl Tool for BrushTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match input {
            Input::Hover(pointer) => self.hover = context.surface.pick(pointer.px, &context.view),
            Input::Leave => self.hover = None,
            Input::Press(pointer) => {
                self.hover = context.surface.pick(pointer.px, &context.view);
                let mut touched = HashSet::new();
                let values = dab(pointer.px, mode(pointer, context), &mut touched, context);
                self.stroke = Some(Stroke { last_px: pointer.px, touched });
                return vec![Command::Begin("Paint rigidity"), Command::Paint { values }].into();
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
                return Reaction { commands: Vec::new(), rigidity: r };
            }
            Input::Release(_) | Input::Key(_) => {}
        }
        Reaction::default()
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let r = context.options.rigidity;
        match (&self.stroke, self.hover) {
            (Some(_), _) => "Esc takes the stroke back".into(),
            (None, Some(pick)) => {
                let here = context.document.scene().rigidity.as_slice()[pick.vertex.index()];
                format!(
                    "Paint rigidity {r} (here {here}) · Ctrl softer · Shift smooth · I takes {here} · [ ] or F radius"
                )
            }
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
        let u = pick.normal.any_orthonormal_vector();
        let v = pick.normal.cross(u);
        let lift = pick.normal * radius * 0.02;
        let at = |k: usize| -> Vec3 {
            let angle = k as f32 / CIRCLE_SEGMENTS as f32 * std::f32::consts::TAU;
            pick.position + lift + (u * angle.cos() + v * angle.sin()) * radius
        };
        let line = |k| Line { a: at(k), b: at(k + 1), color: [255, 255, 255, 230], width_px: 1.5, on_top: true };
        Marks { lines: (0..CIRCLE_SEGMENTS).map(line).collect(), ..Marks::default() }
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    fn is_active(&self) -> bool {
        self.stroke.is_some()
    }
}
