//! The window's words: palette, sheet of keys, hints, help, and the size of text.

use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use pliant::editor::{Action, Sample};

use crate::editor_window::{Window, press, step_until, window};

fn press_with(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(3);
}

fn type_text(window: &mut Window, text: &str) {
    window.event(Event::Text(text.to_owned()));
    window.run_steps(6);
}

const CTRL_SHIFT: Modifiers = Modifiers { shift: true, ..Modifiers::COMMAND };

#[test]
fn a_few_letters_in_the_palette_and_enter_do_an_action() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    let had = window.state_mut().session().look.wireframe;
    press_with(&mut window, CTRL_SHIFT, Key::P);
    type_text(&mut window, "wirefr");
    press(&mut window, Key::Enter);
    window.run_steps(2);
    let session = window.state_mut().session();
    assert_eq!(session.look.wireframe, !had, "the palette did not switch the wireframe");
    assert_eq!(session.habits.recent(), [Action::TOGGLE_WIREFRAME]);
    assert!(window.query_by_label("Find an action").is_none(), "the palette stays open");
}

#[test]
fn the_palette_says_why_an_action_cannot_be_done_and_stays_open() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press_with(&mut window, CTRL_SHIFT, Key::P);
    type_text(&mut window, "redo");
    press(&mut window, Key::Enter);
    window.run_steps(2);
    assert!(window.query_by_label_contains("There is nothing to redo").is_some(), "no reason is shown");
    press(&mut window, Key::Escape);
    window.run_steps(2);
    assert!(window.query_by_label("Find an action").is_none(), "the palette stays in spite of Esc");
}

#[test]
fn a_key_changed_on_the_sheet_works_at_once_and_a_taken_one_is_asked_about() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    press(&mut window, Key::F1);
    window.run_steps(2);
    type_text(&mut window, "wireframe");
    window.get_by_label("Keys of Wireframe: W").click();
    window.run_steps(2);
    // B takes the brush in hand: asked about, then refused by Esc, which leaves the sheet open.
    press(&mut window, Key::B);
    window.run_steps(2);
    assert!(window.query_by_label_contains("from Brush").is_some(), "the conflict is not shown");
    press(&mut window, Key::Escape);
    window.run_steps(2);
    window.get_by_label("Keys of Wireframe: W").click();
    window.run_steps(2);
    press(&mut window, Key::F9);
    window.run_steps(2);
    press(&mut window, Key::Escape);
    window.run_steps(2);
    let had = window.state_mut().session().look.wireframe;
    press(&mut window, Key::W);
    assert_eq!(window.state_mut().session().look.wireframe, had, "the old key still works");
    press(&mut window, Key::F9);
    assert_eq!(window.state_mut().session().look.wireframe, !had, "the new key does nothing");
}

#[test]
fn text_and_buttons_grow_and_shrink_within_bounds_and_come_back() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    for (key, times, expected) in [(Key::Plus, 9, 2.5), (Key::Minus, 12, 0.75), (Key::Num0, 1, 1.0)] {
        (0..times).for_each(|_| press_with(&mut window, Modifiers::COMMAND, key));
        assert_eq!(window.ctx.zoom_factor(), expected, "after {key:?}");
    }
}

#[test]
fn hints_come_once_and_again_when_asked_for() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = window(folder.path());
    let creature = |window: &mut Window| {
        window.state_mut().session().start(pliant::editor::Job::OpenSample(Sample::Creature));
        step_until(window, "the sample is open", |session| session.running_job().is_none());
        window.run_steps(2);
    };
    creature(&mut window);
    window.get_by_label("Dismiss the hints").click();
    window.run_steps(2);
    assert!(window.state_mut().session().habits.has_seen_hints);
    creature(&mut window);
    assert!(window.query_by_label("Start here").is_none(), "the hints came twice");
    assert!(Action::SHOW_HINTS.perform_in(window.state_mut().session()));
    window.run_steps(2);
    assert!(window.query_by_label("Start here").is_some(), "the hints do not come when asked for");
}
