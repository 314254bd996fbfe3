//! What does a ray meet first: a bounding volume hierarchy over the triangles of a surface that moves.

use crate::bounds::{Bounds, corners};
use crate::ray::{Hit, PreparedRay, Ray};
use crate::tree::{Node, NodeStack, Tree};
use glam::Vec3;
use rayon::prelude::*;

/// Bounding volume hierarchy over the triangles of a surface that moves: built once, refitted when positions change.
///
/// It keeps neither positions nor triangles; pass the same ones to every call (positions as of the last build or refit,
/// else hits are missed). After large deformations answers stay exact and get somewhat slower; build anew at leisure.
#[derive(Clone, Debug)]
pub struct Bvh {
    tree: Tree,
}

impl Bvh {
    /// Builds the hierarchy. O(n log n), parallel.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]]) -> Bvh {
        let boxes: Vec<Bounds> = triangles.par_iter().map(|&t| bounds_of(positions, t)).collect();
        Bvh { tree: Tree::new(&boxes) }
    }

    /// Same triangles, new positions. O(n), no allocation.
    pub fn refit(&mut self, positions: &[Vec3], triangles: &[[u32; 3]]) {
        self.tree.refit(|item| triangles.get(item as usize).map_or(Bounds::EMPTY, |&t| bounds_of(positions, t)));
    }

    /// Nearest triangle met from either side; of several at one distance, the one with the lowest number.
    pub fn cast(&self, ray: Ray, positions: &[Vec3], triangles: &[[u32; 3]]) -> Option<Hit> {
        let prepared = PreparedRay::new(ray)?;
        let mut best: Option<(f64, u32, [f64; 3])> = None;
        let mut stack = NodeStack::default();
        stack.extend(self.tree.root());
        while let Some(node) = stack.pop() {
            let limit = best.map_or(f64::INFINITY, |(distance, ..)| distance);
            if prepared.enters(self.tree.bounds(node), limit).is_none() {
                continue;
            }
            match self.tree.node(node) {
                Node::Inner(children) => self.push_near_last(&prepared, limit, children, &mut stack),
                Node::Leaf(items) => {
                    for &item in items {
                        let Some((distance, weights)) = meets(&prepared, item, positions, triangles) else {
                            continue;
                        };
                        if best.is_none_or(|(d, i, _)| (distance, item) < (d, i)) {
                            best = Some((distance, item, weights));
                        }
                    }
                }
            }
        }
        best.map(|(distance, triangle, weights)| Hit {
            triangle,
            distance: distance as f32,
            barycentric: weights.map(|w| w as f32),
        })
    }

    /// Whether anything is met at a distance less than `max_distance` (in directions). To ask whether a point is hidden,
    /// cast from the eye towards it and stop a little short of it, since the point's own triangles count.
    pub fn is_blocked(&self, ray: Ray, max_distance: f32, positions: &[Vec3], triangles: &[[u32; 3]]) -> bool {
        let Some(prepared) = PreparedRay::new(ray) else {
            return false;
        };
        let limit = f64::from(max_distance);
        let mut stack = NodeStack::default();
        stack.extend(self.tree.root());
        while let Some(node) = stack.pop() {
            if prepared.enters(self.tree.bounds(node), limit).is_none() {
                continue;
            }
            match self.tree.node(node) {
                Node::Inner(children) => stack.extend(children),
                Node::Leaf(items) => {
                    let met = |&item: &u32| meets(&prepared, item, positions, triangles);
                    if items.iter().filter_map(met).any(|(distance, _)| distance < limit) {
                        return true;
                    }
                }
            }
        }
        false
    }

    /// Pushes the children that the ray enters, the nearer one on top.
    fn push_near_last(&self, ray: &PreparedRay, limit: f64, children: [usize; 2], stack: &mut NodeStack) {
        match children.map(|child| ray.enters(self.tree.bounds(child), limit)) {
            [Some(left), Some(right)] if left < right => stack.extend([children[1], children[0]]),
            [Some(_), Some(_)] => stack.extend(children),
            [Some(_), None] => stack.push(children[0]),
            [None, Some(_)] => stack.push(children[1]),
            [None, None] => {}
        }
    }
}

fn bounds_of(positions: &[Vec3], triangle: [u32; 3]) -> Bounds {
    corners(positions, triangle).map_or(Bounds::EMPTY, Bounds::around)
}

