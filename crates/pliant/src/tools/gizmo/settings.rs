//! What the user chooses about the gizmo.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use crate::document::{Group, GroupKind, Scene, rotation_of};
use crate::tools::View;

/// Which parts of the gizmo are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GizmoShown {
    /// Everything.
    All,
    /// Arrows and planes.
    Move,
    /// Rings.
    Turn,
    /// Knobs.
    Scale,
}

/// The point that turns and stretches leave in place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Pivot {
    /// The middle of all active handles.
    #[default]
    Middle,
    /// Each handle's own middle.
    Each,
    /// A point on the surface that was picked, world space.
    Point(#[serde(with = "numbers")] DVec3),
    /// The world's origin.
    Origin,
}

/// Which way the axes of the gizmo point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axes {
    /// As the world's.
    World,
    /// As the leading handle has been turned.
    Local,
    /// Right, up and toward the viewer.
    View,
}

/// Settings of the gizmo; plain values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct GizmoSettings {
    /// Which parts.
    pub shown: GizmoShown,
    /// About which point. One that was picked belongs to what is open, and is kept in its project.
    pub pivot: Pivot,
    /// Along which axes.
    pub axes: Axes,
    /// Grid of moves while Ctrl is held, in the model's units.
    pub step: f64,
}

impl Default for GizmoSettings {
    fn default() -> GizmoSettings {
        GizmoSettings { shown: GizmoShown::All, pivot: Pivot::Middle, axes: Axes::World, step: 0.1 }
    }
}

impl GizmoSettings {
    /// Takes over a grid that suits a model of this size, one, two or five times a power of ten near a hundredth of its
    /// diagonal (by eye), and lets go of a point picked on another.
    pub fn fit(&mut self, diagonal: f64) {
        self.step = round_number(0.01 * diagonal);
        if matches!(self.pivot, Pivot::Point(_)) {
            self.pivot = Pivot::Middle;
        }
    }

    /// The same with a grid that can be stepped on: what was stored may come from anywhere.
    pub fn in_range(mut self) -> GizmoSettings {
        if !(self.step.is_finite() && self.step > 0.0) {
            self.step = GizmoSettings::default().step;
        }
        if matches!(self.pivot, Pivot::Point(point) if !point.is_finite()) {
            self.pivot = Pivot::Middle;
        }
        self
    }

    /// Where the gizmo stands: the pivot, or the leading handle where each turns about its own. `None` without a handle
    /// among the active groups.
    pub fn place(&self, scene: &Scene) -> Option<DVec3> {
        let handles = || scene.active_groups().filter(|group| group.kind == GroupKind::Handle);
        let lead = handles().last()?;
        Some(match self.pivot {
            Pivot::Middle => handles().map(Group::center).sum::<DVec3>() / handles().count() as f64,
            Pivot::Each => lead.center(),
            Pivot::Point(point) => point,
            Pivot::Origin => DVec3::ZERO,
        })
    }

    /// The pivot of one of the active handles.
    pub fn pivot_of(&self, group: &Group, place: DVec3) -> DVec3 {
        if self.pivot == Pivot::Each { group.center() } else { place }
    }

    /// Unit axes of the gizmo.
    pub fn axes(&self, scene: &Scene, view: &View) -> DMat3 {
        let lead = || scene.active_groups().filter(|group| group.kind == GroupKind::Handle).last();
        match self.axes {
            Axes::World => DMat3::IDENTITY,
            Axes::Local => lead().and_then(|lead| rotation_of(lead.motion.matrix3)).unwrap_or(DMat3::IDENTITY),
            Axes::View => view_axes(view),
        }
    }
}

/// A point as three numbers.
mod numbers {
    use glam::DVec3;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(point: &DVec3, serializer: S) -> Result<S::Ok, S::Error> {
        point.to_array().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
        <[f64; 3]>::deserialize(deserializer).map(DVec3::from_array)
    }
}

/// Right, up and toward the viewer, orthonormal in double precision.
pub(super) fn view_axes(view: &View) -> DMat3 {
    DMat3::from_quat(view.camera.orientation.as_dquat().normalize())
}

/// The nearest of 1, 2, 5 times a power of ten, on a logarithmic scale.
fn round_number(x: f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return 1.0;
    }
    let power = 10_f64.powf(x.log10().floor());
    let candidates = [1.0, 2.0, 5.0, 10.0].map(|k| k * power);
    let far = |candidate: &f64| (candidate / x).ln().abs();
    candidates.into_iter().min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::round_number;

    #[test]
    fn the_grid_is_a_round_number_for_models_of_any_size() {
        for (x, expected) in [(0.017, 0.02), (1.0, 1.0), (3.9, 5.0), (8.0e5, 1.0e6), (0.0, 1.0), (f64::NAN, 1.0)] {
            let got = round_number(x);
            assert!((got / expected - 1.0).abs() < 1e-12, "{x}: {got}, expected {expected}");
        }
        assert!((round_number(4.0e-9) / 5.0e-9 - 1.0).abs() < 1e-12);
    }
}
