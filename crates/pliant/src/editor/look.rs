//! How the surface is shown: not part of the document, not undone. Kept between starts and in projects, by name: a new field
//! needs nothing more.

use pliant_solver::Rigidity;
use serde::{Deserialize, Serialize};

use crate::solving::Measure;
use crate::viewport::{Matcap, Shading, Theme};

/// r at the stiff end of the color ramp: the paper's 6, or more if the surface has more.
pub(super) fn ramp_max(rigidity: &Rigidity) -> u16 {
    rigidity.max().max(6)
}

/// What colors the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ColorBy {
    /// The file's own colors.
    Plain,
    /// r.
    Rigidity,
    /// Soft or stiff, in two colors.
    SoftStiff,
    /// Energy of each vertex (paper Fig. 3).
    Energy,
    /// Largest difference of that energy to a neighboring vertex (paper Fig. 3c, e, g).
    EnergyDifference,
    /// How far edges are from their length at rest.
    Stretch,
}

impl ColorBy {
    /// Every coloring, in the order of menus.
    pub const ALL: [ColorBy; 6] = [
        ColorBy::Plain,
        ColorBy::Rigidity,
        ColorBy::SoftStiff,
        ColorBy::Energy,
        ColorBy::EnergyDifference,
        ColorBy::Stretch,
    ];

    /// Its name in lists.
    pub const fn label(self) -> &'static str {
        match self {
            ColorBy::Plain => "File colors",
            ColorBy::Rigidity => "Rigidity",
            ColorBy::SoftStiff => "Soft / stiff",
            ColorBy::Energy => "Energy",
            ColorBy::EnergyDifference => "Energy difference",
            ColorBy::Stretch => "Edge stretch",
        }
    }

    /// One sentence more.
    pub const fn tooltip(self) -> &'static str {
        match self {
            ColorBy::Plain => "Colors and textures of the file, clay where it has none",
            ColorBy::Rigidity => "How stiff each vertex is, from soft blue to stiff red",
            ColorBy::SoftStiff => "Two colors: soft, and stiff from a rigidity on that you choose",
            ColorBy::Energy => {
                "Where the surface is strained most: the share of each vertex in the energy (E_k of eq. 1)"
            }
            ColorBy::EnergyDifference => {
                "Where strain changes abruptly: the largest difference of energy to a neighboring vertex"
            }
            ColorBy::Stretch => {
                "Which edges got longer or shorter than at rest: of each vertex the edge that changed most"
            }
        }
    }

    /// What the solver's thread has to measure for it.
    pub(super) fn measure(self) -> Option<Measure> {
        match self {
            ColorBy::Plain | ColorBy::Rigidity | ColorBy::SoftStiff => None,
            ColorBy::Energy => Some(Measure::Energy),
            ColorBy::EnergyDifference => Some(Measure::EnergyDifference),
            ColorBy::Stretch => Some(Measure::Stretch),
        }
    }
}

/// Every shading with its name and one sentence more, in the order of menus.
pub(super) const SHADINGS: [(Shading, &str, &str); 6] = [
    (Shading::Smooth, "Smooth", "Three soft lamps on a smooth surface"),
    (Shading::Flat, "Flat", "The same lamps on single faces"),
    (Shading::Matcap(Matcap::Clay), "Clay", "Warm modelling clay, lit alike from wherever one looks"),
    (Shading::Matcap(Matcap::Porcelain), "Porcelain", "Glazed porcelain: sharp reflections show small bumps"),
    (Shading::Matcap(Matcap::Metal), "Metal", "Brushed metal between sky and ground: shows how the form leans"),
    (Shading::Matcap(Matcap::Stripes), "Stripes", "Reflected stripes: where they break, the surface is not smooth"),
];

/// Settings of the picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Look {
    /// What colors the surface.
    pub color_by: ColorBy,
    /// How much of the color shows, 0 to 1.
    pub opacity: f32,
    /// The smallest r that counts as stiff where two colors tell soft from stiff.
    pub stiff_from: u16,
    /// Smooth or flat.
    pub shading: Shading,
    /// Edges drawn over the surface.
    pub wireframe: bool,
    /// The surface hides only little of what is behind it.
    pub see_through: bool,
    /// Faces that pass through others are looked for and pointed out.
    pub crossings: bool,
    /// Ground grid.
    pub grid: bool,
    /// Dots of handles and anchors, and the gizmo.
    pub handles: bool,
    /// Dark or light.
    pub theme: Theme,
}

impl Look {
    /// The same with every number in its range: what was stored may come from anywhere.
    pub fn in_range(mut self) -> Look {
        self.opacity = self.opacity.clamp(0.0, 1.0);
        self.stiff_from = self.stiff_from.clamp(2, Rigidity::MAX);
        self
    }
}

impl Default for Look {
    fn default() -> Look {
        Look {
            color_by: ColorBy::Rigidity,
            opacity: 0.85,
            // Half of the paper's 1 to 6.
            stiff_from: 3,
            shading: Shading::Smooth,
            wireframe: false,
            see_through: false,
            crossings: false,
            grid: true,
            handles: true,
            theme: Theme::Dark,
        }
    }
}
