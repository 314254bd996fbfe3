//! What the inspector lets the user set for brush and flood fill.

use serde::{Deserialize, Serialize};

use super::{MirrorOptions, Options};

/// What the brush's radius is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BrushUnit {
    /// Points on screen: zooming in paints finer.
    Screen,
    /// The model's own units: the same wherever one looks from.
    Model,
}

/// Which vertices a dab reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BrushReach {
    /// Along the surface, around edges as well, but never to a sheet that only lies near in space.
    Surface,
    /// Along the surface, only where it faces the eye.
    Front,
    /// Everything under the circle, hidden or not: both sides of an arm at once.
    Through,
}

/// What bounds the region that a click of the flood fill takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FillBoundary {
    /// Another r; a click into the selection takes the selection.
    Rigidity,
    /// The edge of the selection, from either side.
    Selection,
    /// Edges at which the surface turns sharply, at rest.
    SharpEdges,
    /// Nothing: all that hangs together.
    Piece,
    /// The part or material as the file names it.
    Part,
}

impl FillBoundary {
    /// In the order of the inspector, with a name and a sentence.
    pub const ALL: [(FillBoundary, &'static str, &'static str); 5] = [
        (FillBoundary::Rigidity, "Equal rigidity", "As far as rigidity is the same; in the selection, the selection"),
        (FillBoundary::Selection, "Selection", "As far as the selection goes, or up to it from outside"),
        (FillBoundary::SharpEdges, "Sharp edges", "As far as the surface goes on without a sharp edge"),
        (FillBoundary::Piece, "Whole piece", "All that hangs together with the clicked point"),
        (FillBoundary::Part, "Part of the file", "The part or material that the file names there"),
    ];
}

/// Settings of brush and flood fill beyond mode, screen radius and r.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PaintOptions {
    /// Which of the two radii counts.
    pub unit: BrushUnit,
    /// Radius in model units.
    pub radius: f32,
    /// Way between dabs of a stroke, in radii.
    pub spacing: f32,
    /// Which vertices a dab reaches.
    pub reach: BrushReach,
    /// What bounds a fill.
    pub boundary: FillBoundary,
    /// Edges that turn by more than this are sharp, in degrees.
    pub sharp_degrees: f32,
    /// Whether painting is mirrored, and how.
    pub mirror: MirrorOptions,
}

impl PaintOptions {
    /// Smallest and largest way between dabs, in radii (by eye): beyond two, dabs no longer touch.
    pub const SPACING: std::ops::RangeInclusive<f32> = 0.05..=2.0;
    /// Angles that can be told from those of any smooth mesh, and that any mesh has.
    pub const SHARP_DEGREES: std::ops::RangeInclusive<f32> = 1.0..=179.0;

    /// The same with every number where the window would leave it: files and fields may hold anything.
    pub fn in_range(mut self) -> PaintOptions {
        let usual = PaintOptions::default();
        let within = |x: f32, range: std::ops::RangeInclusive<f32>, usual: f32| {
            if x.is_nan() { usual } else { x.clamp(*range.start(), *range.end()) }
        };
        self.spacing = within(self.spacing, Self::SPACING, usual.spacing);
        self.sharp_degrees = within(self.sharp_degrees, Self::SHARP_DEGREES, usual.sharp_degrees);
        self.radius = if self.radius.is_normal() { self.radius.abs() } else { usual.radius };
        self.mirror = self.mirror.in_range();
        self
    }

    /// Takes over sizes that suit a model of this diagonal and edge length.
    pub fn fit(&mut self, diagonal: f64, mean_edge: f64) {
        // A brush of a twentieth of the model is neither lost on it nor larger than its limbs (by eye).
        self.radius = (0.05 * diagonal) as f32;
        self.mirror.fit(mean_edge);
    }
}

impl Default for PaintOptions {
    fn default() -> PaintOptions {
        PaintOptions {
            unit: BrushUnit::Screen,
            radius: 0.1,
            // The edge of a stroke looks smooth (by eye).
            spacing: 0.25,
            reach: BrushReach::Surface,
            boundary: FillBoundary::Rigidity,
            // Between the facets of a cylinder of twelve sides and the edges of a box: what modellers' tools begin with.
            sharp_degrees: 30.0,
            mirror: MirrorOptions::default(),
        }
    }
}

impl Options {
    /// Radius of the brush in model units, where a point on screen is this large.
    pub fn brush_radius(&self, world_per_px: f32) -> f32 {
        match self.paint.unit {
            BrushUnit::Screen => self.brush_radius_px * world_per_px,
            BrushUnit::Model => self.paint.radius,
        }
    }

    /// Makes the brush larger or smaller by a move of the pointer to the side.
    pub fn drag_brush(&mut self, delta_px: f32) {
        match self.paint.unit {
            BrushUnit::Screen => {
                let range = Options::BRUSH_RADIUS_PX;
                self.brush_radius_px = (self.brush_radius_px + 0.5 * delta_px).clamp(*range.start(), *range.end());
            }
            // 70 points double it: about as fast as on screen at the radius one starts with.
            BrushUnit::Model => self.scale_brush((0.01 * delta_px).exp()),
        }
    }

    /// Makes the brush larger or smaller by a factor.
    pub fn scale_brush(&mut self, factor: f32) {
        match self.paint.unit {
            BrushUnit::Screen => {
                let range = Options::BRUSH_RADIUS_PX;
                self.brush_radius_px = (self.brush_radius_px * factor).clamp(*range.start(), *range.end());
            }
            BrushUnit::Model => {
                let radius = self.paint.radius * factor;
                if radius.is_normal() {
                    self.paint.radius = radius;
                }
            }
        }
    }
}
