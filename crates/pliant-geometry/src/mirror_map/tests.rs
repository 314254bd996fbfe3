use super::*;
use crate::test_shapes::{Noise, square};
use glam::DVec3;
use std::collections::HashMap;

type Shape = (Vec<DVec3>, Vec<[u32; 3]>);

/// An octahedron of radius 1 with each face cut in four `times` times over: symmetric about x = 0.
fn octahedron(times: u32) -> Shape {
    let mut positions = vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let mut triangles = vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..times {
        let mut middles = HashMap::new();
        let mut finer = Vec::new();
        for &[a, b, c] in &triangles {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    positions.push(((positions[a as usize] + positions[b as usize]) * 0.5).normalize());
                    positions.len() as u32 - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    (positions, triangles)
}

/// Puts a vertex in the middle of a triangle.
fn split((positions, triangles): &mut Shape, face: usize) {
    let [a, b, c] = triangles[face];
    let middle = positions.len() as u32;
    positions.push([a, b, c].map(|v| positions[v as usize]).iter().sum::<DVec3>() / 3.0);
    triangles[face] = [a, b, middle];
    triangles.extend([[b, c, middle], [c, a, middle]]);
}

fn face_at((positions, triangles): &Shape, place: DVec3) -> usize {
    let off = |f: usize| (triangles[f].iter().map(|&v| positions[v as usize]).sum::<DVec3>() / 3.0).distance(place);
    (0..triangles.len()).min_by(|&f, &g| off(f).total_cmp(&off(g))).expect("a triangle")
}

/// A symmetric mesh without any other order: some triangles cut on both sides, vertices and corners shuffled.
fn irregular(seed: u64) -> Shape {
    let mut noise = Noise(seed);
    let mut shape = octahedron(2);
    for _ in 0..60 {
        let place = noise.point().as_dvec3().normalize() + DVec3::X * 0.01;
        let place = DVec3::new(place.x.abs() + 0.1, place.y, place.z).normalize();
        let (face, image) = (face_at(&shape, place), face_at(&shape, place * DVec3::new(-1.0, 1.0, 1.0)));
        if face != image {
            split(&mut shape, face);
            split(&mut shape, image);
        }
    }
    shuffled(shape, &mut noise)
}

fn shuffled((positions, triangles): Shape, noise: &mut Noise) -> Shape {
    let mut order: Vec<(f32, usize)> = (0..positions.len()).map(|v| (noise.number(), v)).collect();
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut place = vec![0_u32; positions.len()];
    (0..).zip(&order).for_each(|(new, &(_, old))| place[old] = new);
    let turned = |t: &[u32; 3]| {
        let mut t = t.map(|v| place[v as usize]);
        t.rotate_left((noise.number() * 3.0) as usize);
        t
    };
    (order.iter().map(|&(_, old)| positions[old]).collect(), triangles.iter().map(turned).collect())
}

const MIDDLE: Plane = Plane { axis: 0, at: 0.0 };

fn is_involution(map: &MirrorMap) {
    for v in 0..map.n_vertices() as u32 {
        if let Some(w) = map.partner(v) {
            assert_eq!(map.partner(w), Some(v), "the partner of the partner of {v}");
        }
        assert!(map.across(v).iter().all(|&w| map.source(w) == Some(v)), "what takes after {v}");
    }
    let n_across: usize = (0..map.n_vertices() as u32).map(|v| map.across(v).len()).sum();
    assert_eq!(n_across + map.n_alone(), map.n_vertices());
}

/// Every vertex has the partner that mirroring its place (at rest) gives.
fn is_whole(map: &MirrorMap, rest: &[DVec3]) {
    is_involution(map);
    for (v, &p) in (0..).zip(rest) {
        let partner = map.partner(v).unwrap_or_else(|| panic!("vertex {v} has no partner"));
        let off = MIDDLE.mirrored(p).distance(rest[partner as usize]);
        assert!(off < 1e-9, "vertex {v} and its partner {partner}: {off}");
    }
}

#[test]
fn on_a_symmetric_mesh_every_vertex_has_its_partner_by_plane() {
    let (rest, _) = irregular(1);
    is_whole(&MirrorMap::by_plane(&rest, MIDDLE, 1e-5), &rest);
    // Far from the origin, and tiny or huge.
    for (scale, place) in [(1e-9, 0.0), (1e9, 0.0), (1.0, 1e5)] {
        let moved: Vec<DVec3> = rest.iter().map(|&p| p * scale + DVec3::splat(place)).collect();
        let map = MirrorMap::by_plane(&moved, Plane { axis: 0, at: place }, 1e-5 * scale);
        is_whole(&map, &rest);
    }
}

#[test]
fn on_an_irregular_triangulation_each_takes_after_the_nearest_within_the_tolerance() {
    let (positions, _) = square(31, 0.3, &mut Noise(4));
    let positions: Vec<DVec3> = positions.iter().map(|p| p.as_dvec3()).collect();
    let plane = Plane { axis: 0, at: 0.53 };
    for tolerance in [0.01, 0.04] {
        let map = MirrorMap::by_plane(&positions, plane, tolerance);
        is_involution(&map);
        for (v, &p) in (0..).zip(&positions) {
            let off = |w: u32| plane.mirrored(p).distance(positions[w as usize]);
            let nearest = (0..positions.len() as u32).map(off).fold(f64::INFINITY, f64::min);
            match map.source(v) {
                Some(w) => assert!((off(w) - nearest).abs() < 1e-6 && off(w) < tolerance + 1e-6, "vertex {v}"),
                None => assert!(nearest > tolerance - 1e-6, "vertex {v} has an image at {nearest}"),
            }
        }
        assert!(map.n_alone() > 0, "the plane is not in the middle");
    }
}

#[test]
fn on_a_symmetric_mesh_in_any_pose_topology_finds_every_partner_from_one_edge() {
    for seed in 1..5 {
        let (rest, triangles) = irregular(seed);
        let is_middle = |v: u32| rest[v as usize].x.abs() < 1e-9;
        let along = triangles.iter().find_map(|&[a, b, _]| (is_middle(a) && is_middle(b)).then_some([a, b]));
        let mut noise = Noise(seed);
        let posed: Vec<DVec3> = rest.iter().map(|_| noise.point().as_dvec3()).collect();
        let seam = Seam { edge: along, plane: MIDDLE, tolerance: 1e-6 };
        assert!(along.is_some(), "an edge in the middle");
        let (map, uneven) = MirrorMap::by_topology(&posed, &triangles, seam);
        assert_eq!(uneven, None);
        is_whole(&map, &rest);
        let (map, uneven) = MirrorMap::by_topology(&rest, &triangles, Seam { edge: None, ..seam });
        assert_eq!(uneven, None, "the edge was to be found");
        is_whole(&map, &rest);
    }
}

#[test]
fn an_edge_may_cross_the_middle() {
    // Two triangles whose common edge 0–1 goes from side to side, and one more at each flank.
    let positions = [(-1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (-2.0, 1.0), (2.0, 1.0)];
    let positions = positions.map(|(x, y)| DVec3::new(x, y, 0.0));
    let triangles = [[0, 1, 2], [1, 0, 3], [0, 2, 4], [2, 1, 5]];
    for edge in [Some([1, 0]), None] {
        let seam = Seam { edge, plane: MIDDLE, tolerance: 0.1 };
        let (map, uneven) = MirrorMap::by_topology(&positions, &triangles, seam);
        assert_eq!(uneven, None);
        is_whole(&map, &positions);
    }
}

#[test]
fn where_the_sides_differ_is_said_and_the_rest_keeps_its_partners() {
    let mut shape = octahedron(3);
    let face = face_at(&shape, DVec3::new(0.5, 0.6, 0.6));
    let corners = shape.1[face];
    split(&mut shape, face);
    let (positions, triangles) = shuffled(shape.clone(), &mut Noise(2));
    let seam = Seam { edge: None, plane: MIDDLE, tolerance: 1e-6 };
    let (map, uneven) = MirrorMap::by_topology(&positions, &triangles, seam);
    is_involution(&map);
    let [a, b] = uneven.expect("a difference").map(|v| positions[v as usize]);
    let places = corners.map(|v| shape.0[v as usize]);
    let near = |p: DVec3| places.iter().any(|q| q.distance(DVec3::new(p.x.abs(), p.y, p.z)) < 0.3);
    assert!(near(a) || near(b), "the difference is at {places:?}, not at {a} and {b}");
    assert!(map.n_alone() <= 1, "{} vertices have no partner", map.n_alone());
}

#[test]
fn pieces_on_one_side_are_paired_by_their_places() {
    let (body, body_triangles) = irregular(7);
    let (mut positions, mut triangles) = (body.clone(), body_triangles);
    let (eye, eye_triangles) = octahedron(1);
    for side in [-1.0, 1.0] {
        let first = positions.len() as u32;
        positions.extend(eye.iter().map(|&p| DVec3::new(side * (p.x + 3.0), p.y, p.z)));
        triangles.extend(eye_triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let seam = Seam { edge: None, plane: MIDDLE, tolerance: 1e-3 };
    let (map, uneven) = MirrorMap::by_topology(&positions, &triangles, seam);
    assert_eq!(uneven, None);
    is_whole(&map, &positions);
}

#[test]
fn broken_meshes_have_no_partners_and_do_no_harm() {
    let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NAN, DVec3::ZERO];
    let triangles = [[0, 1, 2], [1, 2, 3], [0, 0, 4], [1, 9, 1]];
    for edge in [None, Some([0, 1]), Some([7, 9])] {
        let seam = Seam { edge, plane: Plane { axis: 7, at: f64::NAN }, tolerance: f64::NAN };
        is_involution(&MirrorMap::by_topology(&positions, &triangles, seam).0);
    }
    let none = MirrorMap::by_plane(&[], MIDDLE, 1.0);
    assert_eq!((none.partner(0), none.across(3), none.n_alone()), (None, &[][..], 0));
    assert_eq!(MirrorMap::by_plane(&[DVec3::X; 3], MIDDLE, -1.0).n_alone(), 3, "nothing is nearer than nothing");
}
