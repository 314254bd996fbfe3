use super::*;
use crate::test_shapes::{Noise, sphere, square};
use std::f32::consts::PI;

fn nearest_triangle(positions: &[Vec3], triangles: &[[u32; 3]], point: Vec3) -> u32 {
    let center = |t: &[u32; 3]| t.iter().map(|&v| positions[v as usize]).sum::<Vec3>() / 3.0;
    let by_distance = |i: &u32| center(&triangles[*i as usize]).distance_squared(point);
    (0..triangles.len() as u32).min_by(|a, b| by_distance(a).total_cmp(&by_distance(b))).expect("not empty")
}

#[test]
fn on_a_plane_distances_are_straight_lines_on_any_triangulation() {
    // Jitter up to 0.25 flips no triangle but leaves some almost flat, with corners near 180°. Stretched cells 1 : 4 too.
    for (jitter, stretch) in [(0.0, 1.0), (0.2, 1.0), (0.25, 1.0), (0.2, 0.25)] {
        let (mut positions, triangles) = square(41, jitter, &mut Noise(3));
        positions.iter_mut().for_each(|p| p.y *= stretch);
        let point = Vec3::new(0.41, 0.53 * stretch, 0.0);
        let source = nearest_triangle(&positions, &triangles, point);
        let radius = 0.35 * stretch;
        let mut distances = SurfaceDistance::new(positions.len(), &triangles);
        let point = triangles[source as usize].iter().map(|&v| positions[v as usize]).sum::<Vec3>() / 3.0;
        let found = distances.within(&positions, &triangles, source, point, radius);
        for &(v, got) in &found {
            let expected = positions[v as usize].distance(point);
            assert!(
                (got - expected).abs() <= 0.01 * radius,
                "vertex {v} at jitter {jitter}: got {got}, expected {expected}"
            );
        }
        let n_expected = positions.iter().filter(|p| p.distance(point) <= radius * 0.99).count();
        assert!(found.len() >= n_expected, "jitter {jitter}: {} of {n_expected}", found.len());
        let mut once: Vec<u32> = found.iter().map(|&(v, _)| v).collect();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), found.len(), "each vertex once");
    }
}

#[test]
fn on_a_sphere_distances_follow_great_circles() {
    let (points, triangles) = sphere(40, 80);
    let positions: Vec<Vec3> = points.iter().map(|p| p.as_vec3()).collect();
    let mut distances = SurfaceDistance::new(positions.len(), &triangles);
    for target in [Vec3::new(0.3, 0.8, 0.5), Vec3::Z, Vec3::new(1.0, 0.0, 0.1)] {
        let source = nearest_triangle(&positions, &triangles, target.normalize());
        let v = triangles[source as usize][0];
        let found = distances.within(&positions, &triangles, source, positions[v as usize], 4.0);
        assert_eq!(found.len(), positions.len(), "all of the sphere");
        for (u, got) in found {
            let expected = positions[u as usize].angle_between(positions[v as usize]);
            assert!((got - expected).abs() <= 0.03 * PI, "vertex {u} from {v}: got {got}, expected {expected}");
        }
    }
}

#[test]
fn a_sheet_near_in_space_but_far_on_the_surface_is_not_reached() {
    // Two squares 0.01 apart: not connected, then joined along the far border x = 1.
    let (one, triangles_one) = square(21, 0.2, &mut Noise(5));
    let n = one.len() as u32;
    let lifted = one.iter().map(|p| *p + Vec3::Z * 0.01);
    let positions: Vec<Vec3> = one.iter().copied().chain(lifted).collect();
    let mut triangles = triangles_one.clone();
    triangles.extend(triangles_one.iter().map(|t| t.map(|v| v + n)));
    let point = Vec3::new(0.1, 0.5, 0.0);
    let source = nearest_triangle(&positions, &triangles, point);
    let mut apart = SurfaceDistance::new(positions.len(), &triangles);
    let found = apart.within(&positions, &triangles, source, point, 100.0);
    assert_eq!(found.len(), n as usize, "one sheet and all of it");
    assert!(found.iter().all(|&(v, _)| v < n), "no vertex of the other sheet");

    let border: Vec<u32> = (0..21).map(|j| 20 * 21 + j).collect();
    triangles.extend(border.windows(2).flat_map(|w| [[w[0], w[1], w[0] + n], [w[1], w[1] + n, w[0] + n]]));
    let mut joined = SurfaceDistance::new(positions.len(), &triangles);
    assert!(joined.within(&positions, &triangles, source, point, 0.85).iter().all(|&(v, _)| v < n));
    let found = joined.within(&positions, &triangles, source, point, 2.5);
    let above = found.iter().find(|&&(v, _)| v == n + 2 * 21 + 10).expect("reached around the border");
    // 0.9 to the border, 0.01 across and 0.9 back, give or take the jitter of one cell.
    assert!((above.1 - 1.81).abs() < 0.05, "got {}", above.1);
}

