//! Shapes made by formula. Every coordinate is exactly a 32-bit number, so that every file format can hold it.

use std::collections::BTreeMap;
use std::fmt::Write;

/// A point or a vector.
pub type Vector = [f64; 3];

/// A triangle mesh: positions and corners.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Position of every vertex.
    pub positions: Vec<Vector>,
    /// Corners of every triangle, counterclockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// The shape as the text of an OBJ file, with positions to the last bit.
    pub fn obj(&self) -> String {
        let mut text = String::new();
        for [x, y, z] in &self.positions {
            writeln!(text, "v {x} {y} {z}").expect("writing to a string");
        }
        for [a, b, c] in &self.triangles {
            writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).expect("writing to a string");
        }
        text
    }

    /// Length of the bounding box's diagonal.
    pub fn diagonal(&self) -> f64 {
        let extent = |axis: usize| {
            let values = self.positions.iter().map(|position| position[axis]);
            values.clone().fold(f64::MIN, f64::max) - values.fold(f64::MAX, f64::min)
        };
        (extent(0).powi(2) + extent(1).powi(2) + extent(2).powi(2)).sqrt()
    }

    /// Vertices whose position satisfies `condition`.
    pub fn vertices(&self, condition: impl Fn(Vector) -> bool) -> Vec<usize> {
        (0..self.positions.len()).filter(|&vertex| condition(self.positions[vertex])).collect()
    }
}

/// The surface of a box of `cells` cells, `size` large, from (0, 0, 0): each cell cut by a diagonal, diagonals
/// alternating like a checkerboard on every side.
pub fn bar(cells: [u32; 3], size: Vector) -> Shape {
    let mut shape = Shape { positions: Vec::new(), triangles: Vec::new() };
    let mut known = BTreeMap::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for (level, outward) in [(0, false), (cells[axis], true)] {
            for (i, j) in (0..cells[u]).flat_map(|i| (0..cells[v]).map(move |j| (i, j))) {
                let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| {
                    let mut at = [0; 3];
                    (at[axis], at[u], at[v]) = (level, i, j);
                    grid_vertex(at, cells, size, &mut known, &mut shape.positions)
                });
                let quad = if outward { corners } else { [corners[0], corners[3], corners[2], corners[1]] };
                shape.triangles.extend(split(quad, (i + j) % 2 == 0));
            }
        }
    }
    shape
}

/// The bar of the paper's figures 3 and 8: 6 × 6 × 45 cells, 1154 vertices, 1 × 1 × 7.5, long along x.
pub fn paper_bar() -> Shape {
    bar([45, 6, 6], [7.5, 1.0, 1.0])
}

/// The bar of the paper's table 1: 2 × 2 × 143 cells, 1154 vertices, 1 × 1 × 36, long along x.
pub fn thin_bar() -> Shape {
    bar([143, 2, 2], [36.0, 1.0, 1.0])
}

fn grid_vertex(
    at: [u32; 3],
    cells: [u32; 3],
    size: Vector,
    known: &mut BTreeMap<[u32; 3], u32>,
    positions: &mut Vec<Vector>,
) -> u32 {
    *known.entry(at).or_insert_with(|| {
        let axes = [0, 1, 2];
        positions.push(axes.map(|axis| round(size[axis] * f64::from(at[axis]) / f64::from(cells[axis]))));
        positions.len() as u32 - 1
    })
}

fn split([a, b, c, d]: [u32; 4], along_ac: bool) -> [[u32; 3]; 2] {
    if along_ac { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// Where a bar of length `length` along x, with y from 0 to 1, is bent along an arc of `degrees`: the image of the
/// point at its far end with these y and z.
pub fn arc_end(position: Vector, length: f64, degrees: f64) -> Vector {
    let theta = degrees.to_radians();
    let radius = length / theta;
    let [_, y, z] = position;
    let height = y - 0.5;
    [(radius - height) * theta.sin(), 0.5 + radius - (radius - height) * theta.cos(), z]
}

/// An open sheet of `columns` × `rows` jittered, bumpy cells with diagonals by chance.
pub fn irregular_sheet(columns: u32, rows: u32, jitter: f64, seed: u64) -> Shape {
    let mut chance = Chance::new(seed);
    let mut shape = Shape { positions: Vec::new(), triangles: Vec::new() };
    for (row, column) in (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column))) {
        let x = f64::from(column) + jitter * chance.signed();
        let y = f64::from(row) + jitter * chance.signed();
        let z = (x / 3.0).sin() + (y / 4.0).cos() + 0.3 * chance.signed();
        shape.positions.push([x, y, z].map(round));
    }
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let at = |row, column| row * (columns + 1) + column;
        let quad = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
        shape.triangles.extend(split(quad, chance.signed() > 0.0));
    }
    shape
}

