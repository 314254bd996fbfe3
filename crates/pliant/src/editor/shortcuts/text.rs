//! Shortcuts as text, for files: `Cmd+Shift+Z`. *Cmd* is Command on a Mac and Ctrl elsewhere; *Ctrl* is the key of that
//! name on a Mac.

use egui::{Key, KeyboardShortcut, Modifiers};

/// The text of a shortcut.
pub(super) fn of(shortcut: &KeyboardShortcut) -> String {
    let Modifiers { alt, ctrl, shift, command, .. } = shortcut.modifiers;
    let held = [(command, "Cmd+"), (ctrl && !command, "Ctrl+"), (alt, "Alt+"), (shift, "Shift+")];
    let held: String = held.into_iter().filter(|(is_held, _)| *is_held).map(|(_, name)| name).collect();
    held + shortcut.logical_key.name()
}

/// Reads it back; `None` for anything else.
pub(super) fn parse(text: &str) -> Option<KeyboardShortcut> {
    let mut modifiers = Modifiers::NONE;
    let mut rest = text;
    while let Some((name, after)) = rest.split_once('+').filter(|(_, after)| !after.is_empty()) {
        modifiers |= match name {
            "Cmd" => Modifiers::COMMAND,
            "Ctrl" => Modifiers::CTRL,
            "Alt" => Modifiers::ALT,
            "Shift" => Modifiers::SHIFT,
            _ => return None,
        };
        rest = after;
    }
    Some(KeyboardShortcut::new(modifiers, Key::from_name(rest)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_is_the_same_after_it_was_written_and_read() {
        let sets = [Modifiers::NONE, Modifiers::CTRL, Modifiers::COMMAND | Modifiers::SHIFT, Modifiers::ALT];
        for &key in Key::ALL {
            for modifiers in sets {
                let shortcut = KeyboardShortcut::new(modifiers, key);
                assert_eq!(parse(&of(&shortcut)), Some(shortcut), "{}", of(&shortcut));
            }
        }
    }

    #[test]
    fn what_is_no_shortcut_is_read_as_none() {
        for text in ["", "Hyper+A", "Cmd+", "Cmd+Nothing", "++++"] {
            assert_eq!(parse(text), None, "{text:?}");
        }
    }
}
