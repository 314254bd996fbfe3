//! Which triangles pass through each other.
//!
//! Two triangles *cross* when an edge of one passes through the inside of the other: its ends lie strictly on different
//! sides of the other's plane, and it passes strictly between the other's edges. All signs are exact (Shewchuk's
//! adaptive predicates, crate `robust`), so the answer does not depend on rounding, order or scale.
//!
//! Touching is not crossing: a vertex or edge that only reaches a plane, edges that meet in a point, triangles that
//! overlap within one plane, and triangles without area all give some sign of zero and are not counted. Neighbors are left
//! out: triangles with a common vertex number always touch there.

use crate::bounds::{Bounds, corners_f64};
use crate::tree::Tree;
use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord3D, orient3d};

/// Pairs of triangles without a common vertex that cross, lower number first, sorted.
pub fn crossings(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let boxes: Vec<Bounds> =
        triangles.par_iter().map(|&t| corners_f64(positions, t).map_or(Bounds::EMPTY, Bounds::around_f64)).collect();
    let tree = Tree::new(&boxes);
    let crossed_by = |first: u32| {
        let mut found = Vec::new();
        let Some(corners) = corners_f64(positions, triangles[first as usize]) else {
            return found;
        };
        let bounds = &boxes[first as usize];
        tree.for_each_near(bounds, |second| {
            let wanted = second > first
                && boxes[second as usize].overlaps(bounds)
                && !share_a_vertex(triangles[first as usize], triangles[second as usize]);
            let other = wanted.then(|| corners_f64(positions, triangles[second as usize])).flatten();
            if other.is_some_and(|other| cross(corners, other)) {
                found.push([first, second]);
            }
        });
        found.sort_unstable();
        found
    };
    (0..triangles.len() as u32).into_par_iter().with_min_len(64).flat_map_iter(crossed_by).collect()
}

fn share_a_vertex(a: [u32; 3], b: [u32; 3]) -> bool {
    a.iter().any(|v| b.contains(v))
}

fn cross(a: [DVec3; 3], b: [DVec3; 3]) -> bool {
    // Exact: -1, 0 or 1.
    let sides_of_a = b.map(|p| side(a, p));
    if same_side(sides_of_a) {
        return false;
    }
    let sides_of_b = a.map(|p| side(b, p));
    if same_side(sides_of_b) {
        return false;
    }
    an_edge_pierces(a, sides_of_b, b) || an_edge_pierces(b, sides_of_a, a)
}

/// Whether no edge between the three points passes strictly from one side to the other.
fn same_side(sides: [i8; 3]) -> bool {
    sides.iter().all(|&s| s >= 0) || sides.iter().all(|&s| s <= 0)
}

/// Whether an edge of `a`, whose corners lie on these sides of `b`'s plane, passes through the inside of `b`.
fn an_edge_pierces(a: [DVec3; 3], sides: [i8; 3], b: [DVec3; 3]) -> bool {
    (0..3).any(|i| {
        let j = (i + 1) % 3;
        sides[i] * sides[j] < 0 && {
            let around = |k: usize| side([a[i], a[j], b[k]], b[(k + 1) % 3]);
            let first = around(0);
            first != 0 && around(1) == first && around(2) == first
        }
    })
}

/// On which side of the plane through three points a fourth one lies: -1, 0 or 1, exactly.
fn side(plane: [DVec3; 3], point: DVec3) -> i8 {
    let coord = |p: DVec3| Coord3D { x: p.x, y: p.y, z: p.z };
    let volume = orient3d(coord(plane[0]), coord(plane[1]), coord(plane[2]), coord(point));
    i8::from(volume > 0.0) - i8::from(volume < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{Noise, soup, torus};

    fn brute_force(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let mut found = Vec::new();
        for i in 0..triangles.len() {
            for j in i + 1..triangles.len() {
                let [a, b] = [i, j].map(|t| triangles[t].map(|v| positions[v as usize]));
                if !share_a_vertex(triangles[i], triangles[j]) && cross(a, b) {
                    found.push([i as u32, j as u32]);
                }
            }
        }
        found
    }

    #[test]
    fn the_same_pairs_as_testing_all_pairs() {
        for n in [0, 1, 2, 40, 700] {
            let (positions, triangles) = soup(n, 0.25, &mut Noise(n as u64 + 7));
            let positions: Vec<DVec3> = positions.iter().map(|p| p.as_dvec3()).collect();
            let got = crossings(&positions, &triangles);
            assert_eq!(got, brute_force(&positions, &triangles), "{n} triangles");
            assert!(n < 700 || got.len() > 50, "too few to mean anything: {}", got.len());
        }
    }

    #[test]
    fn linked_rings_cross_only_when_they_touch() {
        let (mut positions, mut triangles) = torus(1.0, 0.2, 48, 16);
        let (second, second_triangles) = torus(1.0, 0.2, 48, 16);
        let n = positions.len() as u32;
        triangles.extend(second_triangles.iter().map(|t| t.map(|v| v + n)));
        // Turned by 90° and shifted by one radius the rings are linked with a gap; shifted by the tube they overlap.
        let rings = |shift: f64| {
            let mut all = positions.clone();
            all.extend(second.iter().map(|p| DVec3::new(p.x + shift, -p.z, p.y)));
            all
        };
        assert_eq!(crossings(&rings(1.0), &triangles), Vec::<[u32; 2]>::new(), "linked with a gap");
        positions = rings(0.30).clone();
        let overlapping = crossings(&positions, &triangles);
        assert!(overlapping.len() > 20, "{} pairs", overlapping.len());
        assert!(overlapping.iter().all(|&[a, b]| a < n * 2 && b >= n * 2), "each pair takes one of either ring");
        assert_eq!(overlapping, brute_force(&positions, &triangles));
    }

    #[test]
    fn touching_is_not_crossing() {
        let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        let cases = [
            ("a vertex on the face", [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0), DVec3::new(2.0, 1.0, 1.0)]),
            ("an edge on the face", [DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0)]),
            ("in one plane", [DVec3::new(1.0, 1.0, 0.0), DVec3::new(2.0, 1.0, 0.0), DVec3::new(1.0, 5.0, 0.0)]),
            ("an edge on an edge", [DVec3::new(2.0, 0.0, -1.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(2.0, -3.0, 0.0)]),
            ("no area", [DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, -1.0)]),
        ];
        for (name, other) in cases {
            let positions: Vec<DVec3> = floor.into_iter().chain(other).collect();
            assert_eq!(crossings(&positions, &[[0, 1, 2], [3, 4, 5]]), Vec::<[u32; 2]>::new(), "{name}");
        }
        let through = [DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 1e-300), DVec3::new(1.5, -9.0, -1.0)];
        let positions: Vec<DVec3> = floor.into_iter().chain(through).collect();
        assert_eq!(crossings(&positions, &[[0, 1, 2], [3, 4, 5]]), [[0, 1]], "by a hair");
    }

    #[test]
    fn neighbors_and_broken_triangles_are_left_out() {
        let nan = DVec3::splat(f64::NAN);
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, nan, DVec3::splat(1e308), DVec3::splat(-1e308)];
        let triangles = [[0, 1, 2], [0, 1, 3], [4, 5, 6], [5, 6, 3], [7, 8, 9]];
        assert_eq!(crossings(&positions, &triangles), Vec::<[u32; 2]>::new());
    }
}
