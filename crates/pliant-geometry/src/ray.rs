//! Rays and what they meet.

use crate::bounds::Bounds;
use glam::{DVec3, Vec3};
use robust::{Coord, orient2d};

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

/// Both the box and the triangle test round numbers up to the farthest corner's distance from the origin a few times
/// (difference, quotient, product, difference); boxes are widened by this part of it, so that none hides a hit in it.
const BOX_SLACK: f64 = 8.0 * f64::EPSILON;

/// A ray made ready for many tests, in `f64`.
///
/// Triangles are met in coordinates of the ray: two across it, in which the ray is the point zero, and the distance
/// along it (after Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"). A vertex gets the same
/// coordinates in each of its triangles, and on which side of an edge zero lies is decided exactly. So no ray slips
/// through between neighbors, as long as `f64` tells their corners apart as seen from its origin.
pub(crate) struct PreparedRay {
    origin: DVec3,
    direction: DVec3,
    inverse: DVec3,
    /// Axes across the ray, and last the one it follows most.
    axes: [usize; 3],
    /// How far the ray moves along the first two axes for each unit along the last one; at most 1.
    slopes: [f64; 2],
}

impl PreparedRay {
    /// `None` when the ray has no direction or is not finite.
    pub(crate) fn new(ray: Ray) -> Option<PreparedRay> {
        PreparedRay::from_f64(ray.origin.as_dvec3(), ray.direction.as_dvec3())
    }

    fn from_f64(origin: DVec3, direction: DVec3) -> Option<PreparedRay> {
        if !origin.is_finite() || !direction.is_finite() || direction == DVec3::ZERO {
            return None;
        }
        let along = direction.abs().max_position();
        let axes = [(along + 1) % 3, (along + 2) % 3, along];
        let slopes = [direction[axes[0]] / direction[along], direction[axes[1]] / direction[along]];
        Some(PreparedRay { origin, direction, inverse: direction.recip(), axes, slopes })
    }

    /// Distance at which the ray enters the box (0 when it starts inside), if that is at most `limit`. Boxes of nothing
    /// are not entered.
    pub(crate) fn enters(&self, bounds: &Bounds, limit: f64) -> Option<f64> {
        if bounds.min.cmpgt(bounds.max).any() {
            return None;
        }
        let (min, max) = (bounds.min.as_dvec3() - self.origin, bounds.max.as_dvec3() - self.origin);
        let slack = BOX_SLACK * min.abs().max(max.abs()).max_element();
        let (min, max) = (min - slack, max + slack);
        let (mut near, mut far) = (0.0_f64, limit);
        for axis in 0..3 {
            if self.direction[axis] == 0.0 {
                if min[axis] > 0.0 || max[axis] < 0.0 {
                    return None;
                }
                continue;
            }
            let (a, b) = (min[axis] * self.inverse[axis], max[axis] * self.inverse[axis]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        (near <= far).then_some(near)
    }

    /// Distance and corner weights where the ray meets the closed triangle, from either side. Triangles seen edge-on, without
    /// area or not finite are not met.
    pub(crate) fn meets(&self, corners: [Vec3; 3]) -> Option<(f64, [f64; 3])> {
        let [(a, a_along), (b, b_along), (c, c_along)] = corners.map(|p| self.seen_along(p));
        let zero = Coord { x: 0.0, y: 0.0 };
        // Twice the areas that zero spans with the edges; their signs are exact.
        let areas = [orient2d(b, c, zero), orient2d(c, a, zero), orient2d(a, b, zero)];
        let inside = areas.iter().all(|&area| area >= 0.0) || areas.iter().all(|&area| area <= 0.0);
        let area: f64 = areas.iter().sum();
        if !inside || area == 0.0 {
            return None;
        }
        let [u, v, w] = areas.map(|part| part / area);
        let distance = u * a_along + v * b_along + w * c_along;
        (distance >= 0.0 && distance.is_finite()).then_some((distance, [u, v, w]))
    }

    /// Where a point lies across the ray, and at what distance along it.
    fn seen_along(&self, point: Vec3) -> (Coord<f64>, f64) {
        let from_origin = point.as_dvec3() - self.origin;
        let [x, y, along] = self.axes.map(|axis| from_origin[axis]);
        let across = Coord { x: x - along * self.slopes[0], y: y - along * self.slopes[1] };
        (across, along * self.inverse[self.axes[2]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::Noise;
    use std::f32::consts::TAU;

    #[test]
    fn no_ray_slips_through_an_edge_from_afar() {
        // A fan of triangles; rays aimed at its spokes in f64, so that they pass them by no more than the rounding of the
        // test itself, which a distance of a million blows up to some 1e-10 of a triangle.
        let mut noise = Noise(11);
        let center = Vec3::new(0.3, 0.1, -0.2);
        let rim: Vec<Vec3> = (0..=16)
            .map(|i| (i % 16) as f32 / 16.0 * TAU)
            .map(|angle| center + Vec3::new(angle.cos(), angle.sin(), 0.37 * angle.cos() - 0.2 * angle.sin()))
            .collect();
        for i in 0..5000_usize {
            let spoke = rim[i % 16].as_dvec3();
            let target = center.as_dvec3().lerp(spoke, f64::from(noise.number()) * 0.9);
            let direction = noise.point().as_dvec3() + DVec3::new(0.0, 0.0, -1.5);
            let ray = PreparedRay::from_f64(target - direction * 1e6, direction).expect("a usable ray");
            let met = rim.windows(2).map(|side| [center, side[0], side[1]]).any(|corners| {
                ray.enters(&Bounds::around(corners), f64::INFINITY).is_some() && ray.meets(corners).is_some()
            });
            assert!(met, "ray {i} along {direction} towards {target}");
        }
    }

    #[test]
    fn no_ray_enters_a_box_of_nothing() {
        let box_of_something = Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE };
        for direction in [Vec3::X, Vec3::ONE, Vec3::new(-0.3, 0.0, 2.0)] {
            let ray = PreparedRay::new(Ray { origin: Vec3::ZERO, direction }).expect("a usable ray");
            assert_eq!(ray.enters(&Bounds::EMPTY, f64::INFINITY), None, "towards {direction}");
            assert_eq!(ray.enters(&box_of_something, f64::INFINITY), Some(0.0), "towards {direction}");
        }
    }
}