fn meets(ray: &PreparedRay, item: u32, positions: &[Vec3], triangles: &[[u32; 3]]) -> Option<(f64, [f64; 3])> {
    ray.meets(corners(positions, *triangles.get(item as usize)?)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{Noise, soup};

    /// What every ray meets, asked triangle by triangle.
    fn brute_force(ray: Ray, positions: &[Vec3], triangles: &[[u32; 3]]) -> Option<(u32, f32)> {
        let ray = PreparedRay::new(ray)?;
        let hits = (0..triangles.len() as u32).filter_map(|i| Some((meets(&ray, i, positions, triangles)?.0, i)));
        hits.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))).map(|(d, i)| (i, d as f32))
    }

    fn check_rays(bvh: &Bvh, positions: &[Vec3], triangles: &[[u32; 3]], noise: &mut Noise) {
        let mut n_hits = 0;
        for i in 0..400 {
            let ray = Ray { origin: noise.point() * 2.0, direction: noise.point() - Vec3::splat(0.1) };
            let got = bvh.cast(ray, positions, triangles).map(|h| (h.triangle, h.distance));
            let expected = brute_force(ray, positions, triangles);
            assert_eq!(got, expected, "ray {i} {ray:?}");
            n_hits += usize::from(got.is_some());
            let limit = noise.number() * 3.0;
            let expected = expected.is_some_and(|(_, d)| d < limit);
            assert_eq!(bvh.is_blocked(ray, limit, positions, triangles), expected, "ray {i} {ray:?} within {limit}");
        }
        assert!(triangles.len() < 50 || n_hits > 20, "only {n_hits} of 400 rays met anything");
    }

    #[test]
    fn rays_meet_what_a_search_of_all_triangles_finds_also_after_moving() {
        for n in [0, 1, 3, 5, 50, 3000] {
            let mut noise = Noise(n as u64 + 1);
            let (mut positions, triangles) = soup(n, 0.3, &mut noise);
            let mut bvh = Bvh::new(&positions, &triangles);
            check_rays(&bvh, &positions, &triangles, &mut noise);
            for p in &mut positions {
                *p = Vec3::new(p.y * 1.5, p.z, p.x) + noise.point() * 0.2;
            }
            bvh.refit(&positions, &triangles);
            check_rays(&bvh, &positions, &triangles, &mut noise);
        }
    }

    #[test]
    fn both_sides_of_a_triangle_are_met() {
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let triangles = [[0, 1, 2]];
        let bvh = Bvh::new(&positions, &triangles);
        for side in [1.0, -1.0] {
            let ray = Ray { origin: Vec3::new(0.2, 0.3, side), direction: Vec3::new(0.0, 0.0, -2.0 * side) };
            let hit = bvh.cast(ray, &positions, &triangles).expect("the triangle is straight ahead");
            assert_eq!(hit.distance, 0.5);
            assert_eq!(hit.nearest_vertex(&triangles), 0);
            assert!(hit.point(&positions, &triangles).distance(ray.at(0.5)) < 1e-6);
        }
    }

    #[test]
    fn rays_in_the_plane_of_a_face_meet_only_other_faces() {
        // Two walls of a corner: a ray within the floor's plane z = 0 meets the wall x = 1 and not the floor.
        let positions = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::new(1.0, -1.0, -1.0),
            Vec3::new(1.0, 3.0, -1.0),
            Vec3::new(1.0, 0.0, 3.0),
        ];
        let triangles = [[0, 1, 2], [3, 4, 5]];
        let bvh = Bvh::new(&positions, &triangles);
        let ray = Ray { origin: Vec3::new(-1.0, 0.25, 0.0), direction: Vec3::X };
        let hit = bvh.cast(ray, &positions, &triangles).expect("the wall is ahead");
        assert_eq!((hit.triangle, hit.distance), (1, 2.0));
    }

    #[test]
    fn no_ray_slips_between_neighbors() {
        // A fan of triangles in a tilted plane; rays aimed exactly at shared edges and at the center.
        let n = 64_u32;
        let center = Vec3::new(0.3, 0.1, -0.2);
        let mut positions = vec![center];
        positions.extend((0..n).map(|i| {
            let angle = i as f32 / n as f32 * std::f32::consts::TAU;
            center + Vec3::new(angle.cos(), angle.sin(), 0.37 * angle.cos() - 0.2 * angle.sin())
        }));
        let triangles: Vec<[u32; 3]> = (0..n).map(|i| [0, 1 + i, 1 + (i + 1) % n]).collect();
        let bvh = Bvh::new(&positions, &triangles);
        let from = Vec3::new(0.9, -0.8, 3.0);
        for origin in [from, from * 1e6] {
            for i in 0..=n as usize {
                for part in [0.0, 0.1, 0.7, 0.9] {
                    // Far away, neither origin nor direction are exact: the ray passes the edge on either side by a rounding.
                    let target = positions[0].lerp(positions[i], part);
                    let ray = Ray { origin, direction: target - origin };
                    let met = bvh.cast(ray, &positions, &triangles).is_some();
                    assert!(met, "from {origin} towards edge {i} at {part}");
                }
            }
        }
    }

    #[test]
    fn broken_triangles_and_rays_are_absent() {
        let nan = Vec3::new(f32::NAN, 0.0, 0.0);
        let far = Vec3::splat(f32::MAX);
        let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, nan, Vec3::INFINITY, far, -far];
        let triangles = [[0, 0, 0], [0, 1, 1], [0, 1, 3], [0, 1, 4], [0, 1, 99], [5, 6, 5], [5, 6, 6], [0, 1, 2]];
        let mut bvh = Bvh::new(&positions, &triangles);
        bvh.refit(&positions, &triangles);
        let ray = Ray { origin: Vec3::new(0.2, 0.2, 1.0), direction: -Vec3::Z };
        assert_eq!(bvh.cast(ray, &positions, &triangles).map(|h| h.triangle), Some(7));
        for direction in [Vec3::ZERO, nan, Vec3::INFINITY] {
            let ray = Ray { direction, ..ray };
            assert_eq!(bvh.cast(ray, &positions, &triangles), None);
            assert!(!bvh.is_blocked(ray, 10.0, &positions, &triangles));
        }
    }
}
