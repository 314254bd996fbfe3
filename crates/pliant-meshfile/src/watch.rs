//! How far opening is, and whether it is still wanted.

use crate::Fault;
use std::ops::ControlFlow;
use std::sync::Mutex;

/// Told the fraction that is done; answers whether to go on.
pub(crate) type Tell<'a> = dyn Fn(f64) -> ControlFlow<()> + Sync + 'a;

/// Vertices or faces of a text that are read in a few milliseconds, at some 200 ns each.
pub(crate) const PIECE: usize = 1 << 14;

/// A share of the work of opening, whose own progress goes from 0 to 1.
#[derive(Clone, Copy)]
pub(crate) struct Stage<'a> {
    tell: &'a Tell<'a>,
    from: f64,
    to: f64,
}

impl<'a> Stage<'a> {
    /// All of the work.
    pub(crate) fn new(tell: &'a Tell<'a>) -> Stage<'a> {
        Stage { tell, from: 0.0, to: 1.0 }
    }

    /// All of some work that nobody watches and nothing stops.
    pub(crate) fn unwatched() -> Stage<'static> {
        Stage::new(&|_| ControlFlow::Continue(()))
    }

    /// The part of this stage between two fractions of it.
    pub(crate) fn part(self, from: f64, to: f64) -> Stage<'a> {
        let at = |fraction: f64| self.from + fraction * (self.to - self.from);
        Stage { tell: self.tell, from: at(from), to: at(to) }
    }

    /// Tells that `done` of `all` pieces are done. A fault when opening is no longer wanted, which the caller is to pass
    /// on without delay.
    pub(crate) fn tell(self, done: usize, all: usize) -> Result<(), Fault> {
        let fraction = if all == 0 { 1.0 } else { done as f64 / all as f64 };
        match (self.tell)(self.part(fraction, 1.0).from) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Fault::Canceled),
        }
    }
}

/// Calls `work` with what passes progress on to `report`: one call at a time, never descending, and none once it has answered
/// with a break, whichever threads the work is spread over.
pub(crate) fn watched<T>(
    report: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    work: impl FnOnce(Stage<'_>) -> T,
) -> T {
    struct State<'a> {
        report: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
        told: f64,
        is_stopped: bool,
    }
    let state = Mutex::new(State { report, told: 0.0, is_stopped: false });
    let tell = |fraction: f64| {
        // A report that panicked ends the work of the other threads too.
        let Ok(mut state) = state.lock() else { return ControlFlow::Break(()) };
        if !state.is_stopped {
            state.told = fraction.max(state.told);
            let told = state.told;
            state.is_stopped = (state.report)(told).is_break();
        }
        if state.is_stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    work(Stage::new(&tell))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_parts_ascend_to_one_and_nothing_is_told_after_a_stop() {
        let mut told = Vec::new();
        let outcome = watched(
            &mut |fraction| {
                told.push(fraction);
                if fraction >= 0.75 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
            |stage| {
                stage.part(0.0, 0.5).tell(1, 2)?;
                // Behind what was told already.
                stage.tell(1, 8)?;
                stage.part(0.5, 1.0).part(0.0, 0.5).tell(3, 3)?;
                stage.tell(1, 1)
            },
        );
        assert!(matches!(outcome, Err(Fault::Canceled)), "{outcome:?}");
        assert_eq!(told, [0.25, 0.25, 0.75]);
    }
}
