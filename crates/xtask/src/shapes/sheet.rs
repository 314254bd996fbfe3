//! An open, bumpy sheet with an irregular triangulation: borders, uneven triangles, no symmetry.

use super::handles::turn_and_shift;
use super::{Handles, Sample, Shape, flips::improve};
use glam::{DVec2, DVec3};

/// Vertices along each side.
const N: u32 = 60;
/// How far a vertex strays from the grid, in cells. Up to a quarter no triangle turns over.
const JITTER: f64 = 0.25;
/// Bumps: where (x, z), how wide, how high. By eye.
const BUMPS: [(DVec2, f64, f64); 7] = [
    (DVec2::new(-0.45, -0.40), 0.45, 0.20),
    (DVec2::new(0.40, -0.50), 0.38, -0.13),
    (DVec2::new(0.10, 0.15), 0.50, 0.24),
    (DVec2::new(-0.55, 0.50), 0.36, -0.12),
    (DVec2::new(0.62, 0.48), 0.34, 0.15),
    (DVec2::new(-0.05, -0.75), 0.24, 0.08),
    (DVec2::new(0.75, -0.02), 0.26, 0.07),
];

/// Two units wide in x and z, y up. The border x = −1 is held, the opposite one lifted and twisted.
pub(crate) const SHEET: Sample =
    Sample { name: "sheet", make: surface, handles: |shape| vec![("", lifted(shape))], rigidity: None };

fn surface() -> Shape {
    let mut shape = grid();
    improve(&mut shape);
    for p in &mut shape.positions {
        p.y = height(DVec2::new(p.x, p.z));
    }
    improve(&mut shape);
    shape.rounded_to_f32()
}

fn lifted(shape: &Shape) -> Handles {
    let matrix = turn_and_shift(DVec3::X, DVec3::X, 70.0, DVec3::new(-0.45, 0.8, 0.0));
    Handles {
        fixed: shape.vertices_where(|p| p.x == -1.0),
        moved: Vec::new(),
        groups: vec![(shape.vertices_where(|p| p.x == 1.0), matrix)],
    }
}

/// A flat, jittered grid over −1..1 in x and z, cells uneven in size; corners stay, borders stray along themselves.
fn grid() -> Shape {
    let mut shape = Shape::default();
    let mut noise = Noise(2023);
    for i in 0..N {
        for j in 0..N {
            let stray = [noise.number(), noise.number()].map(|x| (2.0 * x - 1.0) * JITTER);
            let along = |step: u32, stray: f64| {
                let free = if step == 0 || step == N - 1 { 0.0 } else { stray };
                let t = 2.0 * (f64::from(step) + free) / f64::from(N - 1) - 1.0;
                // Finer towards the middle: slope 0.76 there, 1.48 at the borders.
                t * (0.76 + 0.24 * t * t)
            };
            shape.positions.push(DVec3::new(along(i, stray[0]), 0.0, along(j, stray[1])));
        }
    }
    for i in 0..N - 1 {
        for j in 0..N - 1 {
            let at = |di: u32, dj: u32| (i + di) * N + j + dj;
            shape.triangles.push([at(0, 0), at(0, 1), at(1, 1)]);
            shape.triangles.push([at(0, 0), at(1, 1), at(1, 0)]);
        }
    }
    shape
}

fn height(at: DVec2) -> f64 {
    let bump = |(center, width, height): (DVec2, f64, f64)| {
        let t = (1.0 - at.distance_squared(center) / (width * width)).max(0.0);
        height * t * t * t
    };
    BUMPS.into_iter().map(bump).sum()
}

/// Repeatable numbers in 0..1 (splitmix64).
struct Noise(u64);

impl Noise {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
