//! Arrows, planes, rings and knobs around the active handles: plain values, begin → measure → change.
//!
//! A drag is *measured* as one or two numbers (a way, an angle, a factor), which may then be snapped to a grid or
//! replaced by what is typed, and only then becomes a [`Change`]: so a typed angle is exact.

mod measure;
mod settings;
mod shapes;

use glam::{DMat3, DVec2, DVec3, Vec2, Vec3};

use super::View;
use crate::document::Change;
use crate::viewport::Line;

pub use settings::{Axes, GizmoSettings, GizmoShown, Pivot};

/// Length of an arrow on screen, in points (by eye).
const ARROW_PX: f32 = 78.0;
/// How near, in points, the pointer must be to take a part.
const REACH_PX: f32 = 7.0;
/// This far around the middle nothing is taken, so that the dots there can be dragged.
const FREE_PX: f32 = 14.0;
/// Rotation step while Ctrl is held.
const SNAP_DEGREES: f64 = 15.0;
/// Step of factors while Ctrl is held (by eye).
const SNAP_FACTOR: f64 = 0.1;
/// Stretches stay above this: a patch pressed flat cannot be pulled apart again.
const SMALLEST_FACTOR: f64 = 1e-3;

const AXIS_COLORS: [[u8; 4]; 3] = [[235, 84, 84, 255], [122, 196, 72, 255], [84, 142, 240, 255]];
const HOT_COLOR: [u8; 4] = [255, 214, 92, 255];
const NEUTRAL_COLOR: [u8; 4] = [225, 225, 225, 255];
/// A locked axis is drawn this many arrows long to both sides (by eye).
const AXIS_LINE: f32 = 40.0;

/// What can be taken with the mouse. Axes are numbered x = 0, y = 1, z = 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GizmoPart {
    /// No part: the handle itself, which moves in the plane of the view.
    Free,
    /// An arrow: moves along an axis.
    Move(usize),
    /// A small square: moves across an axis.
    MovePlane(usize),
    /// A ring: turns about an axis.
    Rotate(usize),
    /// The outer ring: turns about the direction of view.
    RotateView,
    /// The knob on the outer ring: scales alike along all axes.
    Scale,
    /// The knob beyond an arrow: scales along an axis.
    ScaleAxis(usize),
}

impl GizmoPart {
    /// Whether dragging it turns.
    pub fn turns(self) -> bool {
        matches!(self, GizmoPart::Rotate(_) | GizmoPart::RotateView)
    }

    /// Whether dragging it stretches.
    pub fn scales(self) -> bool {
        matches!(self, GizmoPart::Scale | GizmoPart::ScaleAxis(_))
    }

    /// The same kind of change along one axis.
    pub fn locked_to(self, axis: usize) -> GizmoPart {
        match self {
            _ if self.turns() => GizmoPart::Rotate(axis),
            _ if self.scales() => GizmoPart::ScaleAxis(axis),
            _ => GizmoPart::Move(axis),
        }
    }
}

/// A gizmo with its size for the present view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gizmo {
    /// Where it stands, view space.
    pub center: Vec3,
    /// Unit axes in the world.
    axes: DMat3,
    /// Right, up and toward the viewer.
    view_axes: DMat3,
    length: f32,
    shown: GizmoShown,
}

impl Gizmo {
    /// A gizmo that looks equally large wherever it is.
    pub fn new(center: Vec3, axes: DMat3, shown: GizmoShown, view: &View) -> Gizmo {
        let length = ARROW_PX * view.camera.world_per_px(center, view.size);
        Gizmo { center, axes, view_axes: settings::view_axes(view), length, shown }
    }

