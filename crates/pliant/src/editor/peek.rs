//! The key that shows the rest shape: a tap leaves it shown, while it is held it is a short look.

use egui::{Context, Event, Key};

use super::{Action, Session};

/// A key that is held for longer than this is not a tap (by hand: taps take a third of it).
const TAP_SECS: f64 = 0.3;

/// The key under way.
#[derive(Default)]
pub(super) struct Peek {
    /// Which key showed the rest shape, and when.
    held: Option<(Key, f64)>,
}

impl Peek {
    /// Takes the presses and releases of the key out of this frame's events.
    pub(super) fn take(&mut self, ctx: &Context, session: &mut Session) {
        ctx.input_mut(|input| {
            let now = input.time;
            input.events.retain(|event| match *event {
                Event::Key { key, pressed: true, repeat, modifiers, .. }
                    if session.habits.shortcuts.action_for(key, modifiers) == Some(Action::TOGGLE_REST) =>
                {
                    if !repeat && Action::TOGGLE_REST.perform_in(session) {
                        self.held = session.shows_rest().then_some((key, now));
                    }
                    false
                }
                Event::Key { key, pressed: false, .. } => {
                    let since = self.held.filter(|(held, _)| *held == key).map(|(_, since)| since);
                    if since.is_some() {
                        self.held = None;
                    }
                    if since.is_some_and(|since| now - since > TAP_SECS) && session.shows_rest() {
                        session.toggle_rest();
                    }
                    true
                }
                _ => true,
            });
        });
    }
}
