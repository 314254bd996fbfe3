//! Everything that can be done from menus and keys, once: label, tooltip, shortcut, and what it does.

use egui::{Key, KeyboardShortcut, Modifiers};

use super::{Look, Sample, Session};
use crate::document::{Command, GroupKind};
use crate::tools::{Input, Options, ToolKey, ToolKind};
use crate::viewport::{Axis, Projection, Shading, Theme};

/// A thing to do without further input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Shows the open dialog.
    Open,
    /// Opens a mesh of the program's own.
    OpenSample(Sample),
    /// Reads the file again.
    Reopen,
    /// Writes to where it was last written, or asks.
    Save,
    /// Asks where to write.
    SaveAs,
    /// Closes the window.
    Quit,
    /// Takes back a step.
    Undo,
    /// Makes it again.
    Redo,
    /// Selects everything.
    SelectAll,
    /// Selects nothing.
    SelectNone,
    /// Handle from the selection.
    HandleFromSelection,
    /// Anchor from the selection.
    AnchorFromSelection,
    /// Anchors what is not selected.
    HoldEverythingElse,
    /// Current r for the selection.
    FillSelection,
    /// Current r everywhere.
    FillAll,
    /// The panel in which rigidity is learned.
    LearnRigidity,
    /// Removes the active or hovered group.
    DeleteHandle,
    /// Everything back to rest.
    ResetPose,
    /// Takes a tool in hand.
    Tool(ToolKind),
    /// A smaller brush.
    BrushSmaller,
    /// A larger brush.
    BrushLarger,
    /// Takes over the r under the pointer.
    Eyedropper,
    /// Fits selection or surface into the viewport.
    Frame,
    /// Looks along an axis.
    LookFrom(Axis),
    /// Perspective or orthographic.
    ToggleProjection,
    /// Edges over the surface.
    ToggleWireframe,
    /// Smooth or flat.
    ToggleShading,
    /// Dark or light.
    ToggleTheme,
    /// The sheet of keys.
    Keys,
}

/// What only the window can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WindowAction {
    /// Show the open dialog.
    Open,
    /// Open a sample, unless changes would be lost.
    OpenSample(Sample),
    /// Open the same file again, unless changes would be lost.
    Reopen,
    /// Show the save dialog.
    SaveAs,
    /// Write to the known path.
    Save,
    /// Close.
    Quit,
    /// Show the sheet of keys.
    Keys,
}

impl Action {
    /// Every action, in the order of the sheet of keys.
    pub const ALL: &[Action] = &[
        Action::Open,
        Action::Reopen,
        Action::Save,
        Action::SaveAs,
        Action::Quit,
        Action::Undo,
        Action::Redo,
        Action::Tool(ToolKind::Handle),
        Action::Tool(ToolKind::Anchor),
        Action::Tool(ToolKind::Select),
        Action::Tool(ToolKind::Brush),
        Action::Tool(ToolKind::Fill),
        Action::DeleteHandle,
        Action::ResetPose,
        Action::SelectAll,
        Action::SelectNone,
        Action::HandleFromSelection,
        Action::AnchorFromSelection,
        Action::HoldEverythingElse,
        Action::FillSelection,
        Action::FillAll,
        Action::LearnRigidity,
        Action::BrushSmaller,
        Action::BrushLarger,
        Action::Eyedropper,
        Action::Frame,
        Action::LookFrom(Axis::Front),
        Action::LookFrom(Axis::Back),
        Action::LookFrom(Axis::Right),
        Action::LookFrom(Axis::Left),
        Action::LookFrom(Axis::Top),
        Action::LookFrom(Axis::Bottom),
        Action::ToggleProjection,
        Action::ToggleWireframe,
        Action::ToggleShading,
        Action::ToggleTheme,
        Action::Keys,
    ];

