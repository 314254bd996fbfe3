//! Axis-aligned boxes in `f32`, and which triangles count as present.

use glam::{DVec3, Vec3};

/// An axis-aligned box; empty when `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl Bounds {
    /// Contains nothing and overlaps nothing.
    pub(crate) const EMPTY: Bounds = Bounds { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The smallest box around three points.
    pub(crate) fn around(corners: [Vec3; 3]) -> Bounds {
        let [a, b, c] = corners;
        Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    /// A box around three points in `f64`, rounded outwards so that it surely contains them.
    pub(crate) fn around_f64(corners: [DVec3; 3]) -> Bounds {
        let [a, b, c] = corners;
        let low = a.min(b).min(c).to_array().map(rounded_down);
        let high = a.max(b).max(c).to_array().map(|x| -rounded_down(-x));
        Bounds { min: Vec3::from(low), max: Vec3::from(high) }
    }

    /// The smallest box that contains both.
    pub(crate) fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Squared distance of a point to the box; 0 inside. Infinite for an empty box.
    pub(crate) fn distance_squared(&self, point: Vec3) -> f32 {
        (self.min - point).max(point - self.max).max(Vec3::ZERO).length_squared()
    }

    /// Whether the closed boxes have a point in common.
    pub(crate) fn overlaps(&self, other: &Bounds) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Middle of the box; zero for an empty one, so that absent triangles sort somewhere harmless.
    pub(crate) fn center(&self) -> Vec3 {
        let center = self.min * 0.5 + self.max * 0.5;
        if center.is_finite() { center } else { Vec3::ZERO }
    }
}

/// The largest `f32` not above `x`.
fn rounded_down(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// The corners of a triangle, or `None` when it counts as absent: a vertex past the end or a position that is not finite.
pub(crate) fn corners(positions: &[Vec3], triangle: [u32; 3]) -> Option<[Vec3; 3]> {
    let [a, b, c] = triangle.map(|v| positions.get(v as usize).copied());
    let corners = [a?, b?, c?];
    corners.iter().all(|p| p.is_finite()).then_some(corners)
}

/// [`corners`] for positions in `f64`.
pub(crate) fn corners_f64(positions: &[DVec3], triangle: [u32; 3]) -> Option<[DVec3; 3]> {
    let [a, b, c] = triangle.map(|v| positions.get(v as usize).copied());
    let corners = [a?, b?, c?];
    corners.iter().all(|p| p.is_finite()).then_some(corners)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_of_f64_points_contain_them() {
        for x in [0.1, -0.1, 1.0 / 3.0, 1e300, -1e300, 1e-300, 16_777_217.0] {
            let b = Bounds::around_f64([DVec3::splat(x); 3]);
            assert!(f64::from(b.min.x) <= x && x <= f64::from(b.max.x), "{x}: {b:?}");
        }
    }

    #[test]
    fn empty_boxes_overlap_nothing() {
        let unit = Bounds { min: Vec3::ZERO, max: Vec3::ONE };
        assert!(!Bounds::EMPTY.overlaps(&unit) && !unit.overlaps(&Bounds::EMPTY));
        assert_eq!(Bounds::EMPTY.union(unit), unit);
    }
}
