//! One shape bent by one method, from rest and R = I, as in the paper.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use pliant_solver::{
    Analysis, Deformer, LooseComponents, Method, Minimizer, Neighborhoods, Rigidity, Solver, Start, Weights,
};

use crate::failure::Failure;
use crate::models::Posing;

/// Relative decrease of the energy at which the paper stops (3.2.3).
const GAMMA: f64 = 1e-3;
/// A thousandth of that, over [`QUIET`] iterations, is settled: the editor's measure of rest.
const SETTLED: f64 = 1e-6;
/// One iteration of L-BFGS may be cut short, the next be a plain one, and the next but one be long again.
const QUIET: usize = 3;
/// By far more than any of the figures needs.
const MOST_ITERATIONS: usize = 5000;

/// A shape after bending.
pub(crate) struct Bent {
    pub(crate) positions: Vec<DVec3>,
    /// Energy after each iteration.
    pub(crate) energies: Vec<f64>,
    /// The share of each vertex in the last one; empty where vertices have none.
    pub(crate) vertex_energies: Vec<f64>,
}

impl Bent {
    pub(crate) fn n_iterations(&self) -> usize {
        self.energies.len()
    }
}

/// What the paper's table 1 tells about a run.
pub(crate) struct Times {
    pub(crate) neighborhoods: Duration,
    pub(crate) factor: Duration,
    /// Medians over the iterations.
    pub(crate) global: Duration,
    pub(crate) local: Duration,
    /// All iterations.
    pub(crate) total: Duration,
}

impl Times {
    /// The shorter time of either run, stage by stage.
    pub(crate) fn fastest(&self, other: &Times) -> Times {
        Times {
            neighborhoods: self.neighborhoods.min(other.neighborhoods),
            factor: self.factor.min(other.factor),
            global: self.global.min(other.global),
            local: self.local.min(other.local),
            total: self.total.min(other.total),
        }
    }
}

/// As in the paper: raw cotangents, global and local steps in turn, until the energy falls by less than γ.
pub(crate) fn as_in_the_paper(posing: &Posing, rigidity: &Rigidity) -> Result<(Bent, Times), Failure> {
    let analysis = Arc::new(Analysis::new(posing.mesh.clone(), Weights::Cotangent));
    let (neighborhoods, search) = timed(|| Neighborhoods::new(&analysis, rigidity));
    let neighborhoods = neighborhoods?;
    let loose = LooseComponents::KeepAtRest;
    let (solver, factor) = timed(|| Solver::new(analysis, neighborhoods, rigidity, &posing.held, loose));
    let mut solver = solver?;
    solver.set_targets(&posing.targets)?;
    solver.start(Start::Rest);
    let (mut energies, mut globals, mut locals) = (Vec::new(), Vec::new(), Vec::new());
    let begun = Instant::now();
    while energies.len() < MOST_ITERATIONS {
        let ((), global) = timed(|| solver.global_step());
        let (report, local) = timed(|| solver.local_step());
        globals.push(global);
        locals.push(local);
        energies.push(report.energy);
        if energies.len() > 1 && report.relative_decrease < GAMMA {
            break;
        }
    }
    let total = begun.elapsed();
    let bent = Bent { positions: solver.positions(), energies, vertex_energies: solver.vertex_energies() };
    Ok((bent, Times { neighborhoods: search, factor, global: median(globals), local: median(locals), total }))
}

/// To the end of the valley that lies below the rest pose, whatever the method: with the weights that the program takes by
/// itself, and L-BFGS, which ends where plain iteration ends, sooner.
pub(crate) fn settled(posing: &Posing, method: &Method) -> Result<Bent, Failure> {
    let analysis = Arc::new(Analysis::new(posing.mesh.clone(), Weights::Clamped));
    let mut deformer = method.prepare(analysis, &posing.held, LooseComponents::KeepAtRest, Minimizer::Lbfgs)?;
    deformer.set_targets(&posing.targets)?;
    deformer.start(Start::Rest);
    Ok(iterate(&mut *deformer, posing.mesh.n_vertices()))
}

fn iterate(deformer: &mut dyn Deformer, n_vertices: usize) -> Bent {
    let mut energies: Vec<f64> = Vec::new();
    while energies.len() < MOST_ITERATIONS {
        let energy = deformer.step().energy;
        let before = energies.len().checked_sub(QUIET).map(|place| energies[place]);
        energies.push(energy);
        if energy == 0.0 || before.is_some_and(|before| before - energy < SETTLED * before.abs()) {
            break;
        }
    }
    let mut positions = vec![DVec3::ZERO; n_vertices];
    deformer.positions_into(&mut positions);
    Bent { positions, energies, vertex_energies: deformer.vertex_energies().unwrap_or_default() }
}

fn timed<T>(run: impl FnOnce() -> T) -> (T, Duration) {
    let begun = Instant::now();
    let value = run();
    (value, begun.elapsed())
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}
