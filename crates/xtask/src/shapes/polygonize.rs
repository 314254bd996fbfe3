//! From a field to a mesh of well-shaped triangles.
//!
//! A net of one vertex in every grid cell that the surface passes, joined across every grid edge that crosses it
//! (surface nets), is closed and evenly spaced but follows the grid. Alternating Delaunay flips with smoothing
//! along the surface then frees it from the grid.
//!
//! Where two sheets pass through one cell the net would join them; the samples' grids are chosen so that none do.

use super::field::Field;
use super::flips::improve;
use super::mesh::{Shape, area_vector};
use glam::DVec3;
use rayon::prelude::*;

/// Where to look, and how finely.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// Side of a cell; triangles get edges of about this length.
    pub(crate) cell: f64,
}

/// Rounds of smoothing; by eye: after 20 the angles hardly change.
const N_ROUNDS: usize = 30;
/// How far towards the middle of its neighbors a vertex goes in a round: half way neither oscillates nor crawls.
const STEP: f64 = 0.5;

/// The closed surface of a field within the grid's box.
pub(crate) fn polygonize(field: &impl Field, grid: Grid) -> Shape {
    let mut shape = net(field, grid);
    settle(&mut shape, field);
    for _ in 0..N_ROUNDS {
        improve(&mut shape);
        smooth(&mut shape, field);
    }
    settle(&mut shape, field);
    improve(&mut shape);
    shape
}

/// Moves all vertices onto the surface.
fn settle(shape: &mut Shape, field: &impl Field) {
    shape.positions.par_iter_mut().for_each(|p| *p = field.project(*p, 4));
}

/// Surface nets.
fn net(field: &impl Field, grid: Grid) -> Shape {
    let n = ((grid.high - grid.low) / grid.cell).ceil();
    let nodes = [n.x as usize + 1, n.y as usize + 1, n.z as usize + 1];
    let index = |[i, j, k]: [usize; 3]| (k * nodes[1] + j) * nodes[0] + i;
    let place = |[i, j, k]: [usize; 3]| grid.low + DVec3::new(i as f64, j as f64, k as f64) * grid.cell;
    let mut values: Vec<f64> = vec![0.0; nodes.iter().product()];
    values.par_iter_mut().enumerate().for_each(|(i, value)| {
        *value = field.at(place([i % nodes[0], i / nodes[0] % nodes[1], i / (nodes[0] * nodes[1])]));
    });
    let mut shape = Shape::default();
    let mut vertex_of_cell = vec![u32::MAX; values.len()];
    each_below(nodes.map(|n| n - 1), |at| {
        if let Some(p) = middle_of_crossings(at, |node| (place(node), values[index(node)])) {
            vertex_of_cell[index(at)] = shape.positions.len() as u32;
            shape.positions.push(p);
        }
    });
    each_below(nodes.map(|n| n - 1), |at| {
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut end = at;
            end[axis] += 1;
            let (inside, end_inside) = (values[index(at)] < 0.0, values[index(end)] < 0.0);
            if inside == end_inside || at[u] == 0 || at[v] == 0 {
                continue;
            }
            let cell = |du: usize, dv: usize| {
                let mut c = at;
                (c[u], c[v]) = (c[u] - du, c[v] - dv);
                vertex_of_cell[index(c)]
            };
            let [a, b, c, d] = [cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)];
            let quad = [[a, b, c], [a, c, d]];
            shape.triangles.extend(quad.map(|t| if inside { t } else { [t[0], t[2], t[1]] }));
        }
    });
    shape
}

fn each_below(n: [usize; 3], mut visit: impl FnMut([usize; 3])) {
    for k in 0..n[2] {
        for j in 0..n[1] {
            (0..n[0]).for_each(|i| visit([i, j, k]));
        }
    }
}

/// Mean of the points where the cell's twelve edges cross the surface, if any does.
fn middle_of_crossings(cell: [usize; 3], node: impl Fn([usize; 3]) -> (DVec3, f64)) -> Option<DVec3> {
    let corner = |bits: usize| node([cell[0] + (bits & 1), cell[1] + (bits >> 1 & 1), cell[2] + (bits >> 2)]);
    let (mut sum, mut count) = (DVec3::ZERO, 0);
    for from in 0..8 {
        for to in [1, 2, 4].map(|bit| from | bit).into_iter().filter(|&to| to != from) {
            let ((p, a), (q, b)) = (corner(from), corner(to));
            if (a < 0.0) != (b < 0.0) {
                sum += p.lerp(q, a / (a - b));
                count += 1;
            }
        }
    }
    (count > 0).then(|| sum / f64::from(count))
}

/// Moves every vertex along the surface towards the middle of the triangles around it, then back onto the surface.
fn smooth(shape: &mut Shape, field: &impl Field) {
    let n = shape.positions.len();
    let (mut sums, mut weights, mut normals) = (vec![DVec3::ZERO; n], vec![0.0; n], vec![DVec3::ZERO; n]);
    for &t in &shape.triangles {
        let corners = shape.corners(t);
        let normal = area_vector(corners);
        let area = normal.length();
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        for v in t.map(|v| v as usize) {
            sums[v] += middle * area;
            weights[v] += area;
            normals[v] += normal;
        }
    }
    shape.positions.par_iter_mut().enumerate().for_each(|(v, p)| {
        let normal = normals[v].normalize_or_zero();
        let step = (sums[v] / weights[v] - *p) * STEP;
        *p = field.project_along(*p + step - normal * normal.dot(step), normal);
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::field::{Union, ball};

    #[test]
    fn a_ball_becomes_a_closed_even_sphere() {
        let mut field = Union::default();
        field.join(ball(DVec3::ZERO, 1.0), 0.1);
        let grid = Grid { low: DVec3::splat(-1.3), high: DVec3::splat(1.3), cell: 0.2 };
        let shape = polygonize(&field, grid);
        assert_eq!(shape.flaws(false), Vec::<String>::new());
        assert_eq!(shape.triangles.len(), 2 * shape.positions.len() - 4, "a sphere by Euler's formula");
        assert!(shape.smallest_angle() > 30.0, "{}°", shape.smallest_angle());
        // Six volumes of the ball are 8 π = 25.1; facets 0.2 long cut off about one percent.
        assert!((24.5..25.2).contains(&shape.volume()), "{}", shape.volume());
        assert!(shape.positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-9));
    }
}
