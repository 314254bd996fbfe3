//! The guide speaks of what is there: its pictures, its actions with their keys, and its own headings.

use std::path::{Path, PathBuf};

use pliant::editor::{Action, Shortcuts};

fn docs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs")
}

fn guide() -> String {
    std::fs::read_to_string(docs().join("guide.md")).expect("docs/guide.md")
}

/// What stands between `open` and `close`, wherever that is.
fn between<'a>(text: &'a str, open: &str, close: &str) -> Vec<&'a str> {
    text.split(open).skip(1).filter_map(|rest| rest.split_once(close)).map(|(inside, _)| inside).collect()
}

#[test]
fn every_picture_of_the_guide_exists_and_every_picture_is_shown() {
    let text = guide();
    let named: Vec<&str> = between(&text, "](", ")").into_iter().filter(|link| link.ends_with(".png")).collect();
    for name in &named {
        assert!(docs().join(name).is_file(), "docs/{name} is missing: run `cargo xtask guide`");
    }
    for entry in std::fs::read_dir(docs().join("guide")).expect("docs/guide") {
        let name = format!("guide/{}", entry.expect("an entry").file_name().to_string_lossy());
        assert!(named.contains(&name.as_str()), "docs/{name} is shown nowhere");
    }
}

#[test]
fn every_action_of_the_guide_is_in_the_menu_it_names() {
    let text = guide();
    // The introduction shows how actions are written.
    let bold = text.split("**").skip(1).step_by(2);
    let named = bold.filter(|name| name.contains(" › ") && *name != "Menu › Action");
    let known: Vec<String> = Action::all().map(Action::full_name).collect();
    let mut count = 0;
    for name in named {
        let name = name.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(known.contains(&name), "the guide names an action that is not there: {name}");
        count += 1;
    }
    assert!(count > 20, "the guide names only {count} actions");
}

#[test]
fn every_key_after_an_action_of_the_guide_is_its_key() {
    let (text, shortcuts) = (guide(), Shortcuts::default());
    for rest in text.split("**").collect::<Vec<_>>().windows(2).filter(|pair| pair[0].contains(" › ")) {
        let Some(key) = rest[1].trim_start().strip_prefix("(`").and_then(|after| after.split_once('`')) else {
            continue;
        };
        let name = rest[0].split_whitespace().collect::<Vec<_>>().join(" ");
        let Some(action) = Action::all().find(|action| action.full_name() == name) else { continue };
        let keys: Vec<String> = shortcuts.of(action).iter().map(written).collect();
        assert!(keys.contains(&key.0.to_owned()), "the guide says {} for {name}, which has {keys:?}", key.0);
    }
}

/// As the guide writes keys, on any platform.
fn written(key: &egui::KeyboardShortcut) -> String {
    let mut name = String::new();
    for (held, word) in [(key.modifiers.command, "Ctrl+"), (key.modifiers.alt, "Alt+"), (key.modifiers.shift, "Shift+")]
    {
        name += if held { word } else { "" };
    }
    name + match key.logical_key {
        egui::Key::Delete => "Del",
        egui::Key::Minus => "-",
        other => other.symbol_or_name(),
    }
}

#[test]
fn every_heading_that_the_guide_links_to_is_there() {
    let text = guide();
    let headings: Vec<String> = text.lines().filter_map(|line| line.strip_prefix("## ")).map(anchor).collect();
    for link in between(&text, "](#", ")") {
        assert!(headings.iter().any(|heading| heading == link), "the guide links to #{link}, which is nowhere");
    }
    for heading in &headings {
        assert!(text.contains(&format!("](#{heading})")), "the contents leave out {heading}");
    }
}

/// How a heading becomes an address.
fn anchor(heading: &str) -> String {
    let kept =
        heading.to_lowercase().chars().filter(|c| c.is_alphanumeric() || *c == ' ' || *c == '-').collect::<String>();
    kept.replace(' ', "-")
}
