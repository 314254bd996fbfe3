//! From pointer and keys to commands. Each tool is a small state machine that knows nothing of windows; what it shows
//! (marks, hint, cursor) is a function of its state.
//!
//! Adding a tool is one file that implements [`Tool`] and one line in [`ToolKind::ALL`] and [`ToolKind::new_tool`].

mod brush;
mod fill;
mod gizmo;
mod grow;
mod inspect;
mod length;
mod mirror;
mod mouse;
mod options;
mod outline;
mod paint_options;
mod place;
mod prepared;
mod prompt;
mod region;
mod select;
mod surface;
mod tool;

pub use gizmo::{Axes, Gizmo, GizmoPart, GizmoSettings, GizmoShown, Pivot};
pub use length::{fixed, length};
pub use mirror::{Mirror, MirrorKind, MirrorOptions};
pub use mouse::{Gesture, VIEW_GESTURES};
pub use options::{BrushMode, Options, SelectShape};
pub use paint_options::{BrushReach, BrushUnit, FillBoundary, PaintOptions};
pub use prepared::Prepared;
pub use surface::{Pick, Surface};
pub use tool::{Card, Context, Cursor, Input, Label, Marks, Modifiers, Pointer, Reaction, Tool, ToolKey, View};

use crate::document::GroupKind;

/// Which tool plain left clicks speak to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToolKind {
    /// Places and drags handles.
    Handle,
    /// Places anchors.
    Anchor,
    /// Selects surface points.
    Select,
    /// Paints rigidity.
    Brush,
    /// Fills regions with rigidity.
    Fill,
    /// Tells about vertices and measures between them.
    Inspect,
}

impl ToolKind {
    /// In the order of the tool rail.
    pub const ALL: [ToolKind; 6] =
        [ToolKind::Handle, ToolKind::Anchor, ToolKind::Select, ToolKind::Brush, ToolKind::Fill, ToolKind::Inspect];

    /// Name on its button.
    pub const fn label(self) -> &'static str {
        match self {
            ToolKind::Handle => "Handle",
            ToolKind::Anchor => "Anchor",
            ToolKind::Select => "Select",
            ToolKind::Brush => "Brush",
            ToolKind::Fill => "Fill",
            ToolKind::Inspect => "Inspect",
        }
    }

    /// What it does, for the tooltip.
    pub const fn description(self) -> &'static str {
        match self {
            ToolKind::Handle => "Click the surface to place a handle, drag handles to bend it",
            ToolKind::Anchor => "Click the surface to hold it where it is",
            ToolKind::Select => "Select vertices by click, box, lasso or brush, for handles, anchors and fills",
            ToolKind::Brush => "Paint how stiff the surface is",
            ToolKind::Fill => "Click to fill a region with rigidity, or drag to spread it from a point",
            ToolKind::Inspect => "Point at a vertex to read its numbers; click two to measure between them",
        }
    }

    /// A fresh tool of this kind, idle.
    pub fn new_tool(self) -> Box<dyn Tool> {
        match self {
            ToolKind::Handle => Box::new(place::PlaceTool::new(GroupKind::Handle)),
            ToolKind::Anchor => Box::new(place::PlaceTool::new(GroupKind::Anchor)),
            ToolKind::Select => Box::<select::SelectTool>::default(),
            ToolKind::Brush => Box::<brush::BrushTool>::default(),
            ToolKind::Fill => Box::<fill::FillTool>::default(),
            ToolKind::Inspect => Box::<inspect::InspectTool>::default(),
        }
    }
}
