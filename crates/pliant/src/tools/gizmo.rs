//! Arrows, rings and a scale box around the active handle group: plain values, begin → drag → motion.

use glam::{DAffine3, DQuat, DVec3, Vec2, Vec3};
use pliant_geometry::Ray;

use super::{Modifiers, View};
use crate::viewport::Line;

/// Length of an arrow on screen, in points (by eye).
const ARROW_PX: f32 = 78.0;
/// Radius of the rings, as a fraction of the arrow.
const RING: f32 = 0.72;
/// Place of the scale box on the way to each arrow's tip.
const BOX_AT: f32 = 1.22;
/// How near, in points, the pointer must be to take a part.
const REACH_PX: f32 = 7.0;
/// Segments of a ring.
const RING_SEGMENTS: usize = 64;
/// A ring's plane seen at a smaller slope than this says too little about the angle (by eye).
const EDGE_ON: f32 = 0.15;
/// Rotation step while Ctrl is held.
const SNAP_RADIANS: f64 = 15.0 * std::f64::consts::PI / 180.0;

const AXIS_COLORS: [[u8; 4]; 3] = [[235, 84, 84, 255], [122, 196, 72, 255], [84, 142, 240, 255]];
const HOT_COLOR: [u8; 4] = [255, 214, 92, 255];
const BOX_COLOR: [u8; 4] = [225, 225, 225, 255];

/// What can be taken with the mouse. Axes are numbered x = 0, y = 1, z = 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GizmoPart {
    /// An arrow: moves along an axis.
    Move(usize),
    /// A ring: turns about an axis.
    Rotate(usize),
    /// The box: scales about the pivot.
    Scale,
}

/// A gizmo at a pivot, with its size for the present view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gizmo {
    /// Pivot, view space.
    pub center: Vec3,
    length: f32,
}

impl Gizmo {
    /// A gizmo that looks equally large wherever it is.
    pub fn new(center: Vec3, view: &View) -> Gizmo {
        Gizmo { center, length: ARROW_PX * view.camera.world_per_px(center, view.size) }
    }

    /// The part under the pointer, if any.
    pub fn hit(&self, px: Vec2, view: &View) -> Option<GizmoPart> {
        let near = |a: Vec3, b: Vec3| {
            let (Some((a, _)), Some((b, _))) = (view.camera.project(a, view.size), view.camera.project(b, view.size))
            else {
                return f32::INFINITY;
            };
            distance_to_segment(px, a, b)
        };
        let mut best = (REACH_PX, None);
        let mut consider = |distance: f32, part| {
            if distance < best.0 {
                best = (distance, Some(part));
            }
        };
        for axis in 0..3 {
            let unit = Vec3::AXES[axis];
            // The first quarter is left free, so that the dots in the middle can be dragged.
            consider(near(self.at(unit * 0.25), self.at(unit)), GizmoPart::Move(axis));
            for k in 0..RING_SEGMENTS {
                if self.faces_eye(self.ring_point(axis, k), view) {
                    consider(near(self.ring_point(axis, k), self.ring_point(axis, k + 1)), GizmoPart::Rotate(axis));
                }
            }
        }
        let corner = self.scale_box();
        consider(near(corner, corner) - 3.0, GizmoPart::Scale);
        best.1
    }

    /// Motion of the pivot's surroundings, in view space, when `part` is dragged from one pixel to another. `None`
    /// where the mouse says nothing (looking exactly along an arrow).
    pub fn drag(&self, part: GizmoPart, from: Vec2, to: Vec2, modifiers: Modifiers, view: &View) -> Option<DAffine3> {
        match part {
            GizmoPart::Move(axis) => {
                let unit = Vec3::AXES[axis];
                let along = |px| parameter_on_line(view.camera.ray(px, view.size), self.center, unit);
                Some(DAffine3::from_translation((unit * (along(to)? - along(from)?)).as_dvec3()))
            }
            GizmoPart::Rotate(axis) => {
                let mut angle = f64::from(self.turn(axis, from, to, view)?);
                if modifiers.ctrl {
                    angle = (angle / SNAP_RADIANS).round() * SNAP_RADIANS;
                }
                let rotation = DQuat::from_axis_angle(DVec3::AXES[axis], angle);
                Some(about(self.center.as_dvec3(), DAffine3::from_quat(rotation)))
            }
            GizmoPart::Scale => {
                let (center, _) = view.camera.project(self.center, view.size)?;
                let (before, after) = (from.distance(center).max(1.0), to.distance(center).max(1.0));
                Some(about(self.center.as_dvec3(), DAffine3::from_scale(DVec3::splat(f64::from(after / before)))))
            }
        }
    }

