//! The inspect tool: what is known of the vertex under the pointer, and how far it is from one to another.
//!
//! A click pins a vertex, a second one measures from there; a third begins anew. Pins are vertices, so that they stay
//! with the surface while it bends.

use pliant_solver::VertexId;

use super::{Card, Context, Cursor, Input, Marks, Pick, Reaction, Tool, ToolKey};
use crate::viewport::{Dot, Line};

/// A pinned vertex; by eye: seen on all ramps, and no color of handles.
const PIN_COLOR: [u8; 4] = [255, 255, 255, 255];
/// The vertex under the pointer, edges around it, the straight way.
const HOVER_COLOR: [u8; 4] = [255, 255, 255, 200];
/// Edges shown around a vertex: those of a fan's hub would be a disc of white (by eye).
const MOST_EDGES: usize = 64;

/// A vertex that was pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    vertex: VertexId,
    triangle: u32,
}

impl From<Pick> for Point {
    fn from(pick: Pick) -> Point {
        Point { vertex: pick.vertex, triangle: pick.triangle }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum State {
    #[default]
    Free,
    /// One vertex is pinned.
    Pinned(Point),
    /// Two are.
    Measured(Point, Point),
}

/// Looks, and changes nothing.
#[derive(Default)]
pub(super) struct InspectTool {
    state: State,
    hover: Option<(Pick, glam::Vec2)>,
}

impl InspectTool {
    fn click(&mut self) {
        let Some((pick, _)) = self.hover else { return };
        self.state = match self.state {
            State::Pinned(first) if first.vertex != pick.vertex => State::Measured(first, pick.into()),
            State::Pinned(_) => State::Free,
            State::Free | State::Measured(..) => State::Pinned(pick.into()),
        };
    }

    /// The vertex under the pointer, unless it is pinned.
    fn hovered(&self) -> Option<Card> {
        let (pick, px) = self.hover?;
        let is_pinned = match self.state {
            State::Free => false,
            State::Pinned(point) => point.vertex == pick.vertex,
            State::Measured(..) => true,
        };
        (!is_pinned).then_some(Card { vertex: pick.vertex, triangle: pick.triangle, pointer: Some(px) })
    }

    fn pins(&self) -> Vec<Point> {
        match self.state {
            State::Free => Vec::new(),
            State::Pinned(point) => vec![point],
            State::Measured(from, to) => vec![from, to],
        }
    }
}

impl Tool for InspectTool {
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction {
        match input {
            Input::Hover(pointer) | Input::Drag(pointer) | Input::Press(pointer) => {
                self.hover = context.surface.pick(pointer.px, &context.view).map(|pick| (pick, pointer.px));
                if matches!(input, Input::Press(_)) {
                    self.click();
                }
            }
            Input::Leave => self.hover = None,
            Input::Key(ToolKey::Escape) => self.state = State::Free,
            Input::Release(_) | Input::DoubleClick(_) | Input::Key(_) => {}
        }
        Reaction::default()
    }

    fn hint(&self, _context: &Context<'_>) -> String {
        match self.state {
            State::Free => "Point at the surface to read a vertex · click pins it".into(),
            State::Pinned(_) => "Click another vertex to measure the way to it · Esc lets go".into(),
            State::Measured(..) => "Click to begin anew · Esc clears".into(),
        }
    }

    fn marks(&self, context: &Context<'_>) -> Marks {
        let positions = &context.surface.frame().positions;
        let at = |v: VertexId| positions[v.index()];
        let line = |a, b, on_top| Line { a: at(a), b: at(b), color: HOVER_COLOR, width_px: 1.5, on_top };
        let hovered = self.hovered();
        let mut marks = Marks::default();
        let pins = self.pins();
        for &Point { vertex, triangle } in &pins {
            marks.dots.push(Dot { position: at(vertex), color: PIN_COLOR, radius_px: 4.0 });
            marks.cards.push(Card { vertex, triangle, pointer: None });
        }
        if let Some(card) = hovered {
            let around = context.document.model().mesh.neighbors(card.vertex);
            marks.lines = around.iter().take(MOST_EDGES).map(|&w| line(card.vertex, VertexId(w), false)).collect();
            marks.dots.push(Dot { position: at(card.vertex), color: HOVER_COLOR, radius_px: 3.0 });
            marks.cards.push(card);
        }
        if let [from, to] = marks.cards[..] {
            marks.lines.push(line(from.vertex, to.vertex, true));
            marks.measured = matches!(self.state, State::Measured(..)).then_some([from, to]);
        }
        marks
    }

    fn cursor(&self) -> Cursor {
        Cursor::Cross
    }

    /// There is nothing to take back: changing the tool lets go of the pins anyway.
    fn is_active(&self) -> bool {
        false
    }
}
