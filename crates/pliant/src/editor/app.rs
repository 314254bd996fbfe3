//! The window: eframe's side of the editor.

mod files;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{CentralPanel, Frame, Margin, Panel};

use super::compare_view::CompareView;
use super::keyboard::Keyboard;
use super::panels::{self, Dialog, Loss};
use super::strip::{self, StripView};
use super::viewport_panel::ViewportPanel;
use super::{Job, NoticeKind, Opened, Sample, Session, theme};

/// Why the window could not be shown.
#[derive(Debug, thiserror::Error)]
pub enum EditorError {
    /// The window system or the graphics adapter refused.
    #[error("no window could be opened: {0}")]
    NoWindow(String),
    /// No graphics device.
    #[error("no graphics adapter was found")]
    NoAdapter,
    /// No thread for the solver.
    #[error("the solver thread could not be started: {0}")]
    NoThread(#[from] std::io::Error),
}

/// The application that eframe runs.
pub struct EditorApp {
    session: Session,
    viewport: ViewportPanel,
    compare: CompareView,
    strip: StripView,
    dialog: Dialog,
    keyboard: Keyboard,
    title: String,
    /// The user has agreed to lose changes by closing.
    may_close: bool,
    /// What to go on with once the mesh is written.
    after_save: Option<Loss>,
    /// A mesh that was opened while the document was changed further: shown when the user agrees.
    opened_meanwhile: Option<(Box<Opened>, Option<Sample>)>,
    last_frame: FrameWork,
}

/// Time that the last frame took in the window's own thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameWork {
    /// All of it.
    pub ui: Duration,
    /// The part spent in the renderer of the viewport.
    pub drawing: Duration,
}

impl EditorApp {
    /// Builds the application inside eframe. Opens the first of `files`, or the start sample. Nothing lasts beyond the
    /// window.
    pub fn new(cc: &eframe::CreationContext<'_>, files: Vec<PathBuf>) -> Result<EditorApp, EditorError> {
        EditorApp::remembering(cc, files, None)
    }

    /// The same with a folder for what lasts: settings, recent files, autosaves.
    pub fn remembering(
        cc: &eframe::CreationContext<'_>,
        files: Vec<PathBuf>,
        data: Option<&Path>,
    ) -> Result<EditorApp, EditorError> {
        let render_state = cc.wgpu_render_state.as_ref().ok_or(EditorError::NoAdapter)?;
        let ctx = cc.egui_ctx.clone();
        let mut session = Session::new(move || ctx.request_repaint())?;
        if let Some(data) = data {
            session.remember_in(data);
        }
        theme::apply(&cc.egui_ctx, session.look.theme);
        // Ours are actions in the table, with bounds of their own.
        cc.egui_ctx.options_mut(|options| options.zoom_with_keyboard = false);
        let mut files = files.into_iter();
        session.start(match files.next() {
            Some(path) => Job::Open(path),
            None => Job::OpenSample(Sample::Creature),
        });
        if files.next().is_some() {
            session.notices.push(NoticeKind::Warning, "Only the first of the files is opened: one mesh at a time");
        }
        Ok(EditorApp {
            session,
            viewport: ViewportPanel::new(render_state),
            compare: CompareView::default(),
            strip: StripView::default(),
            dialog: Dialog::None,
            keyboard: Keyboard::default(),
            title: String::new(),
            may_close: false,
            after_save: None,
            opened_meanwhile: None,
            last_frame: FrameWork::default(),
        })
    }

    /// The editor behind the window.
    pub fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    /// What the last frame cost.
    pub fn last_frame_work(&self) -> FrameWork {
        self.last_frame
    }

    pub(super) fn ask_how_to_export_poses(&mut self, _ctx: &egui::Context) {
        self.strip.begin_export(&self.session);
    }

    pub(super) fn show_keys(&mut self, _ctx: &egui::Context) {
        self.dialog = Dialog::Keys(panels::KeySheet::default());
    }

    pub(super) fn show_palette(&mut self, _ctx: &egui::Context) {
        self.dialog = Dialog::Palette(panels::Palette::default());
    }

    pub(super) fn show_what_rigidity_is(&mut self, _ctx: &egui::Context) {
        self.dialog = Dialog::WhatIsRigidity;
    }

    pub(super) fn show_about(&mut self, _ctx: &egui::Context) {
        self.dialog = Dialog::About;
    }
}

