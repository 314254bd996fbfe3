//! Hints for a newcomer: each gets a check mark once followed, and they vanish when all are, or when dismissed.

use egui::{Align2, Color32, Context, Frame, Rect, RichText, Ui, vec2};

use crate::editor::{Action, Sample, Session, Welcome, theme};

/// Shows the hints in the upper left corner of `viewport` while they are wanted.
pub(in crate::editor) fn welcome(ui: &Ui, viewport: Rect, session: &mut Session) {
    session.watch_view();
    let Some(steps) = session.welcome() else { return };
    let hints = hints(ui.ctx(), session, steps);
    let mut dismissed = steps.all_done();
    egui::Area::new(egui::Id::unique("welcome"))
        .pivot(Align2::LEFT_TOP)
        .fixed_pos(viewport.left_top() + vec2(12.0, 12.0))
        .show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.label(RichText::new("Start here").strong());
                    let button = ui.small_button("×").on_hover_text("Dismiss the hints; the menu Help has them");
                    super::name(ui, &button, "Dismiss the hints");
                    dismissed |= button.clicked();
                });
                // The first that is left to do stands out.
                let next = hints.iter().position(|(done, _)| !done);
                for (index, (done, text)) in hints.into_iter().enumerate() {
                    ui.horizontal(|ui| {
                        mark(ui, done);
                        let text = RichText::new(text);
                        ui.label(if Some(index) == next { text.strong() } else { text.weak() });
                    });
                }
                let (find, keys) = (key(ui.ctx(), session, Action::PALETTE), key(ui.ctx(), session, Action::KEYS));
                ui.label(RichText::new(format!("{find} finds anything · {keys} shows all keys")).weak().small());
            });
        });
    if dismissed {
        session.dismiss_welcome();
    }
}

/// What to do, and whether it was done.
fn hints(ctx: &Context, session: &Session, steps: Welcome) -> [(bool, String); 4] {
    let is_start_sample = session.document().is_some_and(|document| document.model().name == Sample::Creature.name());
    let handle = key(ctx, session, Action::TOOL_HANDLE);
    let pull = match (is_start_sample, session.document().is_some_and(|document| document.scene().groups.is_empty())) {
        (true, _) => format!("Pull: drag a hand with the left mouse button (tool Handle, {handle})"),
        (false, true) => format!("Press {handle} and click the surface: that part is held"),
        (false, false) => format!("Pull: drag another part with the left mouse button (tool Handle, {handle})"),
    };
    let brush = key(ctx, session, Action::TOOL_BRUSH);
    let paint = match is_start_sample {
        true => format!("Paint: press {brush}, then 1, and stroke the belly: it gets soft"),
        false => format!("Paint: press {brush}, then 6, and stroke the surface: it gets stiff"),
    };
    let undo = format!("Take it back: {}", key(ctx, session, Action::UNDO));
    let turn = "Turn: drag with the right mouse button; the wheel zooms".to_owned();
    [(steps.pulled, pull), (steps.painted, paint), (steps.undone, undo), (steps.turned, turn)]
}

/// The key of an action, or where else it is found.
fn key(ctx: &Context, session: &Session, action: Action) -> String {
    match session.habits.shortcuts.text(action, ctx) {
        key if key.is_empty() => action.full_name(),
        key => key,
    }
}

fn mark(ui: &mut Ui, done: bool) {
    let (rect, _) = ui.allocate_exact_size(vec2(12.0, 16.0), egui::Sense::hover());
    if done {
        ui.painter().circle_filled(rect.center(), 5.0, Color32::from_rgb(92, 180, 110));
    } else {
        ui.painter().circle_stroke(rect.center(), 4.5, egui::Stroke::new(1.5, theme::ACCENT));
    }
}
