//! All surfaces of a play, filled in by a thread while it plays.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::plan::n_ways;
use super::{Segment, inbetweens};
use crate::document::{KeptPose, Pose};
use crate::solving::{Groundwork, SolveRequest};
use crate::viewport::SurfaceFrame;

/// Surfaces between two poses: a second of film.
const BETWEEN: usize = 23;
/// Bytes of all surfaces together; fewer lie between two poses where they would take more.
const BUDGET_BYTES: usize = 512 << 20;
/// A position and a normal in single precision.
const BYTES_PER_VERTEX: usize = 24;

struct Shared {
    surfaces: Mutex<Surfaces>,
    is_over: AtomicBool,
}

struct Surfaces {
    list: Vec<Option<Arc<SurfaceFrame>>>,
    n_solved: usize,
    failure: Option<String>,
}

/// The surfaces of a play: the poses, and others between them. Dropped, its thread ends.
pub struct Frames {
    shared: Arc<Shared>,
    between: usize,
}

/// What frames are made from.
pub struct Source {
    /// In their order.
    pub poses: Arc<[KeptPose]>,
    /// Mesh, method and sizes.
    pub template: SolveRequest,
    /// What the editor's solver stands on, if it is there.
    pub ground: Option<Arc<Groundwork>>,
    /// Whether there are surfaces from the last pose back to the first.
    pub closed: bool,
}

impl Frames {
    /// Starts the thread. `wake` is called from it whenever there is another surface.
    pub fn start(
        Source { poses, template, ground, closed }: Source,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Frames> {
        let n_ways = n_ways(poses.len(), closed);
        let between = between((poses.len(), n_ways), template.model.mesh.n_vertices());
        let n = poses.len() + n_ways * between;
        let surfaces = Surfaces { list: vec![None; n], n_solved: 0, failure: None };
        let shared = Arc::new(Shared { surfaces: Mutex::new(surfaces), is_over: AtomicBool::new(false) });
        let theirs = shared.clone();
        let work = move || {
            let worked =
                catch_unwind(AssertUnwindSafe(|| fill(&theirs, (&poses, n_ways), (template, ground), between, &wake)));
            let failure = match worked {
                Ok(outcome) => outcome.err(),
                Err(_) => Some("it stopped unexpectedly; please report it".into()),
            };
            theirs.lock().failure = failure;
            wake();
        };
        std::thread::Builder::new().name("playing".into()).spawn(work)?;
        Ok(Frames { shared, between })
    }

    /// How many surfaces there are, solved or not.
    pub fn len(&self) -> usize {
        self.shared.lock().list.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Surfaces from one pose to the next.
    pub fn per_pose(&self) -> usize {
        self.between + 1
    }

    /// How many are solved.
    pub fn n_solved(&self) -> usize {
        self.shared.lock().n_solved
    }

    /// Why the others will not be, if they will not.
    pub fn failure(&self) -> Option<String> {
        self.shared.lock().failure.clone()
    }

    /// The surface of that number, or the nearest one before it that is solved.
    pub fn surface(&self, number: usize) -> Option<Arc<SurfaceFrame>> {
        let surfaces = self.shared.lock();
        let last = number.min(surfaces.list.len().checked_sub(1)?);
        surfaces.list[..=last].iter().rev().find_map(Clone::clone)
    }
}

impl Drop for Frames {
    fn drop(&mut self) {
        self.shared.is_over.store(true, Ordering::Relaxed);
    }
}

impl Shared {
    fn lock(&self) -> std::sync::MutexGuard<'_, Surfaces> {
        self.surfaces.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put(&self, number: usize, frame: Arc<SurfaceFrame>) {
        let mut surfaces = self.lock();
        surfaces.n_solved += usize::from(surfaces.list[number].replace(frame).is_none());
    }

    fn goes_on(&self) -> bool {
        !self.is_over.load(Ordering::Relaxed)
    }
}

/// Surfaces on each of so many ways between so many poses, of so many vertices each.
fn between((n_poses, n_ways): (usize, usize), n_vertices: usize) -> usize {
    let affordable = BUDGET_BYTES / (n_vertices.max(1) * BYTES_PER_VERTEX);
    (affordable.saturating_sub(n_poses) / n_ways.max(1)).clamp(1, BETWEEN)
}

fn fill(
    shared: &Shared,
    (poses, n_ways): (&[KeptPose], usize),
    (template, ground): (SolveRequest, Option<Arc<Groundwork>>),
    between: usize,
    wake: &dyn Fn(),
) -> Result<(), String> {
    let ground = ground.filter(|ground| ground.serves(&template));
    let ground = ground.unwrap_or_else(|| Arc::new(Groundwork::new(&template)));
    // The poses first: whatever comes between takes longer.
    for (k, kept) in poses.iter().enumerate() {
        let pose = Pose { positions: kept.positions.clone() };
        shared.put(k * (between + 1), Arc::new(ground.frame(&pose)));
    }
    wake();
    for k in 0..n_ways {
        let first = k * (between + 1) + 1;
        let mut put = |number: usize, solved: super::Solved| {
            shared.put(first + number, solved.frame);
            wake();
        };
        let segment = Segment::new(&poses[k], &poses[(k + 1) % poses.len()]);
        if inbetweens((&ground, &template), &segment, between, &|| shared.goes_on(), &mut put)?.is_none() {
            break;
        }
    }
    Ok(())
}
