//! The menu *Edit*: steps back and forth, and tools.

use egui::Key;

use super::actions;
use super::entry::{CTRL, CTRL_SHIFT, Entry, NONE};
use crate::editor::Session;
use crate::tools::ToolKind;

actions! {
    /// Takes back a step.
    UNDO = Entry::new("edit.undo", "Undo", "Take back the last step")
        .key(CTRL, Key::Z)
        .unless(nothing_to_undo)
        .titled(|session| {
            let name = session.document()?.history().undo_name()?;
            Some(format!("Undo {}", name.to_lowercase()))
        })
        .does(Session::undo);
    /// Makes it again.
    REDO = Entry::new("edit.redo", "Redo", "Make the undone step again")
        .key(CTRL_SHIFT, Key::Z)
        .key(CTRL, Key::Y)
        .unless(nothing_to_redo)
        .titled(|session| {
            let name = session.document()?.history().redo_name()?;
            Some(format!("Redo {}", name.to_lowercase()))
        })
        .does(Session::redo);
    /// The tool that places and drags handles.
    TOOL_HANDLE = Entry::tool("tool.handle", ToolKind::Handle)
        .key(NONE, Key::H)
        .on(|session| session.tool_kind() == ToolKind::Handle)
        .apart();
    /// The tool that places anchors.
    TOOL_ANCHOR = Entry::tool("tool.anchor", ToolKind::Anchor)
        .key(NONE, Key::A)
        .on(|session| session.tool_kind() == ToolKind::Anchor);
    /// The tool that selects.
    TOOL_SELECT = Entry::tool("tool.select", ToolKind::Select)
        .key(NONE, Key::S)
        .on(|session| session.tool_kind() == ToolKind::Select);
    /// The tool that paints rigidity.
    TOOL_BRUSH = Entry::tool("tool.brush", ToolKind::Brush)
        .key(NONE, Key::B)
        .on(|session| session.tool_kind() == ToolKind::Brush);
    /// The tool that fills regions with rigidity.
    TOOL_FILL = Entry::tool("tool.fill", ToolKind::Fill)
        .key(NONE, Key::G)
        .on(|session| session.tool_kind() == ToolKind::Fill);
    /// The tool that tells about vertices.
    TOOL_INSPECT = Entry::tool("tool.inspect", ToolKind::Inspect)
        .key(NONE, Key::Q)
        .on(|session| session.tool_kind() == ToolKind::Inspect);
}

fn nothing_to_undo(session: &Session) -> Option<&'static str> {
    let document = session.document()?;
    (document.history().is_empty() && !document.in_step()).then_some("There is nothing to undo")
}

fn nothing_to_redo(session: &Session) -> Option<&'static str> {
    session.document()?.history().redo_name().is_none().then_some("There is nothing to redo")
}
