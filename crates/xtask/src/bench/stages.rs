//! What every stage of the solver costs, by size and r.

use super::clock::{median, median_of, timed, timed_median};
use super::scene::{Scene, analyze, factored, solver};
use super::table::{Table, count, ms};
use pliant_solver::{Analysis, Neighborhoods, Rigidity, SolveError, Solver, VertexId};
use std::sync::Arc;
use std::time::Duration;

/// Iterations before anything is timed: rotations are then warm, as they are nearly always.
const WARM: usize = 5;
/// Vertices of a new handle, and of a dab of the brush with r before and after it.
const HANDLE: usize = 19;
const DAB: usize = 500;
const DAB_R: (u16, u16) = (2, 6);

/// The tables of all stages, a row for every scene and r.
pub(crate) fn tables(scenes: &[(Scene, Vec<u16>)]) -> Result<String, SolveError> {
    let header =
        ["mesh", "vertices", "r", "neighborhoods", "factor", "global step", "local step", "iteration", "/ r = 1"];
    let mut stages = Table::new(1, &header);
    let changes_header = ["mesh", "vertices", "order", "new handle", "+ 1 iteration", "dab", "+ 1 iteration"];
    let mut changes = Table::new(1, &changes_header);
    for (scene, sizes) in scenes {
        let mesh = scene.mesh();
        let (analysis, order) = timed(|| analyze(&mesh));
        let mut first = None;
        for &r in sizes {
            eprintln!("stages: {} of {} vertices, r = {r}", scene.name, count(scene.n_vertices()));
            let times = stage_times(scene, &analysis, r)?;
            let first = *first.get_or_insert(times.iteration);
            let cells = [times.neighborhoods, times.factor, times.global, times.local, times.iteration].map(ms);
            let ratio = format!("{:.2}", times.iteration.as_secs_f64() / first.as_secs_f64());
            stages.row(name(scene).into_iter().chain([r.to_string()]).chain(cells).chain([ratio]));
        }
        let [handle, dab] = [new_handle(scene, &analysis)?, dab(scene, &analysis)?];
        changes.row(name(scene).into_iter().chain([order, handle.0, handle.1, dab.0, dab.1].map(ms)));
    }
    Ok(format!(
        "Milliseconds of every stage. *Factor* is `Solver::new` after the neighborhoods: matrix, factorization and what \
         the sums need. *Iteration* is a global and a local step.\n\n{}\
         *Order* is `Analysis::new`: edges along a curve, weights, fill-reducing order. *New handle*: {HANDLE} more \
         vertices held at r = 1. *Dab*: {DAB} vertices painted from r = {} to {}. With the iteration after it, each is \
         what a person waits for.\n\n{}",
        stages.into_text(),
        DAB_R.0,
        DAB_R.1,
        changes.into_text()
    ))
}

/// First cells of a row.
pub(crate) fn name(scene: &Scene) -> [String; 2] {
    [scene.name.to_owned(), count(scene.n_vertices())]
}

struct StageTimes {
    neighborhoods: Duration,
    factor: Duration,
    global: Duration,
    local: Duration,
    iteration: Duration,
}

fn stage_times(scene: &Scene, analysis: &Arc<Analysis>, r: u16) -> Result<StageTimes, SolveError> {
    let rigidity = Rigidity::uniform(scene.n_vertices(), r);
    let mut made = Neighborhoods::new(analysis, &rigidity);
    let neighborhoods = median_of(|| made = Neighborhoods::new(analysis, &rigidity));
    let made = made?;
    let (built, factor) = timed(|| factored(scene, analysis, &rigidity, made));
    let mut solver = built?;
    (0..WARM).for_each(|_| {
        solver.step();
    });
    let iteration = median_of(|| {
        solver.step();
    });
    // Halves are timed in turn, for a half step repeated has nothing left to do.
    let mut locals = Vec::new();
    let global = timed_median(|| {
        let global = timed(|| solver.global_step()).1;
        locals.push(timed(|| solver.local_step()).1);
        global
    });
    Ok(StageTimes { neighborhoods, factor, global, local: median(locals), iteration })
}

/// More vertices held: the change, and the change with the iteration after it.
fn new_handle(scene: &Scene, analysis: &Arc<Analysis>) -> Result<(Duration, Duration), SolveError> {
    let before = scene.held().0;
    let mut after = before.clone();
    after.extend(scene.dab(HANDLE).into_iter().map(VertexId).filter(|v| !before.contains(v)));
    let mut solver = solver(scene, analysis, &Rigidity::uniform(scene.n_vertices(), 1))?;
    solver.step();
    change(&mut solver, |solver| solver.set_held(&after), |solver| solver.set_held(&before))
}

/// A dab of the brush: the change, and the change with the iteration after it.
fn dab(scene: &Scene, analysis: &Arc<Analysis>) -> Result<(Duration, Duration), SolveError> {
    let before = Rigidity::uniform(scene.n_vertices(), DAB_R.0);
    let mut r = before.as_slice().to_vec();
    scene.dab(DAB).into_iter().for_each(|v| r[v as usize] = DAB_R.1);
    let after = Rigidity::new(r).expect("sizes in range");
    let mut solver = solver(scene, analysis, &before)?;
    solver.step();
    change(&mut solver, |solver| solver.set_rigidity(&after), |solver| solver.set_rigidity(&before))
}

/// Median times of a change, without and with the iteration after it; `back` undoes it, untimed.
fn change(
    solver: &mut Solver,
    mut forth: impl FnMut(&mut Solver) -> Result<(), SolveError>,
    mut back: impl FnMut(&mut Solver) -> Result<(), SolveError>,
) -> Result<(Duration, Duration), SolveError> {
    let (mut outcome, mut with_iteration) = (Ok(()), Vec::new());
    let alone = timed_median(|| {
        let (changed, alone) = timed(|| forth(solver));
        let iteration = timed(|| solver.step()).1;
        with_iteration.push(alone + iteration);
        let undone = back(solver);
        solver.step();
        outcome = outcome.clone().and(changed).and(undone);
        alone
    });
    outcome.map(|()| (alone, median(with_iteration)))
}
