//! What a way of the pointer means for a part: a way in space, an angle, a factor.

use glam::{DVec2, Vec2, Vec3};
use pliant_geometry::Ray;

use super::{Gizmo, GizmoPart};
use crate::tools::View;

/// A ring's plane seen at a smaller slope than this says too little about the angle (by eye).
const EDGE_ON: f32 = 0.15;

impl Gizmo {
    /// The numbers of a part when it is dragged from one pixel to another: way along one or two axes, radians, or factor.
    /// `None` where the mouse says nothing (looking exactly along an arrow).
    pub fn measure(&self, part: GizmoPart, from: Vec2, to: Vec2, view: &View) -> Option<DVec2> {
        let measured = match part {
            GizmoPart::Free => {
                let way = view.camera.drag_in_view_plane(self.center, to - from, view.size).as_dvec3();
                DVec2::new(way.dot(self.view_axes.x_axis), way.dot(self.view_axes.y_axis))
            }
            GizmoPart::Move(axis) => {
                let along = |px| parameter_on_line(view.camera.ray(px, view.size), self.center, self.axis(axis));
                one(along(to)? - along(from)?)
            }
            GizmoPart::MovePlane(normal) => {
                let on_plane = |px| self.on_plane(self.axis(normal), px, view);
                let way = (on_plane(to)? - on_plane(from)?).as_dvec3();
                DVec2::new(way.dot(self.axes.col((normal + 1) % 3)), way.dot(self.axes.col((normal + 2) % 3)))
            }
            GizmoPart::Rotate(axis) => one(self.turn(self.axis(axis), from, to, view)?),
            GizmoPart::RotateView => one(self.turn(self.view_axes.z_axis.as_vec3(), from, to, view)?),
            GizmoPart::Scale | GizmoPart::ScaleAxis(_) => {
                let (center, _) = view.camera.project(self.center, view.size)?;
                let (before, after) = (from.distance(center).max(1.0), to.distance(center).max(1.0));
                one(after / before)
            }
        };
        measured.is_finite().then_some(measured)
    }

    /// From the middle to where the plane across `normal` lies under a pixel.
    fn on_plane(&self, normal: Vec3, px: Vec2, view: &View) -> Option<Vec3> {
        let ray = view.camera.ray(px, view.size);
        let t = (self.center - ray.origin).dot(normal) / ray.direction.dot(normal);
        (t.is_finite() && t > 0.0).then(|| ray.origin + ray.direction * t - self.center)
    }

    /// Angle about an axis between two pixels: in the ring's plane, or along the near half of the ring where that is seen
    /// edge-on.
    pub(super) fn turn(&self, unit: Vec3, from: Vec2, to: Vec2, view: &View) -> Option<f32> {
        if self.toward_eye(view).dot(unit).abs() > EDGE_ON {
            let (a, b) = (self.on_plane(unit, from, view)?, self.on_plane(unit, to, view)?);
            return Some(a.cross(b).dot(unit).atan2(a.dot(b)));
        }
        // Toward the eye lies the middle of the near half; turning moves it along unit × toward the eye.
        let near = -view.camera.forward();
        let middle = self.on_ring((near - unit * near.dot(unit)).normalize_or(near));
        let ahead = middle + unit.cross(middle - self.center) * 0.1;
        let along = view.camera.project(ahead, view.size)?.0 - view.camera.project(middle, view.size)?.0;
        Some((to - from).dot(along.normalize_or(Vec2::X)) / Gizmo::RING_PX)
    }
}

fn one(x: f32) -> DVec2 {
    DVec2::new(f64::from(x), 0.0)
}

/// Where on the line `origin + t·unit` a ray passes nearest.
fn parameter_on_line(ray: Ray, origin: Vec3, unit: Vec3) -> Option<f32> {
    let direction = ray.direction.normalize();
    let slope = direction.dot(unit);
    let denominator = 1.0 - slope * slope;
    let between = origin - ray.origin;
    (denominator > 1e-3).then(|| (slope * direction.dot(between) - unit.dot(between)) / denominator)
}