    /// Lines to draw, the part under the pointer highlighted.
    pub fn lines(&self, hot: Option<GizmoPart>, view: &View) -> Vec<Line> {
        let mut lines = Vec::with_capacity(3 * (RING_SEGMENTS + 5));
        for (axis, rest_color) in AXIS_COLORS.into_iter().enumerate() {
            let color = |part| {
                if hot == Some(part) { HOT_COLOR } else { rest_color }
            };
            self.arrow(axis, color(GizmoPart::Move(axis)), &mut lines);
            let ring = color(GizmoPart::Rotate(axis));
            for k in 0..RING_SEGMENTS {
                let (a, b) = (self.ring_point(axis, k), self.ring_point(axis, k + 1));
                // The half behind the pivot is left out: three full rings are a thicket.
                if self.faces_eye(a, view) {
                    lines.push(Line { a, b, color: ring, width_px: 2.0, on_top: true });
                }
            }
        }
        let color = if hot == Some(GizmoPart::Scale) { HOT_COLOR } else { BOX_COLOR };
        let (corner, half) = (self.scale_box(), view.camera.right() * self.length * 0.05);
        lines.push(Line { a: corner - half, b: corner + half, color, width_px: 9.0, on_top: true });
        lines
    }

    fn arrow(&self, axis: usize, color: [u8; 4], lines: &mut Vec<Line>) {
        let unit = Vec3::AXES[axis];
        lines.push(Line { a: self.at(unit * 0.2), b: self.at(unit), color, width_px: 2.5, on_top: true });
        for k in 0..4 {
            let side = Vec3::AXES[(axis + 1 + k / 2) % 3] * if k % 2 == 0 { 0.055 } else { -0.055 };
            lines.push(Line { a: self.at(unit), b: self.at(unit * 0.86 + side), color, width_px: 2.5, on_top: true });
        }
    }

    fn at(&self, offset: Vec3) -> Vec3 {
        self.center + offset * self.length
    }

    fn ring_point(&self, axis: usize, k: usize) -> Vec3 {
        let angle = (k % RING_SEGMENTS) as f32 / RING_SEGMENTS as f32 * std::f32::consts::TAU;
        let (u, v) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
        self.at((u * angle.cos() + v * angle.sin()) * RING)
    }

    fn scale_box(&self) -> Vec3 {
        self.at(Vec3::ONE.normalize() * BOX_AT)
    }

    fn faces_eye(&self, p: Vec3, view: &View) -> bool {
        (p - self.center).dot(view.camera.forward()) <= 0.05 * self.length
    }

    /// Angle about an axis between two pixels: in the ring's plane, or along the near half of the ring where that is seen
    /// edge-on.
    fn turn(&self, axis: usize, from: Vec2, to: Vec2, view: &View) -> Option<f32> {
        let unit = Vec3::AXES[axis];
        let toward = view.camera.project(self.center, view.size)?.0;
        let slope = view.camera.ray(toward, view.size).direction.normalize().dot(unit);
        if slope.abs() > EDGE_ON {
            let on_plane = |px: Vec2| {
                let ray = view.camera.ray(px, view.size);
                let t = (self.center - ray.origin).dot(unit) / ray.direction.dot(unit);
                (t.is_finite() && t > 0.0).then(|| ray.origin + ray.direction * t - self.center)
            };
            let (a, b) = (on_plane(from)?, on_plane(to)?);
            return Some(a.cross(b).dot(unit).atan2(a.dot(b)));
        }
        // Toward the eye lies the middle of the near half; turning moves it along unit × toward the eye.
        let near = -view.camera.forward();
        let middle = self.at((near - unit * near.dot(unit)).normalize_or(near) * RING);
        let ahead = middle + unit.cross(middle - self.center) * 0.1;
        let along = view.camera.project(ahead, view.size)?.0 - view.camera.project(middle, view.size)?.0;
        Some((to - from).dot(along.normalize_or(Vec2::X)) / (ARROW_PX * RING))
    }
}

