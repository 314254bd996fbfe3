//! Undo and redo: whole snapshots, which share what did not change, capped by bytes.

use std::ops::RangeInclusive;

use super::{Pose, Scene};

/// What undo brings back: the scene and the pose it had.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// The user's part.
    pub scene: Scene,
    /// The solver's part.
    pub pose: Pose,
}

#[derive(Debug)]
struct Step {
    name: &'static str,
    snapshot: Snapshot,
    bytes: usize,
}

/// Two stacks of steps. The newest undo step holds the state *before* the newest change.
#[derive(Debug)]
pub struct History {
    undo: Vec<Step>,
    redo: Vec<Step>,
    budget_bytes: usize,
}

/// Oldest steps are forgotten beyond this. By eye: 800 whole poses of a 12k mesh, 10 of a million vertices.
const BUDGET_BYTES: usize = 256 << 20;
/// What a person may choose instead: enough for a few steps of small meshes, and what machines of today can spare.
const BUDGETS: RangeInclusive<usize> = 64 << 20..=4 << 30;

impl Default for History {
    fn default() -> History {
        History { undo: Vec::new(), redo: Vec::new(), budget_bytes: BUDGET_BYTES }
    }
}

impl History {
    /// Notes that `name` is about to turn (or has just turned) `before` into something else.
    pub fn push(&mut self, name: &'static str, before: Snapshot) {
        self.redo.clear();
        let bytes = self.cost(&before);
        self.undo.push(Step { name, snapshot: before, bytes });
        self.forget();
    }

    /// Drops the oldest steps beyond the budget, but never the newest.
    fn forget(&mut self) {
        let mut total = self.bytes();
        let mut forgotten = 0;
        while total > self.budget_bytes && forgotten + 1 < self.undo.len() {
            total -= self.undo[forgotten].bytes;
            forgotten += 1;
        }
        self.undo.drain(..forgotten);
    }

    /// Smallest and largest budget, in bytes.
    pub const BUDGETS: RangeInclusive<usize> = BUDGETS;

    /// Bytes beyond which the oldest steps are forgotten.
    pub fn budget(&self) -> usize {
        self.budget_bytes
    }

    /// Changes the budget, kept within [`History::BUDGETS`]; steps beyond it are forgotten at once.
    pub fn set_budget(&mut self, bytes: usize) {
        self.budget_bytes = bytes.clamp(*BUDGETS.start(), *BUDGETS.end());
        self.forget();
    }

    /// Bytes that all steps take, about.
    pub fn bytes(&self) -> usize {
        self.undo.iter().chain(&self.redo).map(|step| step.bytes).sum()
    }

    /// Names of all steps, oldest first: first those that can be taken back, [`History::len`] of them, then those that can be
    /// made again.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &'static str> + '_ {
        let all = self.undo.len() + self.redo.len();
        (0..all).map(|step| self.name(step))
    }

    /// Name of a step, counted from the oldest, which must exist.
    pub fn name(&self, step: usize) -> &'static str {
        match self.undo.get(step) {
            Some(step) => step.name,
            // The next one to be made again lies on top.
            None => self.redo[self.redo.len() - 1 - (step - self.undo.len())].name,
        }
    }

    /// The state after the first `n` steps, or after all if there are fewer; `now` and what lies between is kept for the way
    /// back. Nothing if that is now.
    pub fn jump(&mut self, n: usize, now: Snapshot) -> Option<Snapshot> {
        let mut state = None;
        while self.undo.len() > n {
            let from = state.take().unwrap_or_else(|| now.clone());
            state = self.undo(from).map(|(_, before)| before);
        }
        while self.undo.len() < n && !self.redo.is_empty() {
            let from = state.take().unwrap_or_else(|| now.clone());
            state = self.redo(from).map(|(_, after)| after);
        }
        state
    }

    /// Takes the state to go back to, keeping `now` for redo.
    pub fn undo(&mut self, now: Snapshot) -> Option<(&'static str, Snapshot)> {
        let step = self.undo.pop()?;
        self.redo.push(Step { name: step.name, snapshot: now, bytes: step.bytes });
        Some((step.name, step.snapshot))
    }

    /// Takes the state to go forward to, keeping `now` for undo.
    pub fn redo(&mut self, now: Snapshot) -> Option<(&'static str, Snapshot)> {
        let step = self.redo.pop()?;
        self.undo.push(Step { name: step.name, snapshot: now, bytes: step.bytes });
        Some((step.name, step.snapshot))
    }

    /// Name of the change that undo would take back.
    pub fn undo_name(&self) -> Option<&'static str> {
        self.undo.last().map(|step| step.name)
    }

    /// Name of the change that redo would make again.
    pub fn redo_name(&self) -> Option<&'static str> {
        self.redo.last().map(|step| step.name)
    }

    /// Number of changes that can be taken back.
    pub fn len(&self) -> usize {
        self.undo.len()
    }

    /// Whether there is nothing to take back.
    pub fn is_empty(&self) -> bool {
        self.undo.is_empty()
    }

    fn cost(&self, snapshot: &Snapshot) -> usize {
        let pose = size_of_val(&*snapshot.pose.positions);
        match self.undo.last() {
            None => pose,
            Some(last) => {
                let shared = std::sync::Arc::ptr_eq(&last.snapshot.pose.positions, &snapshot.pose.positions);
                snapshot.scene.bytes_beyond(&last.snapshot.scene) + if shared { 0 } else { pose }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Selection;
    use pliant_solver::{LooseComponents, Rigidity, Weights};

    fn snapshot(x: f64) -> Snapshot {
        let scene = Scene {
            rigidity: Rigidity::uniform(100, 1),
            groups: [].into(),
            selection: Selection::default(),
            locked: Selection::default(),
            active: crate::document::ActiveGroups::default(),
            sets: [].into(),
            weights: Weights::default(),
            loose: LooseComponents::default(),
            method: crate::document::Method::default(),
            poses: [].into(),
        };
        Snapshot { scene, pose: Pose { positions: vec![glam::DVec3::splat(x); 100].into() } }
    }

    #[test]
    fn the_oldest_steps_are_forgotten_beyond_the_budget_and_the_newest_never() {
        let mut history = History { budget_bytes: 10_000, ..History::default() };
        for k in 0..20 {
            history.push("step", snapshot(f64::from(k)));
        }
        // 2400 bytes of positions and a little more in each.
        assert!((2..=4).contains(&history.len()), "{} steps were kept", history.len());
        let (_, newest) = history.undo(snapshot(20.0)).expect("a step");
        assert_eq!(newest.pose.positions[0].x, 19.0);
        let mut tiny = History { budget_bytes: 1, ..History::default() };
        tiny.push("step", snapshot(1.0));
        tiny.push("step", snapshot(2.0));
        assert_eq!(tiny.len(), 1, "the newest step must stay");
    }

    #[test]
    fn a_new_step_ends_the_redo_of_older_ones() {
        let mut history = History::default();
        history.push("a", snapshot(1.0));
        assert_eq!(history.undo(snapshot(2.0)).map(|(name, _)| name), Some("a"));
        assert_eq!(history.redo_name(), Some("a"));
        history.push("b", snapshot(1.0));
        assert_eq!(history.redo_name(), None);
    }
}
