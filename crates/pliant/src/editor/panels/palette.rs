//! The palette: any action by a few letters of its name.

use egui::{Button, Key, Modifiers, RichText, ScrollArea, TextEdit, Ui, Vec2};

use super::tip;
use crate::editor::{Action, Session, find_actions};

/// Rows that are seen without scrolling (by eye: half the height of the smallest window).
const ROWS: f32 = 10.0;

/// What is typed and which row is marked.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::editor) struct Palette {
    query: String,
    marked: usize,
}

impl Palette {
    /// Shows field and list; returns the action that was chosen.
    pub(super) fn show(&mut self, ui: &mut Ui, session: &mut Session) -> Option<Action> {
        let moved = self.take_arrows(ui);
        let entered = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        let hint = "What do you want to do?";
        let field = ui.add(TextEdit::singleline(&mut self.query).hint_text(hint).desired_width(f32::INFINITY));
        let field = field.on_hover_text("A few letters of what you want to do");
        super::name(ui, &field, "Find an action");
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        if field.changed() {
            self.marked = 0;
        }
        let found = find_actions(&self.query, session);
        self.marked = self.marked.min(found.len().saturating_sub(1));
        let clicked = self.list(ui, session, &found, moved || field.changed());
        ui.separator();
        footer(ui, session, found.get(self.marked).copied());
        let entered = if entered { found.get(self.marked).copied() } else { None };
        let chosen = clicked.or(entered).filter(|action| action.obstacle(session).is_none());
        if let Some(action) = chosen {
            session.habits.remember(action);
        }
        chosen
    }

    /// Up, down and by pages; whether the mark moved.
    fn take_arrows(&mut self, ui: &Ui) -> bool {
        let before = self.marked;
        let pressed = |key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key));
        self.marked += pressed(Key::ArrowDown) + ROWS as usize * pressed(Key::PageDown);
        self.marked = self.marked.saturating_sub(pressed(Key::ArrowUp) + ROWS as usize * pressed(Key::PageUp));
        self.marked != before
    }

    fn list(&mut self, ui: &mut Ui, session: &Session, found: &[Action], follow: bool) -> Option<Action> {
        let mut clicked = None;
        let row = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
        let height = (ROWS * row).min(ui.ctx().content_rect().height() * 0.5);
        let area = ScrollArea::vertical().auto_shrink([false, false]).max_height(height).min_scrolled_height(height);
        area.show(ui, |ui| {
            if found.is_empty() {
                ui.label(RichText::new("Nothing is called so").weak());
            }
            for (index, &action) in found.iter().enumerate() {
                let response = entry(ui, session, action, index == self.marked);
                if index == self.marked && follow {
                    response.scroll_to_me(None);
                }
                if response.clicked() {
                    self.marked = index;
                    clicked = Some(action);
                }
            }
        });
        clicked
    }
}

fn entry(ui: &mut Ui, session: &Session, action: Action, is_marked: bool) -> egui::Response {
    let mut title = RichText::new(match action.submenu() {
        Some(_) => action.long_label(),
        None => action.title(session),
    });
    if action.obstacle(session).is_some() {
        title = title.weak();
    }
    let button = Button::selectable(is_marked, title).min_size(Vec2::new(ui.available_width() - 12.0, 0.0));
    let response = ui.add(button.shortcut_text(session.habits.shortcuts.text(action, ui.ctx())));
    response.on_hover_text(format!("{}\n{}", action.full_name(), tip(ui, session, action)))
}

/// What the marked action does, or why it cannot be done now. Always equally high.
fn footer(ui: &mut Ui, session: &Session, action: Option<Action>) {
    let text = match action {
        Some(action) => match action.obstacle(session) {
            Some(why) => format!("Not now: {why}"),
            None => action.tooltip().to_owned(),
        },
        None => "Try fewer letters".to_owned(),
    };
    ui.add(egui::Label::new(RichText::new(text).weak()).truncate());
    ui.label(RichText::new("Enter does it · arrow keys choose · Esc closes").weak().small());
}
