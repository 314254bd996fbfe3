//! The editor without its window: what is open, which tool is in hand, what the solver said. Everything the window
//! does goes through here, and so can a test.

mod aside;
mod compare;
mod exporting;
mod handles;
mod hints;
mod inspect;
mod method;
mod paint;
mod playing;
mod poses;
mod project;
mod selection;
mod views;

pub use inspect::Inspection;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use glam::{DAffine3, Vec2};
use pliant_meshfile::{OpenOptions, Welding};
use pliant_solver::Rigidity;

use super::crossings::Search;
use super::jobs::{Jobs, Opened};
use super::measuring::Measuring;
use super::preparing::Preparing;
use super::{
    Autosave, Habits, Job, JobEvent, Learning, Leftover, Look, NoticeKind, Notices, Open, Preferences, Recent, Sample,
    Shown, Status, Trial, Welcome,
};
use crate::document::{Command, Document, History};
use crate::solving::{Measure, SolveReport, SolveRequest, Worker};
use crate::tools::{Context, Input, Marks, Options, Pivot, Tool, ToolKey, ToolKind, View};

/// Everything behind the window.
pub struct Session {
    open: Option<Open>,
    tool: Box<dyn Tool>,
    tool_kind: ToolKind,
    /// Settings of the tools.
    pub options: Options,
    /// Settings of the picture.
    pub look: Look,
    /// Messages on screen.
    pub notices: Notices,
    /// What the solver last said.
    pub status: Status,
    /// Which vertices of the next file become one point.
    pub welding: Welding,
    /// What belongs to the person.
    pub habits: Habits,
    /// Why the textures of what is open cannot be shown on this device, if so.
    pub textures_obstacle: Option<&'static str>,
    /// Rigidity being learned from poses, while its panel is open.
    pub learning: Option<Learning>,
    /// Methods side by side, while that is open.
    compare: Option<super::Compare>,
    typed_placement: handles::Typed,
    aside: aside::Aside,
    /// The strip of kept poses.
    strip: poses::Strip,
    playing: playing::Playing,
    exporting: Option<exporting::Exporting>,
    wake: Arc<dyn Fn() + Send + Sync>,
    viewport_size: Vec2,
    worker: Worker,
    jobs: Jobs,
    preparing: Preparing,
    measuring: Measuring,
    sent: Option<(u64, Option<Measure>, bool)>,
    shows_rest: bool,
    crossings: Search,
    welcome: Option<Welcome>,
    /// What lasts from one start to the next.
    pub preferences: Preferences,
    /// Files that were opened or saved lately.
    pub recent: Recent,
    /// Autosaves of windows that stopped, until the user has decided about them.
    pub recovery: Vec<Arc<Leftover>>,
    autosave: Option<Autosave>,
    history_budget: usize,
    /// What the preferences were last told.
    noted: Option<(Options, Look, usize, Recent, Habits)>,
    /// When preferences that were changed are written.
    preferences_due: Option<Instant>,
    /// A file that a panel wants to open: the window asks about unsaved changes first.
    wanted: Option<PathBuf>,
    /// Revision of the document when a job was started that will replace it.
    revision_at_open: u64,
}

