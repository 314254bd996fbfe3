//! Views in the window: keys that change them, legends that say what is shown, twice the pixels.

use egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use pliant::document::{Command, GroupKind};
use pliant::editor::{ColorBy, Crossings};
use pliant_solver::VertexId;

use crate::editor_window::{Window, open_bar, settle, step_until};

/// The window with the paper's bar held at one end and turned aside at the other.
fn window(folder: &std::path::Path, pixels_per_point: f32) -> Window {
    let builder = Harness::builder().with_size([900.0, 640.0]).with_pixels_per_point(pixels_per_point);
    let mut window = open_bar(folder, builder);
    let session = window.state_mut().session();
    let positions = session.document().expect("open").model().mesh.positions().to_vec();
    let (lo, hi) = positions.iter().fold((f64::MAX, f64::MIN), |(lo, hi), p| (lo.min(p.x), hi.max(p.x)));
    for (x, kind) in [(lo, GroupKind::Anchor), (hi, GroupKind::Handle)] {
        let vertices = (0..positions.len() as u32).filter(|&v| (positions[v as usize].x - x).abs() < 1e-6);
        session.apply(Command::Hold { kind, vertices: vertices.map(VertexId).collect() });
    }
    settle(&mut window);
    window
}

#[test]
fn a_key_shows_the_rest_shape_while_it_is_held_and_a_tap_leaves_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path(), 1.0);
    let shows_rest = |window: &mut Window| window.state_mut().session().shows_rest();
    window.key_down(Key::O);
    window.step();
    assert!(shows_rest(&mut window), "at once");
    window.run_steps(4);
    assert!(shows_rest(&mut window), "as long as it is held");
    window.key_up(Key::O);
    window.step();
    assert!(!shows_rest(&mut window), "until it is let go");
    window.key_press(Key::O);
    window.step();
    assert!(shows_rest(&mut window), "a tap leaves it");
    window.key_press(Key::O);
    window.step();
    assert!(!shows_rest(&mut window), "and another ends it");
}

#[test]
fn every_coloring_says_what_it_shows_and_keys_change_the_view() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path(), 1.0);
    for (color_by, words) in [
        (ColorBy::SoftStiff, "Soft up to rigidity 2"),
        (ColorBy::Energy, "squared units"),
        (ColorBy::EnergyDifference, "squared units"),
        (ColorBy::Stretch, "longer is green"),
    ] {
        let session = window.state_mut().session();
        let mut look = session.look.clone();
        look.color_by = color_by;
        session.set_look(look);
        step_until(&mut window, "the numbers are there", |session| {
            !matches!(color_by, ColorBy::Energy | ColorBy::EnergyDifference | ColorBy::Stretch)
                || session.measured().is_some()
        });
        window.run_steps(2);
        assert!(window.query_by_label_contains(words).is_some(), "{color_by:?} has no legend with {words:?}");
    }
    window.key_press_modifiers(Modifiers::ALT, Key::Z);
    window.step();
    assert!(window.state_mut().session().look.see_through);
    let session = window.state_mut().session();
    let mut look = session.look.clone();
    look.crossings = true;
    session.set_look(look);
    step_until(&mut window, "the search is over", |session| matches!(session.crossings(), Crossings::Found { .. }));
    window.run_steps(2);
    assert!(window.query_by_label_contains("self-intersections").is_some(), "the count is told");
}

#[test]
fn a_dense_screen_shows_the_same_window_twice_as_fine() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path(), 2.0);
    window.run_steps(2);
    let picture = window.render().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(picture.dimensions(), (1800, 1280));
    // The surface is drawn as finely as the screen: neighbors of two pixels differ somewhere on it.
    let viewport = window.get_by_label("viewport").rect();
    let at = |x: f32, y: f32| picture.get_pixel((2.0 * x) as u32, (2.0 * y) as u32).0;
    let row = viewport.center().y;
    let fine = (viewport.left() as u32 + 40..viewport.right() as u32 - 40)
        .filter(|&x| at(x as f32, row) != at(x as f32 + 0.5, row))
        .count();
    assert!(fine > 20, "{fine} pairs of pixels differ");
}
