//! Orbit camera: where the eye is, and how pixels and world points belong together.
//!
//! The camera looks at `target` from `distance`; the plane through `target` across the view is where pan and zoom are
//! exact. The orthographic view has the same height at that plane as the perspective one, so switching between them keeps the size of
//! what is looked at. World: right-handed, y up. Pixels: points from the viewport's top left, y down. No GPU is involved.

use glam::camera::rh::proj::directx;
use glam::{Mat4, Quat, Vec2, Vec3};
use pliant_geometry::{Lens, Ray};
use std::f32::consts::{FRAC_PI_2, PI};

#[cfg(test)]
mod tests;

/// Radians a pixel of pointer movement turns: 0.4°, half a turn in 450 pixels (by eye).
const ORBIT_RADIANS_PER_PX: f32 = 0.4 * PI / 180.0;
/// Vertical field of view of a new camera: like a short portrait lens, little distortion at the sides (by eye).
const FIELD_OF_VIEW: f32 = 35.0 * PI / 180.0;
/// Framed bounds leave this part of the half view free on each side (by eye).
const MARGIN: f32 = 0.05;
/// A framed box seen along its only extent still lies wholly before the eye, in radii.
const CLOSEST_FRAME: f32 = 1.5;
/// Depth range in radii of the bounds: holds the ground grid, which reaches four radii out.
const DEPTH_RADII: f32 = 5.0;
/// Closest visible depth as a part of the distance to the target. Depth is a reversed float, so small values cost nothing.
const NEAR_PART: f32 = 0.01;
/// Where the orthographic view begins, in distances from the target towards the viewer: room for all of a model until one
/// zooms in more than a hundredfold. More would cost precision: the f32 origin of a ray from there is rounded by 6e-8 of
/// its length, here about a hundredth of a pixel.
const ORTHOGRAPHIC_START: f32 = 200.0;
/// Distances stay inside the range in which squares of them are normal f32 numbers.
const DISTANCES: (f32, f32) = (1e-12, 1e15);

/// Orbit camera: looks at `target` from `distance`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The point looked at and turned around, world units.
    pub target: Vec3,
    /// From the eye to `target`, world units, positive.
    pub distance: f32,
    /// Turns camera axes (x right, y up, z backward) into world axes. Unit length.
    pub orientation: Quat,
    /// How depth shrinks things.
    pub projection: Projection,
    /// Field of view along the height, or along the width where the viewport is taller than wide, so that what was framed stays inside.
    pub fov_y_radians: f32,
}

/// How depth shrinks things.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Projection {
    /// Farther is smaller.
    Perspective,
    /// Size does not depend on depth.
    Orthographic,
}

/// The side of the model that faces the viewer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Seen from +z, where glTF models look.
    Front,
    /// Seen from −z.
    Back,
    /// Seen from +x.
    Right,
    /// Seen from −x.
    Left,
    /// Seen from +y.
    Top,
    /// Seen from −y.
    Bottom,
}

impl Camera {
    /// A three-quarter view from above that shows the whole box.
    pub fn framing(min: Vec3, max: Vec3) -> Camera {
        let mut camera = Camera {
            target: Vec3::ZERO,
            distance: 1.0,
            orientation: turntable(35_f32.to_radians(), -20_f32.to_radians()),
            projection: Projection::Perspective,
            fov_y_radians: FIELD_OF_VIEW,
        };
        camera.frame(min, max);
        camera
    }

    /// Moves target and distance so that the whole box is seen with a margin in a viewport of any shape; keeps orientation and
    /// projection. An empty or non-finite box counts as the unit box around the origin.
    pub fn frame(&mut self, min: Vec3, max: Vec3) {
        let (center, radius) = sphere(min, max);
        let half = ((max - min) * 0.5).abs();
        let half = if half.is_finite() && half.max_element() > 0.0 { half } else { Vec3::splat(radius) };
        let tangent = self.half_tangent() * (1.0 - MARGIN);
        let (right, up, forward) = (self.right(), self.up(), self.forward());
        // The distance at which a corner touches the edge of the view: its reach across the view, plus how far it stands before the center.
        let needed = |corner: Vec3| {
            let across = corner.dot(right).abs().max(corner.dot(up).abs()) / tangent;
            match self.projection {
                Projection::Perspective => across - corner.dot(forward),
                Projection::Orthographic => across,
            }
        };
        let distance = corners(half).map(needed).into_iter().fold(radius * CLOSEST_FRAME, f32::max);
        self.target = center;
        self.distance = distance.clamp(DISTANCES.0, DISTANCES.1);
    }

