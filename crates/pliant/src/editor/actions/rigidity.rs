//! The menu *Rigidity*.

use egui::Key;

use super::actions;
use super::entry::{CTRL, Entry, NONE};
use super::select::nothing_selected;
use crate::document::Command;
use crate::editor::Session;
use crate::tools::{Input, Options, ToolKey, ToolKind};

/// How much a key press changes the radius of the brush; four presses double it (by eye).
const BRUSH_STEP: f32 = 1.2;

actions! {
    /// Current r for the selection.
    FILL_SELECTION =
        Entry::new("rigidity.fill-selection", "Fill selection", "Give the selected vertices the current rigidity")
            .key(CTRL, Key::F)
            .unless(nothing_selected)
            .does(Session::fill_selection);
    /// Current r everywhere.
    FILL_ALL =
        Entry::new("rigidity.fill-all", "Set rigidity everywhere", "Give every vertex the current rigidity")
            .does(|session| session.apply(Command::FillAll(session.options.rigidity)));
    /// The panel in which rigidity is learned.
    LEARN_RIGIDITY = Entry::new(
        "rigidity.learn",
        "Learn rigidity from poses…",
        "Find out from a few poses where the mesh is stiff and where it bends",
    )
    .key(CTRL, Key::L)
    .does(Session::open_learning);
    /// Takes over the r under the pointer.
    EYEDROPPER = Entry::new(
        "rigidity.eyedropper",
        "Take rigidity under pointer",
        "Paint with the rigidity that is under the pointer",
    )
    .key(NONE, Key::I)
    .apart()
    .unless(no_painting_tool)
    .does(|session| session.input(Input::Key(ToolKey::Eyedropper)));
    /// A smaller brush.
    BRUSH_SMALLER = Entry::new("rigidity.brush-smaller", "Smaller brush", "Make the brush smaller")
        .key(NONE, Key::OpenBracket)
        .does(|session| scale_brush(session, 1.0 / BRUSH_STEP));
    /// A larger brush.
    BRUSH_LARGER = Entry::new("rigidity.brush-larger", "Larger brush", "Make the brush larger")
        .key(NONE, Key::CloseBracket)
        .does(|session| scale_brush(session, BRUSH_STEP));
}

fn no_painting_tool(session: &Session) -> Option<&'static str> {
    let paints = matches!(session.tool_kind(), ToolKind::Brush | ToolKind::Fill);
    (!paints).then_some("Take the brush or the fill tool first")
}

fn scale_brush(session: &mut Session, factor: f32) {
    let range = Options::BRUSH_RADIUS_PX;
    let radius = session.options.brush_radius_px * factor;
    session.options.brush_radius_px = radius.clamp(*range.start(), *range.end());
}
