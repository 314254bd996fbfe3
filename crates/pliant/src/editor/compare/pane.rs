//! One way to solve, and what has been found of it.

use std::sync::Arc;
use std::time::Duration;

use pliant_solver::Rigidity;

use super::Measures;
use crate::document::{Document, Method, MethodKind, Pose};
use crate::solving::mailbox::Mailbox;
use crate::solving::{Measure, Measured, SolveRequest, SolveState};
use crate::viewport::SurfaceFrame;

/// The ways to solve that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PaneKind {
    /// r-ring with the painted rigidity.
    Painted,
    /// r-ring with the same r everywhere.
    Uniform,
    /// ARAP.
    Arap,
    /// SR-ARAP.
    SrArap,
    /// Embedded deformation.
    Embedded,
}

impl PaneKind {
    /// In the order in which they are shown.
    pub const ALL: [PaneKind; 5] =
        [PaneKind::Painted, PaneKind::Uniform, PaneKind::Arap, PaneKind::SrArap, PaneKind::Embedded];

    /// The method that solves it.
    pub fn method(self) -> MethodKind {
        match self {
            PaneKind::Painted | PaneKind::Uniform => MethodKind::RRing,
            PaneKind::Arap => MethodKind::Arap,
            PaneKind::SrArap => MethodKind::SrArap,
            PaneKind::Embedded => MethodKind::Embedded,
        }
    }

    /// What stands above it, with the parameters that count.
    pub fn title(self, method: &Method, uniform: u16) -> String {
        match self {
            PaneKind::Painted => "Rigidity as painted".into(),
            PaneKind::Uniform => format!("Rigidity {uniform} everywhere"),
            PaneKind::Arap => "ARAP".into(),
            PaneKind::SrArap => format!("SR-ARAP, smoothness {}", method.alpha),
            PaneKind::Embedded => format!("Embedded, {} nodes", method.nodes),
        }
    }

    /// What it should solve: the document's handles from rest, by its own method.
    pub(super) fn wish(
        self,
        document: &Document,
        uniform: u16,
        (round, measure): (u64, Option<Measure>),
    ) -> SolveRequest {
        let n = document.model().mesh.n_vertices();
        let wish = SolveRequest::of(document, measure);
        SolveRequest {
            epoch: round,
            pose: Pose { positions: document.model().mesh.positions().into() },
            rigidity: match self {
                PaneKind::Uniform => Rigidity::uniform(n, uniform),
                PaneKind::Arap => Rigidity::uniform(n, 1),
                _ => document.scene().rigidity.clone(),
            },
            method: wish.method.with(self.method()),
            ..wish
        }
    }
}

/// What the thread tells of a pane.
#[derive(Clone)]
pub(super) struct News {
    /// Of the document, when this was wished for.
    pub(super) revision: u64,
    pub(super) state: SolveState,
    /// None if it is as last told.
    pub(super) frame: Option<Arc<SurfaceFrame>>,
    pub(super) measured: Option<Measured>,
    pub(super) energy: f64,
    /// Iterations since the wish changed.
    pub(super) iterations: u64,
    /// Its own work since then, preparation included.
    pub(super) spent: Duration,
    /// Once it has settled.
    pub(super) measures: Option<Measures>,
}

impl News {
    /// A surface that has not been looked at yet goes on with later news that bring none.
    pub(super) fn over(old: News, new: News) -> News {
        News { frame: new.frame.or(old.frame), ..new }
    }
}

/// A way to solve with what has been found.
pub struct Pane {
    /// Which.
    pub kind: PaneKind,
    /// The surface in view space; none before the first is there.
    pub frame: Option<Arc<SurfaceFrame>>,
    /// Numbers of vertices for its colors, when asked for.
    pub measured: Option<Measured>,
    /// How it is doing; none before it has begun.
    pub state: Option<SolveState>,
    /// Energy of its own method.
    pub energy: f64,
    /// Iterations since handles or sizes last changed.
    pub iterations: u64,
    /// Its own work since then, preparation included.
    pub spent: Duration,
    /// What it comes to, once settled.
    pub measures: Option<Measures>,
    /// Whether all of this is about the newest wish.
    pub is_current: bool,
    mailbox: Arc<Mailbox<News>>,
}

impl Pane {
    pub(super) fn new(kind: PaneKind) -> Pane {
        Pane {
            kind,
            frame: None,
            measured: None,
            state: None,
            energy: 0.0,
            iterations: 0,
            spent: Duration::ZERO,
            measures: None,
            is_current: false,
            mailbox: Arc::new(Mailbox::new()),
        }
    }

    pub(super) fn mailbox(&self) -> Arc<Mailbox<News>> {
        self.mailbox.clone()
    }

    /// Whether something is still to come.
    pub fn is_working(&self) -> bool {
        match &self.state {
            None | Some(SolveState::Preparing { .. } | SolveState::Iterating) => true,
            Some(SolveState::Settled) => self.measures.is_none(),
            Some(SolveState::Resting | SolveState::Failed(_)) => false,
        }
    }

    /// Takes what is new; `revision` is that of the newest wish.
    pub(super) fn poll(&mut self, revision: u64) -> bool {
        let Ok(Some(news)) = self.mailbox.take() else { return false };
        self.is_current = news.revision == revision;
        self.frame = news.frame.or(self.frame.take());
        self.measured = news.measured;
        (self.energy, self.iterations, self.spent) = (news.energy, news.iterations, news.spent);
        (self.state, self.measures) = (Some(news.state), news.measures);
        true
    }
}
