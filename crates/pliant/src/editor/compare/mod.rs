//! The same handles solved by every method side by side, without a window.
//!
//! A [`Pane`] is one way to solve. [`Compare`] tells a thread of its own what every pane should solve, and takes what it
//! has to show. The thread works on one pane at a time, in turns, so that it never takes more of the processor than the
//! editor's own solver does; when all have settled it sleeps. Each pane is judged when it has settled, by its own energy
//! and by measures that are the same for all (see `measures.rs`).

mod lane;
mod measures;
mod pane;
mod picture;
mod runner;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::document::Document;
use crate::solving::mailbox::Mailbox;
use crate::solving::{Groundwork, Measure, SolveRequest};
pub use measures::Measures;
pub use pane::{Pane, PaneKind};
pub(crate) use picture::{crop, write_picture};
use runner::Task;

/// The comparison while it is open.
pub struct Compare {
    panes: Vec<Pane>,
    inbox: Arc<Mailbox<Task>>,
    /// r of the pane that has the same everywhere.
    uniform: u16,
    /// Goes up with every wish to begin anew from rest.
    round: u64,
    /// What the thread was last told: revision of the document, r, round, and what colors the vertices.
    sent: Option<(u64, u16, u64, Option<Measure>)>,
}

impl Compare {
    /// Starts the thread; it sleeps until [`Compare::tell`]. `ground`: what the editor's own solver stands on, if it is
    /// there. `wake` is called from the thread when [`Compare::poll`] has something to do.
    pub fn start(
        uniform: u16,
        ground: Option<Arc<Groundwork>>,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Compare> {
        let panes: Vec<Pane> = PaneKind::ALL.map(Pane::new).into();
        let inbox = Arc::new(Mailbox::new());
        let outboxes = panes.iter().map(Pane::mailbox).collect();
        runner::spawn(inbox.clone(), outboxes, ground, wake)?;
        Ok(Compare { panes, inbox, uniform, round: 0, sent: None })
    }

    /// States what the document wants now, unless the thread knows.
    pub fn tell(&mut self, document: &Document, measure: Option<Measure>) {
        let wish = (document.revision(), self.uniform, self.round, measure);
        if self.sent == Some(wish) {
            return;
        }
        self.sent = Some(wish);
        let (uniform, round) = (self.uniform, self.round);
        let wishes: Vec<SolveRequest> =
            self.panes.iter().map(|pane| pane.kind.wish(document, uniform, (round, measure))).collect();
        self.panes.iter_mut().for_each(|pane| pane.is_current = false);
        self.inbox.put(Task { wishes });
    }

    /// Takes what the thread has to show. Whether anything is new.
    pub fn poll(&mut self) -> bool {
        let revision = self.sent.map_or(0, |sent| sent.0);
        let mut is_new = false;
        for pane in &mut self.panes {
            is_new |= pane.poll(revision);
        }
        is_new
    }

    /// The panes, in the order in which they are shown.
    pub fn panes(&self) -> &[Pane] {
        &self.panes
    }

    /// r of the pane that has the same everywhere.
    pub fn uniform(&self) -> u16 {
        self.uniform
    }

    /// Another r for that pane; [`Compare::tell`] then passes it on.
    pub fn set_uniform(&mut self, r: u16) {
        self.uniform = r.clamp(1, pliant_solver::Rigidity::MAX);
    }

    /// Lets all begin anew from rest; [`Compare::tell`] then passes it on.
    pub fn begin_anew(&mut self) {
        self.round += 1;
    }

    /// Whether nothing is left to be done.
    pub fn is_settled(&self) -> bool {
        self.panes.iter().all(|pane| pane.is_current && !pane.is_working())
    }
}

impl Drop for Compare {
    fn drop(&mut self) {
        self.inbox.close();
    }
}
