//! The select tool: click, box, lasso.

use glam::Vec2;
use pliant_solver::VertexId;

use super::region::{inside_outline, patch};
use super::{Context, Cursor, Input, Marks, Pointer, Reaction, SelectShape, Tool, ToolKey};
use crate::document::{Command, SelectMode};

/// A press that moves less than this many points is a click (by eye).
const CLICK_PX: f32 = 4.0;

#[derive(Clone, Debug, Default, PartialEq)]
enum State {
    #[default]
    Idle,
    /// Drawing: where the pointer was, in order.
    Drawing(Vec<Vec2>),
}

/// Box, lasso and click selection.
#[derive(Default)]
pub(super) struct SelectTool {
    state: State,
}

impl SelectTool {
    fn finish(&mut self, pointer: Pointer, context: &mut Context<'_>) -> Reaction {
        let State::Drawing(path) = std::mem::take(&mut self.state) else {
            return Reaction::default();
        };
        let mode = match pointer.modifiers {
            m if m.shift => SelectMode::Add,
            m if m.ctrl => SelectMode::Remove,
            _ => SelectMode::Replace,
        };
        let vertices = if is_click(&path) {
            clicked(pointer, context)
        } else {
            let outline = outline(&path, context.options.select_shape);
            inside_outline(&outline, context.options.select_through, context)
        };
        if vertices.is_empty() && mode != SelectMode::Replace {
            return Reaction::default();
        }
        vec![Command::Select(vertices, mode)].into()
    }
}

fn clicked(pointer: Pointer, context: &mut Context<'_>) -> Vec<VertexId> {
    match context.surface.pick(pointer.px, &context.view) {
        Some(pick) => patch(&context.document.model().mesh, pick.vertex, context.options.patch_rings),
        None => Vec::new(),
    }
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
            (Input::Press(pointer), _) => self.state = State::Drawing(vec![pointer.px]),
            (Input::Drag(pointer), State::Drawing(path)) => path.push(pointer.px),
            (Input::Release(pointer), State::Drawing(path)) => {
                path.push(pointer.px);
                return self.finish(pointer, context);
            }
            (Input::Key(ToolKey::Escape), State::Drawing(_)) => self.state = State::Idle,
            (Input::Key(ToolKey::Escape), State::Idle) if !context.document.scene().selection.is_empty() => {
                return vec![Command::Select(Vec::new(), SelectMode::Replace)].into();
            }
            _ => {}
        }
        Reaction::default()
    }

    fn hint(&self, context: &Context<'_>) -> String {
        let shape = match context.options.select_shape {
            SelectShape::Box => "a box",
            SelectShape::Lasso => "a lasso",
        };
        match &self.state {
            State::Drawing(_) => "Release to select · Esc cancels".into(),
            State::Idle if context.document.scene().selection.is_empty() => {
                format!("Drag {shape} around vertices, or click a patch")
            }
            State::Idle => "Shift adds · Ctrl removes · Esc clears · then hold, anchor or fill the selection".into(),
        }
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        let outline = match &self.state {
            State::Drawing(path) if !is_click(path) => outline(path, context.options.select_shape),
            _ => Vec::new(),
        };
        Marks { outline, ..Marks::default() }
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    fn is_active(&self) -> bool {
        self.state != State::Idle
    }
}
