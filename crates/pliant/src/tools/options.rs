//! What the inspector lets the user set for the tools. Kept between starts and in projects, by name: a new field needs nothing
//! more.

use pliant_solver::Rigidity;
use serde::{Deserialize, Serialize};

use super::{GizmoSettings, PaintOptions};

/// What a brush dab does to r.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BrushMode {
    /// Sets the current r.
    Set,
    /// One more, once a stroke.
    Stiffer,
    /// One less, once a stroke.
    Softer,
    /// The mean of the neighbors.
    Smooth,
    /// Locks what it touches; unlocks with Ctrl.
    Lock,
}

/// What a drag of the select tool draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SelectShape {
    /// A rectangle.
    Box,
    /// A free closed line.
    Lasso,
    /// A stroke of the brush's circle over the surface.
    Brush,
}

impl SelectShape {
    /// In the order of the inspector.
    pub const ALL: [SelectShape; 3] = [SelectShape::Box, SelectShape::Lasso, SelectShape::Brush];

    /// Name on its button.
    pub fn label(self) -> &'static str {
        match self {
            SelectShape::Box => "Box",
            SelectShape::Lasso => "Lasso",
            SelectShape::Brush => "Brush",
        }
    }

    /// The one after it.
    pub fn next(self) -> SelectShape {
        match self {
            SelectShape::Box => SelectShape::Lasso,
            SelectShape::Lasso => SelectShape::Brush,
            SelectShape::Brush => SelectShape::Box,
        }
    }
}

/// Settings of all tools; plain values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Options {
    /// r that brush and fill give.
    pub rigidity: u16,
    /// What the brush does.
    pub brush_mode: BrushMode,
    /// Brush radius on screen, in points.
    pub brush_radius_px: f32,
    /// More for brush and fill.
    pub paint: PaintOptions,
    /// Rings of vertices around the clicked one that become a handle or anchor; 0 is the vertex alone.
    pub patch_rings: u16,
    /// Box, lasso or brush.
    pub select_shape: SelectShape,
    /// Whether the active handle has a gizmo.
    pub show_gizmo: bool,
    /// What the gizmo shows, about which point and along which axes it works.
    pub gizmo: GizmoSettings,
    /// Whether box and lasso take hidden vertices too.
    pub select_through: bool,
}

impl Options {
    /// Largest patch, in rings (by eye).
    pub const MOST_PATCH_RINGS: u16 = 40;

    /// Takes over a patch size that looks alike on coarse and fine meshes: a fiftieth of the diagonal, but two rings at
    /// least, because a handle of one vertex pulls out a spike (by eye).
    pub fn fit_patch(&mut self, diagonal: f64, mean_edge: f64) {
        let rings = (0.02 * diagonal / mean_edge.max(f64::MIN_POSITIVE)).round();
        self.patch_rings = rings.clamp(2.0, f64::from(Options::MOST_PATCH_RINGS)) as u16;
    }

    /// The same with every number in its range: what was stored may come from anywhere.
    pub fn in_range(mut self) -> Options {
        let radius = Options::BRUSH_RADIUS_PX;
        self.rigidity = self.rigidity.clamp(1, Rigidity::MAX);
        self.brush_radius_px = self.brush_radius_px.clamp(*radius.start(), *radius.end());
        self.patch_rings = self.patch_rings.min(Options::MOST_PATCH_RINGS);
        self.paint = self.paint.in_range();
        self.gizmo = self.gizmo.in_range();
        self
    }

    /// Smallest and largest brush radius, in points (by eye).
    pub const BRUSH_RADIUS_PX: std::ops::RangeInclusive<f32> = 3.0..=400.0;
}

impl Default for Options {
    /// r = 6 is the paper's stiffest color.
    fn default() -> Options {
        Options {
            rigidity: 6,
            brush_mode: BrushMode::Set,
            brush_radius_px: 36.0,
            paint: PaintOptions::default(),
            patch_rings: 2,
            select_shape: SelectShape::Box,
            show_gizmo: true,
            gizmo: GizmoSettings::default(),
            select_through: true,
        }
    }
}
