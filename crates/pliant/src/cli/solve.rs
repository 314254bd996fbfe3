//! One deformation from rest to the end of the iteration, with the time of every stage.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use pliant_solver::{
    Analysis, Deformer, LooseComponents, Mesh, Method, Minimizer, Neighborhoods, Rigidity, SolveError, Solver, Start,
    VertexId, Weights,
};

use super::console::Console;
use super::handles_file::Handles;
use super::report::{DeformTimes, median};

/// What is solved.
pub(super) struct Problem {
    pub(super) mesh: Arc<Mesh>,
    pub(super) rigidity: Rigidity,
    pub(super) handles: Handles,
}

/// How it is solved.
#[derive(Clone, Debug)]
pub(super) struct Settings {
    /// Another method than r-ring.
    pub(super) other: Option<Method>,
    pub(super) weights: Weights,
    pub(super) minimizer: Minimizer,
    pub(super) start: Start,
    /// At least 1.
    pub(super) max_iterations: u64,
    /// Relative decrease of the energy below which the iteration ends (3.2.3); 0 runs all iterations.
    pub(super) tolerance: f64,
}

/// Iterations of L-BFGS that together must have lowered the energy by less than the tolerance. Plain iteration slows down
/// evenly, so that its last decrease tells how things stand, and the paper looks at that alone. A step of L-BFGS may be
/// cut short, or be the plain one because what was learned misled, and the next but one, with what that one taught, be
/// long again: three in all.
const LBFGS_QUIET: usize = 3;

impl Settings {
    /// Over how many iterations the decrease of the energy is measured.
    fn quiet(&self) -> usize {
        match (&self.other, self.minimizer) {
            (Some(Method::Embedded { .. }), _) | (_, Minimizer::LocalGlobal) => 1,
            (_, Minimizer::Lbfgs) => LBFGS_QUIET,
        }
    }
}

/// The end of the iteration.
pub(super) struct Solution {
    /// Of every surface point.
    pub(super) positions: Vec<DVec3>,
    /// Energy after each iteration: eq. (1), or that of the other method.
    pub(super) energies: Vec<f64>,
    pub(super) converged: bool,
    /// Largest distance of a held vertex from its target.
    pub(super) max_handle_error: f64,
    /// Vertex count and first vertex of every component without a held vertex.
    pub(super) loose: Vec<(usize, VertexId)>,
    /// Only the stages that belong to solving are filled in.
    pub(super) times: DeformTimes,
}

/// Solves `problem`; the only failure is a system that cannot be set up.
pub(super) fn solve(problem: &Problem, settings: &Settings, console: &mut Console<'_>) -> Result<Solution, SolveError> {
    console.progress(|| "analyzing the mesh".to_owned());
    let clock = Instant::now();
    let analysis = Arc::new(Analysis::new(problem.mesh.clone(), settings.weights));
    let order = milliseconds(clock);
    let mut solution = solve_analyzed(analysis, problem, settings, console)?;
    solution.times.order = order;
    Ok(solution)
}

/// The same for a mesh that was analyzed before, with the weights of `settings`.
pub(super) fn solve_analyzed(
    analysis: Arc<Analysis>,
    problem: &Problem,
    settings: &Settings,
    console: &mut Console<'_>,
) -> Result<Solution, SolveError> {
    let mut times = DeformTimes::default();
    let mut solver = prepare(analysis, problem, settings, (&mut times, console))?;
    solver.set_targets(&problem.handles.targets)?;
    let iterated = iterate(&mut *solver, settings, &mut times, console);
    let mut positions = vec![DVec3::ZERO; problem.mesh.n_vertices()];
    solver.positions_into(&mut positions);
    let held = problem.handles.held.iter().zip(&problem.handles.targets);
    let errors = held.map(|(vertex, &target)| positions[vertex.index()].distance(target));
    Ok(Solution {
        max_handle_error: errors.fold(0.0, f64::max),
        positions,
        energies: iterated.energies,
        converged: iterated.converged,
        loose: solver.loose_components().to_vec(),
        times,
    })
}

