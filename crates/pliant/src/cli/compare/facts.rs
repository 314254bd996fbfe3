//! The figures of a comparison: what the page shows, and what `--json` prints in this order.

use serde::Serialize;

use super::bench::{Bench, Bent, Outcome};
use crate::cli::args::{CompareOptions, Entry, Way};
use crate::cli::report::{MeshCounts, RigiditySummary};
use crate::comparing::{Axis, Ruler};

#[derive(Debug, Serialize)]
pub(super) struct Facts {
    pub(super) mesh: MeshCounts,
    pub(super) handles: HandleCounts,
    /// Of all entries but embedded deformation.
    pub(super) solver: &'static str,
    pub(super) weights: &'static str,
    pub(super) start: &'static str,
    pub(super) max_iterations: u64,
    pub(super) tolerance: f64,
    pub(super) threads: usize,
    pub(super) rest: RestFacts,
    pub(super) axes: Axes,
    pub(super) entries: Vec<EntryFacts>,
    pub(super) times_ms: Times,
    /// Largest resident size of the process; null where the system does not tell.
    pub(super) peak_memory_bytes: Option<u64>,
    pub(super) warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
pub(super) struct HandleCounts {
    /// Surface points that are held.
    pub(super) held: usize,
    /// Those of them that are held elsewhere than at rest.
    pub(super) moved: usize,
}

#[derive(Debug, Serialize)]
pub(super) struct RestFacts {
    /// Pairs of triangles without a common vertex that cross.
    pub(super) self_intersections: usize,
    /// In the file's units; null where the surface encloses none.
    pub(super) volume: Option<f64>,
    /// Why it encloses none.
    pub(super) no_volume: Option<String>,
}

/// Where the axes of all histograms end.
#[derive(Debug, Serialize)]
pub(super) struct Axes {
    /// ln(length / length at rest), from `-stretch` to `stretch`.
    pub(super) stretch: f64,
    /// Degrees, from 0.
    pub(super) bending: f64,
}

/// Wall-clock times in milliseconds.
#[derive(Debug, Serialize)]
pub(super) struct Times {
    /// Reading and checking all files.
    pub(super) load: f64,
    /// Weights, order and symbolic analysis, once for all entries.
    pub(super) order: f64,
    /// From the start of the command until all is drawn.
    pub(super) total: f64,
}

#[derive(Debug, Serialize)]
pub(super) struct EntryFacts {
    /// As it was named on the command line.
    pub(super) entry: String,
    pub(super) method: &'static str,
    pub(super) solver: &'static str,
    /// Null for methods that know none.
    pub(super) rigidity: Option<RigiditySummary>,
    pub(super) alpha: Option<f64>,
    pub(super) nodes: Option<usize>,
    pub(super) node_neighbors: Option<usize>,
    /// Why there is no result.
    pub(super) failed: Option<String>,
    pub(super) result: Option<Measured>,
    #[serde(skip)]
    pub(super) way: Way,
    #[serde(skip)]
    pub(super) is_painted: bool,
}

/// What an entry came to.
#[derive(Debug, Serialize)]
pub(super) struct Measured {
    pub(super) converged: bool,
    pub(super) iterations: usize,
    /// As in the report of `deform`.
    pub(super) energies: Vec<f64>,
    pub(super) common_energy: f64,
    pub(super) max_handle_error: f64,
    pub(super) self_intersections: usize,
    pub(super) self_intersections_at_rest: usize,
    pub(super) volume_ratio: Option<f64>,
    pub(super) stretch: Distribution,
    pub(super) bending: Distribution,
    pub(super) folds: usize,
    pub(super) times_ms: EntryTimes,
}

/// Magnitudes of many numbers, and their histogram over the common axis.
#[derive(Debug, Serialize)]
pub(super) struct Distribution {
    pub(super) count: usize,
    pub(super) mean: f64,
    /// What 99 % do not exceed.
    pub(super) percentile_99: f64,
    /// Parts of the count; what is beyond the axis is in the outermost bins.
    pub(super) histogram: Vec<f64>,
}

/// Wall-clock times in milliseconds.
#[derive(Debug, Serialize)]
pub(super) struct EntryTimes {
    /// Neighborhoods and factorization.
    pub(super) set_up: f64,
    /// The start and all iterations.
    pub(super) iterate: f64,
    pub(super) iteration_median: f64,
}

impl Facts {
    pub(super) fn new(options: &CompareOptions, bench: &Bench, results: &[Outcome]) -> Facts {
        let bent = || results.iter().flatten();
        let stretch = Ruler::stretch().common(bent().map(|bent| &bent.stretch));
        let bending = Ruler::bending().common(bent().map(|bent| &bent.bending));
        let entries = options.entries.iter().zip(results).enumerate();
        let at_rest = bench.volume.at_rest();
        Facts {
            mesh: MeshCounts::new(&bench.file, &bench.mesh),
            handles: HandleCounts { held: bench.handles.held.len(), moved: bench.moved().count() },
            solver: options.solving.solver.name(),
            weights: options.solving.weights.name(),
            start: options.solving.start.name(),
            max_iterations: options.solving.max_iterations,
            tolerance: options.solving.tolerance,
            threads: rayon::current_num_threads(),
            rest: RestFacts {
                self_intersections: bench.rest_crossings.len(),
                volume: at_rest.ok(),
                no_volume: at_rest.err().map(|why| why.to_string()),
            },
            axes: Axes { stretch: stretch.end, bending: bending.end },
            entries: entries
                .map(|(k, (entry, outcome))| {
                    let rigidity = &bench.rigidity[k].rigidity;
                    let summary = RigiditySummary::new(rigidity);
                    EntryFacts {
                        is_painted: rigidity.min() < rigidity.max(),
                        ..EntryFacts::new(options, (entry, summary), outcome, [&stretch, &bending])
                    }
                })
                .collect(),
            times_ms: Times { load: bench.load_ms, order: bench.order_ms, total: 0.0 },
            peak_memory_bytes: None,
            warnings: bench.warnings.clone(),
        }
    }