    /// The part under the pointer, if any.
    pub fn hit(&self, px: Vec2, view: &View) -> Option<GizmoPart> {
        let screen = |p: Vec3| view.camera.project(p, view.size).map(|(px, _)| px);
        if screen(self.center)?.distance(px) < FREE_PX {
            return None;
        }
        let distance = |part: &GizmoPart| {
            let strokes = self.strokes(*part, view);
            let of = |stroke: &shapes::Stroke| match (screen(stroke.a), screen(stroke.b)) {
                (Some(a), Some(b)) => distance_to_segment(px, a, b) - 0.5 * stroke.width_px,
                _ => f32::INFINITY,
            };
            strokes.iter().map(of).fold(f32::INFINITY, f32::min)
        };
        let parts = self.parts(view).into_iter().map(|part| (distance(&part), part));
        let nearest = parts.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|&(distance, _)| distance < REACH_PX).map(|(_, part)| part)
    }

    /// Lines to draw, the part under the pointer highlighted.
    pub fn lines(&self, hot: Option<GizmoPart>, view: &View) -> Vec<Line> {
        let mut lines = Vec::new();
        for part in self.parts(view) {
            let color = if hot == Some(part) { HOT_COLOR } else { color(part) };
            let strokes = self.strokes(part, view);
            lines.extend(strokes.iter().map(|s| Line { a: s.a, b: s.b, color, width_px: s.width_px, on_top: true }));
        }
        lines
    }

    /// The long line that shows along or about which axis a part acts.
    pub fn axis_line(&self, part: GizmoPart) -> Option<Line> {
        let (GizmoPart::Move(axis) | GizmoPart::Rotate(axis) | GizmoPart::ScaleAxis(axis)) = part else { return None };
        let way = self.axis(axis) * self.length * AXIS_LINE;
        let [red, green, blue, _] = AXIS_COLORS[axis];
        let color = [red, green, blue, 150];
        Some(Line { a: self.center - way, b: self.center + way, color, width_px: 1.2, on_top: true })
    }

    /// The axis along which a way in the plane of the view goes farthest.
    pub fn main_axis(&self, from: Vec2, to: Vec2, view: &View) -> usize {
        let way = view.camera.drag_in_view_plane(self.center, to - from, view.size);
        let along = |axis: usize| way.dot(self.axis(axis)).abs();
        (0..3).max_by(|&a, &b| along(a).total_cmp(&along(b))).unwrap_or(0)
    }

    /// Rounds what was measured to the grid that `step` and the kind of part give.
    pub fn snap(part: GizmoPart, measured: DVec2, step: f64) -> DVec2 {
        let round = |x: f64, step: f64| (x / step).round() * step;
        match part {
            _ if part.turns() => DVec2::new(round(measured.x.to_degrees(), SNAP_DEGREES).to_radians(), 0.0),
            _ if part.scales() => DVec2::new(round(measured.x, SNAP_FACTOR).max(SNAP_FACTOR), 0.0),
            _ if step > 0.0 => measured.map(|x| round(x, step)),
            _ => measured,
        }
    }

    /// A typed number in place of what was measured: units along the way, degrees, or a factor.
    pub fn typed(part: GizmoPart, value: f64, measured: Option<DVec2>) -> DVec2 {
        match part {
            _ if part.turns() => DVec2::new(value.to_radians(), 0.0),
            GizmoPart::Free | GizmoPart::MovePlane(_) => measured.unwrap_or_default().normalize_or(DVec2::X) * value,
            _ => DVec2::new(value, 0.0),
        }
    }

    /// What of a way in space a part that moves can go: all of it, along its axis, or in its plane.
    pub fn share(&self, part: GizmoPart, way: DVec3) -> Option<DVec3> {
        match part {
            GizmoPart::Free => Some(way),
            GizmoPart::Move(axis) => Some(self.axes.col(axis) * way.dot(self.axes.col(axis))),
            GizmoPart::MovePlane(normal) => Some(way - self.axes.col(normal) * way.dot(self.axes.col(normal))),
            GizmoPart::Rotate(_) | GizmoPart::RotateView | GizmoPart::Scale | GizmoPart::ScaleAxis(_) => None,
        }
    }

    /// What the numbers of a part mean.
    pub fn change(&self, part: GizmoPart, amount: DVec2) -> Change {
        match part {
            GizmoPart::Free => Change::moved(self.view_axes.x_axis * amount.x + self.view_axes.y_axis * amount.y),
            GizmoPart::Move(axis) => Change::moved(self.axes.col(axis) * amount.x),
            GizmoPart::MovePlane(normal) => {
                let (u, v) = (self.axes.col((normal + 1) % 3), self.axes.col((normal + 2) % 3));
                Change::moved(u * amount.x + v * amount.y)
            }
            GizmoPart::Rotate(axis) => Change::turned(self.axes.col(axis), amount.x),
            GizmoPart::RotateView => Change::turned(self.view_axes.z_axis, amount.x),
            GizmoPart::Scale => Change::scaled(self.axes, DVec3::splat(amount.x.max(SMALLEST_FACTOR))),
            GizmoPart::ScaleAxis(axis) => {
                let mut factors = DVec3::ONE;
                factors[axis] = amount.x.max(SMALLEST_FACTOR);
                Change::scaled(self.axes, factors)
            }
        }
    }

    /// A unit axis, view space.
    fn axis(&self, axis: usize) -> Vec3 {
        self.axes.col(axis).as_vec3()
    }
}

fn color(part: GizmoPart) -> [u8; 4] {
    match part {
        GizmoPart::Move(axis) | GizmoPart::MovePlane(axis) | GizmoPart::Rotate(axis) | GizmoPart::ScaleAxis(axis) => {
            AXIS_COLORS[axis]
        }
        GizmoPart::RotateView => [225, 225, 225, 130],
        GizmoPart::Free | GizmoPart::Scale => NEUTRAL_COLOR,
    }
}

fn distance_to_segment(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

#[cfg(test)]
mod tests;
