//! The editor: a [`Session`] that knows no window, and an egui application around it.

mod actions;
mod app;
mod compare;
mod compare_view;
mod habits;
mod jobs;
mod keyboard;
mod learning;
mod look;
mod notices;
mod open;
mod opening;
mod panels;

mod samples;
mod search;
mod session;
mod shortcuts;
mod status;
mod theme;
mod viewport_panel;
mod welcome;

pub use actions::{Action, Menu};
pub use app::{EditorApp, EditorError, FrameWork, run};
pub use compare::{Compare, Measures, Pane, PaneKind};
pub use habits::Habits;
pub use jobs::{Job, JobEvent, Opened};
pub use learning::{Learning, Omega, Settings, Shown, Trial, View as LearningView};
pub use look::{ColorBy, Look};
pub use notices::{Notice, NoticeKind, Notices};
pub use open::Open;
pub use samples::Sample;
pub use search::find_actions;
pub use session::Session;
pub use shortcuts::Shortcuts;
use shortcuts::pressed as pressed_keys;
pub use status::Status;
pub use welcome::Welcome;
