//! The thread that solves the panes, one at a time and in turns.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use super::lane::Lane;
use super::measures::Yardstick;
use super::pane::News;
use crate::solving::mailbox::{Closed, Mailbox};
use crate::solving::{Groundwork, SolveRequest};

/// Vertices up to which every pane keeps its solver: five of them take 8 to 17 kB a vertex (measured: 1.6 kB each at r = 1,
/// 3.3 kB at r = 20). Beyond, a pane that has settled makes room for the next, and prepares anew when handles move.
const KEPT_VERTICES: usize = 200_000;

/// What all panes should solve, in their order.
pub(super) struct Task {
    pub(super) wishes: Vec<SolveRequest>,
}

/// What all panes stand on, and are measured by.
struct Base {
    ground: Arc<Groundwork>,
    yardstick: Yardstick,
}

struct Runner {
    inbox: Arc<Mailbox<Task>>,
    outboxes: Vec<Arc<Mailbox<News>>>,
    base: Option<Base>,
    lanes: Vec<Lane>,
    /// The lane whose turn it is.
    turn: usize,
}

/// Starts the thread. It ends when the mailbox is closed.
pub(super) fn spawn(
    inbox: Arc<Mailbox<Task>>,
    outboxes: Vec<Arc<Mailbox<News>>>,
    ground: Option<Arc<Groundwork>>,
    wake: impl Fn() + Send + 'static,
) -> std::io::Result<()> {
    std::thread::Builder::new().name("compare".into()).spawn(move || {
        let mut runner = Runner { inbox, outboxes, base: None, lanes: Vec::new(), turn: 0 };
        // The only way out is the closed mailbox.
        while runner.round(&ground, &wake).is_ok() {}
    })?;
    Ok(())
}

impl Runner {
    /// Takes a task if there is one, or waits for one if nothing is left to be done; then works for one turn.
    fn round(&mut self, given: &Option<Arc<Groundwork>>, wake: &impl Fn()) -> Result<(), Closed> {
        let has_work = self.lanes.iter().any(Lane::has_work);
        let task = if has_work { self.inbox.take()? } else { Some(self.inbox.wait()?) };
        if let Some(task) = task {
            self.take(task, given);
        }
        let Some(place) = self.next() else { return Ok(()) };
        let news = self.work(place);
        self.outboxes[place].put_over(news, News::over);
        wake();
        Ok(())
    }

    fn take(&mut self, task: Task, given: &Option<Arc<Groundwork>>) {
        let Some(first) = task.wishes.first() else { return };
        if self.base.as_ref().is_none_or(|base| !base.ground.serves(first)) {
            self.lanes.clear();
            // The old one goes before the new one comes.
            self.base = None;
            let ground = given.clone().filter(|ground| ground.serves(first));
            let ground = ground.unwrap_or_else(|| Arc::new(Groundwork::new(first)));
            self.base = Some(Base { yardstick: Yardstick::new(&first.model.mesh), ground });
        }
        for (place, wish) in task.wishes.into_iter().enumerate() {
            match self.lanes.get_mut(place) {
                Some(lane) => lane.wish(wish),
                None => self.lanes.push(Lane::new(wish)),
            }
        }
    }

    /// The lane whose turn it is: the next one, or the same until it has settled where there is no room for all.
    fn next(&mut self) -> Option<usize> {
        let n = self.lanes.len();
        let stays = !self.has_room() && self.lanes.get(self.turn).is_some_and(Lane::has_work);
        let first = if stays { self.turn } else { self.turn + 1 };
        let place = (first..first + n).map(|k| k % n).find(|&place| self.lanes[place].has_work())?;
        if place != self.turn && !self.has_room() {
            self.lanes.iter_mut().for_each(Lane::free);
        }
        self.turn = place;
        Some(place)
    }

    fn has_room(&self) -> bool {
        let n_vertices = self.base.as_ref().map_or(0, |base| base.ground.analysis().mesh().n_vertices());
        n_vertices <= KEPT_VERTICES
    }

    fn work(&mut self, place: usize) -> News {
        let Runner { inbox, base, lanes, .. } = self;
        let lane = &mut lanes[place];
        let is_overruled = |about: &SolveRequest| {
            inbox.has(|task| task.wishes.get(place).is_some_and(|newer| newer.is_other_system(about)))
        };
        let worked = catch_unwind(AssertUnwindSafe(|| {
            let base = base.as_ref().expect("there are no lanes without what they stand on");
            lane.work((&base.ground, &base.yardstick), &is_overruled)
        }));
        worked.unwrap_or_else(|_| {
            lane.broke("it stopped unexpectedly; please report it".into());
            lane.news(None)
        })
    }
}