impl eframe::App for EditorApp {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.take_events(ctx);
        self.take_dropped(ctx);
        self.take_close(ctx);
        self.name_window(ctx);
        ctx.set_zoom_factor(self.session.habits.ui_scale());
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let begun = Instant::now();
        let ctx = ui.ctx().clone();
        let mut chosen = Vec::new();
        let is_asking = self.compare.is_asking() || self.strip.is_asking() || !self.session.recovery.is_empty();
        if self.dialog == Dialog::None && !is_asking {
            self.strip.take_keys(&ctx, &mut self.session);
            chosen.extend(self.keyboard.take(&ctx, &mut self.session, self.viewport.id));
        }
        let theme_before = self.session.look.theme;
        let bar = Frame::new().fill(ui.visuals().panel_fill).inner_margin(Margin::symmetric(8, 4));
        Panel::top("menu").frame(bar).show(ui, |ui| chosen.extend(panels::menu(ui, &mut self.session)));
        Panel::bottom("status").frame(bar).exact_size(58.0).show(ui, |ui| {
            panels::status(ui, &mut self.session, self.viewport.is_software);
        });
        let side = Frame::new().fill(ui.visuals().panel_fill).inner_margin(Margin::same(6));
        Panel::left("tools").frame(side).exact_size(72.0).resizable(false).show(ui, |ui| {
            panels::rail(ui, &mut self.session);
        });
        let wide = Frame::new().fill(ui.visuals().panel_fill).inner_margin(Margin::same(10));
        Panel::right("inspector").frame(wide).default_size(288.0).size_range(240.0..=420.0).show(ui, |ui| {
            chosen.extend(panels::inspector(ui, &mut self.session));
        });
        if self.session.advance_play(f64::from(ctx.input(|input| input.stable_dt))) {
            ctx.request_repaint();
        }
        self.strip.ask(&ctx, &mut self.session, &self.viewport);
        if self.session.strip_is_open() {
            Panel::bottom("poses").frame(bar).exact_size(strip::HEIGHT).resizable(false).show(ui, |ui| {
                chosen.extend(self.strip.show(ui, &mut self.session, &self.viewport));
            });
        }
        CentralPanel::no_frame().show(ui, |ui| {
            let around = self.compare.show(ui, &mut self.viewport, &mut self.session);
            panels::inspect(ui, around.picture, &mut self.session);
            panels::legend(ui, around.legend, &mut self.session);
            panels::learn(ui, around.messages, &mut self.session);
            if self.session.compare().is_none() {
                panels::welcome(ui, around.messages, &mut self.session);
            }
            panels::notices(ui, around.messages, &mut self.session);
        });
        for action in chosen {
            action.perform(self, &ctx);
        }
        if self.session.look.theme != theme_before {
            theme::apply(&ctx, self.session.look.theme);
        }
        if let Some(outcome) = self.dialog.show(&ctx, &mut self.session) {
            self.after_dialog(outcome, &ctx);
        } else if self.dialog == Dialog::None
            && let Some(file) = panels::recovery(&ctx, &mut self.session)
        {
            self.lose(Loss::Recover(file), &ctx);
        }
        // What was made early in this frame shows in the next what a click or a key did later in it.
        if ctx.input(|input| input.events.iter().any(|event| !matches!(event, egui::Event::PointerMoved(_)))) {
            ctx.request_repaint();
        }
        self.last_frame = FrameWork { ui: begun.elapsed(), drawing: self.viewport.drawing };
    }

    fn on_exit(&mut self) {
        self.session.end();
    }
}

/// Opens the window and runs until it is closed.
pub fn run(files: Vec<PathBuf>) -> Result<(), EditorError> {
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("Pliant")
            .with_app_id("pliant")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([720.0, 480.0]),
        ..Default::default()
    };
    let data = eframe::storage_dir("pliant");
    let create = |cc: &eframe::CreationContext<'_>| EditorApp::remembering(cc, files, data.as_deref());
    eframe::run_native("pliant", options, Box::new(|cc| Ok(Box::new(create(cc)?)))).map_err(why_no_window)
}

fn why_no_window(error: eframe::Error) -> EditorError {
    // The window system's own text names a file on the machine that built it.
    let no_display = if cfg!(target_os = "linux") {
        "no display: neither X11 nor Wayland can be reached"
    } else {
        "no display can be reached"
    };
    match error {
        eframe::Error::AppCreation(source) => match source.downcast::<EditorError>() {
            Ok(own) => *own,
            Err(other) => EditorError::NoWindow(other.to_string()),
        },
        eframe::Error::Winit(_) | eframe::Error::WinitEventLoop(_) => EditorError::NoWindow(no_display.into()),
        other => EditorError::NoWindow(other.to_string()),
    }
}
