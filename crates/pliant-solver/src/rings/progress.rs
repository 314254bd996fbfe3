//! How far a long computation is, told to someone who may stop it.

use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

/// Counts work done by several threads and reports it as a fraction, in ascending order.
pub(crate) struct Meter<'a> {
    total: u64,
    state: Mutex<State<'a>>,
}

struct State<'a> {
    done: u64,
    is_stopped: bool,
    report: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
}

impl<'a> Meter<'a> {
    /// `report` gets fractions of `total` from 0 to 1 and says whether to go on.
    pub(crate) fn new(total: u64, report: &'a mut (dyn FnMut(f64) -> ControlFlow<()> + Send)) -> Meter<'a> {
        Meter { total, state: Mutex::new(State { done: 0, is_stopped: false, report }) }
    }

    /// So much more is done. Once stopped, it stays stopped.
    pub(crate) fn advance(&self, work: u64) -> ControlFlow<()> {
        // A report that panicked takes its computation along; nothing here is left half changed.
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.done += work;
        let fraction = if self.total == 0 { 1.0 } else { state.done as f64 / self.total as f64 };
        if !state.is_stopped && (state.report)(fraction).is_break() {
            state.is_stopped = true;
        }
        if state.is_stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
