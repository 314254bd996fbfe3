//! Bars: box surfaces of square-ish cells, each cut by a diagonal, the diagonals alternating like a checkerboard.
//!
//! The bar lies along x from 0 to its length, its section is the unit square 0..1 in y and z. They are what the paper
//! bends in its figures 3 and 8 and table 1. Which diagonal comes first is seen only in how many pairs of triangles cross
//! in figure 3: 100 this way, 96 the other.

use super::handles::{Handles, sine_and_cosine};
use super::{Sample, Shape};
use glam::DVec3;
use std::collections::BTreeMap;

/// 6 × 6 × 45 cells, 1 × 1 × 7.5; bent by 170°, and by 150°.
pub(crate) const BAR: Sample = Sample {
    name: "bar",
    make: || surface([45, 6, 6], 7.5),
    handles: |shape| vec![("", arc(shape, 7.5, 170.0)), (".150", arc(shape, 7.5, 150.0))],
    rigidity: None,
};

/// 2 × 2 × 143 cells, 1 × 1 × 36; bent to a half circle.
pub(crate) const THIN_BAR: Sample = Sample {
    name: "thin-bar",
    make: || surface([143, 2, 2], 36.0),
    handles: |shape| vec![("", arc(shape, 36.0, 180.0))],
    rigidity: None,
};

/// A bar like [`BAR`] of any fineness, `cells` cells across and about 30 `cells`² vertices, and its bend.
pub(crate) fn bent(cells: u32, degrees: f64) -> (Shape, Handles) {
    let shape = surface([cells * 15 / 2, cells, cells], 7.5);
    let handles = arc(&shape, 7.5, degrees);
    (shape, handles)
}

/// The surface of a box of `cells` cells along x, y, z.
fn surface(cells: [u32; 3], length: f64) -> Shape {
    let [nx, ny, nz] = cells;
    let mut shape = Shape::default();
    let mut numbers = BTreeMap::new();
    for i in 0..=nx {
        for j in 0..=ny {
            for k in 0..=nz {
                let inside = i > 0 && i < nx && j > 0 && j < ny && k > 0 && k < nz;
                if !inside {
                    numbers.insert([i, j, k], shape.positions.len() as u32);
                    let along = |step: u32, n: u32, size: f64| size * f64::from(step) / f64::from(n);
                    shape.positions.push(DVec3::new(along(i, nx, length), along(j, ny, 1.0), along(k, nz, 1.0)));
                }
            }
        }
    }
    // Two sides across each axis: u and v are the other axes in cyclic order, so that u × v points along +axis.
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for far in [false, true] {
            for a in 0..cells[u] {
                for b in 0..cells[v] {
                    let at = |da: u32, db: u32| {
                        let mut key = [0; 3];
                        (key[axis], key[u], key[v]) = (if far { cells[axis] } else { 0 }, a + da, b + db);
                        numbers[&key]
                    };
                    let corners = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
                    shape
                        .triangles
                        .extend(cut(corners, (a + b) % 2 == 1).map(|t| if far { t } else { [t[0], t[2], t[1]] }));
                }
            }
        }
    }
    shape.rounded_to_f32()
}

/// A cell of four corners, counterclockwise, cut along its first or its second diagonal.
fn cut([a, b, c, d]: [u32; 4], first: bool) -> [[u32; 3]; 2] {
    if first { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// The end at x = 0 held, the other carried along an arc in the x-y plane that keeps the middle line's length L: with
/// y' = y − ½ and ρ = L / θ, a vertex goes to ((ρ − y') sin θ, ½ + ρ − (ρ − y') cos θ, z).
fn arc(shape: &Shape, length: f64, degrees: f64) -> Handles {
    let (sin, cos) = sine_and_cosine(degrees);
    let radius = length / degrees.to_radians();
    let carried = |v: u32| {
        let p = shape.positions[v as usize];
        let arm = radius - (p.y - 0.5);
        (v, DVec3::new(arm * sin, 0.5 + radius - arm * cos, p.z))
    };
    Handles {
        fixed: shape.vertices_where(|p| p.x == 0.0),
        moved: shape.vertices_where(|p| p.x == length).into_iter().map(carried).collect(),
        groups: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_bars_have_the_paper_s_number_of_vertices() {
        for sample in [BAR, THIN_BAR] {
            let shape = (sample.make)();
            assert_eq!(shape.positions.len(), 1154, "{}", sample.name);
            assert_eq!(shape.triangles.len(), 2 * 1154 - 4, "{}: Euler's formula", sample.name);
        }
    }

    #[test]
    fn diagonals_alternate_so_that_valences_are_four_and_eight() {
        let shape = (BAR.make)();
        let mut valence = vec![0; shape.positions.len()];
        shape.triangles.iter().flatten().for_each(|&v| valence[v as usize] += 1);
        for (v, p) in shape.positions.iter().enumerate() {
            let on_sides = [p.x == 0.0 || p.x == 7.5, p.y == 0.0 || p.y == 1.0, p.z == 0.0 || p.z == 1.0];
            if on_sides.iter().filter(|&&on| on).count() == 1 {
                assert!(valence[v] == 4 || valence[v] == 8, "vertex {v} at {p}: {} triangles", valence[v]);
            }
        }
    }

    #[test]
    fn arcs_hold_one_end_and_carry_the_other_rigidly() {
        for (sample, n) in [(BAR, 49), (THIN_BAR, 9)] {
            let shape = (sample.make)();
            for (suffix, handles) in &(sample.handles)(&shape) {
                assert_eq!((handles.fixed.len(), handles.moved.len()), (n, n), "{}{suffix}", sample.name);
                let rest = |i: usize| shape.positions[handles.moved[i].0 as usize];
                for i in 1..n {
                    let (got, expected) = (handles.moved[i].1.distance(handles.moved[0].1), rest(i).distance(rest(0)));
                    assert!((got - expected).abs() < 1e-9, "vertex {}: {got} for {expected}", handles.moved[i].0);
                }
            }
        }
    }

    #[test]
    fn a_half_circle_ends_above_its_start() {
        let thin = (THIN_BAR.make)();
        let (_, handles) = &(THIN_BAR.handles)(&thin)[0];
        let diameter = 2.0 * 36.0 / std::f64::consts::PI;
        for &(v, to) in &handles.moved {
            let rest = thin.positions[v as usize];
            let expected = DVec3::new(0.0, diameter + 1.0 - rest.y, rest.z);
            assert!(to.distance(expected) < 1e-9, "vertex {v}: {to} for {expected}");
        }
    }
}
