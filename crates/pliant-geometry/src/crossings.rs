//! Which triangles pass through each other.
//!
//! Two triangles *cross* when an edge of one passes through the inside of the other: its ends lie strictly on different
//! sides of the other's plane, and it passes strictly between the other's edges. All signs are exact (Shewchuk's
//! adaptive predicates, crate `robust`), so the answer does not depend on rounding, order or scale.
//!
//! Touching is not crossing: a vertex or edge that only reaches a plane, edges that meet in a point, triangles that
//! overlap within one plane, and triangles without area all give some sign of zero and are not counted.
//!
//! Neighbors touch where they meet, which gives zeros as well: two triangles with one common vertex cross when the edge across
//! from it pierces the other, and two with a common edge never do. [`crossings`] leaves out all neighbors, as is
//! usual in counts that are compared; [`crossings_of_all`] looks at those with one common vertex too, where a surface that
//! folds sharply crosses itself first.

use crate::bounds::{Bounds, corners_f64};
use crate::tree::Tree;
use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord3D, orient3d};

/// Triangles looked at between two questions whether to go on: about a millisecond.
const PIECE: usize = 512;

/// Pairs of triangles without a common vertex that cross, lower number first, sorted.
pub fn crossings(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    pairs(positions, triangles, 0, &|| true).unwrap_or_default()
}

/// Pairs of triangles with at most one common vertex that cross, lower number first, sorted. Asks `go_on` every
/// few milliseconds; `None` once it says no.
pub fn crossings_of_all(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    go_on: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<[u32; 2]>> {
    pairs(positions, triangles, 1, go_on)
}

/// Pairs of triangles with at most so many common vertices that cross.
fn pairs(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    most_shared: usize,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Option<Vec<[u32; 2]>> {
    let boxes: Vec<Bounds> =
        triangles.par_iter().map(|&t| corners_f64(positions, t).map_or(Bounds::EMPTY, Bounds::around_f64)).collect();
    if !go_on() {
        return None;
    }
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
                && n_shared(triangles[first as usize], triangles[second as usize]) <= most_shared;
            let other = wanted.then(|| corners_f64(positions, triangles[second as usize])).flatten();
            if other.is_some_and(|other| cross(corners, other)) {
                found.push([first, second]);
            }
        });
        found.sort_unstable();
        found
    };
    let n = triangles.len();
    let piece = |k: usize| {
        let range = if go_on() { k * PIECE..((k + 1) * PIECE).min(n) } else { 0..0 };
        range.flat_map(|first| crossed_by(first as u32)).collect::<Vec<_>>()
    };
    let found = (0..n.div_ceil(PIECE)).into_par_iter().flat_map_iter(piece).collect();
    go_on().then_some(found)
}

/// How many corners of one triangle are corners of the other.
fn n_shared(a: [u32; 3], b: [u32; 3]) -> usize {
    a.iter().filter(|v| b.contains(v)).count()
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

    fn brute_force(positions: &[DVec3], triangles: &[[u32; 3]], most_shared: usize) -> Vec<[u32; 2]> {
        let mut found = Vec::new();
        for i in 0..triangles.len() {
            for j in i + 1..triangles.len() {
                let [a, b] = [i, j].map(|t| triangles[t].map(|v| positions[v as usize]));
                if n_shared(triangles[i], triangles[j]) <= most_shared && cross(a, b) {
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
            assert_eq!(got, brute_force(&positions, &triangles, 0), "{n} triangles");
            let of_all = crossings_of_all(&positions, &triangles, &|| true).expect("not stopped");
            assert_eq!(of_all, brute_force(&positions, &triangles, 1), "{n} triangles with neighbors");
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
        assert_eq!(overlapping, brute_force(&positions, &triangles, 0));
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
    fn a_crumpled_sheet_crosses_itself_where_all_pairs_say() {
        let mut noise = Noise(5);
        let (flat, triangles) = crate::test_shapes::square(14, 0.3, &mut noise);
        let positions: Vec<DVec3> = flat.iter().map(|&p| (p * 0.4 + noise.point() * 0.05).as_dvec3()).collect();
        let got = crossings_of_all(&positions, &triangles, &|| true).expect("not stopped");
        assert_eq!(got, brute_force(&positions, &triangles, 1));
        let near = got.iter().filter(|&&[a, b]| n_shared(triangles[a as usize], triangles[b as usize]) == 1).count();
        assert!(near > 5 && got.len() > near, "{near} of {} pairs are neighbors", got.len());
        // An exact answer is the same for any order of corners and triangles.
        let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [c, a, b]).collect();
        assert_eq!(crossings_of_all(&positions, &turned, &|| true).as_ref(), Some(&got));
    }

    #[test]
    fn neighbors_cross_when_one_pierces_the_other_and_not_when_they_only_meet() {
        let fixed = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        // With the common vertex at the origin: the far edge through the inside, past it, and up to the edge.
        for (name, far, expected) in [
            ("through the inside", [DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, 1.0, -1.0)], true),
            ("past it", [DVec3::new(3.0, 3.0, 1.0), DVec3::new(3.0, 3.0, -1.0)], true),
            ("beside it", [DVec3::new(-1.0, -1.0, 1.0), DVec3::new(-1.0, -1.0, -1.0)], false),
            ("on its edge", [DVec3::new(2.0, 0.0, 1.0), DVec3::new(2.0, 0.0, -1.0)], false),
            ("above it", [DVec3::new(1.0, 1.0, 1.0), DVec3::new(2.0, 1.0, 0.5)], false),
        ] {
            let positions: Vec<DVec3> = fixed.into_iter().chain(far).collect();
            let found = crossings_of_all(&positions, &[[0, 1, 2], [0, 3, 4]], &|| true).expect("not stopped");
            assert_eq!(found.len(), usize::from(expected), "{name}");
            assert!(crossings(&positions, &[[0, 1, 2], [0, 3, 4]]).is_empty(), "{name}: neighbors are left out");
        }
        let folded = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.3, 0.3, 0.0)];
        let found = crossings_of_all(&folded, &[[0, 1, 2], [0, 1, 3]], &|| true).expect("not stopped");
        assert!(found.is_empty(), "folded over a common edge");
    }

    #[test]
    fn a_search_that_is_no_longer_wanted_ends_without_an_answer() {
        let (positions, triangles) = torus(1.0, 0.3, 200, 60);
        assert_eq!(crossings_of_all(&positions, &triangles, &|| false), None);
        let asked = std::sync::atomic::AtomicUsize::new(0);
        let a_few = || asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) < 5;
        assert_eq!(crossings_of_all(&positions, &triangles, &a_few), None);
    }

    #[test]
    fn neighbors_and_broken_triangles_are_left_out() {
        let nan = DVec3::splat(f64::NAN);
        let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, nan, DVec3::splat(1e308), DVec3::splat(-1e308)];
        let triangles = [[0, 1, 2], [0, 1, 3], [4, 5, 6], [5, 6, 3], [7, 8, 9]];
        assert_eq!(crossings(&positions, &triangles), Vec::<[u32; 2]>::new());
    }
}
