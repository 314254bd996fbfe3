//! The words that tools and window share.

use glam::Vec2;
use pliant_solver::VertexId;

use super::{Options, Pick, Prepared, Surface};
use crate::document::{Command, Document};
use crate::viewport::{Camera, Dot, Line, Preview};

/// Keys held while the pointer acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Modifiers {
    /// Constrain, add, smooth.
    pub shift: bool,
    /// Snap, remove, softer. Command on a Mac.
    pub ctrl: bool,
    /// Onto a vertex. Option on a Mac.
    pub alt: bool,
}

/// Where the pointer is, in points from the viewport's top left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointer {
    /// Position, y down.
    pub px: Vec2,
    /// Keys held.
    pub modifiers: Modifiers,
}

/// Keys that mean something to every tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolKey {
    /// Take back what is under way.
    Escape,
    /// Remove what is active or under the pointer.
    Delete,
    /// Take over the r under the pointer.
    Eyedropper,
    /// Make the surface under the pointer, or under the next click, the pivot.
    Pivot,
    /// A digit, a point or a minus of a number that is typed.
    Sign(char),
    /// Take back the last sign.
    Erase,
    /// Choose an axis: x = 0, y = 1, z = 2.
    Axis(usize),
    /// Keep what is typed.
    Enter,
}

/// What happens to a tool. Press, drag and release are of the primary button.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// The pointer moved with no button down.
    Hover(Pointer),
    /// The pointer left the viewport.
    Leave,
    /// Button down.
    Press(Pointer),
    /// The pointer moved with the button down.
    Drag(Pointer),
    /// Button up.
    Release(Pointer),
    /// The button was released for the second time in quick succession, at one place.
    DoubleClick(Pointer),
    /// A key.
    Key(ToolKey),
}

/// Camera and viewport size in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye.
    pub camera: Camera,
    /// Width and height.
    pub size: Vec2,
}

/// What a tool may look at.
pub struct Context<'a> {
    /// The truth.
    pub document: &'a Document,
    /// The eye.
    pub view: View,
    /// The surface as it is on screen, for picking.
    pub surface: &'a mut Surface,
    /// Settings.
    pub options: &'a Options,
    /// What was found in the background.
    pub prepared: &'a Prepared,
}

/// What a tool wants done.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reaction {
    /// In this order.
    pub commands: Vec<Command>,
    /// r to take over as the current one.
    pub rigidity: Option<u16>,
    /// World position to take over as the pivot.
    pub pivot: Option<glam::DVec3>,
}

impl From<Vec<Command>> for Reaction {
    fn from(commands: Vec<Command>) -> Reaction {
        Reaction { commands, ..Reaction::default() }
    }
}

/// What a tool draws over the surface.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// Dots in view space.
    pub dots: Vec<Dot>,
    /// Lines in view space.
    pub lines: Vec<Line>,
    /// A closed outline on screen, in points (box, lasso).
    pub outline: Vec<Vec2>,
    /// What a click would fill.
    pub preview: Option<Preview>,
    /// Words, next to the pointer for instance.
    pub label: Option<Label>,
    /// Vertices to tell about in writing.
    pub cards: Vec<Card>,
    /// Two of them whose distance along the surface is wanted.
    pub measured: Option<[Card; 2]>,
}

/// A few words over the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// What they are about, in points from the viewport's top left.
    pub px: Vec2,
    /// One line.
    pub text: String,
}

/// A vertex to tell about, beside it or beside the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Card {
    /// Which.
    pub vertex: VertexId,
    /// The triangle that was pointed at: it tells the part of the file.
    pub triangle: u32,
    /// The pointer, while the card follows it.
    pub pointer: Option<Vec2>,
}

/// Shape of the mouse pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cursor {
    /// An arrow.
    Arrow,
    /// A cross: clicks act exactly here.
    Cross,
    /// An open hand: can be taken.
    Grab,
    /// A closed hand: is being dragged.
    Grabbing,
}

/// A state machine from input to commands.
pub trait Tool: Send {
    /// Advances the state.
    fn handle(&mut self, input: Input, context: &mut Context<'_>) -> Reaction;
    /// What the mouse does now, for the hint line.
    fn hint(&self, context: &Context<'_>) -> String;
    /// What to draw now.
    fn marks(&self, context: &Context<'_>) -> Marks;
    /// Shape of the pointer now.
    fn cursor(&self) -> Cursor;
    /// Whether a drag or stroke is under way.
    fn is_active(&self) -> bool;
    /// Whether it has more to do for the drag it was last told of, and wants to be told again.
    fn is_behind(&self) -> bool {
        false
    }
    /// Whether digits and axis keys are for it now.
    fn takes_numbers(&self) -> bool {
        false
    }
    /// Whether nothing but a number, or the end of it, is missing: any other command ends it.
    fn waits_for_number(&self) -> bool {
        false
    }
    /// What lies under the pointer, for actions that mean it. Tools whose own actions do not say so tell nothing.
    fn pointed_at(&self) -> Option<Pick> {
        None
    }
    /// Whether the pointer is over the surface, as far as the tool looks for that.
    fn is_over_surface(&self) -> bool {
        self.pointed_at().is_some()
    }
}
