//! What the solver says, kept for the status line.

use std::time::Instant;

use crate::solving::{SolveReport, SolveState};

/// What the solver last said, and how often it speaks.
#[derive(Clone, Default)]
pub struct Status {
    /// The newest report that belongs to the open document.
    pub report: Option<SolveReport>,
    /// Surfaces a second while iterating.
    pub surfaces_per_second: f64,
    last_surface: Option<Instant>,
    /// Why the solver last gave up: said once, not with each new try.
    last_failure: Option<String>,
}

impl Status {
    /// Takes over a report. Returns why the solver gave up, if that is news.
    pub(super) fn take(&mut self, report: SolveReport) -> Option<String> {
        if report.frame.is_some() {
            self.count_surface();
        }
        let news = match &report.state {
            SolveState::Failed(why) if self.last_failure.as_ref() != Some(why) => Some(why.clone()),
            _ => None,
        };
        match &report.state {
            SolveState::Failed(why) => self.last_failure = Some(why.clone()),
            SolveState::Preparing { .. } => {}
            SolveState::Resting | SolveState::Iterating | SolveState::Settled => self.last_failure = None,
        }
        // Numbers and colors stay while the solver prepares.
        self.report = Some(match self.report.take() {
            Some(last) if matches!(report.state, SolveState::Preparing { .. }) => {
                SolveReport { state: report.state, revision: report.revision, epoch: report.epoch, ..last }
            }
            _ => report,
        });
        news
    }

    /// Exponential mean over about ten surfaces; a pause of a second or more starts anew.
    fn count_surface(&mut self) {
        let now = Instant::now();
        if let Some(last) = self.last_surface.replace(now) {
            let seconds = now.duration_since(last).as_secs_f64();
            let rate = 1.0 / seconds.max(1e-6);
            let keep = if seconds > 1.0 || self.surfaces_per_second == 0.0 { 0.0 } else { 0.9 };
            self.surfaces_per_second = keep * self.surfaces_per_second + (1.0 - keep) * rate;
        }
    }
}