fn prepare(
    analysis: Arc<Analysis>,
    problem: &Problem,
    settings: &Settings,
    (times, console): (&mut DeformTimes, &mut Console<'_>),
) -> Result<Box<dyn Deformer>, SolveError> {
    let held = &problem.handles.held;
    if let Some(other) = &settings.other {
        console.progress(|| "preparing the method".to_owned());
        let clock = Instant::now();
        let prepared = other.prepare(analysis, held, LooseComponents::KeepAtRest, settings.minimizer);
        times.factorize = milliseconds(clock);
        return prepared;
    }

    console.progress(|| "finding neighborhoods".to_owned());
    let clock = Instant::now();
    let neighborhoods = Neighborhoods::with_progress(&analysis, &problem.rigidity, &mut |part| {
        console.progress(|| format!("finding neighborhoods: {:.0} %", (100.0 * part).floor()));
        ControlFlow::Continue(())
    })?;
    times.neighborhoods = milliseconds(clock);

    console.progress(|| "factorizing".to_owned());
    let clock = Instant::now();
    let mut solver = Solver::new(analysis, neighborhoods, &problem.rigidity, held, LooseComponents::KeepAtRest)?;
    solver.set_minimizer(settings.minimizer);
    times.factorize = milliseconds(clock);
    Ok(Box::new(solver))
}

struct Iterated {
    energies: Vec<f64>,
    converged: bool,
}

/// Iterations until the stop rule of 3.2.3 or the last iteration allowed.
fn iterate(
    solver: &mut dyn Deformer,
    settings: &Settings,
    times: &mut DeformTimes,
    console: &mut Console<'_>,
) -> Iterated {
    let clock = Instant::now();
    let mut energies: Vec<f64> = Vec::new();
    let mut stage_ms = [Vec::new(), Vec::new(), Vec::new()];
    let mut converged = false;
    solver.start(settings.start);
    while (energies.len() as u64) < settings.max_iterations {
        let begun = Instant::now();
        solver.global_step();
        let global = milliseconds(begun);
        let energy = solver.local_step().energy;
        let whole = milliseconds(begun);
        for (list, ms) in stage_ms.iter_mut().zip([global, whole - global, whole]) {
            list.push(ms);
        }
        let before = energies.len().checked_sub(settings.quiet()).map(|place| energies[place]);
        converged = is_settled(before, energy, settings.tolerance);
        energies.push(energy);
        console.progress(|| format!("iteration {}, energy {energy:.6e}", energies.len()));
        if converged && settings.tolerance > 0.0 {
            break;
        }
    }
    times.iterate = milliseconds(clock);
    let [global, local, whole] = stage_ms.each_mut().map(|list| median(list));
    times.global_median = global;
    times.local_median = local;
    times.iteration_median = whole;
    Iterated { energies, converged }
}

/// Whether the energy is zero (the solver reports rounding as zero), or fell from `before`, an iteration or some ago, by
/// less than `tolerance` of it (3.2.3). With a tolerance of 0 an energy that no longer falls at all has settled. Raw cotangents can make energies
/// negative.
fn is_settled(before: Option<f64>, energy: f64, tolerance: f64) -> bool {
    let decrease = before.map(|before| (before - energy) / before.abs());
    energy == 0.0 || decrease.is_some_and(|decrease| decrease < tolerance || decrease <= 0.0)
}

pub(super) fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_energy_has_settled_at_once() {
        assert!(is_settled(None, 0.0, 1e-3));
        assert!(!is_settled(None, 1.0, 1e-3));
    }

    #[test]
    fn settled_means_a_relative_decrease_below_the_tolerance() {
        assert!(is_settled(Some(1.0), 0.9995, 1e-3));
        assert!(!is_settled(Some(1.0), 0.998, 1e-3));
        assert!(!is_settled(Some(1e-6), 0.998e-6, 1e-3));
        assert!(is_settled(Some(-1.0), -1.0005, 1e-3));
        assert!(!is_settled(Some(-1.0), -1.002, 1e-3));
        assert!(!is_settled(None, -1.0, 1e-3));
        assert!(is_settled(Some(1.0), 1.0, 0.0));
        assert!(!is_settled(Some(1.0), 1.0 - 1e-12, 0.0));
    }
}
