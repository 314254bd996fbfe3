//! Which keys do which action: those of the table, unless the user chose others.

mod text;

use std::collections::BTreeMap;

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers};
use serde::{Deserialize, Serialize};

use super::Action;

/// Keys that cannot be given to an action, and why.
const KEPT: [(Key, &str); 4] = [
    (Key::Escape, "Esc takes back and closes, always"),
    (Key::Tab, "Tab goes from one control to the next"),
    (Key::Enter, "Enter presses the control that has the focus"),
    (Key::F, "F, held, sizes the brush"),
];

/// The keys of all actions.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Texts", into = "Texts")]
pub struct Shortcuts {
    /// By id of the action; an empty list is 'no key'.
    changed: BTreeMap<String, Vec<KeyboardShortcut>>,
}

/// What the user changed, as it is stored: id of the action, and its keys.
type Texts = BTreeMap<String, Vec<String>>;

impl From<Shortcuts> for Texts {
    fn from(shortcuts: Shortcuts) -> Texts {
        shortcuts.changed.into_iter().map(|(id, keys)| (id, keys.iter().map(text::of).collect())).collect()
    }
}

/// Keys that are not understood are left out; actions that are not known are kept, for another version may know them.
impl From<Texts> for Shortcuts {
    fn from(texts: Texts) -> Shortcuts {
        let keys = |texts: Vec<String>| texts.iter().filter_map(|text| text::parse(text)).collect();
        Shortcuts { changed: texts.into_iter().map(|(id, texts)| (id, keys(texts))).collect() }
    }
}

impl Shortcuts {
    /// The keys of an action now.
    pub fn of(&self, action: Action) -> Vec<KeyboardShortcut> {
        self.changed.get(action.id()).cloned().unwrap_or_else(|| action.default_keys().collect())
    }

    /// The key that menus and tooltips name, as text; empty if there is none.
    pub fn text(&self, action: Action, ctx: &Context) -> String {
        let first = match self.changed.get(action.id()) {
            Some(keys) => keys.first().copied(),
            None => action.default_keys().next(),
        };
        first.map(|key| ctx.format_shortcut(&key)).unwrap_or_default()
    }

    /// Whether the user chose the keys of this action.
    pub fn is_changed(&self, action: Action) -> bool {
        self.changed.contains_key(action.id())
    }

    /// Whether the user chose any keys.
    pub fn is_any_changed(&self) -> bool {
        !self.changed.is_empty()
    }

    /// Why these keys cannot be given to an action, if they cannot.
    pub fn refusal(key: KeyboardShortcut) -> Option<&'static str> {
        if !key.modifiers.is_none() && !matches!(key.logical_key, Key::Escape | Key::Tab) {
            return None;
        }
        if is_digit(key.logical_key) {
            return Some("Digits choose the current rigidity");
        }
        KEPT.iter().find(|(kept, _)| *kept == key.logical_key).map(|(_, why)| *why)
    }

    /// Which other action these keys do now.
    pub fn owner(&self, key: KeyboardShortcut, other_than: Action) -> Option<Action> {
        Action::all().find(|action| *action != other_than && self.of(*action).contains(&key))
    }

    /// Gives these keys to an action in place of those it had, and takes them from any other.
    pub fn assign(&mut self, action: Action, key: KeyboardShortcut) {
        self.take_from_others(action, key);
        self.set(action, vec![key]);
    }

    /// Leaves an action without keys.
    pub fn clear(&mut self, action: Action) {
        self.set(action, Vec::new());
    }

    /// Gives an action its first keys again, and takes them from whichever has them now.
    pub fn reset(&mut self, action: Action) {
        self.changed.remove(action.id());
        for key in action.default_keys() {
            self.take_from_others(action, key);
        }
    }

    /// All actions have the keys of the table again.
    pub fn reset_all(&mut self) {
        self.changed.clear();
    }

    fn take_from_others(&mut self, action: Action, key: KeyboardShortcut) {
        while let Some(owner) = self.owner(key, action) {
            let left = self.of(owner).into_iter().filter(|owned| *owned != key).collect();
            self.set(owner, left);
        }
    }

    fn set(&mut self, action: Action, keys: Vec<KeyboardShortcut>) {
        if action.default_keys().eq(keys.iter().copied()) {
            self.changed.remove(action.id());
        } else {
            self.changed.insert(action.id().to_owned(), keys);
        }
    }

    /// What these keys do: an exact match before one that leaves out Shift or Alt, which some keyboards need for a sign.
    pub fn action_for(&self, key: Key, modifiers: Modifiers) -> Option<Action> {
        let with_key = || {
            let keys = |action| self.of(action).into_iter().filter(move |shortcut| shortcut.logical_key == key);
            Action::all().flat_map(move |action| keys(action).map(move |shortcut| (action, shortcut)))
        };
        with_key()
            .find(|(_, shortcut)| modifiers.matches_exact(shortcut.modifiers))
            .or_else(|| {
                with_key().find(|(_, shortcut)| is_sign(key) && modifiers.matches_logically(shortcut.modifiers))
            })
            .map(|(action, _)| action)
    }

    /// Takes the key presses of this frame that do something; returns what they do, in their order.
    pub(super) fn take(&self, ctx: &Context, may_take: impl Fn(Key, Modifiers) -> bool) -> Vec<Action> {
        let mut taken = Vec::new();
        ctx.input_mut(|input| {
            input.events.retain(|event| {
                let &Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
                let action = may_take(key, modifiers).then(|| self.action_for(key, modifiers)).flatten();
                taken.extend(action);
                action.is_none()
            });
        });
        taken
    }
}

