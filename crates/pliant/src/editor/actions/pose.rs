//! The menu *Pose*.

use egui::Key;

use super::actions;
use super::entry::{CTRL, Entry, NONE};
use crate::document::Command;
use crate::editor::Session;
use crate::tools::{Input, ToolKey, ToolKind};

actions! {
    /// Removes the active or hovered group.
    DELETE_HANDLE = Entry::new(
        "pose.delete-handle",
        "Delete handle",
        "Let go of the handle or anchor under the pointer, or of the active one",
    )
    .key(NONE, Key::Delete)
    .key(NONE, Key::Backspace)
    .unless(no_handle_to_delete)
    .does(delete_handle);
    /// Everything back to rest.
    RESET_POSE = Entry::new("pose.reset", "Reset pose", "Put all handles and the surface back to rest")
        .key(CTRL, Key::R)
        .does(|session| session.apply(Command::ResetPose));
}

fn holds_handles(kind: ToolKind) -> bool {
    matches!(kind, ToolKind::Handle | ToolKind::Anchor)
}

fn no_handle_to_delete(session: &Session) -> Option<&'static str> {
    let has_one = holds_handles(session.tool_kind()) || !session.document()?.scene().active.is_empty();
    (!has_one).then_some("Choose a handle in the list first")
}

/// The handle tools know what is under the pointer; with another tool in hand the active group goes.
fn delete_handle(session: &mut Session) {
    if holds_handles(session.tool_kind()) {
        session.input(Input::Key(ToolKey::Delete));
    } else if let Some(ids) = session.document().map(|document| document.scene().active.ids().to_vec()) {
        session.apply(Command::Release(ids));
    }
}
