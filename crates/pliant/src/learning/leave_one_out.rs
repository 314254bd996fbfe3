//! Whether learned rigidity is worth having: every pose is predicted from what the others teach.
//!
//! One pose is left out, r is learned from the rest, and a few patches of the surface are held where the pose has them. The
//! solver finds the other vertices with the learned r, and with the same r everywhere, r = 1 (as-rigid-as-possible
//! deformation as it was before) among them. The distance from where the pose really has them, averaged over vertices and
//! over the poses left out, tells which rigidity understood the shape best.

use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use glam::DVec3;
use pliant_solver::{
    Analysis, LearnError, LooseComponents, Minimizer, Neighborhoods, PoseLearner, Rigidity, SolveError, Solver, Start,
    VertexId,
};

use super::Progress;
use super::patches::spread_patches;

/// What is compared, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The sizes to learn from, and the same everywhere to compare with.
    pub range: RangeInclusive<u16>,
    /// The sizes among which r is chosen, if not all of `range`.
    pub chosen: Option<RangeInclusive<u16>>,
    /// Rounds of smoothing of what was learned, 0 for none.
    pub smoothing: usize,
    /// ω; `None` chooses it anew for every pose left out, from the other poses.
    pub omega: Option<f64>,
    /// Patches of a vertex and its neighbors that are held.
    pub n_patches: usize,
    /// The poses to leave out, by their number; `None` for all, one after the other.
    pub left_out: Option<Vec<usize>>,
}

impl Default for Options {
    /// The paper's r from 1 to 6, 25 patches, every pose.
    fn default() -> Options {
        Options { range: 1..=6, chosen: None, smoothing: 0, omega: None, n_patches: 25, left_out: None }
    }
}

/// How one pose was predicted.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// The pose left out.
    pub pose: usize,
    /// ω with which r was learned from the others.
    pub omega: f64,
    /// With learned r.
    pub learned: Outcome,
    /// With the same r everywhere.
    pub uniform: Vec<(u16, Outcome)>,
}

/// How near one solution came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Mean distance of a vertex from its place in the pose, in diagonals of the reference's bounding box.
    pub error: f64,
    /// Iterations until the energy had stopped falling.
    pub iterations: u64,
}

/// All predictions.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Vertices that were held.
    pub n_held: usize,
    /// One per pose left out.
    pub predictions: Vec<Prediction>,
}

impl Report {
    /// Mean error with learned r over all poses left out.
    pub fn learned(&self) -> f64 {
        self.mean(|prediction| prediction.learned.error)
    }

    /// Mean error with each r everywhere, by ascending r.
    pub fn uniform(&self) -> Vec<(u16, f64)> {
        let sizes = self.predictions.first().map_or(&[][..], |first| &first.uniform);
        let mean = |(place, &(r, _)): (usize, &(u16, Outcome))| (r, self.mean(|p| p.uniform[place].1.error));
        sizes.iter().enumerate().map(mean).collect()
    }

    fn mean(&self, error: impl Fn(&Prediction) -> f64) -> f64 {
        self.predictions.iter().map(error).sum::<f64>() / self.predictions.len() as f64
    }
}

