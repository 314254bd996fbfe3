//! The question what kept poses are to be written as, and where.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};

use egui::{Button, ComboBox, Context, DragValue, Grid, Id, Key, Modal, RichText, TextEdit, Ui};

use super::super::Session;
use crate::posing::{Kind, MAX_BETWEEN, MAX_SIDE_PX, Plan};
use crate::viewport::{Coloring, ViewScene};

/// Smallest side of a picture on which anything can be seen (by eye).
const MIN_SIDE_PX: u32 = 16;
/// From a frame of film to ten minutes.
const SECONDS: std::ops::RangeInclusive<f64> = 0.04..=600.0;

/// The question, while it is asked.
pub(super) struct Question {
    plan: Plan,
    path: String,
    /// Files that exist, and for which plan and how many poses that was found out.
    existing: Option<(Plan, usize, usize)>,
    chosen: Option<Receiver<PathBuf>>,
}

/// What was answered.
pub(super) enum Answer {
    Export(Plan),
    Cancel,
}

impl Question {
    pub(super) fn new(session: &Session, kind: Kind) -> Question {
        let mut question = Question {
            plan: Plan {
                kind,
                to: PathBuf::new(),
                between: 11,
                seconds: session.pace().1,
                stepped: false,
                closed: session.pace().0.is_closed(),
                size: [1280, 720],
            },
            path: String::new(),
            existing: None,
            chosen: None,
        };
        question.propose(session);
        question
    }

    /// A name beside the mesh.
    fn propose(&mut self, session: &Session) {
        let Some(model) = session.document().map(|document| document.model()) else { return };
        let name = format!("{}-poses.{}", model.name, self.plan.kind.ending());
        let folder = model.file.path.as_deref().and_then(Path::parent);
        let path = folder.map_or_else(|| PathBuf::from(&name), |folder| folder.join(&name));
        self.path = path.display().to_string();
    }