    /// One line an entry, for the terminal.
    pub(super) fn lines(&self) -> Vec<String> {
        self.entries.iter().map(EntryFacts::line).collect()
    }
}

impl EntryFacts {
    fn new(
        options: &CompareOptions,
        (entry, rigidity): (&Entry, RigiditySummary),
        outcome: &Outcome,
        axes: [&Axis; 2],
    ) -> EntryFacts {
        let (alpha, nodes, node_neighbors) = match entry.way {
            Way::Rring(_) | Way::Arap => (None, None, None),
            Way::SrArap { alpha } => (Some(alpha), None, None),
            Way::Embedded { nodes, node_neighbors } => (None, Some(nodes), Some(node_neighbors)),
        };
        EntryFacts {
            entry: entry.to_string(),
            method: entry.method().name(),
            solver: options.solving.solver_of(entry.method()),
            rigidity: matches!(entry.way, Way::Rring(_) | Way::Arap).then_some(rigidity),
            alpha,
            nodes,
            node_neighbors,
            failed: outcome.as_ref().err().map(ToString::to_string),
            result: outcome.as_ref().ok().map(|bent| Measured::new(bent, axes)),
            way: entry.way.clone(),
            is_painted: false,
        }
    }

    fn line(&self) -> String {
        let Some(result) = &self.result else {
            return format!("  {}: failed: {}", self.entry, self.failed.as_deref().unwrap_or_default());
        };
        let state = if result.converged { "" } else { " (not converged)" };
        format!(
            "  {}: {} iterations{state}, {:.0} ms, common energy {:.4e}, {} pairs of triangles cross",
            self.entry,
            result.iterations,
            result.times_ms.set_up + result.times_ms.iterate,
            result.common_energy,
            result.self_intersections
        )
    }
}

impl Measured {
    fn new(bent: &Bent, [stretch, bending]: [&Axis; 2]) -> Measured {
        let distribution = |spread: &crate::comparing::Spread, axis: &Axis| Distribution {
            count: spread.count,
            mean: spread.mean,
            percentile_99: spread.worst,
            histogram: spread.shares(axis),
        };
        Measured {
            converged: bent.converged,
            iterations: bent.energies.len(),
            energies: bent.energies.clone(),
            common_energy: bent.common_energy,
            max_handle_error: bent.max_handle_error,
            self_intersections: bent.crossings,
            self_intersections_at_rest: bent.crossings_at_rest,
            volume_ratio: bent.volume_ratio.ok(),
            stretch: distribution(&bent.stretch, stretch),
            bending: distribution(&bent.bending, bending),
            folds: bent.folds,
            times_ms: EntryTimes {
                set_up: bent.times.neighborhoods + bent.times.factorize,
                iterate: bent.times.iterate,
                iteration_median: bent.times.iteration_median,
            },
        }
    }
}
