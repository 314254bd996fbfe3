//! The menu *Select*: what is selected, and what to make of it.

use egui::Key;

use super::actions;
use super::entry::{CTRL, CTRL_SHIFT, Entry};
use crate::document::GroupKind;
use crate::editor::Session;

actions! {
    /// Selects everything.
    SELECT_ALL = Entry::new("select.all", "Select all", "Select every vertex")
        .key(CTRL, Key::A)
        .does(|session| session.select_all(true));
    /// Selects nothing.
    SELECT_NONE = Entry::new("select.none", "Select none", "Empty the selection")
        .key(CTRL_SHIFT, Key::A)
        .unless(nothing_selected)
        .does(|session| session.select_all(false));
    /// Handle from the selection.
    HANDLE_FROM_SELECTION =
        Entry::new("select.handle", "Handle from selection", "Move the selected vertices together")
            .key(CTRL, Key::H)
            .apart()
            .unless(nothing_selected)
            .does(|session| session.hold_selection(GroupKind::Handle));
    /// Anchor from the selection.
    ANCHOR_FROM_SELECTION =
        Entry::new("select.anchor", "Anchor from selection", "Hold the selected vertices where they are")
            .key(CTRL_SHIFT, Key::H)
            .unless(nothing_selected)
            .does(|session| session.hold_selection(GroupKind::Anchor));
    /// Anchors what is not selected.
    HOLD_EVERYTHING_ELSE = Entry::new(
        "select.hold-else",
        "Hold everything else",
        "Anchor all that is not selected: only the selection bends",
    )
    .unless(nothing_selected)
    .does(Session::hold_everything_else);
}

/// What most actions of this menu, and some of others, need.
pub(super) fn nothing_selected(session: &Session) -> Option<&'static str> {
    let is_empty = session.document()?.scene().selection.is_empty();
    is_empty.then_some("Select some vertices first (S, then drag a box)")
}