    /// Shows it; returns the answer when there is one.
    pub(super) fn show(&mut self, ctx: &Context, session: &Session) -> Option<Answer> {
        if let Some(path) = self.chosen.as_ref().and_then(|chosen| chosen.try_recv().ok()) {
            self.path = path.display().to_string();
        }
        let mut answer = None;
        let modal = Modal::new(Id::unique("export poses")).show(ctx, |ui| {
            ui.set_width(480.0_f32.min(ui.ctx().content_rect().width() - 48.0));
            ui.heading("Export poses");
            self.kinds(ui, session);
            let entered = self.path(ui);
            self.plan.to = PathBuf::from(self.path.trim());
            ui.add_space(4.0);
            Grid::new("export")
                .num_columns(2)
                .spacing([16.0, 6.0])
                .show(ui, |ui| self.numbers(ui, session.poses().len()));
            ui.add_space(4.0);
            let n_poses = session.poses().len();
            let opened = session.document().and_then(|document| document.model().file.path.clone());
            let obstacle = self.plan.obstacle(n_poses, opened.as_deref());
            let note = obstacle.clone().unwrap_or_else(|| self.note(n_poses));
            ui.label(RichText::new(note).weak());
            ui.add_space(6.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let label = if self.existing.as_ref().is_some_and(|known| known.2 > 0) { "Replace" } else { "Export" };
                let button = ui.add_enabled(obstacle.is_none(), Button::new(label));
                let button = button.on_disabled_hover_text(obstacle.clone().unwrap_or_default());
                if button.on_hover_text("Write in the background").clicked() || entered && obstacle.is_none() {
                    answer = Some(Answer::Export(self.plan.clone()));
                }
                if ui.button("Cancel").on_hover_text("Write nothing (Esc)").clicked() {
                    answer = Some(Answer::Cancel);
                }
            });
        });
        answer.or_else(|| modal.should_close().then_some(Answer::Cancel))
    }

    fn kinds(&mut self, ui: &mut Ui, session: &Session) {
        let before = self.plan.kind;
        ui.horizontal(|ui| {
            for kind in Kind::ALL {
                ui.selectable_value(&mut self.plan.kind, kind, kind.label()).on_hover_text(kind.tooltip());
            }
        });
        if self.plan.kind != before {
            self.propose(session);
        }
        ui.label(RichText::new(self.plan.kind.tooltip()).weak());
        ui.add_space(4.0);
    }

    fn path(&mut self, ui: &mut Ui) -> bool {
        ui.horizontal(|ui| {
            let width = ui.available_width() - 90.0;
            let field = ui.add(TextEdit::singleline(&mut self.path).hint_text("Path").desired_width(width));
            if ui.button("Browse…").on_hover_text("The platform's own file dialog").clicked() {
                self.browse(ui.ctx());
            }
            field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
        })
        .inner
    }

    fn numbers(&mut self, ui: &mut Ui, n_poses: usize) {
        let plan = &mut self.plan;
        row(ui, "Behind the last pose", |ui| {
            let words = |closed: bool| if closed { "On to the first" } else { "Nothing" };
            ui.add_enabled_ui(n_poses > 1, |ui| {
                let combo = ComboBox::from_id_salt("behind the last").selected_text(words(plan.closed && n_poses > 1));
                let combo = combo.show_ui(ui, |ui| {
                    ui.selectable_value(&mut plan.closed, true, words(true));
                    ui.selectable_value(&mut plan.closed, false, words(false));
                });
                combo
                    .response
                    .on_hover_text("A loop goes on from the last pose to the first, and can be repeated without a jump")
                    .on_disabled_hover_text("Keep two poses or more to go from one to another");
            });
        });
        row(ui, "Frames between poses", |ui| {
            let field = DragValue::new(&mut plan.between).range(0..=MAX_BETWEEN).speed(0.1);
            ui.add(field).on_hover_text(
                "Handles are interpolated and the surface is solved, for each of them; 0 for the poses alone",
            );
        });
        row(ui, "From pose to pose", |ui| {
            let field = DragValue::new(&mut plan.seconds).range(SECONDS).speed(0.01).suffix(" s").fixed_decimals(2);
            ui.add_enabled(plan.kind == Kind::Animation, field)
                .on_hover_text("Time of the animation from one pose to the next")
                .on_disabled_hover_text("Files of a sequence have no time");
        });
        row(ui, "Between frames", |ui| {
            let words = |stepped: bool| if stepped { "Hold" } else { "Blend" };
            let tip = "What the animation shows between two frames: the one turning into the other, or the first until the second comes";
            ui.add_enabled_ui(plan.kind == Kind::Animation, |ui| {
                let combo =
                    ComboBox::from_id_salt("between frames").selected_text(words(plan.stepped)).show_ui(ui, |ui| {
                        ui.selectable_value(&mut plan.stepped, false, words(false));
                        ui.selectable_value(&mut plan.stepped, true, words(true));
                    });
                combo
                    .response
                    .on_hover_text(tip)
                    .on_disabled_hover_text("Only animations have something between frames");
            });
        });
        row(ui, "Picture size", |ui| {
            ui.add_enabled_ui(plan.kind == Kind::Pictures, |ui| {
                for (side, what) in plan.size.iter_mut().zip(["Width", "Height"]) {
                    let field = DragValue::new(side).range(MIN_SIDE_PX..=MAX_SIDE_PX).speed(1.0).suffix(" px");
                    ui.add(field).on_hover_text(what).on_disabled_hover_text("Only pictures have a size in pixels");
                }
            });
        });
    }

    /// What will be written; the folder is looked at only when something changed.
    fn note(&mut self, n_poses: usize) -> String {
        let known = self.existing.as_ref().filter(|(plan, n, _)| *plan == self.plan && *n == n_poses);
        let n_existing = match known {
            Some(&(_, _, n_existing)) => n_existing,
            None => {
                let n_existing = self.plan.n_existing(n_poses);
                self.existing = Some((self.plan.clone(), n_poses, n_existing));
                n_existing
            }
        };
        let files = self.plan.files(n_poses);
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let what = match &files[..] {
            [first, .., last] => format!("{} files, {} to {}", files.len(), name(first), name(last)),
            _ => format!("{} frames in one file", self.plan.n_frames(n_poses)),
        };
        match (n_existing, files.len()) {
            (0, _) => what,
            (_, 1) => format!("{what}; this file exists and will be replaced"),
            (n, _) => format!("{what}; {n} of them exist and will be replaced"),
        }
    }

    fn browse(&mut self, ctx: &Context) {
        let (sender, chosen) = channel();
        self.chosen = Some(chosen);
        let name = PathBuf::from(&self.path).file_name().map(|name| name.to_string_lossy().into_owned());
        let ctx = ctx.clone();
        let ask = move || {
            if let Some(path) = rfd::FileDialog::new().set_file_name(name.unwrap_or_default()).save_file() {
                // Nobody listens any more once the question is gone.
                let _ = sender.send(path);
                ctx.request_repaint();
            }
        };
        if let Err(error) = std::thread::Builder::new().name("dialog".into()).spawn(ask) {
            log::warn!("no thread for the file dialog: {error}");
        }
    }
}

fn row(ui: &mut Ui, label: &str, contents: impl FnOnce(&mut Ui)) {
    ui.label(label);
    ui.horizontal(contents);
    ui.end_row();
}

/// What pictures are drawn like: as in the viewport, without marks, and without colors that belong to one surface.
pub(super) fn look_of(shown: Option<&ViewScene>) -> Option<ViewScene> {
    let shown = shown?.clone();
    let coloring = match shown.coloring {
        Coloring::Energy | Coloring::Stretch => Coloring::Plain,
        other => other,
    };
    let nothing = ViewScene { coloring, values: None, selected: None, locked: None, preview: None, ..shown };
    Some(ViewScene { dots: [].into(), lines: [].into(), pixels_per_point: 1.0, ..nothing })
}
