//! The menu *Help*.

use egui::Key;

use super::actions;
use super::entry::{Entry, NONE};
use crate::editor::EditorApp;

actions! {
    /// The sheet of keys.
    KEYS = Entry::new("help.keys", "Keys and mouse", "Show all keys and what the mouse does")
        .key(NONE, Key::F1)
        .key(NONE, Key::Questionmark)
        .anytime()
        .window(EditorApp::show_keys);
}
