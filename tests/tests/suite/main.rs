//! Promises that cross crates, in one test binary.

mod agreement;
mod commands;
mod compare_command;
mod editor;
mod editor_access;
mod editor_comparing;
mod editor_window;
mod editor_words;
mod guide;
mod learn_command;
mod learning;
mod paper_figures;
mod process;
mod project_damage;
mod refusals;
mod reports;
mod shaders;
mod viewport;
mod views_window;
