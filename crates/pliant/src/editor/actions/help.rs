//! The menu *Help*.

use egui::Key;

use super::actions;
use super::entry::{CTRL_SHIFT, Entry, NONE};
use crate::editor::{EditorApp, Session};

actions! {
    /// The palette.
    PALETTE = Entry::new("help.palette", "Find an action…", "Find anything Pliant can do by a few letters of its name")
        .key(CTRL_SHIFT, Key::P)
        .anytime()
        .window(EditorApp::show_palette);
    /// The sheet of keys.
    KEYS = Entry::new("help.keys", "Keys and mouse…", "Show all keys and what the mouse does; keys can be changed there")
        .key(NONE, Key::F1)
        .key(NONE, Key::Questionmark)
        .anytime()
        .window(EditorApp::show_keys);
    /// What r means.
    WHAT_IS_RIGIDITY =
        Entry::new("help.rigidity", "What rigidity means…", "The same pull on the same bar, with rigidity 1, 2, 6 and 20")
            .anytime()
            .apart()
            .window(EditorApp::show_what_rigidity_is);
    /// The first hints again.
    SHOW_HINTS = Entry::new("help.hints", "Show hints again", "The first steps: pull, paint, take back")
        .does(Session::show_hints);
    /// Version and license.
    ABOUT = Entry::new("help.about", "About Pliant", "Version, license and what it is built with")
        .anytime()
        .apart()
        .window(EditorApp::show_about);
}