impl Session {
    /// An empty session. `wake` is called from other threads when [`Session::poll`] has something to do.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> std::io::Result<Session> {
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(wake);
        let wake_worker = wake.clone();
        Ok(Session {
            open: None,
            tool: ToolKind::Handle.new_tool(),
            tool_kind: ToolKind::Handle,
            options: Options::default(),
            look: Look::default(),
            notices: Notices::default(),
            status: Status::default(),
            welding: Welding::Exact,
            habits: Habits::default(),
            textures_obstacle: None,
            learning: None,
            compare: None,
            typed_placement: None,
            aside: None,
            strip: poses::Strip::default(),
            playing: playing::Playing::default(),
            exporting: None,
            wake: wake.clone(),
            viewport_size: Vec2::new(800.0, 600.0),
            worker: Worker::start(move || wake_worker())?,
            preparing: Preparing::new(wake.clone()),
            measuring: Measuring::new(wake.clone()),
            jobs: Jobs::new(wake.clone()),
            sent: None,
            shows_rest: false,
            crossings: Search::new(wake),
            welcome: None,
            preferences: Preferences::default(),
            recent: Recent::default(),
            recovery: Vec::new(),
            autosave: None,
            history_budget: History::default().budget(),
            noted: None,
            preferences_due: None,
            wanted: None,
            revision_at_open: 0,
        })
    }

    /// What is open, if anything.
    pub fn open(&self) -> Option<&Open> {
        self.open.as_ref()
    }

    /// What is open, for camera and save path.
    pub fn open_mut(&mut self) -> Option<&mut Open> {
        self.open.as_mut()
    }

    /// The open document, if any.
    pub fn document(&self) -> Option<&Document> {
        self.open.as_ref().map(|open| &open.document)
    }

    /// Starts work in the background; [`Session::poll`] takes what it came to.
    pub fn start(&mut self, job: Job) {
        if matches!(job, Job::Open(_) | Job::OpenProject { .. } | Job::OpenSample(_)) {
            self.revision_at_open = self.document().map_or(0, Document::revision);
        }
        self.jobs.start(job, OpenOptions { welding: self.welding, keep: true });
    }

    /// How far the mesh is that is being opened, from 0 to 1, while one is.
    pub fn opening(&self) -> Option<f64> {
        self.jobs.opening()
    }

    /// Stops opening a mesh: the one on screen stays.
    pub fn cancel_opening(&mut self) {
        self.jobs.cancel_opening();
    }

    /// Whether a mesh is being written in the background.
    pub fn is_saving(&self) -> bool {
        self.jobs.is_saving()
    }

    /// What is being done in the background.
    pub fn running_job(&self) -> Option<&'static str> {
        self.jobs.running()
    }

    /// Shows a model that is already in memory.
    pub fn show(&mut self, mut opened: Opened, sample: Option<Sample>) {
        for warning in &opened.model.warnings {
            self.notices.push(NoticeKind::Warning, warning.clone());
        }
        self.options.fit_patch(f64::from(opened.model.diagonal()), opened.model.mean_edge());
        self.options.paint.fit(f64::from(opened.model.diagonal()), opened.model.mean_edge());
        self.options.gizmo.fit(f64::from(opened.model.diagonal()));
        self.typed_placement = None;
        self.aside = None;
        self.tool = self.tool_kind.new_tool();
        self.status = Status::default();
        self.learning = None;
        self.compare = None;
        self.measuring.forget();
        self.welcome_to(sample);
        self.take_settings(opened.restored.as_deref_mut());
        let origin = opened.restored.as_ref().map(|restored| restored.origin.clone());
        self.shows_rest = false;
        self.sent = None;
        self.open = Some(Open::new(opened, sample));
        self.arrived(origin);
        self.fit_strip();
        self.synchronize();
    }

    /// Takes what the solver and the jobs have to say. Returns requests for the window: paths chosen in dialogs.
    pub fn poll(&mut self) -> Vec<JobEvent> {
        self.prepare();
        if let Some(report) = self.worker.poll() {
            self.take_report(report);
        }
        if let Some(learning) = &mut self.learning {
            learning.poll();
        }
        self.poll_compare();
        self.poll_exporting();
        self.check_play();
        self.tick(Instant::now());
        self.look_for_crossings();
        self.measure();
        let mut for_window = Vec::new();
        while let Some(event) = self.jobs.poll() {
            match event {
                JobEvent::Opened { opened, sample } if self.has_new_changes() => {
                    for_window.push(JobEvent::Opened { opened, sample });
                }
                JobEvent::Opened { opened, sample } => {
                    self.notices.clear();
                    self.show(*opened, sample);
                }
                JobEvent::Saved { contents, to, warnings } => {
                    self.saved(&contents, &to, &warnings);
                    for_window.push(JobEvent::Saved { contents, to, warnings });
                }
                JobEvent::Exported { model, to, snapshot, warnings } => self.exported(&model, to, snapshot, &warnings),
                JobEvent::Leftovers(leftovers) => self.recovery = leftovers.into_iter().map(Arc::new).collect(),
                JobEvent::Failed { what, why } => {
                    self.notices.push(NoticeKind::Error, why.clone());
                    for_window.push(JobEvent::Failed { what, why });
                }
                JobEvent::Dismissed => {}
                JobEvent::NoDialog => self.notices.push(
                    NoticeKind::Warning,
                    "No file dialog answered on this machine: type the path instead, or drop a file on the window",
                ),
                event @ (JobEvent::ChosenToOpen(_)
                | JobEvent::ChosenPoses(..)
                | JobEvent::ChosenToSave(_)
                | JobEvent::MeshWanted { .. }) => {
                    for_window.push(event);
                }
            }
        }
        for_window
    }

    /// Whether the document was changed after the newest job that opens another was started.
    fn has_new_changes(&self) -> bool {
        self.document().is_some_and(|document| document.is_modified() && document.revision() != self.revision_at_open)
    }

    fn take_report(&mut self, report: SolveReport) {
        let Some(open) = &mut self.open else { return };
        if !open.document.accept(&report.model, report.epoch, report.pose.as_ref()) {
            return;
        }
        if let Some(frame) = &report.frame {
            open.surface.set_frame(frame.clone());
        }
        if let Some(why) = self.status.take(report) {
            self.notices.push(NoticeKind::Error, format!("Cannot solve: {why}"));
        }
    }

    /// Carries out a command; a refusal becomes a notice.
    pub fn apply(&mut self, command: Command) {
        if self.tool.waits_for_number() {
            self.input(Input::Key(ToolKey::Enter));
        }
        self.carry_out(command);
    }

    fn carry_out(&mut self, command: Command) {
        let Some(open) = &mut self.open else { return };
        if let Some(learning) = &mut self.learning
            && matches!(command, Command::Paint { .. } | Command::Fill { .. } | Command::FillAll(_))
        {
            learning.look_away();
        }
        if let Err(error) = open.document.apply(command) {
            self.notices.push(NoticeKind::Error, error.to_string());
        } else if let Some(welcome) = &mut self.welcome {
            let scene = open.document.scene();
            welcome.pulled |= scene.groups.iter().any(|group| group.motion != DAffine3::IDENTITY);
            welcome.painted |= scene.rigidity != open.document.model().rigidity;
        }
        self.synchronize();
    }

    /// Takes back the newest step.
    pub fn undo(&mut self) {
        let waits = self.tool.waits_for_number() && self.document().is_none_or(|document| !document.in_step());
        let is_step = self.tool.is_active() && !waits;
        self.cancel_tool();
        if is_step {
            // What was under way was the newest step.
        } else if let Some(open) = &mut self.open {
            let undone = open.document.undo().is_some();
            if let Some(welcome) = &mut self.welcome {
                welcome.undone |= undone;
            }
        }
        self.synchronize();
    }

    /// Makes the newest undone step again.
    pub fn redo(&mut self) {
        self.cancel_tool();
        if let Some(open) = &mut self.open {
            open.document.redo();
        }
        self.synchronize();
    }

    /// Sends the newest wish to the solver and shows a pose that jumped.
    fn synchronize(&mut self) {
        self.check_play();
        let energies = self.wants_energies();
        let Some(open) = &mut self.open else { return };
        open.catch_up();
        let wish = (open.document.revision(), self.look.color_by.measure(), energies);
        if self.sent != Some(wish) {
            self.sent = Some(wish);
            let request = SolveRequest::of(&open.document, wish.1);
            self.worker.request(SolveRequest { wants_energies: energies, ..request });
        }
        self.tell_compare();
    }

    /// Changes the picture's settings.
    pub fn set_look(&mut self, look: Look) {
        self.options.show_gizmo = look.handles;
        self.look = look;
        self.synchronize();
    }

    /// The tool in hand.
    pub fn tool_kind(&self) -> ToolKind {
        self.tool_kind
    }

    /// Takes another tool in hand; what the old one had under way is taken back.
    pub fn take_tool(&mut self, kind: ToolKind) {
        self.cancel_tool();
        self.tool_kind = kind;
        self.tool = kind.new_tool();
        self.synchronize();
    }

    fn cancel_tool(&mut self) {
        if self.tool.is_active() {
            self.input(Input::Key(ToolKey::Escape));
        }
    }

    /// Whether digits, signs and axis keys are for the tool now.
    pub fn tool_takes_numbers(&self) -> bool {
        self.tool.takes_numbers()
    }

    /// Passes input to the tool in hand and carries out what it wants.
    pub fn input(&mut self, input: Input) {
        if self.player().is_some() {
            // What is under the pointer is not what tools would work on: a press ends the play and does nothing else.
            if matches!(input, Input::Press(_)) {
                self.stop_playing();
            }
            return;
        }
        self.prepare();
        let Some(open) = &mut self.open else { return };
        let view = View { camera: open.camera, size: self.viewport_size };
        let mut context = Context {
            document: &open.document,
            view,
            surface: &mut open.surface,
            options: &self.options,
            prepared: &self.preparing.ready,
        };
        let reaction = self.tool.handle(input, &mut context);
        if let Some(r) = reaction.rigidity {
            self.options.rigidity = r;
        }
        if let Some(point) = reaction.pivot {
            self.options.gizmo.pivot = Pivot::Point(point);
        }
        for command in reaction.commands {
            self.carry_out(command);
        }
        self.tell_compare();
    }

    /// Asks the tool in hand about its looks.
    pub fn with_tool<T>(&mut self, ask: impl FnOnce(&dyn Tool, &Context<'_>) -> T) -> Option<T> {
        let open = self.open.as_mut()?;
        let view = View { camera: open.camera, size: self.viewport_size };
        let context = Context {
            document: &open.document,
            view,
            surface: &mut open.surface,
            options: &self.options,
            prepared: &self.preparing.ready,
        };
        Some(ask(&*self.tool, &context))
    }

    /// What the tool draws now.
    pub fn marks(&mut self) -> Marks {
        self.with_tool(|tool, context| tool.marks(context)).unwrap_or_default()
    }

    /// Whether a drag or stroke is under way.
    pub fn tool_is_active(&self) -> bool {
        self.tool.is_active()
    }

    /// Size of the viewport in points.
    pub fn viewport_size(&self) -> Vec2 {
        self.viewport_size
    }

    /// Tells the size of the viewport in points.
    pub fn set_viewport_size(&mut self, size: Vec2) {
        self.viewport_size = size.max(Vec2::ONE);
    }

    /// Sets the current r, kept within what the solver takes.
    pub fn choose_rigidity(&mut self, r: u16) {
        self.options.rigidity = r.clamp(1, Rigidity::MAX);
    }

    /// r that colors the surface: what is being learned, while it is looked at, else the document's.
    pub fn shown_rigidity(&self) -> Option<&Rigidity> {
        let trial = self.learning.as_ref().and_then(Learning::trial).filter(|trial| trial.shown != Shown::Now);
        trial.map(Trial::rigidity).or_else(|| self.document().map(|document| &document.scene().rigidity))
    }

    /// Opens the panel in which rigidity is learned from poses.
    pub fn open_learning(&mut self) {
        let Some(document) = self.open.as_ref().map(|open| &open.document) else { return };
        if self.learning.is_none() {
            let (model, weights) = (document.model().clone(), document.scene().weights);
            self.learning = Some(Learning::new(model, weights, self.wake.clone()));
        }
    }

    /// Begins to learn from the poses of the panel.
    pub fn start_learning(&mut self) {
        let weights = self.document().map(|document| document.scene().weights);
        if let (Some(learning), Some(weights)) = (&mut self.learning, weights) {
            learning.start_with(weights);
        }
    }

    /// Makes what was learned the rigidity of the surface, and closes the panel.
    pub fn apply_learned(&mut self) {
        let learned = self.learning.as_ref().and_then(Learning::trial).map(|trial| trial.rigidity().clone());
        if let Some(rigidity) = learned {
            self.learning = None;
            self.apply(Command::Learn(rigidity));
        }
    }

    /// Turns the camera so that the selection, or else the whole surface, fills the viewport.
    pub fn frame(&mut self) {
        if let Some(open) = &mut self.open {
            open.frame();
        }
    }
}
