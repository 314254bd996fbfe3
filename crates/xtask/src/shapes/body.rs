//! A bumpy ellipsoid of any number of vertices, triangulated irregularly: what the benchmarks bend.
//!
//! An icosahedron whose sides are cut into `cuts`² triangles is blown up to a sphere (10 cuts² + 2 vertices); its
//! vertices are shaken along the sphere and carried onto the body, and edges are flipped until the triangulation is
//! Delaunay: no weight is negative, so that every method's energy is the same with raw and with clamped weights.

use super::Shape;
use super::flips::improve;
use super::handles::{Handles, turn_and_shift};
use glam::{DMat4, DVec3};
use std::collections::BTreeMap;

/// How far a vertex is shaken, in lengths of an edge; by eye: valences of 4 to 9, and no angle below 5°.
const SHAKE: f64 = 0.2;
/// Half axes.
const AXES: DVec3 = DVec3::new(3.0, 1.0, 1.0);
/// What lies beyond this on either end of the long axis is held.
const END: f64 = 2.6;

/// A body of 10 `cuts`² + 2 vertices.
pub(crate) fn body(cuts: u32) -> Shape {
    let mut shape = icosphere(cuts);
    // An edge of the icosahedron in a unit sphere is 1.05 long, on average less once cut and blown up.
    let step = SHAKE * 1.15 / f64::from(cuts);
    for (i, p) in shape.positions.iter_mut().enumerate() {
        let shaken = (*p + step * noise(i as u64)).normalize();
        *p = onto_body(shaken);
    }
    improve(&mut shape);
    shape.rounded_to_f32()
}

/// One end held, the other bent by `degrees` along an arc that keeps the length of the long axis between them.
pub(crate) fn bend(shape: &Shape, degrees: f64) -> Handles {
    let length = 2.0 * END;
    let center = DVec3::new(-END, length / degrees.to_radians(), 0.0);
    let carry = turn_and_shift(center, DVec3::Z, degrees, DVec3::ZERO) * DMat4::from_translation(-length * DVec3::X);
    Handles {
        fixed: shape.vertices_where(|p| p.x < -END),
        moved: Vec::new(),
        groups: vec![(shape.vertices_where(|p| p.x > END), carry)],
    }
}

fn onto_body(p: DVec3) -> DVec3 {
    // Bumps about 0.7 apart, a tenth high: triangles of the smallest mesh still show them.
    let bumps = libm::sin(9.0 * p.x + 1.0) * libm::sin(3.0 * p.y + 2.0) * libm::sin(4.0 * p.z);
    AXES * p * (1.0 + 0.1 * bumps)
}

/// A vector within the cube of half side 1, the same for the same number everywhere.
fn noise(seed: u64) -> DVec3 {
    // SplitMix64 (Steele, Lea, Flood 2014).
    let number = |i: u64| {
        let mut z = (3 * seed + i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    DVec3::new(number(0), number(1), number(2))
}

/// The sphere of radius 1.
fn icosphere(cuts: u32) -> Shape {
    let mut shape = Shape::default();
    let mut numbers = BTreeMap::new();
    for corners in ICOSAHEDRON {
        // A point of a side is known by how many steps it is from each corner; corners not involved are left out, so
        // that neighboring sides agree.
        let mut at = |a: u32, b: u32| {
            let steps = [cuts - a - b, a, b];
            let mut key = [(u32::MAX, 0); 3];
            let involved = corners.into_iter().zip(steps).filter(|(_, steps)| *steps > 0);
            key.iter_mut().zip(involved).for_each(|(key, value)| *key = value);
            key.sort_unstable();
            *numbers.entry(key).or_insert_with(|| {
                let sum: DVec3 = key.iter().filter(|k| k.1 > 0).map(|&(c, s)| corner(c) * f64::from(s)).sum();
                shape.positions.push(sum.normalize());
                shape.positions.len() as u32 - 1
            })
        };
        for a in 0..cuts {
            for b in 0..cuts - a {
                shape.triangles.push([at(a, b), at(a + 1, b), at(a, b + 1)]);
                if a + b + 2 <= cuts {
                    shape.triangles.push([at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)]);
                }
            }
        }
    }
    shape
}

/// Corner 4 i + 2 s + t is a cyclic shift by i of (0, ±1, ±φ).
fn corner(number: u32) -> DVec3 {
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let sign = |bit: u32| if number & bit == 0 { 1.0 } else { -1.0 };
    let (u, v) = (sign(2), sign(1) * golden);
    [DVec3::new(0.0, u, v), DVec3::new(v, 0.0, u), DVec3::new(u, v, 0.0)][number as usize / 4]
}

/// Sides, counterclockwise from outside.
#[rustfmt::skip]
const ICOSAHEDRON: [[u32; 3]; 20] = [
    [0, 2, 4], [0, 5, 2], [0, 4, 8], [0, 10, 5], [0, 8, 10],
    [1, 6, 3], [1, 3, 7], [1, 8, 6], [1, 7, 10], [1, 10, 8],
    [2, 9, 4], [2, 5, 11], [2, 11, 9], [3, 6, 9], [3, 11, 7],
    [3, 9, 11], [4, 6, 8], [4, 9, 6], [5, 10, 7], [5, 7, 11],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_are_closed_irregular_and_as_large_as_said() {
        for cuts in [4, 10] {
            let shape = body(cuts);
            let n = shape.positions.len();
            assert_eq!((n as u32, shape.triangles.len()), (10 * cuts * cuts + 2, 2 * n - 4), "{cuts} cuts");
            assert_eq!(shape.flaws(false), Vec::<String>::new(), "{cuts} cuts");
            assert!(shape.volume() > 0.0 && shape.smallest_angle() > 5.0, "an angle of {}°", shape.smallest_angle());
            let mut valence = vec![0; n];
            shape.triangles.iter().flatten().for_each(|&v| valence[v as usize] += 1);
            let irregular = valence.iter().filter(|&&valence| valence != 6).count();
            assert!(5 * irregular > n, "{irregular} of {n} vertices have no six neighbors");
        }
    }

    #[test]
    fn no_weight_is_negative() {
        let shape = body(10);
        let edges = shape.directed_edges();
        let cotangent = |from: u32, to: u32| {
            let triangle = shape.triangles[edges.triangle(from, to).expect("closed") as usize];
            let third = triangle.into_iter().find(|&v| v != from && v != to).expect("three corners");
            let [a, b, c] = shape.corners([from, to, third]);
            (a - c).dot(b - c) / (a - c).cross(b - c).length()
        };
        for &((a, b), _) in &edges.0 {
            let sum = cotangent(a, b) + cotangent(b, a);
            // The flips stop a hair below zero, and single precision moves the vertices after them.
            assert!(sum > -1e-5, "edge {a}-{b}: {sum}");
        }
    }

    #[test]
    fn bends_carry_one_end_rigidly_and_hold_the_other() {
        let shape = body(10);
        let handles = bend(&shape, 70.0);
        let (vertices, _) = &handles.groups[0];
        assert!(handles.fixed.len() > 20 && vertices.len() > 20);
        let targets = handles.targets(&shape);
        for part in [&targets[..handles.fixed.len()], &targets[handles.fixed.len()..]] {
            for &(v, to) in part {
                let rest = |v: u32| shape.positions[v as usize];
                let (got, expected) = (to.distance(part[0].1), rest(v).distance(rest(part[0].0)));
                assert!((got - expected).abs() < 1e-9, "vertex {v}: {got} for {expected}");
            }
        }
    }
}
