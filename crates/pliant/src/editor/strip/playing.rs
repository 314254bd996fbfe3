//! Playing, scrubbing and pace.

use egui::{Button, ComboBox, DragValue, Slider, Ui};

use super::super::panels::action_button;
use super::super::{Action, Session};
use crate::posing::{Player, Repeat};

pub(super) fn controls(ui: &mut Ui, session: &mut Session, chosen: &mut Vec<Action>) {
    if action_button(ui, session, Action::PLAY).clicked() {
        chosen.push(Action::PLAY);
    }
    let is_shown = session.player().is_some();
    let end = ui.add_enabled(is_shown, Button::new("End"));
    let end = end.on_hover_text("Back to the surface that can be edited (Esc)");
    if end.on_disabled_hover_text("Nothing is being played").clicked() {
        session.stop_playing();
    }
    scrub(ui, session);
    let (mut repeat, mut seconds) = session.pace();
    let combo = ComboBox::from_id_salt("repeat").width(104.0).selected_text(repeat.label()).show_ui(ui, |ui| {
        for other in Repeat::ALL {
            ui.selectable_value(&mut repeat, other, other.label()).on_hover_text(other.tooltip());
        }
    });
    combo.response.on_hover_text("What comes behind the last pose");
    let field = DragValue::new(&mut seconds).range(Player::SECONDS).speed(0.01).suffix(" s").fixed_decimals(2);
    ui.add(field).on_hover_text("Time from one pose to the next");
    if (repeat, seconds) != session.pace() {
        session.set_pace(repeat, seconds);
    }
    solved(ui, session);
}

fn scrub(ui: &mut Ui, session: &mut Session) {
    let obstacle = session.play_obstacle();
    let last = session.last_place().max(1.0);
    // Counted from 1, as poses are.
    let mut place = session.player().map_or(0.0, Player::position) + 1.0;
    // Narrower than usual, so that the row fits into a window of common size.
    ui.spacing_mut().slider_width = 90.0;
    let slider = Slider::new(&mut place, 1.0..=1.0 + last).show_value(false).text("");
    let response = ui.add_enabled(obstacle.is_none(), slider);
    response.widget_info(|| egui::WidgetInfo::slider(obstacle.is_none(), place, "Place between poses"));
    let response =
        response.on_hover_text("Show a place between the poses").on_disabled_hover_text(obstacle.unwrap_or_default());
    if response.changed() {
        session.seek(place - 1.0);
    }
}

/// How many surfaces are there, as long as some are missing; why, if they will not come.
fn solved(ui: &mut Ui, session: &Session) {
    let Some(frames) = session.player().map(Player::frames) else { return };
    if let Some(why) = frames.failure() {
        ui.colored_label(ui.visuals().warn_fg_color, "cannot solve").on_hover_text(why);
    } else if frames.n_solved() < frames.len() {
        let text = format!("{:>3} of {}", frames.n_solved(), frames.len());
        ui.weak(text).on_hover_text("Surfaces between the poses that are solved so far");
    }
}