    /// Turns to an axis view; keeps target, distance and projection.
    pub fn look_along(&mut self, axis: Axis) {
        let (yaw, pitch) = match axis {
            Axis::Front => (0.0, 0.0),
            Axis::Back => (PI, 0.0),
            Axis::Right => (FRAC_PI_2, 0.0),
            Axis::Left => (-FRAC_PI_2, 0.0),
            Axis::Top => (0.0, -FRAC_PI_2),
            Axis::Bottom => (0.0, FRAC_PI_2),
        };
        self.orientation = turntable(yaw, pitch);
    }

    /// Turntable: yaw about the world's y, pitch about the camera's right, stopped at the poles. Never rolls.
    pub fn orbit(&mut self, delta_px: Vec2) {
        let (right, up, forward) = (self.right(), self.up(), self.forward());
        let yaw = f32::atan2(-right.z, right.x) - delta_px.x * ORBIT_RADIANS_PER_PX;
        let pitch = f32::atan2(forward.y, up.y) - delta_px.y * ORBIT_RADIANS_PER_PX;
        if yaw.is_finite() && pitch.is_finite() {
            self.orientation = turntable(yaw, pitch.clamp(-FRAC_PI_2, FRAC_PI_2));
        }
    }

    /// Moves sideways so that what lies at the target's depth follows the pointer.
    pub fn pan(&mut self, delta_px: Vec2, size: Vec2) {
        let moved = self.target - self.drag_in_view_plane(self.target, delta_px, size);
        if moved.is_finite() {
            self.target = moved;
        }
    }

    /// Comes closer by `factor` (above 1) or goes away (below 1), keeping the point at the target's depth under the pointer.
    /// Factors that are not positive and finite do nothing.
    pub fn zoom(&mut self, factor: f32, toward_px: Vec2, size: Vec2) {
        if !(factor > 0.0 && factor.is_finite() && toward_px.is_finite()) {
            return;
        }
        let distance = (self.distance / factor).clamp(DISTANCES.0, DISTANCES.1);
        let offset = self.drag_in_view_plane(self.target, toward_px - size * 0.5, size);
        self.target += offset * (1.0 - distance / self.distance);
        self.distance = distance;
    }

    /// World to clip space (y up, depth 1 at the near and 0 at the far end), for a viewport of this size. The depth range is
    /// fitted to the bounds and the ground around them. Nothing is drawn before the point where [`Camera::ray`] starts.
    pub fn clip_from_world(&self, size: Vec2, bounds: (Vec3, Vec3)) -> Mat4 {
        self.clip_from_view(size, bounds) * self.view_from_world()
    }

    /// World to camera space: x right, y up, looking along −z.
    pub(super) fn view_from_world(&self) -> Mat4 {
        Mat4::from_rotation_translation(self.orientation, self.eye()).inverse()
    }

    /// Camera to clip space, see [`Camera::clip_from_world`].
    pub(super) fn clip_from_view(&self, size: Vec2, bounds: (Vec3, Vec3)) -> Mat4 {
        let size = size.max(Vec2::ONE);
        let (center, radius) = sphere(bounds.0, bounds.1);
        let depth = (center - self.eye()).dot(self.forward());
        let reach = radius * DEPTH_RADII;
        let half = size / size.min_element() * self.half_tangent();
        // Near and far are handed over in exchanged places: that reverses depth, which keeps f32 precision in the distance.
        match self.projection {
            Projection::Perspective => {
                let near = (depth - reach).max(self.closest_depth());
                let far = (depth + reach).max(near * 2.0);
                directx::perspective(2.0 * half.y.atan(), half.x / half.y, far, near)
            }
            Projection::Orthographic => {
                let half = half * self.distance;
                let near = (depth - reach).max(self.closest_depth());
                // A model wholly nearer than that leaves an empty picture, but still a range.
                let far = if depth + reach > near { depth + reach } else { near + self.distance };
                directx::orthographic(-half.x, half.x, -half.y, half.y, far, near)
            }
        }
    }

    /// Unit direction of view in the world.
    pub fn forward(&self) -> Vec3 {
        self.orientation * Vec3::NEG_Z
    }

    /// Unit direction to the right of the picture in the world.
    pub fn right(&self) -> Vec3 {
        self.orientation * Vec3::X
    }

    /// Unit direction to the top of the picture in the world.
    pub fn up(&self) -> Vec3 {
        self.orientation * Vec3::Y
    }

    /// Where the eye is in the world; in the orthographic view, the point depths are counted from.
    pub fn eye(&self) -> Vec3 {
        self.target - self.forward() * self.distance
    }

