//! How fast the energy falls: from rest after a jump, and during a drag.

use super::clock::timed;
use super::scene::{Scene, analyze, solver};
use super::stages::name;
use super::table::{Table, digits, ms};
use pliant_solver::{Minimizer, Rigidity, SolveError, Solver, Start};
use std::time::{Duration, Instant};

/// The two ways to minimize, with the start that goes with them.
pub(crate) const WAYS: [(&str, Minimizer, Start); 2] =
    [("local-global, rest", Minimizer::LocalGlobal, Start::Rest), ("lbfgs, auto", Minimizer::Lbfgs, Start::Auto)];

/// From rest, set-up included, to within 1 % of the lowest energy that either way reaches in `most` iterations.
pub(crate) fn from_rest(scenes: &[(&Scene, u16)], most: usize) -> Result<String, SolveError> {
    let mut table = Table::new(1, &["mesh", "vertices", "r", "how", "lowest E", "iterations", "ms", "first / this"]);
    for &(scene, r) in scenes {
        let paths = WAYS.map(|way| {
            eprintln!("from rest: {} vertices, r = {r}, {}", scene.n_vertices(), way.0);
            path(scene, r, (way.1, way.2), most)
        });
        let [first, second] = paths;
        let paths = [first?, second?];
        let goal = 1.01 * paths.iter().flatten().map(|station| station.1).fold(f64::INFINITY, f64::min);
        let arrival = |path: &[(Duration, f64)]| path.iter().position(|station| station.1 <= goal);
        let time = |path: &[(Duration, f64)]| arrival(path).map(|at| path[at].0);
        for ((how, ..), path) in WAYS.iter().zip(&paths) {
            let lowest = path.last().map_or(f64::NAN, |station| station.1);
            let ratio = time(&paths[0])
                .zip(time(path))
                .map_or("–".to_owned(), |(first, this)| digits(first.as_secs_f64() / this.as_secs_f64()));
            let iterations = arrival(path).map_or("not reached".to_owned(), |at| (at + 1).to_string());
            let cells = [r.to_string(), (*how).to_owned(), digits(lowest), iterations];
            let taken = time(path).map_or("–".to_owned(), ms);
            table.row(name(scene).into_iter().chain(cells).chain([taken, ratio]));
        }
    }
    Ok(format!(
        "From rest, set-up included, to within 1 % of the lowest energy that either way reaches in {most} iterations, \
         bent by {}°.\n\n{}",
        super::scene::BEND,
        table.into_text()
    ))
}

/// Time since the beginning and energy after every iteration.
fn path(
    scene: &Scene,
    r: u16,
    (minimizer, start): (Minimizer, Start),
    most: usize,
) -> Result<Vec<(Duration, f64)>, SolveError> {
    let mesh = scene.mesh();
    let begun = Instant::now();
    let mut solver = solver(scene, &analyze(&mesh), &Rigidity::uniform(scene.n_vertices(), r))?;
    solver.set_minimizer(minimizer);
    solver.start(start);
    Ok((0..most)
        .map(|_| {
            let energy = solver.step().energy;
            (begun.elapsed(), energy)
        })
        .collect())
}

/// A drag of this many frames at 60 Hz.
const FRAMES: usize = 30;
const FRAME: Duration = Duration::from_nanos(16_666_667);
/// Iterations per frame from each pose by which the converged energy is found.
const CONVERGED: usize = 100;

/// A drag of a scene's handles to where they go, evenly in 30 frames; `r` of every vertex.
pub(crate) fn drag(scene: &Scene, rigidity: &Rigidity) -> Result<String, SolveError> {
    let analysis = analyze(&scene.mesh());
    let fresh = || solver(scene, &analysis, rigidity);
    let mut dragged = Vec::new();
    for (how, minimizer, _) in WAYS {
        eprintln!("drag: {} vertices, {how}", scene.n_vertices());
        let mut solver = fresh()?;
        solver.set_minimizer(minimizer);
        dragged.push((how, drag_frames(scene, &mut solver)?));
    }
    let mut reference = fresh()?;
    reference.set_minimizer(Minimizer::Lbfgs);
    let lowest = lowest_energies(scene, &mut reference, &dragged)?;

    let mut table = Table::new(1, &["how", "iterations a second", "mean excess energy, %", "/ first"]);
    let mean_lowest = lowest.iter().sum::<f64>() / FRAMES as f64;
    let excess = |frames: &[Frame]| {
        let over: f64 = frames.iter().zip(&lowest).map(|(frame, lowest)| frame.energy - lowest).sum();
        100.0 * over / FRAMES as f64 / mean_lowest
    };
    for (how, frames) in &dragged {
        let iterations: usize = frames.iter().map(|frame| frame.iterations).sum();
        let seconds: f64 = frames.iter().map(|frame| frame.taken.as_secs_f64()).sum();
        let own = excess(frames);
        let how = how.split_once(',').map_or(*how, |(minimizer, _)| minimizer);
        let first = excess(&dragged[0].1);
        // Below this the first has converged in every frame, and there is nothing to compare with.
        let share = if first > 1e-3 { format!("{:.3}", own / first) } else { "–".to_owned() };
        let cells = [digits(iterations as f64 / seconds), digits(own), share];
        table.row([how.to_owned()].into_iter().chain(cells));
    }
    Ok(format!(
        "A drag: {FRAMES} frames at 60 Hz, {} of {} vertices, r from {} to {}, as many iterations in every frame as its \
         {:.1} ms allow. Excess is over the energy of the frame's converged surface, in percent of the mean of those.\n\n{}",
        scene.name,
        super::table::count(scene.n_vertices()),
        rigidity.min(),
        rigidity.max(),
        1e3 * FRAME.as_secs_f64(),
        table.into_text()
    ))
}

/// The end of a frame.
struct Frame {
    iterations: usize,
    taken: Duration,
    energy: f64,
    positions: Vec<glam::DVec3>,
}

fn drag_frames(scene: &Scene, solver: &mut Solver) -> Result<Vec<Frame>, SolveError> {
    let mut frames = Vec::with_capacity(FRAMES);
    for frame in 1..=FRAMES {
        solver.set_targets(&scene.targets_at(frame as f64 / FRAMES as f64))?;
        let begun = Instant::now();
        let (mut iterations, mut longest, mut energy) = (0, Duration::ZERO, f64::NAN);
        // One more only if it will be done in time.
        while iterations == 0 || begun.elapsed() + longest < FRAME {
            let (report, taken) = timed(|| solver.step());
            (iterations, longest, energy) = (iterations + 1, longest.max(taken), report.energy);
        }
        frames.push(Frame { iterations, taken: begun.elapsed(), energy, positions: solver.positions() });
    }
    Ok(frames)
}

/// The lowest energy of every frame that is found from its own converged past or from any of the dragged surfaces.
fn lowest_energies(scene: &Scene, solver: &mut Solver, dragged: &[(&str, Vec<Frame>)]) -> Result<Vec<f64>, SolveError> {
    let mut past = solver.positions();
    (0..FRAMES)
        .map(|frame| {
            solver.set_targets(&scene.targets_at((frame + 1) as f64 / FRAMES as f64))?;
            let mut lowest = f64::INFINITY;
            let starts =
                [past.clone()].into_iter().chain(dragged.iter().map(|(_, frames)| frames[frame].positions.clone()));
            for start in starts {
                solver.set_pose(&start)?;
                let energy = (0..CONVERGED).map(|_| solver.step().energy).fold(f64::INFINITY, f64::min);
                if energy < lowest {
                    (lowest, past) = (energy, solver.positions());
                }
            }
            Ok(lowest)
        })
        .collect()
}
