//! Rays and what they meet.

use crate::bounds::Bounds;
use glam::{DVec3, Vec3};

/// A half-line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes; need not be of unit length, and distances are counted in its length.
    pub direction: Vec3,
}

impl Ray {
    /// The point `distance` directions away from the origin.
    pub fn at(&self, distance: f32) -> Vec3 {
        self.origin + self.direction * distance
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which triangle.
    pub triangle: u32,
    /// In units of the ray's direction: the point is [`Ray::at`] of it.
    pub distance: f32,
    /// Weights of the triangle's three corners at the point; they sum to 1.
    pub barycentric: [f32; 3],
}

impl Hit {
    /// Which corner (0, 1, 2) weighs most: the one nearest in the triangle's own coordinates. Ties take the first.
    pub fn nearest_corner(&self) -> usize {
        let [a, b, c] = self.barycentric;
        if a >= b && a >= c {
            0
        } else if b >= c {
            1
        } else {
            2
        }
    }

    /// The vertex of the triangle that weighs most.
    pub fn nearest_vertex(&self, triangles: &[[u32; 3]]) -> u32 {
        triangles[self.triangle as usize][self.nearest_corner()]
    }

    /// The point, from the triangle's corners: better than [`Ray::at`] when the ray comes from far away.
    pub fn point(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
        let corners = triangles[self.triangle as usize].map(|v| positions[v as usize]);
        corners[0] * self.barycentric[0] + corners[1] * self.barycentric[1] + corners[2] * self.barycentric[2]
    }
}

/// How far outside a triangle a ray still counts as a hit, in barycentric weight: a few roundings of `f64`, so that no
/// ray slips through between two triangles that share an edge.
const EDGE_SLACK: f64 = 1e-12;
/// Sine of the angle between ray and plane below which they count as parallel: what rounding leaves of zero in `f64`.
const PARALLEL_SINE: f64 = 1e-14;

/// A ray made ready for many tests. All arithmetic is in `f64`: a box or triangle in `f32` is then met practically
/// exactly, and a tiny direction does not overflow its inverse.
pub(crate) struct PreparedRay {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    length: f64,
}

impl PreparedRay {
    /// `None` when the ray has no direction or is not finite.
    pub(crate) fn new(ray: Ray) -> Option<PreparedRay> {
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let usable = origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO;
        usable.then(|| PreparedRay { origin, direction, inverse: direction.recip(), length: direction.length() })
    }

    /// Distance at which the ray enters the box (0 when it starts inside), if that is at most `limit`.
    pub(crate) fn enters(&self, bounds: &Bounds, limit: f64) -> Option<f64> {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let (mut near, mut far) = (0.0_f64, limit);
        for axis in 0..3 {
            if self.direction[axis] == 0.0 {
                if self.origin[axis] < min[axis] || self.origin[axis] > max[axis] {
                    return None;
                }
                continue;
            }
            let a = (min[axis] - self.origin[axis]) * self.inverse[axis];
            let b = (max[axis] - self.origin[axis]) * self.inverse[axis];
            near = near.max(a.min(b));
            // The rounding of the two products must not part a box without thickness into 'not yet' and 'no longer'.
            far = far.min(a.max(b) * (1.0 + 8.0 * f64::EPSILON));
        }
        (near <= far).then_some(near)
    }

    /// Distance and corner weights where the ray meets the closed triangle, from either side (Möller and Trumbore).
    pub(crate) fn meets(&self, corners: [Vec3; 3]) -> Option<(f64, [f64; 3])> {
        let [a, b, c] = corners.map(|p| p.as_dvec3());
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        let p = self.direction.cross(ac);
        let determinant = ab.dot(p);
        // Written so that NaN and zero area are refused too.
        let usable = determinant.abs() > PARALLEL_SINE * self.length * normal.length();
        if !usable {
            return None;
        }
        let from_a = self.origin - a;
        let v = from_a.dot(p) / determinant;
        let q = from_a.cross(ab);
        let w = self.direction.dot(q) / determinant;
        let u = 1.0 - v - w;
        let distance = ac.dot(q) / determinant;
        let inside = u >= -EDGE_SLACK && v >= -EDGE_SLACK && w >= -EDGE_SLACK && distance >= 0.0;
        (inside && distance.is_finite()).then_some((distance, [u, v, w]))
    }
}
