//! Shapes and numbers for tests.

use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// A small generator of repeatable numbers (splitmix64).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    /// In 0..1.
    pub(crate) fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1_u64 << 24) as f32
    }

    /// In the cube -1..1.
    pub(crate) fn point(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number()) * 2.0 - 1.0
    }
}

/// `n` triangles of about `size` anywhere in the cube -1..1, some sharing a vertex.
pub(crate) fn soup(n: usize, size: f32, noise: &mut Noise) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..n as u32 {
        let center = noise.point();
        positions.extend((0..3).map(|_| center + noise.point() * size));
        let shared = if i % 5 == 4 { 3 * i - 1 } else { 3 * i };
        triangles.push([shared, 3 * i + 1, 3 * i + 2]);
    }
    (positions, triangles)
}

/// Rows and columns of vertices with both directions closed or open; quads cut by one diagonal.
fn grid(rows: u32, columns: u32, wrap_rows: bool, wrap_columns: bool) -> Vec<[u32; 3]> {
    let at = |i: u32, j: u32| (i % rows) * columns + j % columns;
    let mut triangles = Vec::new();
    for i in 0..if wrap_rows { rows } else { rows - 1 } {
        for j in 0..if wrap_columns { columns } else { columns - 1 } {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    triangles
}

/// A ring around the z axis.
pub(crate) fn torus(radius: f64, tube: f64, around: u32, across: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for i in 0..around {
        for j in 0..across {
            let (u, v) = (TAU * f64::from(i) / f64::from(around), TAU * f64::from(j) / f64::from(across));
            let r = radius + tube * v.cos();
            positions.push(DVec3::new(r * u.cos(), r * u.sin(), tube * v.sin()));
        }
    }
    (positions, grid(around, across, true, true))
}

/// The unit sphere by latitude and longitude, outward; the last two vertices are the poles.
pub(crate) fn sphere(rows: u32, columns: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for i in 1..rows {
        for j in 0..columns {
            let (u, v) = (PI * f64::from(i) / f64::from(rows), TAU * f64::from(j) / f64::from(columns));
            positions.push(DVec3::new(u.sin() * v.cos(), u.sin() * v.sin(), u.cos()));
        }
    }
    let mut triangles = grid(rows - 1, columns, false, true);
    let (north, south) = (positions.len() as u32, positions.len() as u32 + 1);
    positions.extend([DVec3::Z, DVec3::NEG_Z]);
    let last_row = (rows - 2) * columns;
    for j in 0..columns {
        let next = (j + 1) % columns;
        triangles.push([north, j, next]);
        triangles.push([south, last_row + next, last_row + j]);
    }
    (positions, triangles)
}

/// The square 0..1 in the plane z = 0 with `n` × `n` vertices, moved about inside by `jitter` cells.
pub(crate) fn square(n: u32, jitter: f32, noise: &mut Noise) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let inside = i > 0 && j > 0 && i + 1 < n && j + 1 < n;
            let moved = noise.point() * if inside { jitter } else { 0.0 };
            let cell = 1.0 / (n - 1) as f32;
            positions.push(Vec3::new((i as f32 + moved.x) * cell, (j as f32 + moved.y) * cell, 0.0));
        }
    }
    (positions, grid(n, n, false, false))
}
