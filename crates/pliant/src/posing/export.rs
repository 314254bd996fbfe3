//! Kept poses into files. A set of files is written beside its place and moved there when it is whole: stopped before, it
//! leaves nothing behind.

mod sequence;
mod staging;

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec3;
use pliant_meshfile::{MorphShape, Morphs};

use super::{Kind, Plan, Segment, Solved, inbetweens};
use crate::document::{KeptPose, Pose};
use crate::solving::{Groundwork, SolveRequest};
use crate::viewport::ViewScene;

/// Everything an export needs; nothing of it changes while it runs.
pub struct Export {
    /// What, and where.
    pub plan: Plan,
    /// In their order.
    pub poses: Arc<[KeptPose]>,
    /// Mesh, method and sizes.
    pub template: SolveRequest,
    /// What the editor's solver stands on, if it is there.
    pub ground: Option<Arc<Groundwork>>,
    /// How pictures look; none where none are drawn.
    pub look: Option<ViewScene>,
}

/// It was stopped, and nothing was written.
#[derive(Debug, PartialEq, Eq)]
pub struct Canceled;

/// Is told the fraction that is done, and says whether to go on.
pub(super) type Progress<'a> = dyn Fn(f64) -> bool + Sync + 'a;

/// Writes everything. Returns what a person should know.
///
/// # Errors
/// Why nothing was written.
pub fn export(work: &Export, progress: &Progress<'_>) -> Result<Result<Vec<String>, Canceled>, String> {
    let n = work.poses.len();
    if let Some(why) = work.plan.obstacle(n, work.template.model.file.path.as_deref()) {
        return Err(why);
    }
    match work.plan.kind {
        Kind::Animation => animation(work, progress),
        Kind::Meshes => sequence::meshes(work, progress),
        Kind::Pictures => sequence::pictures(work, progress),
    }
}

/// r as it is saved: none for a file that never had any and needs none.
fn rigidity(work: &Export) -> Option<&[u16]> {
    let rigidity = &work.template.rigidity;
    (rigidity.max() > 1 || work.template.model.file.rigidity.is_some()).then(|| rigidity.as_slice())
}

/// Tells every frame in order: the poses, and the surfaces solved between them. `None` if `frame` broke or it was stopped.
pub(super) fn each_frame(
    work: &Export,
    progress: &Progress<'_>,
    frame: &mut dyn FnMut(usize, Solved) -> ControlFlow<()>,
) -> Result<Option<()>, String> {
    let ground = work.ground.clone().filter(|ground| ground.serves(&work.template));
    let ground = ground.unwrap_or_else(|| Arc::new(Groundwork::new(&work.template)));
    let (between, total) = (work.plan.between, work.plan.n_frames(work.poses.len()));
    let fraction = |number: usize| number as f64 / total.max(1) as f64;
    for (k, kept) in work.poses.iter().enumerate() {
        let first = k * (between + 1);
        let pose = Pose { positions: kept.positions.clone() };
        let picture = Arc::new(ground.frame(&pose));
        if !progress(fraction(first)) || frame(first, Solved { pose, frame: picture }).is_break() {
            return Ok(None);
        }
        let Some(next) = work.plan.next(k, work.poses.len()).filter(|_| between > 0) else { continue };
        let at = std::sync::atomic::AtomicUsize::new(first);
        let broke = std::sync::atomic::AtomicBool::new(false);
        let order = std::sync::atomic::Ordering::Relaxed;
        let goes_on = || !broke.load(order) && progress(fraction(at.load(order)));
        let mut each = |number: usize, solved: Solved| {
            at.store(first + 1 + number, order);
            if frame(first + 1 + number, solved).is_break() {
                broke.store(true, order);
            }
        };
        let segment = Segment::new(kept, &work.poses[next]);
        let solved = inbetweens((&ground, &work.template), &segment, between, &goes_on, &mut each)?;
        if solved.is_none() || broke.load(order) {
            return Ok(None);
        }
    }
    Ok(Some(()))
}

/// Share of solving in the work of an animation, where there is something to solve (by eye).
const SOLVING: f64 = 0.7;

fn animation(work: &Export, progress: &Progress<'_>) -> Result<Result<Vec<String>, Canceled>, String> {
    let mut frames: Vec<Arc<[DVec3]>> = Vec::new();
    let share = if work.plan.between > 0 { SOLVING } else { 0.0 };
    let mut keep = |_: usize, solved: Solved| {
        frames.push(solved.pose.positions);
        ControlFlow::Continue(())
    };
    if each_frame(work, &|done| progress(done * share), &mut keep)?.is_none() {
        return Ok(Err(Canceled));
    }
    let names: Vec<String> = (0..frames.len()).map(|number| name(work, number)).collect();
    let shapes: Vec<MorphShape<'_>> =
        frames.iter().zip(&names).map(|(points, name)| MorphShape { name, points }).collect();
    // A loop ends as it begins.
    let keys: Vec<(f32, Option<usize>)> =
        work.plan.times(work.poses.len()).enumerate().map(|(k, time)| (time as f32, Some(k % frames.len()))).collect();
    let morphs = Morphs { shapes: &shapes, animation: "Poses", keys: &keys, stepped: work.plan.stepped };
    let mut watch = |done: f64| match progress(share + (1.0 - share) * done) {
        true => ControlFlow::Continue(()),
        false => ControlFlow::Break(()),
    };
    let saved = work.template.model.file.save_morphs(&work.plan.to, rigidity(work), &morphs, &mut watch);
    let warnings = saved.map_err(|error| error.to_string())?;
    Ok(warnings.map(|warnings| warnings.iter().map(ToString::to_string).collect()).ok_or(Canceled))
}

/// A pose by its name, and what lies between two by how far it is.
fn name(work: &Export, number: usize) -> String {
    let (pose, step) = (number / (work.plan.between + 1), number % (work.plan.between + 1));
    let from = &work.poses[pose].name;
    match work.plan.next(pose, work.poses.len()).filter(|_| step > 0) {
        Some(to) => format!("{from} to {} {step}/{}", work.poses[to].name, work.plan.between + 1),
        None => from.clone(),
    }
}
