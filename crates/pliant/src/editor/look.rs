//! How the surface is shown: not part of the document, not undone.

use pliant_solver::Rigidity;

use crate::viewport::{Shading, Theme};

/// r at the stiff end of the color ramp: the paper's 6, or more if the surface has more.
pub(super) fn ramp_max(rigidity: &Rigidity) -> u16 {
    rigidity.max().max(6)
}

/// What colors the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorBy {
    /// The file's own colors.
    Plain,
    /// r.
    Rigidity,
    /// Energy of each vertex (paper Fig. 3).
    Energy,
}

/// Settings of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// What colors the surface.
    pub color_by: ColorBy,
    /// How much of the color shows, 0 to 1.
    pub opacity: f32,
    /// Smooth or flat.
    pub shading: Shading,
    /// Edges drawn over the surface.
    pub wireframe: bool,
    /// Ground grid.
    pub grid: bool,
    /// Dots of handles and anchors, and the gizmo.
    pub handles: bool,
    /// Dark or light.
    pub theme: Theme,
}

impl Default for Look {
    fn default() -> Look {
        Look {
            color_by: ColorBy::Rigidity,
            opacity: 0.85,
            shading: Shading::Smooth,
            wireframe: false,
            grid: true,
            handles: true,
            theme: Theme::Dark,
        }
    }
}
