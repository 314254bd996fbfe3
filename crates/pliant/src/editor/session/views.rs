//! What of the session the picture shows.

use std::sync::Arc;

use super::Session;
use crate::editor::crossings::Wanted;
use crate::editor::{ColorBy, Crossings, Learning, NoticeKind, Shown};
use crate::solving::{Measured, SolveState};
use crate::viewport::{Coloring, SurfaceFrame};

impl Session {
    /// What colors the surface now, and the numbers for it where it is not r.
    pub(in crate::editor) fn coloring(&self) -> (Coloring, Option<Arc<[f32]>>) {
        if let Some(trial) = self.learning.as_ref().and_then(Learning::trial) {
            match trial.shown {
                Shown::Learned => return (Coloring::Rigidity, None),
                Shown::Confidence => return (Coloring::Energy, Some(trial.confidence().clone())),
                Shown::Now => {}
            }
        }
        let values = self.measured().map(|measured| measured.values.clone());
        match self.look.color_by {
            ColorBy::Rigidity => (Coloring::Rigidity, None),
            ColorBy::SoftStiff => (Coloring::SoftStiff { stiff_from: self.look.stiff_from }, None),
            ColorBy::Energy | ColorBy::EnergyDifference if values.is_some() => (Coloring::Energy, values),
            ColorBy::Stretch if values.is_some() => (Coloring::Stretch, values),
            ColorBy::Plain | ColorBy::Energy | ColorBy::EnergyDifference | ColorBy::Stretch => (Coloring::Plain, None),
        }
    }

    /// Whether the shape at rest is shown instead of the pose.
    pub fn shows_rest(&self) -> bool {
        self.shows_rest
    }

    /// Shows the shape at rest, or the pose again. What a tool had under way is taken back: it would go on unseen.
    pub fn toggle_rest(&mut self) {
        self.cancel_tool();
        self.shows_rest = !self.shows_rest && self.open.is_some();
    }

    /// The surface on screen: the pose, or the shape at rest.
    pub fn shown_frame(&self) -> Option<&Arc<SurfaceFrame>> {
        let open = self.open.as_ref()?;
        Some(if self.shows_rest { open.rest() } else { open.surface.frame() })
    }

    /// What is known of faces that cross others.
    pub fn crossings(&self) -> Crossings {
        self.document().map_or(Crossings::Off, |document| self.crossings.state(document.pose()))
    }

    /// The faces to point out: those that cross others, in the pose on screen.
    pub fn crossing_faces(&self) -> Option<Arc<[[u32; 3]]>> {
        let document =
            self.document().filter(|_| self.look.crossings && !self.shows_rest && self.player().is_none())?;
        self.crossings.faces(document.pose())
    }

    /// Looks for faces that cross others when the surface rests, and stops when it moves.
    pub(super) fn look_for_crossings(&mut self) {
        let Some(open) = self.open.as_ref().filter(|_| self.look.crossings) else {
            // Cannot fail: nothing is started.
            let _ = self.crossings.update(Wanted::Nothing);
            return;
        };
        let document = &open.document;
        let rests = self.status.report.as_ref().is_some_and(|report| {
            report.revision == document.revision()
                && matches!(report.state, SolveState::Settled | SolveState::Resting | SolveState::Failed(_))
        });
        let now = Wanted::Now(document.model(), document.pose());
        if let Err(why) = self.crossings.update(if rests { now } else { Wanted::Later }) {
            self.notices.push(NoticeKind::Error, why);
        }
    }

    /// What the chosen coloring shows of every vertex, once the solver's thread has told it.
    pub fn measured(&self) -> Option<&Measured> {
        let wanted = self.look.color_by.measure()?;
        self.status.report.as_ref()?.measured.as_ref().filter(|measured| measured.measure == wanted)
    }
}
