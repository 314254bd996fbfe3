//! The sheet of keys: every action with its keys, which can be changed here, and what the mouse does.

use egui::{Event, Grid, Key, KeyboardShortcut, RichText, ScrollArea, TextEdit, Ui};

use crate::editor::{Action, Menu, Session, Shortcuts, pressed_keys, theme};
use crate::tools::{Gesture, ToolKind, VIEW_GESTURES};

/// What is looked for, and which action waits for new keys.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::editor) struct KeySheet {
    query: String,
    asking: Option<Asking>,
}

/// An action waits for its new keys.
#[derive(Clone, Debug, PartialEq)]
struct Asking {
    action: Action,
    /// Keys that were pressed but belong to another action.
    wanted: Option<(KeyboardShortcut, Action)>,
    /// Why the keys pressed last cannot be had.
    refusal: Option<&'static str>,
}

impl KeySheet {
    /// Shows the sheet.
    pub(super) fn show(&mut self, ui: &mut Ui, session: &mut Session, close: &mut bool) {
        self.take_keys(ui, &mut session.habits.shortcuts);
        ui.heading("Keys and mouse");
        ui.horizontal(|ui| {
            let field = ui.add(TextEdit::singleline(&mut self.query).hint_text("Search").desired_width(260.0));
            let field = field.on_hover_text("Words of an action, or keys");
            super::name(ui, &field, "Search keys and mouse");
            if self.asking.is_none() && ui.memory(|memory| memory.focused().is_none()) {
                field.request_focus();
            }
            let any = session.habits.shortcuts.is_any_changed();
            let reset = ui.add_enabled(any, egui::Button::new("Reset all keys"));
            let reset = reset.on_hover_text("Give every action the keys it comes with");
            if reset.on_disabled_hover_text("Every action has the keys it comes with").clicked() {
                session.habits.shortcuts.reset_all();
            }
        });
        ui.label(RichText::new(self.advice()).weak());
        ui.add_space(4.0);
        let height = ui.ctx().content_rect().height() - 220.0;
        ScrollArea::vertical().auto_shrink([false, false]).max_height(height).show(ui, |ui| {
            for menu in Action::MENUS {
                self.menu(ui, session, menu);
            }
            self.gestures(ui, "Mouse, with every tool", VIEW_GESTURES);
            for kind in ToolKind::ALL {
                self.gestures(ui, &format!("Mouse, with the tool {}", kind.label()), kind.gestures());
            }
        });
        ui.add_space(8.0);
        *close |= ui.button("Close").on_hover_text("Close the sheet (Esc)").clicked();
    }

    /// One line that is always there, so that the sheet does not jump.
    fn advice(&self) -> String {
        match &self.asking {
            None => "Click a key to change it".to_owned(),
            Some(Asking { refusal: Some(why), .. }) => format!("{why}: press other keys, or Esc"),
            Some(Asking { wanted: Some((_, owner)), .. }) => {
                format!("These keys do \"{}\" now: take them, press others, or Esc", owner.label())
            }
            Some(Asking { action, .. }) => format!("Press the new keys for \"{}\", or Esc", action.label()),
        }
    }

    /// While an action waits for keys, all keys are for it.
    fn take_keys(&mut self, ui: &Ui, shortcuts: &mut Shortcuts) {
        let Some(asking) = &mut self.asking else { return };
        let mut pressed = None;
        let mut is_for_text = false;
        ui.input_mut(|input| {
            input.events.retain(|event| match event {
                &Event::Key { key, pressed: true, modifiers, .. } => {
                    if !is_modifier(key) {
                        pressed = Some(pressed_keys(key, modifiers));
                    }
                    false
                }
                Event::Copy | Event::Cut | Event::Paste(_) => {
                    is_for_text = true;
                    false
                }
                Event::Text(_) => false,
                _ => true,
            });
        });
        if is_for_text {
            asking.refusal = Some("Cut, copy and paste belong to text");
        }
        let Some(keys) = pressed else { return };
        if keys.logical_key == Key::Escape {
            self.asking = None;
            return;
        }
        asking.refusal = Shortcuts::refusal(keys);
        asking.wanted = shortcuts.owner(keys, asking.action).map(|owner| (keys, owner));
        if asking.refusal.is_none() && asking.wanted.is_none() {
            shortcuts.assign(asking.action, keys);
            self.asking = None;
        }
    }

