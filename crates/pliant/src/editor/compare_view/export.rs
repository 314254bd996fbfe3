//! The comparison into one PNG: asks where, lets the window draw itself without the question, and cuts the grid out.

use std::path::PathBuf;
use std::sync::mpsc::{Receiver, Sender, channel};

use egui::{Button, ColorImage, Context, Id, Key, Modal, Rect, RichText, TextEdit};

use crate::editor::compare::{crop, write_picture};
use crate::editor::{NoticeKind, Session};

/// Frames without the question before the window is asked for its picture: the one that closes it, and one more for
/// what was behind it.
const FRAMES_TO_WAIT: u8 = 2;

/// What a thread has to tell.
enum Told {
    Chosen(PathBuf),
    Written(Result<PathBuf, String>),
}

#[derive(Default)]
enum Stage {
    #[default]
    Idle,
    /// The path as typed.
    Asking(String),
    /// Frames left before the picture is taken.
    Waiting(PathBuf, u8),
    Writing,
}

pub(super) struct Export {
    stage: Stage,
    sender: Sender<Told>,
    receiver: Receiver<Told>,
}

impl Default for Export {
    fn default() -> Export {
        let (sender, receiver) = channel();
        Export { stage: Stage::Idle, sender, receiver }
    }
}

impl Export {
    pub(super) fn is_asking(&self) -> bool {
        matches!(self.stage, Stage::Asking(_))
    }

    pub(super) fn is_busy(&self) -> bool {
        !matches!(self.stage, Stage::Idle)
    }

    /// The comparison was closed: nothing is left to be taken, and what is being written is written.
    pub(super) fn close(&mut self) {
        if !matches!(self.stage, Stage::Writing) {
            self.stage = Stage::Idle;
        }
    }

    /// Asks where, beginning with a name beside the mesh.
    pub(super) fn begin(&mut self, session: &Session) {
        let Some(model) = session.document().map(|document| document.model()) else { return };
        let name = format!("{}-methods.png", model.name);
        let folder = model.file.path.as_deref().and_then(|path| path.parent());
        let path = folder.map_or_else(|| PathBuf::from(&name), |folder| folder.join(&name));
        // A path that says where it is, wherever the program was started.
        let path = std::path::absolute(&path).unwrap_or(path);
        self.stage = Stage::Asking(path.display().to_string());
    }

    /// Takes what threads have to tell.
    pub(super) fn poll(&mut self, ctx: &Context, session: &mut Session) {
        while let Ok(told) = self.receiver.try_recv() {
            match told {
                Told::Chosen(path) if self.is_asking() => self.stage = Stage::Asking(path.display().to_string()),
                Told::Chosen(_) => {}
                Told::Written(outcome) => {
                    self.stage = Stage::Idle;
                    match outcome {
                        Ok(path) => session.notices.push(NoticeKind::Done, format!("Saved {}", path.display())),
                        Err(why) => session.notices.push(NoticeKind::Error, why),
                    }
                    ctx.request_repaint();
                }
            }
        }
    }

    /// Shows the question, or goes on to the picture of `grid`.
    pub(super) fn ask(&mut self, ctx: &Context, grid: Rect) {
        match std::mem::take(&mut self.stage) {
            Stage::Asking(path) => self.stage = question(ctx, path, &self.sender),
            Stage::Waiting(path, 0) => {
                take(ctx, grid, path, self.sender.clone());
                self.stage = Stage::Writing;
            }
            Stage::Waiting(path, left) => {
                self.stage = Stage::Waiting(path, left - 1);
                ctx.request_repaint();
            }
            other => self.stage = other,
        }
    }
}

fn question(ctx: &Context, mut path: String, sender: &Sender<Told>) -> Stage {
    let (mut save, mut cancel) = (false, false);
    let modal = Modal::new(Id::unique("picture of the comparison")).show(ctx, |ui| {
        ui.set_width(480.0_f32.min(ui.ctx().content_rect().width() - 48.0));
        ui.heading("Save a picture of the comparison");
        ui.label(RichText::new("All panes with their numbers, as they are on screen, in one PNG.").weak());
        ui.add_space(6.0);
        let entered = ui
            .horizontal(|ui| {
                let width = ui.available_width() - 90.0;
                let field = ui.add(TextEdit::singleline(&mut path).hint_text("Path").desired_width(width));
                let field = field.on_hover_text("Path of the picture");
                if ui.button("Browse…").on_hover_text("The platform's own file dialog").clicked() {
                    browse(ui.ctx(), &path, sender.clone());
                }
                field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
            })
            .inner;
        let typed = PathBuf::from(path.trim());
        let obstacle = obstacle(&typed);
        let note =
            if obstacle.is_empty() && typed.is_file() { "This file exists and will be replaced" } else { obstacle };
        ui.label(RichText::new(note).weak());
        ui.add_space(6.0);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let button = ui.add_enabled(obstacle.is_empty(), Button::new("Save")).on_disabled_hover_text(obstacle);
            save = button.clicked() || entered && obstacle.is_empty();
            cancel = ui.button("Cancel").on_hover_text("Write nothing (Esc)").clicked();
        });
    });
    match (save, cancel || modal.should_close()) {
        (true, _) => {
            ctx.request_repaint();
            Stage::Waiting(PathBuf::from(path.trim()), FRAMES_TO_WAIT)
        }
        (false, true) => Stage::Idle,
        (false, false) => Stage::Asking(path),
    }
}

/// Why nothing can be written there, if so.
fn obstacle(path: &std::path::Path) -> &'static str {
    let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if !is_png {
        "Type a path that ends with .png"
    } else if folder.is_some_and(|folder| !folder.is_dir()) {
        "This folder does not exist"
    } else {
        ""
    }
}

fn browse(ctx: &Context, path: &str, sender: Sender<Told>) {
    let name = PathBuf::from(path).file_name().map(|name| name.to_string_lossy().into_owned());
    let ctx = ctx.clone();
    let ask = move || {
        let dialog = rfd::FileDialog::new().add_filter("Pictures", &["png"]);
        if let Some(path) = dialog.set_file_name(name.unwrap_or_default()).save_file() {
            // Nobody listens any more once the window is closed.
            let _ = sender.send(Told::Chosen(path));
            ctx.request_repaint();
        }
    };
    if let Err(error) = std::thread::Builder::new().name("dialog".into()).spawn(ask) {
        log::warn!("no thread for the file dialog: {error}");
    }
}

/// Asks the window for its next picture; what lies in `grid` is written by a thread.
fn take(ctx: &Context, grid: Rect, to: PathBuf, sender: Sender<Told>) {
    let scale = ctx.pixels_per_point();
    let on_pixels = |value: f32| (value * scale).round().max(0.0) as usize;
    let part = [grid.left(), grid.top(), grid.width(), grid.height()].map(on_pixels);
    let again = ctx.clone();
    ctx.request_screenshot(move |image| {
        let report = sender.clone();
        let write = move || {
            let _ = sender.send(Told::Written(write(&image, part, to)));
            again.request_repaint();
        };
        if let Err(error) = std::thread::Builder::new().name("picture".into()).spawn(write) {
            let _ = report.send(Told::Written(Err(format!("no thread could be started: {error}"))));
        }
    });
}

fn write(image: &ColorImage, part: [usize; 4], to: PathBuf) -> Result<PathBuf, String> {
    let pixels: Vec<[u8; 4]> = image.pixels.iter().map(|color| color.to_array()).collect();
    let picture = crop(&pixels, image.size, part).ok_or("the window has no such part")?;
    write_picture(&picture, &to)?;
    Ok(to)
}
