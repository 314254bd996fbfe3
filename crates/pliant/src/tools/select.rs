//! The select tool: click, double click, box, lasso, brush.
//!
//! A drag that stays where it began is a click, which takes one vertex; two of them take all that is linked to it. Shift
//! adds to what is selected and Ctrl removes from it, whatever the shape.

use glam::Vec2;
use pliant_solver::VertexId;

use super::brush::{CIRCLE, circle, radius_at, spacing_px};
use super::region::{covered, inside_outline};
use super::{Context, Cursor, Input, Marks, Modifiers, Pick, Pointer, Reaction, SelectShape, Tool, ToolKey};
use crate::document::{Alike, Command, SelectMode, alike};
use crate::viewport::Dot;

/// A press that moves less than this many points is a click (by eye).
const CLICK_PX: f32 = 4.0;
/// So few selected vertices are marked with dots as well: the tint of a single one among thousands is not seen, and on
/// coarse meshes it spreads over whole faces (by eye).
const MARKED_VERTICES: usize = 300;
/// The tint of the selection, sRGB.
const SELECTED_COLOR: [u8; 4] = [52, 222, 160, 255];
/// What a click would take.
const PREVIEW_COLOR: [u8; 4] = [255, 255, 255, 210];

#[derive(Clone, Debug, Default, PartialEq)]
enum State {
    #[default]
    Idle,
    /// Drawing: where the pointer was, in order.
    Drawing(Vec<Vec2>),
    /// A stroke of the brush: how its dabs join the selection, and where the last one was.
    Stroke(SelectMode, Vec2),
}

/// Selects surface points.
#[derive(Default)]
pub(super) struct SelectTool {
    state: State,
    hover: Option<Pick>,
}