    /// The ray under a pixel, with unit direction. It starts where the picture begins, so that it meets nothing that is not
    /// drawn: a little in front of the eye, or far behind it in the orthographic view.
    pub fn ray(&self, px: Vec2, size: Vec2) -> Ray {
        let at_target = self.target + self.drag_in_view_plane(self.target, px - size * 0.5, size);
        let direction = match self.projection {
            Projection::Perspective => at_target - self.eye(),
            Projection::Orthographic => self.forward() * self.distance,
        };
        // `direction` leads from the eye's depth to the target's; this part of it from the picture's beginning.
        let part = 1.0 - self.closest_depth() / self.distance;
        Ray { origin: at_target - direction * part, direction: direction.normalize_or(self.forward()) }
    }

    /// The same picture for questions about very many points at once.
    pub fn lens(&self, size: Vec2) -> Lens {
        let is_perspective = self.projection == Projection::Perspective;
        Lens {
            eye: self.eye(),
            right: self.right(),
            down: -self.up(),
            forward: self.forward(),
            focal_px: self.focal_px(size) / if is_perspective { 1.0 } else { self.distance },
            size,
            is_perspective,
            closest_depth: self.closest_depth(),
        }
    }

    /// Depth at which the picture begins at the earliest, along `forward` from the eye.
    fn closest_depth(&self) -> f32 {
        match self.projection {
            Projection::Perspective => self.distance * NEAR_PART,
            Projection::Orthographic => self.distance * (1.0 - ORTHOGRAPHIC_START),
        }
    }

    /// Pixel position, and depth along `forward` from the eye. `None` behind the eye of a perspective view.
    pub fn project(&self, world: Vec3, size: Vec2) -> Option<(Vec2, f32)> {
        let from_eye = world - self.eye();
        let depth = from_eye.dot(self.forward());
        let scale = match self.projection {
            Projection::Perspective if depth <= 0.0 => return None,
            Projection::Perspective => self.focal_px(size) / depth,
            Projection::Orthographic => self.focal_px(size) / self.distance,
        };
        let across = Vec2::new(from_eye.dot(self.right()), -from_eye.dot(self.up()));
        Some((size * 0.5 + across * scale, depth))
    }

    /// World length of one pixel at this point's depth; behind the eye, at the closest visible depth.
    pub fn world_per_px(&self, at: Vec3, size: Vec2) -> f32 {
        let depth = match self.projection {
            Projection::Perspective => (at - self.eye()).dot(self.forward()).max(self.distance * NEAR_PART),
            Projection::Orthographic => self.distance,
        };
        depth / self.focal_px(size)
    }

    /// World displacement in the view plane at the depth of `at` for a pixel displacement.
    pub fn drag_in_view_plane(&self, at: Vec3, delta_px: Vec2, size: Vec2) -> Vec3 {
        let delta = delta_px * self.world_per_px(at, size);
        self.right() * delta.x - self.up() * delta.y
    }

    /// Pixels from the picture's center for a direction at 45° to the view.
    pub(super) fn focal_px(&self, size: Vec2) -> f32 {
        0.5 * size.max(Vec2::ONE).min_element() / self.half_tangent()
    }

    /// Half the view's shorter side at depth 1.
    fn half_tangent(&self) -> f32 {
        (self.fov_y_radians.clamp(0.01, 3.0) * 0.5).tan()
    }
}

/// Orientation without roll: looks along −z at 0, 0; a positive pitch looks up.
fn turntable(yaw: f32, pitch: f32) -> Quat {
    Quat::from_rotation_y(yaw) * Quat::from_rotation_x(pitch)
}

/// Center and radius of the ball around a box. A point, an empty or a non-finite box gives a ball one can still look at.
pub(super) fn sphere(min: Vec3, max: Vec3) -> (Vec3, f32) {
    let (center, radius) = ((min + max) * 0.5, (max - min).length() * 0.5);
    if !center.is_finite() || !radius.is_finite() || min.cmpgt(max).any() {
        return (Vec3::ZERO, 1.0);
    }
    // A box thinner than f32 can tell apart at its place is a point.
    let smallest = center.abs().max_element() * 1e-6;
    match radius > smallest {
        true => (center, radius),
        false => (center, if smallest > 0.0 { smallest * 1e3 } else { 1.0 }),
    }
}

/// The eight corners of the box with these half sizes around the origin.
fn corners(half: Vec3) -> [Vec3; 8] {
    std::array::from_fn(|corner| {
        let sign = |axis: usize| if corner >> axis & 1 == 0 { -1.0 } else { 1.0 };
        half * Vec3::new(sign(0), sign(1), sign(2))
    })
}