/// A closed, irregular, bumpy ball of radius about 1: an icosahedron divided `levels` times, its vertices moved along
/// the surface by up to `jitter` of an edge and out or in by bumps.
pub fn bumpy_ball(levels: u32, jitter: f64, seed: u64) -> Shape {
    let mut shape = icosahedron();
    for _ in 0..levels {
        shape = divide(&shape);
    }
    let mut chance = Chance::new(seed);
    // About the edge length of an icosahedron on the unit sphere, halved at each level.
    let edge = 1.05 / f64::from(1 << levels);
    for position in &mut shape.positions {
        let moved = position.map(|value| value + jitter * edge * chance.signed());
        let [x, y, z] = unit(moved);
        let radius = 1.0 + 0.15 * (3.0 * x + 1.0).sin() * (4.0 * y).cos() + 0.1 * (5.0 * z).sin();
        *position = [x, y, z].map(|value| round(radius * value));
    }
    shape
}

fn icosahedron() -> Shape {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut positions = Vec::new();
    for axis in 0..3 {
        for (one, other) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut position = [0.0; 3];
            (position[(axis + 1) % 3], position[(axis + 2) % 3]) = (one, other);
            positions.push(unit(position));
        }
    }
    // A face is three corners that are pairwise nearest; its edge is 1.05, the next distance 1.7.
    let near = |a: usize, b: usize| distance(positions[a], positions[b]) < 1.2;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in (a + 1)..12 {
            for c in (b + 1)..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    let outward = determinant([positions[a], positions[b], positions[c]]) > 0.0;
                    let [b, c] = if outward { [b, c] } else { [c, b] };
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    Shape { positions, triangles }
}

fn divide(shape: &Shape) -> Shape {
    let mut positions = shape.positions.clone();
    let mut middles = BTreeMap::new();
    let mut triangles = Vec::new();
    for &[a, b, c] in &shape.triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(i, j)| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                let (p, q) = (shape.positions[i as usize], shape.positions[j as usize]);
                positions.push(unit([p[0] + q[0], p[1] + q[1], p[2] + q[2]]));
                positions.len() as u32 - 1
            })
        });
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    Shape { positions, triangles }
}

/// Distance of two points.
pub fn distance(a: Vector, b: Vector) -> f64 {
    ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)).sqrt()
}

fn unit(v: Vector) -> Vector {
    let length = distance(v, [0.0; 3]);
    v.map(|value| value / length)
}

fn determinant([a, b, c]: [Vector; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// The nearest 32-bit number.
fn round(value: f64) -> f64 {
    f64::from(value as f32)
}

/// Repeatable chance (a 64-bit linear congruential generator with Knuth's constants).
#[derive(Debug)]
pub struct Chance(u64);

impl Chance {
    /// The same seed gives the same numbers.
    pub fn new(seed: u64) -> Self {
        Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d)
    }

    /// Uniform in −1 … 1.
    pub fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: u64) -> u64 {
        (((self.signed() + 1.0) / 2.0) * end as f64) as u64 % end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every edge of a closed, consistently oriented surface is used once in each direction.
    fn assert_closed(shape: &Shape) {
        let mut uses = BTreeMap::new();
        for &[a, b, c] in &shape.triangles {
            for edge in [(a, b), (b, c), (c, a)] {
                *uses.entry(edge).or_insert(0) += 1;
            }
        }
        for (&(a, b), &count) in &uses {
            assert_eq!((count, uses.get(&(b, a))), (1, Some(&1)), "edge {a} {b}");
        }
    }

    #[test]
    fn the_papers_bars_have_1154_vertices_and_are_closed() {
        for shape in [paper_bar(), thin_bar()] {
            assert_eq!((shape.positions.len(), shape.triangles.len()), (1154, 2304));
            assert_closed(&shape);
        }
    }

    #[test]
    fn bumpy_balls_are_closed() {
        let ball = bumpy_ball(2, 0.2, 1);
        assert_eq!((ball.positions.len(), ball.triangles.len()), (162, 320));
        assert_closed(&ball);
    }

    #[test]
    fn a_small_arc_is_the_rest_pose() {
        let end = arc_end([7.5, 0.25, 0.75], 7.5, 1e-6);
        assert!(distance(end, [7.5, 0.25, 0.75]) < 1e-6, "{end:?}");
    }
}
