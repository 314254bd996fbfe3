//! Turning edges until opposite angles no longer exceed 180° together (Delaunay): the triangles get as round as their
//! vertices allow.

use super::mesh::{Shape, area_vector};
use glam::DVec3;
use std::collections::BTreeSet;

/// Rounds after which flipping ends in any case; it converges in a few.
const MAX_ROUNDS: usize = 20;
/// Two triangles are turned only where they are nearly flat, or the turn would cut off a ridge: cosine of 60°.
const FLAT_ENOUGH: f64 = 0.5;

/// Flips edges until no flip improves the mesh. Connections stay those of a surface: no edge is made twice.
pub(crate) fn improve(shape: &mut Shape) {
    for _ in 0..MAX_ROUNDS {
        if flip_once(shape) == 0 {
            return;
        }
    }
}

/// Visits every edge once in order of vertex numbers; returns how many were flipped.
fn flip_once(shape: &mut Shape) -> usize {
    let edges = shape.directed_edges();
    let mut added = BTreeSet::new();
    let mut changed = vec![false; shape.triangles.len()];
    let mut n_flips = 0;
    for &((a, b), left) in edges.0.iter().filter(|((a, b), _)| a < b) {
        let Some(right) = edges.triangle(b, a) else {
            continue;
        };
        let (left, right) = (left as usize, right as usize);
        if changed[left] || changed[right] {
            continue;
        }
        let c = opposite(shape.triangles[left], a, b);
        let d = opposite(shape.triangles[right], a, b);
        let made = (c.min(d), c.max(d));
        if c == d || edges.joins(c, d) || added.contains(&made) || !is_better(shape, [a, b, c, d]) {
            continue;
        }
        added.insert(made);
        shape.triangles[left] = [a, d, c];
        shape.triangles[right] = [d, b, c];
        (changed[left], changed[right]) = (true, true);
        n_flips += 1;
    }
    n_flips
}

fn opposite(triangle: [u32; 3], a: u32, b: u32) -> u32 {
    triangle.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
}

/// Whether edge cd is better than ab in the quad a d b c.
fn is_better(shape: &Shape, quad: [u32; 4]) -> bool {
    let [a, b, c, d] = quad.map(|v| shape.positions[v as usize]);
    // Cotangents of the angles opposite to ab: their sum is negative when the angles exceed 180° together.
    let cotangent = |at: DVec3| {
        let (u, v) = (a - at, b - at);
        u.dot(v) / u.cross(v).length().max(1e-300)
    };
    // A hair below zero, so that four points on a circle are not turned for ever.
    if cotangent(c) + cotangent(d) > -1e-9 {
        return false;
    }
    let unit = |corners| area_vector(corners).normalize_or_zero();
    let flat = unit([a, b, c]).dot(unit([b, a, d])) > FLAT_ENOUGH;
    flat && unit([a, d, c]).dot(unit([d, b, c])) > FLAT_ENOUGH
}
