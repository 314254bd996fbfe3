//! The window for those who hear it or work it by keys: every control has a name, and Tab reaches it.

use std::collections::BTreeSet;

use egui::{Key, Modifiers, Role};
use egui_kittest::kittest::{NodeT, Queryable};
use pliant::document::{Command, GroupKind};
use pliant::editor::Action;
use pliant::tools::ToolKind;
use pliant_solver::VertexId;

use crate::editor_window::{Window, press, window};

/// Roles of what can be pressed, moved or typed into.
const CONTROLS: [Role; 8] = [
    Role::Button,
    Role::CheckBox,
    Role::RadioButton,
    Role::Slider,
    Role::SpinButton,
    Role::TextInput,
    Role::ComboBox,
    Role::ColorWell,
];

/// What is wrong with controls on screen: no letter or digit in the name, or no tooltip. As text for the failure.
fn faults(window: &Window, place: &str) -> Vec<String> {
    let controls =
        || window.root().children_recursive().filter(|node| CONTROLS.contains(&node.accesskit_node().role()));
    let name_of = |node: &egui_kittest::Node<'_>| node.accesskit_node().label().unwrap_or_default();
    let described = |node: &egui_kittest::Node<'_>| node.accesskit_node().description().is_some();
    let explained: BTreeSet<String> = controls().filter(described).map(|node| name_of(&node)).collect();
    let mut found = Vec::new();
    for node in controls() {
        let (role, name) = (node.accesskit_node().role(), name_of(&node));
        // The number beside a slider bears the slider's name, and the slider has the tooltip.
        let is_with_slider = role == Role::SpinButton && explained.contains(&name);
        if !name.chars().any(char::is_alphanumeric) {
            found.push(format!("{place}: {role:?} {name:?} at {:?} has no name", node.rect()));
        } else if !described(&node) && !is_with_slider && !EXPLAINED.contains(&name.as_str()) {
            found.push(format!("{place}: {role:?} {name:?} has no tooltip"));
        }
    }
    found
}

/// Headings that fold and menus: what is in them explains itself. *Hide* and *Close window* stand in the title of every
/// floating panel.
const EXPLAINED: [&str; 15] = [
    "File",
    "Edit",
    "Select",
    "Handle",
    "Rigidity",
    "Pose",
    "View",
    "Help",
    "Handles",
    "Solver",
    "Mesh",
    "Sets",
    "History",
    "Hide",
    "Close window",
];

fn do_by_palette(window: &mut Window, words: &str) {
    let ctrl_shift = Modifiers { shift: true, ..Modifiers::COMMAND };
    window.key_press_modifiers(ctrl_shift, Key::P);
    window.run_steps(3);
    window.event(egui::Event::Text(words.to_owned()));
    window.run_steps(3);
    press(window, Key::Enter);
    window.run_steps(3);
}

/// A window with everything that panels can show: groups, one of them active, a selection, all sections open.
fn full_window(folder: &std::path::Path) -> Window {
    let mut window = window(folder);
    let session = window.state_mut().session();
    for (kind, first) in [(GroupKind::Anchor, 0), (GroupKind::Handle, 1000)] {
        let vertices = (first..first + 20).map(VertexId).collect();
        session.apply(Command::Hold { kind, vertices });
    }
    session.select_all(true);
    window.run_steps(2);
    for section in ["View", "Mesh"] {
        // Menus bear the same names: the section is the lower one.
        let headers = window.get_all_by_label(section);
        let lowest = headers.max_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
        lowest.expect("a section").click();
        window.run_steps(20);
    }
    window
}

#[test]
fn every_control_of_every_panel_has_a_name_and_a_tooltip() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = full_window(folder.path());
    let mut all = Vec::new();
    for kind in ToolKind::ALL {
        window.state_mut().session().take_tool(kind);
        window.run_steps(3);
        all.extend(faults(&window, kind.label()));
    }
    Action::SHOW_HINTS.perform_in(window.state_mut().session());
    Action::LEARN_RIGIDITY.perform_in(window.state_mut().session());
    window.run_steps(3);
    all.extend(faults(&window, "hints and learning"));
    all.sort();
    all.dedup();
    assert!(all.is_empty(), "\n{}", all.join("\n"));
}

#[test]
fn every_control_of_every_dialog_has_a_name_and_a_tooltip() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = full_window(folder.path());
    let mut all = BTreeSet::new();
    for words in ["open…", "save as", "keys and mouse", "what rigidity means", "about pliant", "open sample creature"]
    {
        do_by_palette(&mut window, words);
        all.extend(faults(&window, words));
        press(&mut window, Key::Escape);
        window.run_steps(3);
        assert!(window.query_by_label("viewport").is_some(), "{words}: Esc leads out of the dialog");
    }
    let all: Vec<String> = all.into_iter().collect();
    assert!(all.is_empty(), "\n{}", all.join("\n"));
}

#[test]
fn tab_goes_around_all_controls_and_is_caught_by_none() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut window = full_window(folder.path());
    let mut visited = BTreeSet::new();
    let mut came_around = false;
    for _ in 0..400 {
        press(&mut window, Key::Tab);
        let focused = window.root().children_recursive().find(|node| node.is_focused());
        let Some(node) = focused else { continue };
        came_around = !visited.insert(node.accesskit_node().id());
        if came_around {
            break;
        }
    }
    assert!(came_around, "after 400 presses Tab has not come around, having visited {}", visited.len());
    // Menus, tools, and more than a dozen controls of the inspector.
    assert!(visited.len() > 25, "Tab reaches only {} controls", visited.len());
}
