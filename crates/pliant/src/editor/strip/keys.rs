//! The strip by keys: arrows go from card to card, Enter shows a pose (as any control is pressed), Delete takes it off,
//! F2 names it, Ctrl with arrows moves it.

use egui::{Context, EventFilter, Id, Key, Modifiers};

use super::StripView;
use crate::document::{Command, PoseChange};
use crate::editor::Session;

/// Arrow keys go to the card that has the focus instead of leading away from it.
pub(super) fn keep_arrows(ctx: &Context, card: Id) {
    let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
    ctx.memory_mut(|memory| memory.set_focus_lock_filter(card, filter));
}

impl StripView {
    /// Takes the keys of this frame that are for the card that has the focus, before they are taken for shortcuts.
    pub(in crate::editor) fn take_keys(&mut self, ctx: &Context, session: &mut Session) {
        let focused = ctx.memory(|memory| memory.focused());
        let Some((_, id)) = self.focused.filter(|(card, _)| focused == Some(*card)) else { return };
        let Some(place) = session.poses().iter().position(|kept| kept.id == id) else { return };
        let last = session.poses().len() - 1;
        let pressed = |modifiers, key| ctx.input_mut(|input| input.consume_key(modifiers, key));
        for (key, to) in [(Key::ArrowLeft, place.saturating_sub(1)), (Key::ArrowRight, (place + 1).min(last))] {
            if pressed(Modifiers::COMMAND, key) && to != place {
                session.apply(Command::Poses(PoseChange::Place(id, to)));
                self.wanted = Some(id);
            } else if pressed(Modifiers::NONE, key) {
                self.wanted = Some(session.poses()[to].id);
            }
        }
        for (key, to) in [(Key::Home, 0), (Key::End, last)] {
            if pressed(Modifiers::NONE, key) {
                self.wanted = Some(session.poses()[to].id);
            }
        }
        if pressed(Modifiers::NONE, Key::F2) {
            self.renaming = Some((id, session.poses()[place].name.clone()));
        }
        if pressed(Modifiers::NONE, Key::Delete) || pressed(Modifiers::NONE, Key::Backspace) {
            // The focus goes to the card that takes its place.
            let beside = if place < last { place + 1 } else { last.saturating_sub(1) };
            self.wanted = Some(session.poses()[beside].id).filter(|beside| *beside != id);
            session.apply(Command::Poses(PoseChange::Delete(id)));
        }
    }
}
