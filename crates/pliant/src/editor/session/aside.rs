//! A few words on the hint line for a moment: why a key just did nothing.

use std::time::{Duration, Instant};

use super::Session;
use crate::editor::Action;

/// How long they stay: time to look down and read a dozen words (by eye).
const STAYS: Duration = Duration::from_secs(5);

/// The words, and when they go.
pub(super) type Aside = Option<(String, Instant)>;

impl Session {
    /// What stands on the hint line in place of the hint, while it does.
    pub fn aside(&self) -> Option<&str> {
        self.aside.as_ref().map(|(text, _)| text.as_str())
    }

    /// Says something on the hint line for a moment.
    pub(in crate::editor) fn say(&mut self, text: impl Into<String>) {
        self.aside = Some((text.into(), Instant::now() + STAYS));
    }

    /// Says why an action that was asked for cannot be done now.
    pub(in crate::editor) fn refuse(&mut self, action: Action, why: &str) {
        self.say(format!("{}: {}", action.long_label(), why));
    }

    /// Takes the words off when their time is over.
    pub(super) fn end_aside(&mut self, now: Instant) {
        if self.aside.as_ref().is_some_and(|(_, until)| now >= *until) {
            self.aside = None;
        }
    }
}
