//! The window in some of its states.

use std::path::Path;

use egui::{Key, Modifiers, pos2};
use pliant::editor::Sample;

use super::stage::Stage;

/// Writes the pictures of the window.
pub(crate) fn make(folder: &Path) -> Result<(), String> {
    bend_and_paint(folder)
}

fn bend_and_paint(folder: &Path) -> Result<(), String> {
    let mut stage = Stage::new(Sample::Creature);
    // The raised hand, as the camera frames the sample.
    stage.key(Modifiers::NONE, Key::H);
    stage.drag(&[pos2(423.0, 284.0), pos2(520.0, 200.0)]);
    stage.settle();
    stage.keep(&folder.join("window.png"))?;
    stage.key(Modifiers::NONE, Key::B);
    stage.key(Modifiers::NONE, Key::Num1);
    stage.drag(&[pos2(310.0, 360.0), pos2(360.0, 370.0), pos2(320.0, 400.0)]);
    stage.settle();
    stage.hover(pos2(345.0, 385.0));
    stage.keep(&folder.join("brush.png"))
}