#[test]
fn questions_do_not_disturb_each_other() {
    let (positions, triangles) = square(31, 0.3, &mut Noise(9));
    let mut used = SurfaceDistance::new(positions.len(), &triangles);
    used.question.epoch = u32::MAX - 20;
    for i in 0..40 {
        let source = i * 37 % triangles.len() as u32;
        let point = positions[triangles[source as usize][1] as usize];
        let fresh =
            SurfaceDistance::new(positions.len(), &triangles).within(&positions, &triangles, source, point, 0.2);
        assert_eq!(used.within(&positions, &triangles, source, point, 0.2), fresh, "question {i}");
    }
}

#[test]
fn broken_surfaces_and_questions_give_what_can_be_reached() {
    let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN, Vec3::ZERO, Vec3::X * 2.0];
    let triangles = [[0, 1, 2], [1, 2, 3], [0, 0, 4], [1, 5, 1], [2, 9, 1]];
    let mut distances = SurfaceDistance::new(positions.len(), &triangles);
    let mut found = distances.within(&positions, &triangles, 0, Vec3::ZERO, 5.0);
    found.sort_unstable_by_key(|&(v, _)| v);
    assert_eq!(found, [(0, 0.0), (1, 1.0), (2, 1.0), (4, 0.0), (5, 2.0)]);
    for (triangle, point, radius) in [
        (1, Vec3::ZERO, 1.0),
        (99, Vec3::ZERO, 1.0),
        (0, Vec3::NAN, 1.0),
        (0, Vec3::ZERO, -1.0),
        (0, Vec3::ZERO, f32::NAN),
    ] {
        assert_eq!(
            distances.within(&positions, &triangles, triangle, point, radius),
            [],
            "{triangle} {point} {radius}"
        );
    }
}

#[test]
fn a_growing_front_reaches_what_a_question_for_each_radius_would() {
    let (mut positions, triangles) = square(41, 0.25, &mut Noise(11));
    positions.iter_mut().for_each(|p| p.z = (7.0 * p.x).sin() * 0.1);
    let mut distances = SurfaceDistance::new(positions.len(), &triangles);
    let point = triangles[900].iter().map(|&v| positions[v as usize]).sum::<Vec3>() / 3.0;
    let mut growth = distances.growth(&positions, &triangles, 900, point).expect("a triangle");
    for radius in [0.0, 0.02, 0.1, 0.11, 0.4, 2.0] {
        // A few vertices at a time.
        while !growth.grow(&positions, &triangles, radius, 50) {}
        let mut got: Vec<(u32, f32)> = growth.reached().filter(|&(_, d)| d <= radius).collect();
        got.sort_unstable_by_key(|&(v, _)| v);
        let mut expected = distances.within(&positions, &triangles, 900, point, radius);
        expected.sort_unstable_by_key(|&(v, _)| v);
        let vertices = |found: &[(u32, f32)]| found.iter().map(|&(v, _)| v).collect::<Vec<_>>();
        assert_eq!(vertices(&got), vertices(&expected), "radius {radius}");
        for (&(v, got), &(_, expected)) in got.iter().zip(&expected) {
            assert!((got - expected).abs() <= 1e-3 * expected, "vertex {v}: got {got}, expected {expected}");
        }
    }
    assert_eq!(growth.reached().filter(|&(_, d)| d <= 2.0).count(), positions.len());
}

#[test]
fn the_line_around_what_is_reached_is_a_circle_on_a_plane() {
    let (positions, triangles) = square(41, 0.2, &mut Noise(12));
    let distances = SurfaceDistance::new(positions.len(), &triangles);
    let point = triangles[1640].iter().map(|&v| positions[v as usize]).sum::<Vec3>() / 3.0;
    let mut growth = distances.growth(&positions, &triangles, 1640, point).expect("a triangle");
    let mut lines = Vec::new();
    for radius in [0.3, 0.15] {
        while !growth.grow(&positions, &triangles, radius, usize::MAX) {}
        growth.line(&positions, &triangles, radius, &mut lines);
        let at = |c: &Crossing| positions[c.edge[0] as usize].lerp(positions[c.edge[1] as usize], c.along);
        let length: f32 = lines.iter().map(|[a, b]| at(a).distance(at(b))).sum();
        let around = 2.0 * PI * radius;
        assert!((length - around).abs() < 0.01 * around, "radius {radius}: a line of {length}, not {around}");
        for end in lines.as_flattened() {
            let off = (at(end).distance(point) - radius).abs();
            // Distance is taken as linear along an edge of 1/40: off by at most edge² / 8 r.
            assert!(off < 0.01 * radius + 0.002, "radius {radius}: {off} beside the circle");
        }
    }
}

#[test]
fn nothing_grows_from_a_triangle_that_is_absent() {
    let distances = SurfaceDistance::new(3, &[[0, 1, 2]]);
    let positions = [Vec3::ZERO, Vec3::X, Vec3::NAN];
    assert!(distances.growth(&positions, &[[0, 1, 2]], 0, Vec3::ZERO).is_none());
    assert!(distances.growth(&positions, &[[0, 1, 2]], 7, Vec3::ZERO).is_none());
}
