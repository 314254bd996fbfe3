//! The window in some of its states.

use std::path::Path;

use egui::{Key, Modifiers, Pos2, pos2, vec2};
use pliant::editor::Sample;
use pliant::tools::SelectShape;

use super::stage::{COMMON, Stage};

/// The raised hand of the creature, as the camera frames the sample, and the way it is pulled.
const HAND: Pos2 = pos2(423.0, 284.0);
const PULLED: Pos2 = pos2(520.0, 200.0);

/// Makes some pictures in a folder.
type Scene = fn(&Path) -> Result<(), String>;

/// What can be asked for by name.
pub(crate) const SCENES: &[(&str, Scene)] =
    &[("window", bend_and_paint), ("selecting", select), ("fill", fill), ("poses", pose), ("compare", compare)];

fn bend_and_paint(folder: &Path) -> Result<(), String> {
    let mut stage = Stage::new(Sample::Creature, COMMON);
    stage.key(Modifiers::NONE, Key::H);
    stage.drag(&[HAND, PULLED]);
    stage.settle();
    stage.keep(&folder.join("window.png"))?;
    let ctrl_shift = Modifiers { shift: true, ..Modifiers::COMMAND };
    stage.key(ctrl_shift, Key::P);
    stage.type_text("pose");
    stage.keep(&folder.join("palette.png"))?;
    stage.key(Modifiers::NONE, Key::Escape);
    stage.key(Modifiers::NONE, Key::F1);
    stage.keep(&folder.join("keys.png"))?;
    stage.key(Modifiers::NONE, Key::Escape);
    stage.key(Modifiers::NONE, Key::B);
    stage.key(Modifiers::NONE, Key::Num1);
    stage.drag(&[pos2(310.0, 360.0), pos2(360.0, 370.0), pos2(320.0, 400.0)]);
    stage.settle();
    stage.hover(pos2(345.0, 385.0));
    stage.keep(&folder.join("brush.png"))
}

/// The head is selected, and a lasso is on its way around a hand.
fn select(folder: &Path) -> Result<(), String> {
    let mut stage = Stage::new(Sample::Creature, COMMON);
    stage.key(Modifiers::NONE, Key::S);
    stage.session().options.select_shape = SelectShape::Lasso;
    stage.drag(&lasso(pos2(352.0, 215.0), 75.0, 1.0));
    stage.draw(&lasso(HAND, 44.0, 0.8));
    stage.keep(&folder.join("selecting.png"))?;
    stage.let_go(HAND);
    Ok(())
}

/// Points of a part of a circle.
fn lasso(center: Pos2, radius: f32, part: f32) -> Vec<Pos2> {
    (0..=10).map(|k| center + radius * egui::Vec2::angled(part * std::f32::consts::TAU * k as f32 / 10.0)).collect()
}

fn fill(folder: &Path) -> Result<(), String> {
    let mut stage = Stage::new(Sample::Creature, COMMON);
    stage.key(Modifiers::NONE, Key::G);
    stage.key(Modifiers::NONE, Key::Num1);
    let from = pos2(365.0, 345.0);
    stage.draw(&[from, from + egui::vec2(48.0, 30.0)]);
    stage.keep(&folder.join("fill.png"))?;
    stage.let_go(from);
    Ok(())
}

fn pose(folder: &Path) -> Result<(), String> {
    let mut stage = Stage::new(Sample::Creature, COMMON);
    stage.key(Modifiers::NONE, Key::K);
    stage.key(Modifiers::NONE, Key::H);
    // Above the strip everything is a little smaller.
    let mut from = pos2(405.0, 222.0);
    for to in [pos2(480.0, 150.0), pos2(470.0, 290.0)] {
        stage.drag(&[from, to]);
        stage.settle();
        stage.key(Modifiers::NONE, Key::K);
        from = to;
    }
    stage.wait_for_thumbnails();
    stage.keep(&folder.join("poses.png"))
}

fn compare(folder: &Path) -> Result<(), String> {
    // Room for six panes and what stands below them.
    let mut stage = Stage::new(Sample::Creature, vec2(1320.0, 880.0));
    stage.key(Modifiers::NONE, Key::H);
    stage.drag(&[pos2(628.0, 393.0), pos2(767.0, 272.0)]);
    stage.settle();
    stage.key(Modifiers::NONE, Key::C);
    stage.until("all methods settle", |session| session.compare().is_some_and(|compare| compare.is_settled()));
    stage.hover(pos2(900.0, 16.0));
    stage.keep(&folder.join("compare.png"))
}
