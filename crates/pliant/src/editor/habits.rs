//! What belongs to the person rather than to a mesh, kept from one start to the next: keys, size of the window's
//! contents, what was seen and used.

use serde::{Deserialize, Serialize};

use super::{Action, Shortcuts};

/// How many of the actions that were chosen in the palette come first there (by eye: half of what it shows).
const RECENT: usize = 6;

/// How a person likes to work. Of what was stored, whatever is missing is as at the first start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Habits {
    /// Keys of the actions.
    pub shortcuts: Shortcuts,
    /// Size of everything but the picture: 1 is as the platform has it.
    pub ui_scale: f32,
    /// The hints for a newcomer were followed or dismissed.
    pub has_seen_hints: bool,
    /// Ids of the actions that were last chosen in the palette, newest first.
    recent: Vec<String>,
}

impl Default for Habits {
    fn default() -> Habits {
        let (shortcuts, recent) = Default::default();
        Habits { shortcuts, ui_scale: 1.0, has_seen_hints: false, recent }
    }
}

impl Habits {
    /// Bounds of [`Habits::ui_scale`]: smaller cannot be read, larger leaves no room for the picture.
    pub const UI_SCALE: std::ops::RangeInclusive<f32> = 0.75..=2.5;

    /// Steps of the scale: fine near 1, where taste decides, coarse where eyes do.
    const UI_SCALES: [f32; 9] = [0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5];

    /// The scale, within its bounds whatever was stored.
    pub fn ui_scale(&self) -> f32 {
        let scale = if self.ui_scale.is_finite() { self.ui_scale } else { 1.0 };
        scale.clamp(*Habits::UI_SCALE.start(), *Habits::UI_SCALE.end())
    }

    /// The next larger scale, or the largest.
    pub fn scale_up(&mut self) {
        let next = Habits::UI_SCALES.into_iter().find(|scale| *scale > self.ui_scale + 0.01);
        self.ui_scale = next.unwrap_or(*Habits::UI_SCALE.end());
    }

    /// The next smaller scale, or the smallest.
    pub fn scale_down(&mut self) {
        let next = Habits::UI_SCALES.into_iter().rev().find(|scale| *scale < self.ui_scale - 0.01);
        self.ui_scale = next.unwrap_or(*Habits::UI_SCALE.start());
    }

    /// Remembers that an action was chosen in the palette.
    pub fn remember(&mut self, action: Action) {
        self.recent.retain(|id| id != action.id());
        self.recent.insert(0, action.id().to_owned());
        self.recent.truncate(RECENT);
    }

    /// Actions last chosen in the palette, newest first.
    pub fn recent(&self) -> Vec<Action> {
        self.recent.iter().filter_map(|id| Action::named(id)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn habits_are_the_same_after_they_were_written_and_read() {
        let mut habits = Habits { ui_scale: 1.5, has_seen_hints: true, ..Habits::default() };
        habits.shortcuts.clear(Action::SAVE);
        habits.remember(Action::UNDO);
        habits.remember(Action::FRAME);
        habits.remember(Action::UNDO);
        assert_eq!(habits.recent(), [Action::UNDO, Action::FRAME]);
        let text = serde_json::to_string(&habits).expect("plain data");
        assert_eq!(serde_json::from_str::<Habits>(&text).expect("as written"), habits);
    }

    #[test]
    fn what_another_version_stored_is_read_as_far_as_it_goes() {
        let text = r#"{"later": 1, "ui_scale": 1e30, "shortcuts": {"edit.undo": ["Cmd+U", "nonsense"]}}"#;
        let habits: Habits = serde_json::from_str(text).expect("missing and unknown fields are allowed");
        assert_eq!(habits.ui_scale(), 2.5);
        assert_eq!(habits.shortcuts.of(Action::UNDO).len(), 1);
        assert!(!habits.has_seen_hints);
    }

    #[test]
    fn the_scale_goes_up_and_down_between_its_bounds_and_comes_back_to_one() {
        let mut habits = Habits::default();
        (0..20).for_each(|_| habits.scale_up());
        assert_eq!(habits.ui_scale, 2.5);
        (0..20).for_each(|_| habits.scale_down());
        assert_eq!(habits.ui_scale, 0.75);
        habits.scale_up();
        habits.scale_up();
        assert_eq!(habits.ui_scale, 1.0);
    }
}
