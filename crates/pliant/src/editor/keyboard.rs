//! Keys: shortcuts of actions, digits for the current r, F for the brush radius, Esc for the tool.

use egui::{Event, Key, Modifiers};

use super::peek::Peek;
use super::{Action, Session};
use crate::tools::{Input, ToolKey};

/// Two digits typed within this time, with nothing else between, are one number. By hand: slow typing takes half of it.
const TYPED_TOGETHER_SECS: f64 = 0.6;

const DIGITS: [Key; 10] =
    [Key::Num0, Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

/// What must be remembered between key presses.
#[derive(Default)]
pub(super) struct Keyboard {
    /// The digit, and the window's time in seconds when it was typed.
    last_digit: Option<(u16, f64)>,
    peek: Peek,
}

impl Keyboard {
    /// Takes the keys of this frame, unless a text field wants them. Returns actions whose shortcut was pressed.
    /// `viewport` is the picture, which leaves all keys to the actions.
    pub(super) fn take(
        &mut self,
        ctx: &egui::Context,
        session: &mut Session,
        viewport: Option<egui::Id>,
    ) -> Vec<Action> {
        let types_text = ctx.text_edit_focused();
        if types_text {
            return session.habits.shortcuts.take(ctx, is_not_for_text);
        }
        // An open menu closes by Esc itself.
        if !egui::Popup::is_any_open(ctx) && ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape)) {
            session.escape();
        }
        if session.tool_takes_numbers() {
            numbers(ctx, session);
        }
        self.peek.take(ctx, session);
        let actions = match ctx.memory(|memory| memory.focused()) {
            // A control that has the focus is worked with these keys.
            Some(focused) if Some(focused) != viewport => {
                session.habits.shortcuts.take(ctx, |key, _| !works_controls(key))
            }
            _ => session.habits.shortcuts.take(ctx, |_, _| true),
        };
        self.digits(ctx, session);
        brush_radius(ctx, session);
        actions
    }

    fn digits(&mut self, ctx: &egui::Context, session: &mut Session) {
        let is_interrupted = |event: &Event| match event {
            Event::PointerButton { .. } => true,
            Event::Key { key, pressed: true, .. } => !DIGITS.contains(key),
            _ => false,
        };
        if ctx.input(|input| input.events.iter().any(is_interrupted)) {
            self.last_digit = None;
        }
        for (digit, key) in (0_u16..).zip(DIGITS) {
            if !ctx.input_mut(|input| consume_plain(input, key)) {
                continue;
            }
            let now = ctx.input(|input| input.time);
            let r = match self.last_digit {
                Some((tens, at)) if now - at < TYPED_TOGETHER_SECS => tens * 10 + digit,
                _ => digit,
            };
            self.last_digit = (r < 10).then_some((r, now));
            if r > 0 {
                session.choose_rigidity(r);
            }
        }
    }
}

/// Takes a key that was pressed with no modifier held.
fn consume_plain(input: &mut egui::InputState, key: Key) -> bool {
    let before = input.events.len();
    input.events.retain(|event| {
        !matches!(event, Event::Key { key: pressed, pressed: true, modifiers, .. } if *pressed == key && modifiers.is_none())
    });
    input.events.len() < before
}

/// Keys that press, move or leave the control that has the focus.
fn works_controls(key: Key) -> bool {
    let arrows = matches!(key, Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp | Key::ArrowDown);
    arrows || matches!(key, Key::Space | Key::Enter | Key::Tab)
}

/// Whether a text field has no use for the keys: F1, and Ctrl with a letter that means nothing in text.
fn is_not_for_text(key: Key, modifiers: Modifiers) -> bool {
    let is_function = key.name().len() > 1 && key.name().starts_with('F');
    is_function || (modifiers.command && matches!(key, Key::O | Key::P | Key::Q | Key::S))
}

/// Keys of a number and of the axes, while a drag or a part of the gizmo takes them.
fn numbers(ctx: &egui::Context, session: &mut Session) {
    let taken = |key: &Key| match key {
        Key::Minus => Some(ToolKey::Sign('-')),
        Key::Period | Key::Comma => Some(ToolKey::Sign('.')),
        Key::Backspace => Some(ToolKey::Erase),
        Key::Enter => Some(ToolKey::Enter),
        Key::X => Some(ToolKey::Axis(0)),
        Key::Y => Some(ToolKey::Axis(1)),
        Key::Z => Some(ToolKey::Axis(2)),
        _ => {
            let digit = DIGITS.iter().position(|digit| digit == key)?;
            char::from_digit(digit as u32, 10).map(ToolKey::Sign)
        }
    };
    let mut keys = Vec::new();
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
            let key = taken(key).filter(|_| !modifiers.command && !modifiers.alt);
            keys.extend(key);
            key.is_none()
        });
    });
    keys.into_iter().for_each(|key| session.input(Input::Key(key)));
}

/// While F is held the mouse, moved sideways, sizes the brush.
fn brush_radius(ctx: &egui::Context, session: &mut Session) {
    let (held, delta) =
        ctx.input(|input| (input.key_down(Key::F) && input.modifiers.is_none(), input.pointer.delta().x));
    if held && delta != 0.0 {
        session.options.drag_brush(delta);
    }
}
