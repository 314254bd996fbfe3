//! What tools need to know of the whole mesh, found in the background: one thread for each kind of answer, and only the
//! newest question is asked once the last is answered.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use pliant_geometry::FacePatches;

use crate::document::Model;
use crate::tools::{FillBoundary, Mirror, MirrorKind, MirrorOptions, Options, Prepared, ToolKind};

/// Finds what is prepared for the tools.
pub(super) struct Preparing {
    /// What has been found.
    pub(super) ready: Prepared,
    mirror: Finding<MirrorOptions, Mirror>,
    patches: Finding<f32, FacePatches>,
    /// Counts answers, so that a resting pointer can be told.
    n_answers: u64,
    wake: Arc<dyn Fn() + Send + Sync>,
}

/// A question about a model, under these options.
#[derive(Clone)]
struct Question<O> {
    model: Arc<Model>,
    options: O,
}

impl<O: PartialEq> Question<O> {
    fn is(&self, model: &Arc<Model>, options: &O) -> bool {
        Arc::ptr_eq(&self.model, model) && self.options == *options
    }
}

/// The last answer, and the question under way.
struct Finding<O, T> {
    /// `None` as an answer: finding it failed.
    known: Option<(Question<O>, Option<Arc<T>>)>,
    running: Option<(Question<O>, Receiver<T>)>,
}

impl<O, T> Default for Finding<O, T> {
    fn default() -> Self {
        Finding { known: None, running: None }
    }
}

impl<O: Clone + PartialEq + Send + 'static, T: Send + 'static> Finding<O, T> {
    /// Asks, unless that is answered or being asked. While another question is under way this one waits its turn.
    fn want(
        &mut self,
        model: &Arc<Model>,
        options: &O,
        wake: &Arc<dyn Fn() + Send + Sync>,
        find: impl FnOnce(&Model, &O) -> T + Send + 'static,
    ) {
        let is_known = self.known.as_ref().is_some_and(|(question, _)| question.is(model, options));
        if is_known || self.running.is_some() {
            return;
        }
        let question = Question { model: model.clone(), options: options.clone() };
        let (sender, receiver) = channel();
        let (asked, wake) = (question.clone(), wake.clone());
        let work = move || {
            let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| find(&asked.model, &asked.options)));
            if let Ok(found) = found {
                // Nobody listens any more once the window is closed.
                let _ = sender.send(found);
            }
            drop(sender);
            wake();
        };
        match std::thread::Builder::new().name("prepare".into()).spawn(work) {
            Ok(_) => self.running = Some((question, receiver)),
            Err(_) => self.known = Some((question, None)),
        }
    }

    /// Takes an answer that has come. Whether there was one.
    fn poll(&mut self) -> bool {
        let Some((_, receiver)) = &self.running else { return false };
        let answer = match receiver.try_recv() {
            Ok(found) => Some(Arc::new(found)),
            Err(TryRecvError::Disconnected) => None,
            Err(TryRecvError::Empty) => return false,
        };
        self.known = self.running.take().map(|(question, _)| (question, answer));
        true
    }

    /// The answer to a question, if it is known.
    fn answer(&self, model: &Arc<Model>, options: &O) -> Option<Arc<T>> {
        let (question, answer) = self.known.as_ref()?;
        answer.clone().filter(|_| question.is(model, options))
    }

    fn is_running(&self) -> bool {
        self.running.is_some()
    }
}

impl Preparing {
    /// Nothing found. `wake` is called from other threads when there is something to poll.
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Preparing {
        Preparing {
            ready: Prepared::default(),
            mirror: Finding::default(),
            patches: Finding::default(),
            n_answers: 0,
            wake,
        }
    }

    /// Takes what has been found, and asks for what the tools need now.
    pub(super) fn prepare(&mut self, model: &Arc<Model>, options: &Options, tool: ToolKind) {
        let paint = &options.paint;
        self.n_answers += u64::from(self.mirror.poll()) + u64::from(self.patches.poll());
        self.ready = Prepared::default();
        if paint.mirror.kind != MirrorKind::Off {
            self.mirror.want(model, &paint.mirror, &self.wake, Mirror::find);
            self.ready.mirror = self.mirror.answer(model, &paint.mirror);
        }
        if tool == ToolKind::Fill && paint.boundary == FillBoundary::SharpEdges {
            self.patches.want(model, &paint.sharp_degrees, &self.wake, |model, &degrees| {
                FacePatches::new(model.mesh.positions(), &model.triangles, f64::from(degrees).to_radians())
            });
            self.ready.patches = self.patches.answer(model, &paint.sharp_degrees);
        }
    }

    /// Whether something is being found.
    pub(super) fn is_busy(&self) -> bool {
        self.mirror.is_running() || self.patches.is_running()
    }

    /// Goes up with every answer.
    pub(super) fn n_answers(&self) -> u64 {
        self.n_answers
    }
}