/// `inner` about a fixed point.
fn about(point: DVec3, inner: DAffine3) -> DAffine3 {
    DAffine3::from_translation(point) * inner * DAffine3::from_translation(-point)
}

fn distance_to_segment(p: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

/// Where on the line `origin + t·unit` a ray passes nearest.
fn parameter_on_line(ray: Ray, origin: Vec3, unit: Vec3) -> Option<f32> {
    let direction = ray.direction.normalize();
    let slope = direction.dot(unit);
    let denominator = 1.0 - slope * slope;
    let between = origin - ray.origin;
    (denominator > 1e-3).then(|| (slope * direction.dot(between) - unit.dot(between)) / denominator)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::Camera;

    fn view() -> View {
        View { camera: Camera::framing(Vec3::splat(-1.0), Vec3::splat(1.0)), size: Vec2::new(800.0, 600.0) }
    }

    fn screen(p: Vec3) -> Vec2 {
        view().camera.project(p, view().size).expect("in front of the eye").0
    }

    #[test]
    fn dragging_an_arrow_moves_along_its_axis_by_what_the_pointer_covers() {
        let gizmo = Gizmo::new(Vec3::ZERO, &view());
        for axis in 0..3 {
            let unit = Vec3::AXES[axis];
            let (from, to) = (screen(unit * 0.1), screen(unit * 0.4));
            let motion = gizmo.drag(GizmoPart::Move(axis), from, to, Modifiers::default(), &view()).expect("a motion");
            let expected = unit.as_dvec3() * 0.3;
            // Single precision rays over a scene of size 2.
            assert!(motion.translation.distance(expected) < 1e-4, "axis {axis}: {motion:?}, expected {expected}");
        }
    }

    #[test]
    fn turning_a_ring_a_quarter_turns_a_quarter() {
        let gizmo = Gizmo::new(Vec3::ZERO, &view());
        for axis in 0..3 {
            let (u, v) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
            let (from, to) = (screen(u * 0.2), screen(v * 0.2));
            let motion =
                gizmo.drag(GizmoPart::Rotate(axis), from, to, Modifiers::default(), &view()).expect("a motion");
            let got = motion.transform_vector3(u.as_dvec3());
            assert!(got.distance(v.as_dvec3()) < 1e-3, "axis {axis}: {u} went to {got}, expected {v}");
        }
    }

    #[test]
    fn a_ring_seen_edge_on_follows_the_pointer_from_every_side() {
        use crate::viewport::Axis;
        for look in [Axis::Front, Axis::Back, Axis::Right, Axis::Left, Axis::Top, Axis::Bottom] {
            for pitch_px in [-6.0, 0.0, 6.0] {
                let mut view = view();
                view.camera.look_along(look);
                view.camera.orbit(Vec2::new(0.0, pitch_px));
                let gizmo = Gizmo::new(Vec3::ZERO, &view);
                for axis in 0..3 {
                    let unit = Vec3::AXES[axis];
                    let near = -view.camera.forward();
                    if near.dot(unit).abs() > EDGE_ON {
                        continue;
                    }
                    let start = (near - unit * near.dot(unit)).normalize() * RING * gizmo.length;
                    let end = glam::Quat::from_axis_angle(unit, 0.2) * start;
                    let screen = |p: Vec3| view.camera.project(p, view.size).expect("in front").0;
                    let angle = gizmo.turn(axis, screen(start), screen(end), &view).expect("an angle");
                    // The arc of 0.2 radians and its sine, and perspective over a ring that is small on screen.
                    assert!((angle - 0.2).abs() < 0.04, "{look:?}, pitch {pitch_px}, axis {axis}: {angle}");
                }
            }
        }
    }

    #[test]
    fn every_part_that_is_drawn_can_be_taken() {
        let gizmo = Gizmo::new(Vec3::ZERO, &view());
        let length = gizmo.length;
        for axis in 0..3 {
            let tip = screen(Vec3::AXES[axis] * 0.95 * length);
            assert_eq!(gizmo.hit(tip, &view()), Some(GizmoPart::Move(axis)));
        }
        assert_eq!(gizmo.hit(screen(gizmo.scale_box()), &view()), Some(GizmoPart::Scale));
        assert_eq!(gizmo.hit(Vec2::new(5.0, 5.0), &view()), None);
    }
}
