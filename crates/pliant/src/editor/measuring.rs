//! The way from one vertex to another along the surface, found on a thread of its own: on a million vertices a front that
//! has to pass all of them takes a second.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use pliant_geometry::Growth;
use pliant_solver::VertexId;

use crate::tools::{Card, Surface};
use crate::viewport::SurfaceFrame;

/// Vertices that the front passes before it asks whether it is still wanted: some milliseconds.
const SLICE: usize = 20_000;
/// How far the front goes at first, and then, in straight distances: most ways are hardly longer than the straight one.
const REACHES: [f32; 4] = [1.1, 2.0, 5.0, f32::INFINITY];

/// What is known of the way along the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// It is being measured.
    UnderWay,
    /// As long as this, view units.
    Far(f32),
    /// There is none: the vertices are in separate parts.
    Apart,
}

/// What was asked: both ends, on this surface.
struct Question {
    ends: [VertexId; 2],
    frame: Arc<SurfaceFrame>,
}

/// Answers one question at a time; a newer one about other ends replaces it.
pub(super) struct Measuring {
    wake: Arc<dyn Fn() + Send + Sync>,
    running: Option<(Question, Receiver<Along>, Stop)>,
    answered: Option<(Question, Along)>,
}

/// Ends the thread when it is dropped.
struct Stop(Arc<AtomicBool>);

impl Drop for Stop {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

impl Measuring {
    pub(super) fn new(wake: Arc<dyn Fn() + Send + Sync>) -> Measuring {
        Measuring { wake, running: None, answered: None }
    }

    /// Nothing is asked any more.
    pub(super) fn forget(&mut self) {
        (self.running, self.answered) = (None, None);
    }

    /// Asks for the way between two vertices, unless that is being found, or known for the surface as it is. A surface that
    /// moves is measured again once it `rests`.
    pub(super) fn ask(&mut self, [from, to]: [Card; 2], surface: &Surface, rests: bool) {
        self.take_answer();
        let ends = [from.vertex, to.vertex];
        self.running.take_if(|(question, ..)| question.ends != ends);
        self.answered.take_if(|(question, _)| question.ends != ends);
        let is_known =
            self.answered.as_ref().is_some_and(|(question, _)| !rests || Arc::ptr_eq(&question.frame, surface.frame()));
        if self.running.is_some() || is_known {
            return;
        }
        let question = Question { ends, frame: surface.frame().clone() };
        match surface.front_from(from) {
            Some(front) => self.start(question, front, surface.triangles().clone()),
            None => self.answered = Some((question, Along::Apart)),
        }
    }

    /// What is known of the way between these.
    pub(super) fn answer(&self, ends: [VertexId; 2]) -> Option<Along> {
        let known = self.answered.as_ref().filter(|(question, _)| question.ends == ends).map(|&(_, along)| along);
        let is_asked = self.running.as_ref().is_some_and(|(question, ..)| question.ends == ends);
        known.or_else(|| is_asked.then_some(Along::UnderWay))
    }

    fn take_answer(&mut self) {
        let Some((_, receiver, _)) = &self.running else { return };
        let answer = match receiver.try_recv() {
            Ok(answer) => answer,
            Err(TryRecvError::Empty) => return,
            // The thread could not be started, or came to grief.
            Err(TryRecvError::Disconnected) => Along::Apart,
        };
        self.answered = self.running.take().map(|(question, ..)| (question, answer));
    }

    fn start(&mut self, question: Question, front: Growth, triangles: Arc<[[u32; 3]]>) {
        let (sender, receiver) = channel();
        let stop = Arc::new(AtomicBool::new(false));
        let (frame, to, is_unwanted, wake) = (question.frame.clone(), question.ends, stop.clone(), self.wake.clone());
        let work = move || {
            if let Some(along) = measure(front, &frame, &triangles, to, &is_unwanted) {
                // Nobody listens any more once other ends are asked about.
                let _ = sender.send(along);
                wake();
            }
        };
        // If no thread can be started, the sender is dropped with its work.
        let _ = std::thread::Builder::new().name("measure".into()).spawn(work);
        self.running = Some((question, receiver, Stop(stop)));
    }
}

/// Sends the front on until it has passed the end; `None` when nobody wants to know any more.
fn measure(
    mut front: Growth,
    frame: &SurfaceFrame,
    triangles: &[[u32; 3]],
    [from, to]: [VertexId; 2],
    is_unwanted: &AtomicBool,
) -> Option<Along> {
    let straight = frame.positions[from.index()].distance(frame.positions[to.index()]);
    for reach in REACHES {
        let radius = reach * straight.max(f32::MIN_POSITIVE);
        while !front.grow(&frame.positions, triangles, radius, SLICE) {
            if is_unwanted.load(Ordering::Relaxed) {
                return None;
            }
        }
        let reached = front.reached().find(|&(v, distance)| v == to.0 && distance <= radius);
        if let Some((_, distance)) = reached.filter(|(_, distance)| distance.is_finite()) {
            return Some(Along::Far(distance));
        }
    }
    Some(Along::Apart)
}
