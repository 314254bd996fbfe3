//! The menu *Rigidity*.

use egui::Key;

use super::actions;
use super::entry::{CTRL, Entry, NONE};
use super::select::nothing_selected;
use crate::document::Command;
use crate::editor::Session;
use crate::tools::{Input, MirrorKind, ToolKey, ToolKind};

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
    /// The rigidity of the selection stays.
    LOCK_SELECTION = Entry::new(
        "rigidity.lock-selection",
        "Lock selection",
        "Keep the rigidity of the selected vertices, whatever is painted, filled or learned",
    )
    .within("Lock")
    .unless(nothing_selected)
    .does(|session| session.lock_selection(true));
    /// The rigidity of the selection may change again.
    UNLOCK_SELECTION =
        Entry::new("rigidity.unlock-selection", "Unlock selection", "Let the selected vertices be painted again")
            .within("Lock")
            .unless(nothing_selected_or_locked)
            .does(|session| session.lock_selection(false));
    /// What has the current r keeps it.
    LOCK_RIGIDITY = Entry::new(
        "rigidity.lock-current",
        "Lock current rigidity",
        "Keep the rigidity of all vertices that have the current one",
    )
    .within("Lock")
    .does(|session| session.lock_current_rigidity(true));
    /// What has the current r may change again.
    UNLOCK_RIGIDITY = Entry::new(
        "rigidity.unlock-current",
        "Unlock current rigidity",
        "Let all vertices that have the current rigidity be painted again",
    )
    .within("Lock")
    .unless(nothing_locked)
    .does(|session| session.lock_current_rigidity(false));
    /// No r changes.
    LOCK_ALL = Entry::new("rigidity.lock-all", "Lock all", "Keep the rigidity of every vertex")
        .within("Lock")
        .does(|session| session.lock_all(true));
    /// Every r may change.
    UNLOCK_ALL = Entry::new("rigidity.unlock-all", "Unlock all", "Let every vertex be painted again")
        .within("Lock")
        .unless(nothing_locked)
        .does(|session| session.lock_all(false));
    /// Painting on both sides, by places.
    MIRROR_PLANE = Entry::new(
        "rigidity.mirror-plane",
        "Mirror by plane",
        "Paint both sides of a plane at once: brush, fill and lock",
    )
    .within("Mirror")
    .on(|session| session.options.paint.mirror.kind == MirrorKind::Plane)
    .key(NONE, Key::M)
    .does(|session| toggle_mirror(session, MirrorKind::Plane));
    /// Painting on both sides, by how the mesh hangs together.
    MIRROR_TOPOLOGY = Entry::new(
        "rigidity.mirror-topology",
        "Mirror by mesh",
        "Paint both sides of a mesh that is symmetric in how it hangs together, in any pose",
    )
    .within("Mirror")
    .on(|session| session.options.paint.mirror.kind == MirrorKind::Topology)
    .does(|session| toggle_mirror(session, MirrorKind::Topology));
    /// From which edge the mesh is walked on both sides.
    TAKE_MIDDLE_EDGE = Entry::new(
        "rigidity.middle-edge",
        "Middle edge from selection",
        "Find the two sides of the mesh from the edge between the two selected vertices",
    )
    .within("Mirror")
    .unless(no_edge_selected)
    .does(Session::take_middle_edge);
    /// The middle edge is looked for again.
    FORGET_MIDDLE_EDGE = Entry::new(
        "rigidity.forget-middle-edge",
        "Look for the middle edge",
        "Find the two sides of the mesh from the edge that looks most like the middle",
    )
    .within("Mirror")
    .unless(no_middle_edge)
    .does(|session| session.options.paint.mirror.edge = None);
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
    .does(take_rigidity);
    /// A smaller brush.
    BRUSH_SMALLER = Entry::new("rigidity.brush-smaller", "Smaller brush", "Make the brush, or the patch of the next handle, smaller")
        .key(NONE, Key::OpenBracket)
        .does(|session| scale_brush(session, 1.0 / BRUSH_STEP));
    /// A larger brush.
    BRUSH_LARGER = Entry::new("rigidity.brush-larger", "Larger brush", "Make the brush, or the patch of the next handle, larger")
        .key(NONE, Key::CloseBracket)
        .does(|session| scale_brush(session, BRUSH_STEP));
}

fn take_rigidity(session: &mut Session) {
    if session.is_over_surface() {
        session.input(Input::Key(ToolKey::Eyedropper));
    } else {
        session.refuse(crate::editor::Action::EYEDROPPER, "Point at the surface first");
    }
}

fn toggle_mirror(session: &mut Session, kind: MirrorKind) {
    let now = &mut session.options.paint.mirror.kind;
    *now = if *now == kind { MirrorKind::Off } else { kind };
}

fn nothing_locked(session: &Session) -> Option<&'static str> {
    let is_empty = session.document().is_none_or(|document| document.scene().locked.is_empty());
    is_empty.then_some("Nothing is locked")
}

fn nothing_selected_or_locked(session: &Session) -> Option<&'static str> {
    nothing_locked(session).or_else(|| nothing_selected(session))
}

fn no_edge_selected(session: &Session) -> Option<&'static str> {
    session.selected_edge().is_none().then_some("Select exactly the two ends of an edge in the middle first")
}

fn no_middle_edge(session: &Session) -> Option<&'static str> {
    session.options.paint.mirror.edge.is_none().then_some("No edge was named: the likeliest one is looked for already")
}

fn no_painting_tool(session: &Session) -> Option<&'static str> {
    let paints = matches!(session.tool_kind(), ToolKind::Brush | ToolKind::Fill);
    (!paints).then_some("Take the brush or the fill tool first")
}

fn scale_brush(session: &mut Session, factor: f32) {
    if matches!(session.tool_kind(), ToolKind::Handle | ToolKind::Anchor) {
        session.resize_patch(if factor > 1.0 { 1 } else { -1 });
    } else {
        session.options.scale_brush(factor);
    }
}