impl SelectTool {
    fn press(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Reaction {
        self.hover = context.surface.pick(pointer.px, &context.view);
        if context.options.select_shape != SelectShape::Brush {
            self.state = State::Drawing(vec![pointer.px]);
            return Reaction::default();
        }
        let mode = mode(pointer.modifiers);
        self.state = State::Stroke(if mode == SelectMode::Remove { mode } else { SelectMode::Add }, pointer.px);
        vec![Command::Begin("Select"), Command::Select(dab(pointer.px, context), mode)].into()
    }

    fn stroke_to(&mut self, px: Vec2, context: &mut Context<'_>) -> Vec<Command> {
        let State::Stroke(mode, last) = &mut self.state else {
            return Vec::new();
        };
        let spacing = spacing_px(*last, context);
        let mut vertices = Vec::new();
        while last.distance(px) >= spacing {
            *last += (px - *last).normalize_or_zero() * spacing;
            vertices.extend(dab(*last, context));
        }
        if vertices.is_empty() { Vec::new() } else { vec![Command::Select(vertices, *mode)] }
    }

    fn release(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Reaction {
        match std::mem::take(&mut self.state) {
            State::Idle => Reaction::default(),
            State::Drawing(mut path) => {
                path.push(pointer.px);
                finish(&path, mode(pointer.modifiers), context)
            }
            stroke @ State::Stroke(..) => {
                self.state = stroke;
                let mut commands = self.stroke_to(pointer.px, context);
                self.state = State::Idle;
                commands.push(Command::Commit);
                commands.into()
            }
        }
    }

    fn escape(&mut self, context: &Context<'_>) -> Reaction {
        match std::mem::take(&mut self.state) {
            State::Stroke(..) => vec![Command::Cancel].into(),
            State::Idle if !context.document.scene().selection.is_empty() => {
                vec![Command::Select(Vec::new(), SelectMode::Replace)].into()
            }
            State::Drawing(_) | State::Idle => Reaction::default(),
        }
    }
}

fn mode(keys: Modifiers) -> SelectMode {
    match keys {
        m if m.shift => SelectMode::Add,
        m if m.ctrl => SelectMode::Remove,
        _ => SelectMode::Replace,
    }
}

/// What a click, box or lasso selects.
fn finish(path: &[Vec2], mode: SelectMode, context: &mut Context<'_>) -> Reaction {
    let vertices = if is_click(path) {
        let pick = path.last().and_then(|&px| context.surface.pick(px, &context.view));
        pick.map(|pick| pick.vertex).into_iter().collect()
    } else {
        let outline = outline(path, context.options.select_shape);
        inside_outline(&outline, context.options.select_through, context)
    };
    select(vertices, mode)
}

/// A component of the surface.
fn linked(pointer: Pointer, context: &mut Context<'_>) -> Reaction {
    let Some(pick) = context.surface.pick(pointer.px, &context.view) else {
        return Reaction::default();
    };
    let (model, scene) = (context.document.model(), context.document.scene());
    select(alike(model, scene, &[pick.vertex], Alike::Linked).vertices().to_vec(), mode(pointer.modifiers))
}

fn select(vertices: Vec<VertexId>, mode: SelectMode) -> Reaction {
    if vertices.is_empty() && mode != SelectMode::Replace {
        return Reaction::default();
    }
    vec![Command::Select(vertices, mode)].into()
}

/// Vertices under one dab of the brush.
fn dab(px: Vec2, context: &mut Context<'_>) -> Vec<VertexId> {
    let Some(pick) = context.surface.pick(px, &context.view) else {
        return Vec::new();
    };
    let radius = radius_at(&pick, context);
    covered(&pick, radius, context)
}

fn is_click(path: &[Vec2]) -> bool {
    path.iter().all(|p| p.distance(path[0]) < CLICK_PX)
}

fn outline(path: &[Vec2], shape: SelectShape) -> Vec<Vec2> {
    match (shape, path) {
        (SelectShape::Box, [a, .., b]) => vec![*a, Vec2::new(b.x, a.y), *b, Vec2::new(a.x, b.y)],
        _ => path.to_vec(),
    }
}

impl Tool for SelectTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match (input, &mut self.state) {
            (Input::Hover(pointer), _) => self.hover = context.surface.pick(pointer.px, &context.view),
            (Input::Leave, _) => self.hover = None,
            (Input::Press(pointer), State::Idle) => return self.press(pointer, context),
            (Input::Drag(pointer), State::Drawing(path)) => path.push(pointer.px),
            (Input::Drag(pointer), State::Stroke(..)) => {
                self.hover = context.surface.pick(pointer.px, &context.view);
                return self.stroke_to(pointer.px, context).into();
            }
            (Input::Release(pointer), _) => return self.release(pointer, context),
            // Two dabs of the brush in quick succession are two dabs.
            (Input::DoubleClick(pointer), State::Idle) if context.options.select_shape != SelectShape::Brush => {
                return linked(pointer, context);
            }
            (Input::Key(ToolKey::Escape), _) => return self.escape(context),
            _ => {}
        }
        Reaction::default()
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let selection = &context.document.scene().selection;
        let drag = match context.options.select_shape {
            SelectShape::Box => "Drag a box around vertices",
            SelectShape::Lasso => "Drag a lasso around vertices",
            SelectShape::Brush => "Drag over the surface",
        };
        match &self.state {
            State::Drawing(_) => "Release to select · Shift adds · Ctrl removes · Esc cancels".into(),
            State::Stroke(SelectMode::Remove, _) => "Removing from the selection · Esc takes the stroke back".into(),
            State::Stroke(..) => "Selecting · Esc takes the stroke back".into(),
            State::Idle if selection.is_empty() => match context.options.select_shape {
                SelectShape::Brush => format!("{drag} to select · [ ] or F radius · L adds all that is linked"),
                _ => format!("{drag}, or click a vertex · double click takes all that is linked to it"),
            },
            State::Idle => {
                "Shift adds · Ctrl removes · double click: linked · Esc clears · then hold, anchor or fill it".into()
            }
        }
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        let outline = match &self.state {
            State::Drawing(path) if !is_click(path) => outline(path, context.options.select_shape),
            _ => Vec::new(),
        };
        let is_brush = context.options.select_shape == SelectShape::Brush;
        let positions = &context.surface.frame().positions;
        let dot = |v: VertexId, color, radius_px| Dot { position: positions[v.index()], color, radius_px };
        let selected = context.document.scene().selection.vertices();
        let (mut dots, mut lines) = (Vec::new(), Vec::new());
        if selected.len() <= MARKED_VERTICES {
            dots.extend(selected.iter().map(|&v| dot(v, SELECTED_COLOR, 2.5)));
        }
        match (self.hover, &self.state) {
            (Some(pick), _) if is_brush => {
                lines = circle(pick.position, pick.normal, radius_at(&pick, context), CIRCLE).collect();
            }
            (Some(pick), State::Idle) => dots.push(dot(pick.vertex, PREVIEW_COLOR, 3.0)),
            _ => {}
        }
        Marks { dots, lines, outline, ..Marks::default() }
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    fn is_active(&self) -> bool {
        self.state != State::Idle
    }

    fn pointed_at(&self) -> Option<Pick> {
        self.hover
    }
}
