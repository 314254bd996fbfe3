//! The numbers that are told of the iterations: the last energies and times.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

use pliant_solver::StepReport;

/// Energies kept for the plot.
const PLOTTED_ENERGIES: usize = 300;
/// Iteration times of which the median is shown.
const TIMED_ITERATIONS: usize = 32;

pub(super) struct Figures {
    pub(super) last: StepReport,
    energies: VecDeque<f64>,
    times_ms: VecDeque<f64>,
}

impl Default for Figures {
    fn default() -> Figures {
        let last = StepReport { energy: 0.0, iteration: 0, relative_decrease: 0.0 };
        Figures { last, energies: VecDeque::new(), times_ms: VecDeque::new() }
    }
}

impl Figures {
    pub(super) fn stepped(&mut self, report: StepReport, took: Duration) {
        self.last = report;
        remember(&mut self.times_ms, TIMED_ITERATIONS, took.as_secs_f64() * 1e3);
        remember(&mut self.energies, PLOTTED_ENERGIES, report.energy);
    }

    /// Energies from before do not compare.
    pub(super) fn forget_energies(&mut self) {
        self.energies.clear();
    }

    /// Nor do times.
    pub(super) fn forget_all(&mut self) {
        *self = Figures::default();
    }

    /// Oldest first.
    pub(super) fn energies(&self) -> Arc<[f64]> {
        self.energies.iter().copied().collect()
    }

    /// Median, milliseconds.
    pub(super) fn iteration_ms(&self) -> f64 {
        let mut sorted: Vec<f64> = self.times_ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
    }
}

fn remember(queue: &mut VecDeque<f64>, keep: usize, value: f64) {
    if queue.len() == keep {
        queue.pop_front();
    }
    queue.push_back(value);
}
