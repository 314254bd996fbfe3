//! What of the session the picture shows.

use std::sync::Arc;

use super::Session;
use crate::editor::{ColorBy, Learning, Shown};
use crate::solving::Measured;
use crate::viewport::Coloring;

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

    /// What the chosen coloring shows of every vertex, once the solver's thread has told it.
    pub fn measured(&self) -> Option<&Measured> {
        let wanted = self.look.color_by.measure()?;
        self.status.report.as_ref()?.measured.as_ref().filter(|measured| measured.measure == wanted)
    }
}
