//! What the table knows of an action, and the words to write an entry with.

use egui::{Key, KeyboardShortcut, Modifiers};

use crate::editor::{EditorApp, Look, Session};
use crate::tools::ToolKind;

/// No modifier.
pub(super) const NONE: Modifiers = Modifiers::NONE;
/// Ctrl, or Command on a Mac.
pub(super) const CTRL: Modifiers = Modifiers::COMMAND;
/// Shift.
pub(super) const SHIFT: Modifiers = Modifiers::SHIFT;
/// Alt, or Option on a Mac.
pub(super) const ALT: Modifiers = Modifiers::ALT;
/// Ctrl and Shift.
pub(super) const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

/// What happens.
#[derive(Clone, Copy)]
pub(in crate::editor) enum Does {
    /// Something to what is behind the window.
    Session(fn(&mut Session)),
    /// Something to the settings of the picture.
    Look(fn(&mut Look)),
    /// Takes a tool in hand.
    Tool(ToolKind),
    /// Something that only the window can do.
    Window(fn(&mut EditorApp, &egui::Context)),
}

/// An action in the table.
pub(in crate::editor) struct Entry {
    pub(super) id: &'static str,
    pub(super) label: &'static str,
    pub(super) tooltip: &'static str,
    pub(super) keys: [Option<KeyboardShortcut>; 2],
    pub(super) needs_mesh: bool,
    pub(super) obstacle: fn(&Session) -> Option<&'static str>,
    pub(super) title: Option<fn(&Session) -> Option<String>>,
    pub(super) is_on: Option<fn(&Session) -> bool>,
    pub(super) submenu: Option<&'static str>,
    pub(super) begins_part: bool,
    pub(super) does: Does,
}

impl Entry {
    /// Does nothing yet; can be done whenever a mesh is open; has no key.
    pub(super) const fn new(id: &'static str, label: &'static str, tooltip: &'static str) -> Entry {
        Entry {
            id,
            label,
            tooltip,
            keys: [None, None],
            needs_mesh: true,
            obstacle: |_| None,
            title: None,
            is_on: None,
            submenu: None,
            begins_part: false,
            does: Does::Session(|_| {}),
        }
    }

    /// A tool: its name and description, on while it is in hand.
    pub(super) const fn tool(id: &'static str, kind: ToolKind) -> Entry {
        let does = Does::Tool(kind);
        Entry { does, ..Entry::new(id, kind.label(), kind.description()).anytime().within("Tool") }
    }

    /// The key that menus show; said twice, the second is another way to the same.
    pub(super) const fn key(mut self, modifiers: Modifiers, key: Key) -> Entry {
        let slot = if self.keys[0].is_none() { 0 } else { 1 };
        assert!(self.keys[slot].is_none(), "an action comes with two keys at most");
        self.keys[slot] = Some(KeyboardShortcut::new(modifiers, key));
        self
    }

    /// It makes sense with nothing open.
    pub(super) const fn anytime(mut self) -> Entry {
        self.needs_mesh = false;
        self
    }

    /// Says why it cannot be done now, if it cannot. Asked only with a mesh open, unless it can be done anytime.
    pub(super) const fn unless(mut self, obstacle: fn(&Session) -> Option<&'static str>) -> Entry {
        self.obstacle = obstacle;
        self
    }

    /// A label that tells more, where there is more to tell.
    pub(super) const fn titled(mut self, title: fn(&Session) -> Option<String>) -> Entry {
        self.title = Some(title);
        self
    }

    /// It is either on or off.
    pub(super) const fn on(mut self, is_on: fn(&Session) -> bool) -> Entry {
        self.is_on = Some(is_on);
        self
    }

    /// Stands in a menu of this name within its menu.
    pub(super) const fn within(mut self, submenu: &'static str) -> Entry {
        self.submenu = Some(submenu);
        self
    }

    /// A line above it.
    pub(super) const fn apart(mut self) -> Entry {
        self.begins_part = true;
        self
    }

    /// What it does.
    pub(super) const fn does(mut self, act: fn(&mut Session)) -> Entry {
        self.does = Does::Session(act);
        self
    }

    /// How it changes the picture's settings.
    pub(super) const fn look(mut self, change: fn(&mut Look)) -> Entry {
        self.does = Does::Look(change);
        self
    }

    /// What it does where the window is needed.
    pub(super) const fn window(mut self, act: fn(&mut EditorApp, &egui::Context)) -> Entry {
        self.does = Does::Window(act);
        self
    }
}
