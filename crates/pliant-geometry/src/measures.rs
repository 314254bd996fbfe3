//! What a bent surface tells about itself, vertex by vertex: how its edges are stretched, how much a quantity differs from
//! one vertex to the next.
//!
//! Both take undirected edges and give one number a vertex, the one of the edge where it is strongest: a mean would hide
//! a single torn edge among five good ones, and a sheared corner, whose edges change both ways, would look untouched.

use glam::DVec3;
use rayon::prelude::*;

/// Edges to a task: a few microseconds of work, far above the cost of handing it out.
const PER_TASK: usize = 4096;
/// The largest ratio of lengths that is told apart (by eye: beyond that it is only broken).
const MOST: f64 = 1e6;

/// How far the lengths of the edges around each vertex are from those at rest: ln(length now / length at rest) of the edge
/// that changed most, 0 where none changed. Edges without length at rest say nothing; one that lost its length altogether
/// counts as shrunk a millionfold, and no change counts for more.
pub fn edge_stretch(edges: &[[u32; 2]], rest: &[DVec3], now: &[DVec3]) -> Vec<f64> {
    let length = |positions: &[DVec3], [a, b]: [u32; 2]| {
        Some(positions.get(a as usize)?.distance(*positions.get(b as usize)?)).filter(|length| length.is_finite())
    };
    let ratio = |&edge: &[u32; 2]| match (length(rest, edge), length(now, edge)) {
        (Some(before), Some(after)) if before > 0.0 => (after / before).clamp(1.0 / MOST, MOST),
        _ => 1.0,
    };
    let ratios: Vec<f64> = edges.par_iter().with_min_len(PER_TASK).map(ratio).collect();
    // A ratio and its reciprocal are equally strong; logarithms are taken once a vertex only.
    let strength = |ratio: f64| ratio.max(1.0 / ratio);
    let mut strongest = vec![1.0_f64; now.len()];
    for (ends, &ratio) in edges.iter().zip(&ratios) {
        for &v in ends {
            if let Some(known) = strongest.get_mut(v as usize)
                && strength(ratio) > strength(*known)
            {
                *known = ratio;
            }
        }
    }
    strongest.into_par_iter().with_min_len(PER_TASK).map(f64::ln).collect()
}

/// The largest difference of `values` between each vertex and the vertices it shares an edge with; 0 without neighbors.
pub fn largest_difference(edges: &[[u32; 2]], values: &[f64]) -> Vec<f64> {
    let mut largest = vec![0.0_f64; values.len()];
    for &[a, b] in edges {
        let (a, b) = (a as usize, b as usize);
        let (Some(x), Some(y)) = (values.get(a), values.get(b)) else { continue };
        // A value that is no number makes no difference: the larger of it and a number is the number.
        let difference = (x - y).abs();
        largest[a] = largest[a].max(difference);
        largest[b] = largest[b].max(difference);
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{Noise, square, torus};

    /// Every edge of the triangles once.
    fn edges_of(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
        let around = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut edges: Vec<_> = around.map(|[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// An irregular sheet and the same sheet pulled, twisted and crumpled.
    fn crumpled() -> (Vec<DVec3>, Vec<DVec3>, Vec<[u32; 3]>) {
        let mut noise = Noise(11);
        let (rest, triangles) = square(24, 0.35, &mut noise);
        let rest: Vec<DVec3> = rest.iter().map(|p| p.as_dvec3()).collect();
        let bent = |p: &DVec3| {
            let turned = DVec3::new(p.x * (3.0 * p.y).cos() * 1.4, p.y * 0.6, p.x * (3.0 * p.y).sin());
            turned + noise.point().as_dvec3() * 0.01
        };
        let now = rest.iter().map(bent).collect();
        (rest, now, triangles)
    }

    #[test]
    fn stretch_is_that_of_the_edge_that_changed_most() {
        let (rest, now, triangles) = crumpled();
        let edges = edges_of(&triangles);
        let got = edge_stretch(&edges, &rest, &now);
        for (v, &got) in got.iter().enumerate() {
            let logs = edges.iter().filter(|edge| edge.contains(&(v as u32))).map(|&[a, b]| {
                let length = |p: &[DVec3]| p[a as usize].distance(p[b as usize]);
                (length(&now) / length(&rest)).ln()
            });
            let expected = logs.max_by(|x, y| x.abs().total_cmp(&y.abs())).unwrap_or(0.0);
            // One rounding of the ratio and one of its logarithm.
            assert!((got - expected).abs() < 1e-14, "vertex {v}: got {got}, expected {expected}");
        }
        assert!(got.iter().any(|&x| x > 0.2) && got.iter().any(|&x| x < -0.2), "both ways");
    }

    #[test]
    fn moving_turning_and_scaling_stretch_as_expected() {
        let (rest, triangles) = torus(1.0, 0.3, 32, 12);
        let edges = edges_of(&triangles);
        let turn = glam::DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.1);
        for scale in [1e-9, 0.5, 1.0, 3.0, 1e5] {
            let now: Vec<DVec3> = rest.iter().map(|&p| turn * p * scale + DVec3::new(5.0, -2.0, 0.3) * scale).collect();
            let expected = f64::ln(f64::max(scale, 1.0 / MOST));
            for (v, got) in edge_stretch(&edges, &rest, &now).into_iter().enumerate() {
                // Coordinates up to 6 against edges of 0.15: 40 roundings of 1e-16, with room.
                assert!((got - expected).abs() < 1e-12, "scale {scale}, vertex {v}: got {got}, expected {expected}");
            }
        }
    }

    #[test]
    fn edges_without_length_and_nonsense_say_nothing() {
        let rest = [DVec3::ZERO, DVec3::ZERO, DVec3::X, DVec3::splat(f64::NAN)];
        let now = [DVec3::ZERO, DVec3::Y, DVec3::Y, DVec3::X];
        let got = edge_stretch(&[[0, 1], [0, 3], [2, 9], [1, 2]], &rest, &now);
        assert_eq!(got, [0.0, -MOST.ln(), -MOST.ln(), 0.0]);
    }

    #[test]
    fn differences_are_those_of_all_neighbors() {
        let (rest, _, triangles) = crumpled();
        let mut edges = edges_of(&triangles);
        edges.push([0, 1_000_000]);
        let mut noise = Noise(3);
        let mut values: Vec<f64> = rest.iter().map(|_| f64::from(noise.number())).collect();
        values[40] = f64::NAN;
        let got = largest_difference(&edges, &values);
        for (v, &got) in got.iter().enumerate() {
            let around = edges.iter().filter(|edge| edge.contains(&(v as u32)) && (edge[1] as usize) < rest.len());
            let differences = around.map(|&[a, b]| (values[a as usize] - values[b as usize]).abs());
            assert_eq!(got, differences.fold(0.0, f64::max), "vertex {v}");
        }
    }
}