/// Why nothing could be compared.
#[derive(Debug, thiserror::Error)]
pub enum LeaveOneOutError {
    /// Nothing would be left to learn from.
    #[error("leaving one pose out needs two poses besides the reference, there are {0}: add poses")]
    TooFewPoses(usize),
    /// [`Options::left_out`] is empty.
    #[error("no pose is to be left out; name at least one")]
    NothingLeftOut,
    /// A number in [`Options::left_out`].
    #[error("there is no pose {pose} to leave out: there are {n_poses}, counted from 0")]
    NoSuchPose {
        /// The number.
        pose: usize,
        /// How many there are.
        n_poses: usize,
    },
    /// The surface has no extent to measure errors by.
    #[error("the reference is a single point: choose another reference")]
    Pointlike,
    /// A pose, or the range of r, cannot be learned from.
    #[error(transparent)]
    Learn(#[from] LearnError),
    /// A prediction could not be set up.
    #[error(transparent)]
    Solve(#[from] SolveError),
}

/// Predicts each pose from the others; poses are in the numbering of the analyzed mesh, which is the reference. The
/// poses' place in space does not matter, their scale does.
///
/// # Errors
/// Any [`LeaveOneOutError`].
pub fn leave_one_out<P: AsRef<[DVec3]>>(
    analysis: &Arc<Analysis>,
    poses: &[P],
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<ControlFlow<(), Report>, LeaveOneOutError> {
    let left_out = left_out(poses.len(), options)?;
    let mut share = Share { progress, from: 0.0, to: LEARNING };
    let learned = match learn(analysis, poses, options, &left_out, &mut share)? {
        ControlFlow::Continue(learned) => learned,
        ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
    };
    let mut judge = Judge::new(analysis, options.n_patches)?;
    // All poses with learned r, then with one r after the other: a matrix is factored once for each uniform r.
    let columns: Vec<Option<u16>> = [None].into_iter().chain(options.range.clone().map(Some)).collect();
    let n_trials = columns.len() * learned.len();
    let mut outcomes = Vec::with_capacity(n_trials);
    for column in &columns {
        for (&pose, (_, rigidity)) in left_out.iter().zip(&learned) {
            let rigidity = match *column {
                None => rigidity.clone(),
                Some(r) => Rigidity::uniform(analysis.mesh().n_vertices(), r),
            };
            share.narrow(outcomes.len(), n_trials);
            match judge.predict(&rigidity, poses[pose].as_ref(), &mut share)? {
                ControlFlow::Continue(outcome) => outcomes.push(outcome),
                ControlFlow::Break(()) => return Ok(ControlFlow::Break(())),
            }
        }
    }
    let of_pose = |(place, (&pose, &(omega, _))): (usize, (&usize, &(f64, Rigidity)))| {
        let of_columns = columns.iter().zip(outcomes.iter().skip(place).step_by(learned.len()));
        let uniform = of_columns.filter_map(|(column, &outcome)| Some(((*column)?, outcome))).collect();
        Prediction { pose, omega, learned: outcomes[place], uniform }
    };
    let predictions = left_out.iter().zip(&learned).enumerate().map(of_pose).collect();
    Ok(share.at(1.0).map_continue(|()| Report { n_held: judge.held.len(), predictions }))
}

/// The part of the time that learning takes, about (3 and 4 % were measured on the project's own sets).
const LEARNING: f64 = 0.04;
/// A prediction has settled when [`QUIET_STEPS`] iterations together lower its energy by less than this part of it: the
/// editor's measure of rest, a thousandth of the paper's γ.
const SETTLED_BELOW: f64 = 1e-6;
/// One iteration of L-BFGS may be cut short, the next be a plain one, and the next but one be long again.
const QUIET_STEPS: usize = 3;
/// By far more than any prediction of the sets tried needed.
const MOST_ITERATIONS: u64 = 2000;

/// A part of the whole progress.
struct Share<'a, 'b> {
    progress: &'a mut Progress<'b>,
    from: f64,
    to: f64,
}

impl Share<'_, '_> {
    /// The next of `n` equal parts of what comes after learning, `done` of which are done.
    fn narrow(&mut self, done: usize, n: usize) {
        let step = (1.0 - LEARNING) / n as f64;
        self.from = LEARNING + step * done as f64;
        self.to = self.from + step;
    }

    /// The fraction of this part that is done.
    fn at(&mut self, fraction: f64) -> ControlFlow<()> {
        (self.progress)(self.from + (self.to - self.from) * fraction)
    }
}

fn left_out(n_poses: usize, options: &Options) -> Result<Vec<usize>, LeaveOneOutError> {
    if n_poses < 2 {
        return Err(LeaveOneOutError::TooFewPoses(n_poses));
    }
    let left_out = options.left_out.clone().unwrap_or_else(|| (0..n_poses).collect());
    match left_out.iter().find(|&&pose| pose >= n_poses) {
        Some(&pose) => Err(LeaveOneOutError::NoSuchPose { pose, n_poses }),
        None if left_out.is_empty() => Err(LeaveOneOutError::NothingLeftOut),
        None => Ok(left_out),
    }
}

/// ω and r for every pose left out, learned from all others. The energies of all poses are added up once; those of the one
/// are then taken away again.
fn learn<P: AsRef<[DVec3]>>(
    analysis: &Arc<Analysis>,
    poses: &[P],
    options: &Options,
    left_out: &[usize],
    share: &mut Share<'_, '_>,
) -> Result<ControlFlow<(), Vec<(f64, Rigidity)>>, LeaveOneOutError> {
    let n_passes = (1 + poses.len() + left_out.len()) as f64;
    let learner = PoseLearner::new(analysis.clone(), options.range.clone(), &mut |done| share.at(done / n_passes))?;
    let ControlFlow::Continue(mut learner) = learner else {
        return Ok(ControlFlow::Break(()));
    };
    let mut n_done = 1.0;
    let mut add = |learner: &mut PoseLearner, pose: &P| {
        let added = learner.add_with_progress(pose.as_ref(), &mut |done| share.at((n_done + done) / n_passes));
        n_done += 1.0;
        added
    };
    for pose in poses {
        if add(&mut learner, pose)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    let all = learner.table()?;
    let mut learned = Vec::new();
    for &pose in left_out {
        learner.clear();
        if add(&mut learner, &poses[pose])?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let others = all.without(&learner.table()?).ok_or(LeaveOneOutError::TooFewPoses(poses.len()))?;
        let omega = options.omega.unwrap_or_else(|| others.auto_omega());
        let chosen = options.chosen.clone().unwrap_or_else(|| options.range.clone());
        let rigidity = others.learn(omega, chosen).rigidity;
        learned.push((omega, rigidity.smoothed(analysis.mesh(), options.smoothing)));
    }
    Ok(ControlFlow::Continue(learned))
}

/// Solves for poses from a few held patches.
struct Judge {
    solver: Solver,
    held: Vec<VertexId>,
    /// Of the reference's bounding box.
    diagonal: f64,
}

impl Judge {
    fn new(analysis: &Arc<Analysis>, n_patches: usize) -> Result<Judge, LeaveOneOutError> {
        let mesh = analysis.mesh();
        let low = mesh.positions().iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = mesh.positions().iter().copied().reduce(DVec3::max).unwrap_or_default();
        let diagonal = low.distance(high);
        if diagonal == 0.0 {
            return Err(LeaveOneOutError::Pointlike);
        }
        let held = spread_patches(mesh, n_patches.max(1));
        let soft = Rigidity::uniform(mesh.n_vertices(), 1);
        let neighborhoods = Neighborhoods::new(analysis, &soft)?;
        let mut solver = Solver::new(analysis.clone(), neighborhoods, &soft, &held, LooseComponents::FollowNearest)?;
        solver.set_minimizer(Minimizer::Lbfgs);
        Ok(Judge { solver, held, diagonal })
    }

    /// The pose from its patches alone. It begins at rest, whatever was predicted before.
    fn predict(
        &mut self,
        rigidity: &Rigidity,
        pose: &[DVec3],
        share: &mut Share<'_, '_>,
    ) -> Result<ControlFlow<(), Outcome>, SolveError> {
        if share.at(0.0).is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let solver = &mut self.solver;
        solver.set_rigidity(rigidity)?;
        solver.set_targets(&self.held.iter().map(|v| pose[v.index()]).collect::<Vec<_>>())?;
        solver.start(Start::Rest);
        solver.start(Start::Auto);
        let mut before = [f64::INFINITY; QUIET_STEPS];
        for iterations in 1..=MOST_ITERATIONS {
            let energy = solver.step().energy;
            if energy == 0.0 || before[0] - energy < SETTLED_BELOW * before[0].abs() {
                return Ok(ControlFlow::Continue(self.outcome(pose, iterations)));
            }
            before.rotate_left(1);
            before[QUIET_STEPS - 1] = energy;
            if share.at(0.0).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(self.outcome(pose, MOST_ITERATIONS)))
    }

    fn outcome(&self, pose: &[DVec3], iterations: u64) -> Outcome {
        let positions = self.solver.positions();
        let sum: f64 = positions.iter().zip(pose).map(|(p, q)| p.distance(*q)).sum();
        Outcome { error: sum / positions.len() as f64 / self.diagonal, iterations }
    }
}
