//! Mirror images by nearest place.

use super::{MirrorMap, NONE};
use crate::bounds::Bounds;
use crate::tree::Tree;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A plane at a right angle to an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// 0, 1 or 2 for x, y or z.
    pub axis: usize,
    /// Where it cuts the axis.
    pub at: f64,
}

impl Plane {
    /// A point beyond the plane, as far from it. An axis past z counts as z.
    pub fn mirrored(self, point: DVec3) -> DVec3 {
        let mut image = point;
        let axis = self.axis.min(2);
        image[axis] = 2.0 * self.at - point[axis];
        image
    }
}

impl MirrorMap {
    /// Each vertex takes after the one nearest to its mirrored place, unless that is farther than `tolerance`; of several
    /// equally near ones, the first. O(n log n), parallel.
    pub fn by_plane(positions: &[DVec3], plane: Plane, tolerance: f64) -> MirrorMap {
        // Single precision suffices for "nearest" once the surface's own place and size are taken off.
        let (lo, hi) = positions.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), &p| (a.min(p), b.max(p)));
        let size = (hi - lo).max_element().max(f64::MIN_POSITIVE);
        let near = |p: DVec3| ((p - lo) / size).as_vec3();
        let places: Vec<Vec3> = positions.iter().map(|&p| near(p)).collect();
        let boxes: Vec<Bounds> = places.iter().map(|&p| Bounds { min: p, max: p }).collect();
        let (tree, reach) = (Tree::new(&boxes), (tolerance / size) as f32);
        let of = positions.par_iter().map(|&p| {
            let found = tree.nearest(near(plane.mirrored(p)), reach, |item| places[item as usize]);
            found.unwrap_or(NONE)
        });
        MirrorMap::new(of.collect())
    }
}
