//! The menu *Handle*.

use egui::{Key, Modifiers};

use super::actions;
use super::entry::{Entry, NONE};
use super::select::nothing_selected;
use crate::editor::Session;
use crate::tools::{GizmoShown, Input, ToolKey, ToolKind};

actions! {
    /// Works on all groups.
    CHOOSE_ALL_GROUPS = Entry::new("handle.choose-all", "Choose all", "Work on all handles and anchors at once")
        .unless(no_groups)
        .does(Session::choose_all_groups);
    /// The active groups into view.
    FRAME_GROUPS = Entry::new("handle.frame", "Look at chosen", "Bring the chosen handles and anchors into view")
        .unless(none_chosen)
        .does(Session::frame_active_groups);
    /// The vertices of the active groups become the selection.
    SELECT_GROUPS = Entry::new("handle.select", "Select vertices", "Select the vertices that the chosen groups hold")
        .unless(none_chosen)
        .does(Session::select_active_groups);
    /// Back to the rest shape.
    RETURN_TO_REST =
        Entry::new("handle.rest", "Return to rest", "Put the chosen handles and anchors back to the rest shape")
            .apart()
            .unless(none_chosen)
            .does(Session::return_active_to_rest);
    /// Handles become anchors and anchors handles.
    SWAP_KINDS = Entry::new(
        "handle.swap",
        "Swap kind",
        "Make the chosen handles anchors, which stay where they are, and the chosen anchors handles, which can be moved",
    )
    .unless(none_chosen)
    .does(Session::swap_active_kinds);
    /// One group of several.
    MERGE_GROUPS = Entry::new("handle.merge", "Merge", "Make one of the chosen groups; nothing moves")
        .unless(not_two_chosen)
        .does(Session::merge_active);
    /// The selection into the leading group.
    ADD_TO_GROUP =
        Entry::new("handle.add", "Add selection", "Hold the selected vertices with the group that was chosen last")
            .unless(none_chosen_or_selected)
            .does(Session::add_selection_to_active);
    /// The selection out of the active groups.
    REMOVE_FROM_GROUP =
        Entry::new("handle.remove", "Remove selection", "Let the selected vertices of the chosen groups go")
            .unless(none_chosen_or_selected)
            .does(Session::remove_selection_from_active);
    /// All parts of the gizmo.
    GIZMO_ALL = Entry::new("handle.gizmo-all", "All", "Arrows, squares, rings and knobs at the chosen handle")
        .within("Gizmo")
        .apart()
        .on(|session| session.options.gizmo.shown == GizmoShown::All)
        .does(|session| show(session, GizmoShown::All));
    /// Only what moves.
    GIZMO_MOVE = Entry::new("handle.gizmo-move", "Move", "Arrows and squares only; once more shows all")
        .key(Modifiers::SHIFT, Key::G)
        .within("Gizmo")
        .on(|session| session.options.gizmo.shown == GizmoShown::Move)
        .does(|session| show(session, GizmoShown::Move));
    /// Only what turns.
    GIZMO_TURN = Entry::new("handle.gizmo-turn", "Turn", "Rings only; once more shows all")
        .key(Modifiers::SHIFT, Key::R)
        .within("Gizmo")
        .on(|session| session.options.gizmo.shown == GizmoShown::Turn)
        .does(|session| show(session, GizmoShown::Turn));
    /// Only what scales.
    GIZMO_SCALE = Entry::new("handle.gizmo-scale", "Scale", "Knobs only; once more shows all")
        .key(Modifiers::SHIFT, Key::S)
        .within("Gizmo")
        .on(|session| session.options.gizmo.shown == GizmoShown::Scale)
        .does(|session| show(session, GizmoShown::Scale));
    /// A point of the surface becomes the pivot.
    PICK_PIVOT = Entry::new(
        "handle.pivot",
        "Pick pivot",
        "Turn and scale about the point of the surface under the pointer, or under the next click",
    )
    .key(NONE, Key::V)
    .unless(not_handle_tool)
    .does(|session| session.input(Input::Key(ToolKey::Pivot)));
}

fn no_groups(session: &Session) -> Option<&'static str> {
    session.document()?.scene().groups.is_empty().then_some("There are no handles or anchors yet")
}

fn none_chosen(session: &Session) -> Option<&'static str> {
    session.document()?.scene().active.is_empty().then_some("Choose a handle or anchor first: click it")
}

fn not_two_chosen(session: &Session) -> Option<&'static str> {
    let few = session.document()?.scene().active.len() < 2;
    few.then_some("Choose two handles or anchors at least: Shift+click them")
}

fn none_chosen_or_selected(session: &Session) -> Option<&'static str> {
    none_chosen(session).or_else(|| nothing_selected(session))
}

fn not_handle_tool(session: &Session) -> Option<&'static str> {
    (session.tool_kind() != ToolKind::Handle).then_some("Take the handle tool first (H)")
}

/// What is shown already gives way to all parts.
fn show(session: &mut Session, shown: GizmoShown) {
    let settings = &mut session.options.gizmo;
    settings.shown = if settings.shown == shown { GizmoShown::All } else { shown };
}
