//! Which keys do which action: those of the table, unless the user chose others.

use std::collections::BTreeMap;

use egui::{Context, Event, Key, KeyboardShortcut, Modifiers};

use super::Action;

/// The keys of all actions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shortcuts {
    /// By id of the action; an empty list is 'no key'.
    changed: BTreeMap<String, Vec<KeyboardShortcut>>,
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
    pub(super) fn take(&self, ctx: &Context, may_take: impl Fn(Key) -> bool) -> Vec<Action> {
        let mut taken = Vec::new();
        ctx.input_mut(|input| {
            input.events.retain(|event| {
                let &Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
                let action = may_take(key).then(|| self.action_for(key, modifiers)).flatten();
                taken.extend(action);
                action.is_none()
            });
        });
        taken
    }
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
}
