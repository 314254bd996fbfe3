//! Everything that can be done by name, in one table: menus, keys, the palette and buttons all read it.
//!
//! A file of this folder is a menu, and the order of its entries is the order in the menu. Adding an action is one entry
//! in the file of its menu: `DOUBLE = Entry::new("pose.double", "Double", "Pull twice as far").key(NONE, Key::D).does(…)`
//! makes `Action::DOUBLE`, shows it in the menu *Pose*, on the sheet of keys and in the palette.

mod edit;
mod entry;
mod file;
mod handle;
mod help;
mod pose;
mod rigidity;
mod select;
mod view;

use std::fmt;
use std::hash::{Hash, Hasher};

use egui::KeyboardShortcut;

use super::Session;
use crate::tools::ToolKind;
use entry::{Does, Entry};

/// Makes an associated constant of `Action` from each entry, and `ALL` of a file's entries.
macro_rules! actions {
    ($($(#[$doc:meta])+ $name:ident = $entry:expr;)+) => {
        impl crate::editor::Action {
            $($(#[$doc])+ pub const $name: crate::editor::Action = crate::editor::Action { entry: const { &$entry } };)+
        }
        /// Every entry of this file, in order.
        pub(super) const ALL: &[crate::editor::Action] = &[$(crate::editor::Action::$name),+];
    };
}
use actions;

/// A thing to do without further input: a reference to its entry in the table.
#[derive(Clone, Copy)]
pub struct Action {
    entry: &'static Entry,
}

/// A menu and what is in it, in order.
#[derive(Clone, Copy, Debug)]
pub struct Menu {
    /// Its name in the menu bar.
    pub name: &'static str,
    /// What it holds.
    pub actions: &'static [Action],
}

impl Action {
    /// The menus, in the order of the menu bar: together they are the table.
    pub const MENUS: &[Menu] = &[
        Menu { name: "File", actions: file::ALL },
        Menu { name: "Edit", actions: edit::ALL },
        Menu { name: "Select", actions: select::ALL },
        Menu { name: "Handle", actions: handle::ALL },
        Menu { name: "Rigidity", actions: rigidity::ALL },
        Menu { name: "Pose", actions: pose::ALL },
        Menu { name: "View", actions: view::ALL },
        Menu { name: "Help", actions: help::ALL },
    ];

    /// Every action, menu by menu.
    pub fn all() -> impl Iterator<Item = Action> {
        Action::MENUS.iter().flat_map(|menu| menu.actions.iter().copied())
    }

    /// The action of this id, if there is one.
    pub fn named(id: &str) -> Option<Action> {
        Action::all().find(|action| action.id() == id)
    }

    /// The action that takes this tool in hand.
    pub fn of_tool(kind: ToolKind) -> Option<Action> {
        Action::all().find(|action| matches!(action.entry.does, Does::Tool(tool) if tool == kind))
    }

    /// What stored shortcuts call it: never changes once released.
    pub fn id(self) -> &'static str {
        self.entry.id
    }

    /// Name in menus and on the sheet of keys.
    pub fn label(self) -> &'static str {
        self.entry.label
    }

    /// Where it stands: menu, submenu and label.
    pub fn full_name(self) -> String {
        let menu = Action::MENUS.iter().find(|menu| menu.actions.contains(&self)).map_or("", |menu| menu.name);
        match self.submenu() {
            Some(submenu) => format!("{menu} › {submenu} › {}", self.label()),
            None => format!("{menu} › {}", self.label()),
        }
    }

    /// The label outside of its menu: with its submenu, if it stands in one.
    pub fn long_label(self) -> String {
        match self.submenu() {
            Some(submenu) => format!("{submenu}: {}", self.label()),
            None => self.label().to_owned(),
        }
    }

    /// The label as it reads now: 'Undo paint' rather than 'Undo'.
    pub fn title(self, session: &Session) -> String {
        self.entry.title.and_then(|title| title(session)).unwrap_or_else(|| self.label().to_owned())
    }

    /// One sentence more than the label.
    pub fn tooltip(self) -> &'static str {
        self.entry.tooltip
    }

    /// The keys it comes with; the first is shown in menus. What the user chose instead is in `Shortcuts`.
    pub fn default_keys(self) -> impl Iterator<Item = KeyboardShortcut> {
        self.entry.keys.into_iter().flatten()
    }

    /// Why it cannot be done now, if it cannot.
    pub fn obstacle(self, session: &Session) -> Option<&'static str> {
        if self.entry.needs_mesh && session.document().is_none() {
            return Some("Open a mesh first");
        }
        (self.entry.obstacle)(session)
    }

    /// For what is either on or off: whether it is on.
    pub fn is_on(self, session: &Session) -> Option<bool> {
        self.entry.is_on.map(|is_on| is_on(session))
    }

    /// The menu within its menu in which it stands, if any.
    pub fn submenu(self) -> Option<&'static str> {
        self.entry.submenu
    }

    /// Whether a line sets it apart from what stands above.
    pub fn begins_part(self) -> bool {
        self.entry.begins_part
    }

    /// Does it, unless something is in the way, which the hint line says then, or it needs the window. Returns whether
    /// it was done.
    pub fn perform_in(self, session: &mut Session) -> bool {
        if let Some(why) = self.obstacle(session) {
            session.refuse(self, why);
            return false;
        }
        match self.entry.does {
            Does::Session(act) => act(session),
            Does::Look(change) => {
                let mut look = session.look.clone();
                change(&mut look);
                session.set_look(look);
            }
            Does::Tool(kind) => session.take_tool(kind),
            Does::Window(_) => return false,
        }
        true
    }

    /// Does it, unless something is in the way.
    pub(super) fn perform(self, app: &mut super::EditorApp, ctx: &egui::Context) {
        match self.entry.does {
            Does::Window(act) if self.obstacle(app.session()).is_none() => act(app, ctx),
            _ => {
                self.perform_in(app.session());
            }
        }
    }
}

impl fmt::Debug for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

impl PartialEq for Action {
    fn eq(&self, other: &Action) -> bool {
        self.id() == other.id()
    }
}

impl Eq for Action {}

impl Hash for Action {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.id().hash(state);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_action_has_an_id_of_its_own_and_words_to_show() {
        let all: Vec<Action> = Action::all().collect();
        for (k, action) in all.iter().enumerate() {
            let twin = all[..k].iter().find(|other| other.id() == action.id());
            assert!(twin.is_none(), "two actions are called {}", action.id());
            assert!(!action.label().is_empty() && !action.tooltip().is_empty(), "{action:?} has no words");
            assert!(!action.tooltip().ends_with('.'), "the tooltip of {action:?} ends with a period");
            assert_eq!(Action::named(action.id()), Some(*action));
        }
    }

    #[test]
    fn no_two_actions_come_with_the_same_key() {
        let mut seen: Vec<(KeyboardShortcut, Action)> = Vec::new();
        for action in Action::all() {
            for key in action.default_keys() {
                let owner = seen.iter().find(|(taken, _)| *taken == key).map(|(_, owner)| *owner);
                assert_eq!(owner, None, "{action:?} comes with a key that is taken: {key:?}");
                seen.push((key, action));
            }
        }
    }
}
