//! Single kernels of an iteration, for benchmarks: no part of the interface, and only there with the feature `measure`.

use crate::Solver;
use crate::kernels::rotations::Ties;
use crate::linear::ByFaer;

/// A part of an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kernel {
    /// Q, the pulls of the edges, and their sums at the vertices: half the gradient.
    Gradient,
    /// Both triangular solves, on what the gradient left.
    Solve,
    /// S, the rotations and the energy.
    Local,
}

/// How many of everything a solver goes through.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Vertices.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Runs of edges of all neighborhoods with r > 1.
    pub runs: usize,
    /// Values stored of the factor L.
    pub factor: usize,
}

/// Runs one kernel. The pose changes as it would in an iteration, only not the positions.
pub fn run(solver: &mut Solver, kernel: Kernel) {
    let Solver { analysis, rings, held, system, pose, workspace, .. } = solver;
    match kernel {
        Kernel::Gradient => workspace.gradient(&analysis.layout, rings, &held.is_fixed, pose),
        Kernel::Solve => system.solve_in_place(&mut workspace.rhs),
        Kernel::Local => {
            workspace.local(&analysis.layout, rings, pose, Ties::Nudged);
        }
    }
}

/// Counts of a solver.
pub fn counts(solver: &Solver) -> Counts {
    let layout = &solver.analysis.layout;
    Counts {
        vertices: layout.n_vertices(),
        edges: layout.n_edges(),
        runs: (0..layout.n_vertices()).map(|k| solver.rings.neighborhoods.runs(k).len()).sum(),
        factor: solver.system.n_values(),
    }
}

/// The solver's system, factored and solved by faer alone in the same order.
pub struct Faer(ByFaer);

impl Faer {
    /// None if faer cannot factor it.
    pub fn new(solver: &Solver) -> Option<Faer> {
        ByFaer::new(&solver.system).map(Faer)
    }

    /// Both triangular solves for three right-hand sides.
    pub fn solve(&mut self) {
        self.0.solve();
    }
}