fn is_digit(key: Key) -> bool {
    key.name().len() == 1 && key.name().as_bytes()[0].is_ascii_digit()
}

/// What was pressed, as a shortcut: Command where the platform has it or Ctrl stands for it.
pub(super) fn pressed(key: Key, modifiers: Modifiers) -> KeyboardShortcut {
    let (alt, shift) = (modifiers.alt, modifiers.shift);
    let base = if modifiers.command {
        Modifiers::COMMAND
    } else if modifiers.ctrl {
        Modifiers::CTRL
    } else {
        Modifiers::NONE
    };
    // A sign is what it is, whichever keys make it.
    let shift = shift && !is_sign(key);
    KeyboardShortcut::new(Modifiers { alt, shift, ..base }, key)
}

/// Whether the key is a sign that another keyboard may have elsewhere, behind Shift or Alt.
fn is_sign(key: Key) -> bool {
    !key.symbol_or_name().chars().next().is_some_and(char::is_alphanumeric)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longer_of_two_shortcuts_with_one_key_wins_and_foreign_modifiers_do_nothing() {
        let shortcuts = Shortcuts::default();
        let shift = Modifiers::COMMAND | Modifiers::SHIFT;
        for (key, modifiers, expected) in [
            (Key::Z, Modifiers::COMMAND, Some(Action::UNDO)),
            (Key::Z, shift, Some(Action::REDO)),
            (Key::Y, Modifiers::COMMAND, Some(Action::REDO)),
            (Key::S, Modifiers::NONE, Some(Action::TOOL_SELECT)),
            (Key::S, Modifiers::COMMAND, Some(Action::SAVE)),
            (Key::S, shift, Some(Action::SAVE_AS)),
            (Key::S, Modifiers::ALT, None),
            (Key::B, Modifiers::SHIFT, None),
            // On a German keyboard these need Shift and AltGr.
            (Key::Questionmark, Modifiers::SHIFT, Some(Action::KEYS)),
            (Key::OpenBracket, Modifiers::ALT, Some(Action::BRUSH_SMALLER)),
            (Key::Home, Modifiers::NONE, Some(Action::FRAME)),
        ] {
            assert_eq!(shortcuts.action_for(key, modifiers), expected, "{modifiers:?} {key:?}");
        }
    }

    fn ctrl(key: Key) -> KeyboardShortcut {
        KeyboardShortcut::new(Modifiers::COMMAND, key)
    }

    #[test]
    fn keys_given_to_an_action_are_taken_from_the_one_that_had_them_and_reset_gives_them_back() {
        let mut shortcuts = Shortcuts::default();
        shortcuts.assign(Action::SELECT_ALL, ctrl(Key::Y));
        assert_eq!(shortcuts.action_for(Key::Y, Modifiers::COMMAND), Some(Action::SELECT_ALL));
        assert_eq!(shortcuts.action_for(Key::A, Modifiers::COMMAND), None);
        assert_eq!(shortcuts.of(Action::REDO).len(), 1, "redo kept a key that was taken");
        shortcuts.reset(Action::REDO);
        assert_eq!(shortcuts.action_for(Key::Y, Modifiers::COMMAND), Some(Action::REDO));
        assert!(shortcuts.of(Action::SELECT_ALL).is_empty());
        shortcuts.reset_all();
        assert_eq!(shortcuts, Shortcuts::default());
    }

    #[test]
    fn keys_that_the_window_needs_are_refused_with_a_reason() {
        for key in [Key::Escape, Key::Tab, Key::Enter, Key::F, Key::Num7] {
            assert!(Shortcuts::refusal(pressed(key, Modifiers::NONE)).is_some(), "{key:?} was not refused");
        }
        for allowed in [ctrl(Key::Num7), ctrl(Key::F), pressed(Key::Space, Modifiers::NONE)] {
            assert_eq!(Shortcuts::refusal(allowed), None);
        }
        for action in Action::all() {
            action.default_keys().for_each(|key| assert_eq!(Shortcuts::refusal(key), None, "{action:?}"));
        }
    }

    #[test]
    fn what_was_changed_is_the_same_after_it_was_written_and_read() {
        let mut shortcuts = Shortcuts::default();
        shortcuts.assign(Action::SAVE, pressed(Key::F5, Modifiers::ALT | Modifiers::SHIFT));
        shortcuts.assign(Action::FRAME, pressed(Key::Plus, Modifiers::COMMAND));
        shortcuts.clear(Action::QUIT);
        assert_eq!(Shortcuts::from(Texts::from(shortcuts.clone())), shortcuts);
    }
}