    fn menu(&mut self, ui: &mut Ui, session: &mut Session, menu: &Menu) {
        let actions: Vec<Action> =
            menu.actions.iter().copied().filter(|action| self.is_wanted(ui, session, *action)).collect();
        if actions.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.label(RichText::new(menu.name).strong());
        Grid::new(menu.name).num_columns(2).min_col_width(230.0).spacing([12.0, 3.0]).striped(true).show(ui, |ui| {
            for action in actions {
                ui.label(action.long_label()).on_hover_text(action.tooltip());
                ui.horizontal(|ui| self.keys(ui, session, action));
                ui.end_row();
            }
        });
    }

    /// The keys of an action, and what can be done to them.
    fn keys(&mut self, ui: &mut Ui, session: &mut Session, action: Action) {
        let shortcuts = &mut session.habits.shortcuts;
        let texts: Vec<String> = shortcuts.of(action).iter().map(|key| ui.ctx().format_shortcut(key)).collect();
        let is_asking = self.asking.as_ref().is_some_and(|asking| asking.action == action);
        let text = match (is_asking, texts.is_empty()) {
            (true, _) => RichText::new("press keys").color(theme::ACCENT),
            (false, true) => RichText::new("–").weak(),
            (false, false) => RichText::new(texts.join(" or ")),
        };
        let button = ui.button(text).on_hover_text("Click, then press the new keys");
        super::name(ui, &button, &format!("Keys of {}: {}", action.long_label(), texts.join(" or ")));
        if button.clicked() {
            let asking = Asking { action, wanted: None, refusal: None };
            self.asking = (!is_asking).then_some(asking);
            ui.memory_mut(|memory| memory.stop_text_input());
        }
        let wanted = self.asking.as_ref().filter(|_| is_asking).and_then(|asking| asking.wanted);
        if let Some((keys, owner)) = wanted {
            let text = format!("Take {} from {}", ui.ctx().format_shortcut(&keys), owner.label());
            if ui.button(text).on_hover_text("The other action is left without these keys").clicked() {
                shortcuts.assign(action, keys);
                self.asking = None;
            }
        } else if is_asking && !texts.is_empty() {
            if ui.button("No keys").on_hover_text("Leave this action without keys").clicked() {
                shortcuts.clear(action);
                self.asking = None;
            }
        } else if shortcuts.is_changed(action) && !is_asking {
            let reset = ui.small_button("reset").on_hover_text("The keys it comes with");
            super::name(ui, &reset, &format!("Reset the keys of {}", action.long_label()));
            if reset.clicked() {
                shortcuts.reset(action);
            }
        }
    }

    fn gestures(&self, ui: &mut Ui, heading: &str, gestures: &[Gesture]) {
        let wanted: Vec<&Gesture> = gestures.iter().filter(|(how, what)| self.finds(&[heading, how, what])).collect();
        if wanted.is_empty() {
            return;
        }
        ui.add_space(4.0);
        ui.label(RichText::new(heading).strong());
        Grid::new(heading).num_columns(2).min_col_width(230.0).spacing([12.0, 3.0]).striped(true).show(ui, |ui| {
            for (how, what) in wanted {
                ui.label(*how);
                ui.label(*what);
                ui.end_row();
            }
        });
    }

    fn is_wanted(&self, ui: &Ui, session: &Session, action: Action) -> bool {
        let keys = session.habits.shortcuts.of(action);
        let keys: Vec<String> = keys.iter().map(|key| ui.ctx().format_shortcut(key)).collect();
        self.finds(&[&action.full_name(), action.tooltip(), &keys.join(" ")])
    }

    /// Whether every word that is looked for is in one of the texts.
    fn finds(&self, texts: &[&str]) -> bool {
        let texts: Vec<String> = texts.iter().map(|text| text.to_lowercase()).collect();
        self.query.to_lowercase().split_whitespace().all(|word| texts.iter().any(|text| text.contains(word)))
    }
}

fn is_modifier(key: Key) -> bool {
    matches!(
        key,
        Key::ShiftLeft
            | Key::ShiftRight
            | Key::ControlLeft
            | Key::ControlRight
            | Key::AltLeft
            | Key::AltRight
            | Key::SuperLeft
            | Key::SuperRight
    )
}