    /// Name in menus and on the sheet of keys.
    pub fn label(self) -> &'static str {
        match self {
            Action::Open => "Open…",
            Action::OpenSample(sample) => sample.name(),
            Action::Reopen => "Reopen",
            Action::Save => "Save",
            Action::SaveAs => "Save as…",
            Action::Quit => "Quit",
            Action::Undo => "Undo",
            Action::Redo => "Redo",
            Action::SelectAll => "Select all",
            Action::SelectNone => "Select none",
            Action::HandleFromSelection => "Handle from selection",
            Action::AnchorFromSelection => "Anchor from selection",
            Action::HoldEverythingElse => "Hold everything else",
            Action::FillSelection => "Fill selection",
            Action::FillAll => "Set rigidity everywhere",
            Action::LearnRigidity => "Learn rigidity from poses…",
            Action::DeleteHandle => "Delete handle",
            Action::ResetPose => "Reset pose",
            Action::Tool(kind) => kind.label(),
            Action::BrushSmaller => "Smaller brush",
            Action::BrushLarger => "Larger brush",
            Action::Eyedropper => "Take rigidity under pointer",
            Action::Frame => "Frame selection or all",
            Action::LookFrom(Axis::Front) => "Front view",
            Action::LookFrom(Axis::Back) => "Back view",
            Action::LookFrom(Axis::Right) => "Right view",
            Action::LookFrom(Axis::Left) => "Left view",
            Action::LookFrom(Axis::Top) => "Top view",
            Action::LookFrom(Axis::Bottom) => "Bottom view",
            Action::ToggleProjection => "Perspective / orthographic",
            Action::ToggleWireframe => "Wireframe",
            Action::ToggleShading => "Smooth / flat shading",
            Action::ToggleTheme => "Dark / light theme",
            Action::Keys => "Keys and mouse",
        }
    }

    /// One sentence more than the label.
    pub fn tooltip(self) -> &'static str {
        match self {
            Action::Open => "Open a mesh: OBJ, glTF, GLB, PLY, STL or OFF. A file dropped on the window opens too",
            Action::OpenSample(_) => "A mesh that comes with Pliant",
            Action::Reopen => "Read the file again, as it is now, with the welding that is chosen",
            Action::Save => "Write the bent mesh to where it was last saved",
            Action::SaveAs => "Write the bent mesh, with everything else the file held",
            Action::Quit => "Close the window",
            Action::Undo => "Take back the last step",
            Action::Redo => "Make the undone step again",
            Action::SelectAll => "Select every vertex",
            Action::SelectNone => "Empty the selection",
            Action::HandleFromSelection => "Move the selected vertices together",
            Action::AnchorFromSelection => "Hold the selected vertices where they are",
            Action::HoldEverythingElse => "Anchor all that is not selected: only the selection bends",
            Action::FillSelection => "Give the selected vertices the current rigidity",
            Action::FillAll => "Give every vertex the current rigidity",
            Action::LearnRigidity => "Find out from a few poses where the mesh is stiff and where it bends",
            Action::DeleteHandle => "Let go of the handle or anchor under the pointer, or of the active one",
            Action::ResetPose => "Put all handles and the surface back to rest",
            Action::Tool(kind) => kind.description(),
            Action::BrushSmaller => "Make the brush smaller",
            Action::BrushLarger => "Make the brush larger",
            Action::Eyedropper => "Paint with the rigidity that is under the pointer",
            Action::Frame => "Bring the selection, or else the whole surface, into view",
            Action::LookFrom(_) => "Look along an axis",
            Action::ToggleProjection => "With or without vanishing points",
            Action::ToggleWireframe => "Show the edges of the mesh",
            Action::ToggleShading => "Show smooth shading or single faces",
            Action::ToggleTheme => "Switch between the dark and the light window",
            Action::Keys => "Show all keys and what the mouse does",
        }
    }

    /// Its key, if it has one.
    pub fn shortcut(self) -> Option<KeyboardShortcut> {
        let plain = |key| Some(KeyboardShortcut::new(Modifiers::NONE, key));
        let command = |key| Some(KeyboardShortcut::new(Modifiers::COMMAND, key));
        let command_shift = |key| Some(KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::SHIFT, key));
        match self {
            Action::Open => command(Key::O),
            Action::Save => command(Key::S),
            Action::SaveAs => command_shift(Key::S),
            Action::Quit => command(Key::Q),
            Action::Undo => command(Key::Z),
            Action::Redo => command_shift(Key::Z),
            Action::SelectAll => command(Key::A),
            Action::SelectNone => command_shift(Key::A),
            Action::HandleFromSelection => command(Key::H),
            Action::AnchorFromSelection => command_shift(Key::H),
            Action::OpenSample(_) | Action::Reopen | Action::HoldEverythingElse => None,
            Action::FillSelection => command(Key::F),
            Action::FillAll => None,
            Action::LearnRigidity => command(Key::L),
            Action::DeleteHandle => plain(Key::Delete),
            Action::ResetPose => command(Key::R),
            Action::Tool(ToolKind::Handle) => plain(Key::H),
            Action::Tool(ToolKind::Anchor) => plain(Key::A),
            Action::Tool(ToolKind::Select) => plain(Key::S),
            Action::Tool(ToolKind::Brush) => plain(Key::B),
            Action::Tool(ToolKind::Fill) => plain(Key::G),
            Action::BrushSmaller => plain(Key::OpenBracket),
            Action::BrushLarger => plain(Key::CloseBracket),
            Action::Eyedropper => plain(Key::I),
            Action::Frame => plain(Key::Period),
            Action::LookFrom(_) => None,
            Action::ToggleProjection => plain(Key::P),
            Action::ToggleWireframe => plain(Key::W),
            Action::ToggleShading => plain(Key::N),
            Action::ToggleTheme => None,
            Action::Keys => plain(Key::F1),
        }
    }

    /// Why it cannot be done now, if it cannot.
    pub fn obstacle(self, session: &Session) -> Option<&'static str> {
        let Some(document) = session.document() else {
            let needs_none = matches!(
                self,
                Action::Open
                    | Action::OpenSample(_)
                    | Action::Quit
                    | Action::Tool(_)
                    | Action::ToggleTheme
                    | Action::Keys
            );
            return (!needs_none).then_some("Open a mesh first");
        };
        let scene = document.scene();
        match self {
            Action::Reopen if document.model().file.path.is_none() => Some("This mesh comes from no file"),
            Action::Undo if document.history().is_empty() && !document.in_step() => Some("There is nothing to undo"),
            Action::Redo if document.history().redo_name().is_none() => Some("There is nothing to redo"),
            Action::SelectNone
            | Action::HandleFromSelection
            | Action::AnchorFromSelection
            | Action::HoldEverythingElse
            | Action::FillSelection
                if scene.selection.is_empty() =>
            {
                Some("Select some vertices first (S, then drag a box)")
            }
            Action::DeleteHandle
                if scene.active.is_none() && !matches!(session.tool_kind(), ToolKind::Handle | ToolKind::Anchor) =>
            {
                Some("Choose a handle in the list first")
            }
            Action::Eyedropper if !matches!(session.tool_kind(), ToolKind::Brush | ToolKind::Fill) => {
                Some("Take the brush or the fill tool first")
            }
            _ => None,
        }
    }

    /// Does it, or says what the window has to do.
    pub(super) fn perform(self, session: &mut Session) -> Option<WindowAction> {
        if self.obstacle(session).is_some() {
            return None;
        }
        match self {
            Action::Open => return Some(WindowAction::Open),
            Action::OpenSample(sample) => return Some(WindowAction::OpenSample(sample)),
            Action::Reopen => return Some(WindowAction::Reopen),
            Action::Save => return Some(WindowAction::Save),
            Action::SaveAs => return Some(WindowAction::SaveAs),
            Action::Quit => return Some(WindowAction::Quit),
            Action::Keys => return Some(WindowAction::Keys),
            Action::Undo => session.undo(),
            Action::Redo => session.redo(),
            Action::SelectAll => session.select_all(true),
            Action::SelectNone => session.select_all(false),
            Action::HandleFromSelection => session.hold_selection(GroupKind::Handle),
            Action::AnchorFromSelection => session.hold_selection(GroupKind::Anchor),
            Action::HoldEverythingElse => session.hold_everything_else(),
            Action::FillSelection => session.fill_selection(),
            Action::FillAll => session.apply(Command::FillAll(session.options.rigidity)),
            Action::LearnRigidity => session.open_learning(),
            Action::DeleteHandle => delete_handle(session),
            Action::ResetPose => session.apply(Command::ResetPose),
            Action::Tool(kind) => session.take_tool(kind),
            Action::BrushSmaller => scale_brush(session, 1.0 / 1.2),
            Action::BrushLarger => scale_brush(session, 1.2),
            Action::Eyedropper => session.input(Input::Key(ToolKey::Eyedropper)),
            Action::Frame => session.frame(),
            Action::LookFrom(axis) => look_from(session, axis),
            Action::ToggleProjection => toggle_projection(session),
            Action::ToggleWireframe => change_look(session, |look| look.wireframe = !look.wireframe),
            Action::ToggleShading => change_look(session, |look| {
                look.shading = if look.shading == Shading::Smooth { Shading::Flat } else { Shading::Smooth };
            }),
            Action::ToggleTheme => change_look(session, |look| {
                look.theme = if look.theme == Theme::Dark { Theme::Light } else { Theme::Dark };
            }),
        }
        None
    }
}

fn change_look(session: &mut Session, change: impl FnOnce(&mut Look)) {
    let mut look = session.look.clone();
    change(&mut look);
    session.set_look(look);
}

/// The handle tools know what is under the pointer; with another tool in hand the active group goes.
fn delete_handle(session: &mut Session) {
    if matches!(session.tool_kind(), ToolKind::Handle | ToolKind::Anchor) {
        session.input(Input::Key(ToolKey::Delete));
    } else if let Some(id) = session.document().and_then(|document| document.scene().active) {
        session.apply(Command::Release(vec![id]));
    }
}

fn scale_brush(session: &mut Session, factor: f32) {
    let range = Options::BRUSH_RADIUS_PX;
    let radius = session.options.brush_radius_px * factor;
    session.options.brush_radius_px = radius.clamp(*range.start(), *range.end());
}

fn look_from(session: &mut Session, axis: Axis) {
    if let Some(open) = session.open_mut() {
        open.camera.look_along(axis);
    }
}

fn toggle_projection(session: &mut Session) {
    if let Some(open) = session.open_mut() {
        open.camera.projection = match open.camera.projection {
            Projection::Perspective => Projection::Orthographic,
            Projection::Orthographic => Projection::Perspective,
        };
    }
}
