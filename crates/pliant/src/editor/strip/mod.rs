//! The strip of kept poses on screen: a card for each, and what can be done with them.

mod card;
mod export;
mod keys;
mod playing;
mod thumbnails;

use egui::{Align, Button, Layout, ProgressBar, RichText, ScrollArea, Ui};

use super::viewport_panel::ViewportPanel;
use super::{Action, Session};
use crate::document::{Command, PoseChange, PoseId};
use crate::posing::Kind;
use export::{Answer, Question};
use thumbnails::Thumbnails;

/// Height of the strip: a row of buttons and a row of cards, in points.
pub(super) const HEIGHT: f32 = 138.0;

/// What the window remembers of the strip.
#[derive(Default)]
pub(super) struct StripView {
    thumbnails: Thumbnails,
    /// The name being typed.
    renaming: Option<(PoseId, String)>,
    question: Option<Question>,
    /// The card that had the focus in the last frame, and the pose whose card is to have it next.
    focused: Option<(egui::Id, PoseId)>,
    wanted: Option<PoseId>,
}

impl StripView {
    /// Whether a dialog of the strip has the keyboard.
    pub(super) fn is_asking(&self) -> bool {
        self.question.is_some()
    }

    /// Asks what the poses are to be written as.
    pub(super) fn begin_export(&mut self, session: &Session) {
        self.question = Some(Question::new(session, Kind::Animation));
    }

    /// Shows that question, and begins what is answered.
    pub(super) fn ask(&mut self, ctx: &egui::Context, session: &mut Session, viewport: &ViewportPanel) {
        match self.question.as_mut().and_then(|question| question.show(ctx, session)) {
            Some(Answer::Export(plan)) => {
                self.question = None;
                let look = export::look_of(viewport.shown());
                session.export_poses(plan, look);
            }
            Some(Answer::Cancel) => self.question = None,
            None => {}
        }
    }

    /// Fills `ui` with the strip; returns the actions that were chosen.
    pub(super) fn show(&mut self, ui: &mut Ui, session: &mut Session, viewport: &ViewportPanel) -> Vec<Action> {
        let mut chosen = Vec::new();
        ui.horizontal(|ui| {
            // *Hide* stays in sight, however narrow the window.
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let hide = ui.button("Hide").on_hover_text("Hide the strip; the poses stay (Pose › Strip of poses)");
                if hide.clicked() {
                    session.toggle_strip();
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let row = ScrollArea::horizontal().id_salt("pose buttons").auto_shrink([false, true]);
                    row.show(ui, |ui| ui.horizontal(|ui| self.buttons(ui, session, &mut chosen)));
                });
            });
        });
        self.thumbnails.poll(ui.ctx(), session.poses());
        ScrollArea::horizontal().id_salt("poses").auto_shrink([false, false]).show(ui, |ui| {
            ui.horizontal_top(|ui| self.cards(ui, session, viewport));
        });
        chosen
    }

    fn buttons(&mut self, ui: &mut Ui, session: &mut Session, chosen: &mut Vec<Action>) {
        for action in [Action::KEEP_POSE, Action::UPDATE_POSE, Action::DELETE_POSE] {
            if super::panels::action_button(ui, session, action).clicked() {
                chosen.push(action);
            }
        }
        for (label, action) in [("<", Action::POSE_EARLIER), (">", Action::POSE_LATER)] {
            let obstacle = action.obstacle(session);
            let button = ui.add_enabled(obstacle.is_none(), Button::new(label));
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, action.label()));
            let button = button.on_hover_text(action.tooltip()).on_disabled_hover_text(obstacle.unwrap_or_default());
            if button.clicked() {
                chosen.push(action);
            }
        }
        ui.separator();
        playing::controls(ui, session, chosen);
        ui.separator();
        export_or_progress(ui, session, chosen);
    }

    fn cards(&mut self, ui: &mut Ui, session: &mut Session, viewport: &ViewportPanel) {
        let poses = session.document().map(|document| document.scene().poses.clone()).unwrap_or_default();
        if poses.is_empty() {
            let text = "No poses yet: bend the surface, then keep the pose. Two or more can be played and exported.";
            ui.label(RichText::new(text).weak());
            return;
        }
        let shown = session.document().and_then(|document| document.scene().pose_shown()).map(|kept| kept.id);
        let marked = session.chosen_pose().map(|kept| kept.id);
        let mut wish = None;
        let (wanted, mut focused) = (self.wanted.take(), None);
        for (place, kept) in poses.iter().enumerate() {
            let picture = self.thumbnails.picture_of(ui.ctx(), kept, session, viewport);
            let is = |id: Option<PoseId>| id == Some(kept.id);
            let (is_wanted, is_shown, is_chosen) = (is(wanted), is(shown), is(marked));
            let state = card::State { is_wanted, is_shown, is_chosen, place };
            let (response, wished) = card::show(ui, kept, picture, state, &mut self.renaming);
            wish = wished.or(wish);
            if response.has_focus() || is_wanted {
                keys::keep_arrows(ui.ctx(), response.id);
                focused = Some((response.id, kept.id));
            }
        }
        self.focused = focused;
        match wish {
            Some(card::Wish::Show(id)) => session.show_pose(id),
            Some(card::Wish::Change(change)) => session.apply(Command::Poses(change)),
            Some(card::Wish::Rename(id)) => {
                let name = poses.iter().find(|kept| kept.id == id).map(|kept| kept.name.clone());
                self.renaming = name.map(|name| (id, name));
            }
            Some(card::Wish::Named(id, name)) => {
                (self.renaming, self.wanted) = (None, Some(id));
                session.apply(Command::Poses(PoseChange::Rename(id, name)));
            }
            Some(card::Wish::NotNamed) => self.wanted = self.renaming.take().map(|(id, _)| id),
            None => {}
        }
    }
}

fn export_or_progress(ui: &mut Ui, session: &mut Session, chosen: &mut Vec<Action>) {
    let Some(done) = session.exporting_poses() else {
        if super::panels::action_button(ui, session, Action::EXPORT_POSES).clicked() {
            chosen.push(Action::EXPORT_POSES);
        }
        return;
    };
    ui.add(ProgressBar::new(done as f32).desired_width(90.0).show_percentage());
    if ui.button("Cancel").on_hover_text("Stop the export: no file is written").clicked() {
        session.cancel_exporting_poses();
    }
}
