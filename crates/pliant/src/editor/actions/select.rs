//! The menu *Select*: what is selected, and what to make of it.

use egui::Key;

use super::actions;
use super::entry::{CTRL, CTRL_SHIFT, Entry, NONE, SHIFT};
use crate::document::{Alike, GroupKind};
use crate::editor::Session;
use crate::tools::ToolKind;

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
    /// Selects the rest.
    INVERT_SELECTION = Entry::new("select.invert", "Invert", "Select what is not selected, and nothing else")
        .key(CTRL, Key::I)
        .does(Session::invert_selection);
    /// Adds a ring of vertices.
    GROW_SELECTION = Entry::new("select.grow", "Grow", "Add the vertices one edge away")
        .key(NONE, Key::Plus)
        .unless(nothing_selected)
        .does(Session::grow_selection);
    /// Takes a ring of vertices away.
    SHRINK_SELECTION = Entry::new("select.shrink", "Shrink", "Take away the outermost ring of vertices")
        .key(NONE, Key::Minus)
        .unless(nothing_selected)
        .does(Session::shrink_selection);
    /// Adds what hangs together.
    SELECT_LINKED = Entry::new(
        "select.linked",
        "Linked",
        "Add all that is linked by edges to the vertex under the pointer, or else to the selection",
    )
    .key(NONE, Key::L)
    .apart()
    .unless(nothing_pointed_at)
    .does(|session| session.select_alike(Alike::Linked));
    /// Adds what has the same r.
    SELECT_SAME_RIGIDITY = Entry::new(
        "select.same-rigidity",
        "Same rigidity",
        "Add all vertices with the rigidity of the one under the pointer, or else of the selection",
    )
    .key(SHIFT, Key::L)
    .unless(nothing_pointed_at)
    .does(|session| session.select_alike(Alike::Rigidity));
    /// Adds what belongs to the same part of the file.
    SELECT_SAME_PART = Entry::new(
        "select.same-part",
        "Same part",
        "Add the part or material of the file under the pointer, or else those of the selection",
    )
    .unless(nothing_pointed_at)
    .does(|session| session.select_alike(Alike::Part));
    /// Selects borders.
    SELECT_BORDER = Entry::new("select.border", "Borders", "Select the vertices at the borders of the surface")
        .unless(without_border)
        .does(Session::select_border);
    /// Selects what the active group holds.
    SELECT_HANDLE = Entry::new("select.of-handle", "Active handle", "Select the vertices of the active handle or anchor")
        .unless(no_active_group)
        .does(Session::select_active_group);
    /// Keeps the selection.
    STORE_SELECTION = Entry::new("select.store", "Store", "Keep the selection under a name, to come back to")
        .unless(nothing_selected)
        .does(Session::store_selection);
    /// Changes what a drag of the select tool draws.
    NEXT_SELECT_SHAPE = Entry::new("select.next-shape", "Next shape", "Select by box, lasso or brush in turn")
        .key(SHIFT, Key::C)
        .does(|session| {
            session.options.select_shape = session.options.select_shape.next();
            session.take_tool(ToolKind::Select);
        });
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
    /// Lets go of handles and anchors.
    RELEASE_EVERYTHING = Entry::new(
        "select.release",
        "Release everything",
        "Let go of all handles and anchors; the surface stays as it is",
    )
    .unless(nothing_held)
    .does(Session::release_everything);
}

/// What most actions of this menu, and some of others, need.
pub(super) fn nothing_selected(session: &Session) -> Option<&'static str> {
    let is_empty = session.document()?.scene().selection.is_empty();
    is_empty.then_some("Select some vertices first (S, then drag a box)")
}

fn nothing_pointed_at(session: &Session) -> Option<&'static str> {
    (!session.can_select_alike()).then_some("Select some vertices first, or point at one with the select tool (S)")
}

fn without_border(session: &Session) -> Option<&'static str> {
    let mesh = &session.document()?.model().mesh;
    (mesh.defects().boundary_edges == 0).then_some("This surface has no border: it is closed")
}

fn no_active_group(session: &Session) -> Option<&'static str> {
    session.document()?.scene().active_group().is_none().then_some("Choose a handle or anchor in the list first")
}

fn nothing_held(session: &Session) -> Option<&'static str> {
    session.document()?.scene().groups.is_empty().then_some("Nothing is held")
}
