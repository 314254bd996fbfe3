//! Position along a three-dimensional Hilbert curve: neighbors in space get numbers close to each other, so that what
//! is used together lies together in memory, and a neighborhood is a few runs of consecutive edges.
//!
//! A cell of a 2²¹-cubed grid is walked to from the coarsest octant down. At each level the curve enters the octants in
//! Gray-code order, mirrored and turned so that it joins up. Those mirrorings and turns are undone bit by bit on the
//! coordinates (Skilling's observation), after which the Gray code of the interleaved bits is the position.

use glam::DVec3;
use rayon::prelude::*;

/// Bits per axis: three times 21 fit a 64-bit key.
const BITS: u32 = 21;
/// Points treated side by side. One alone waits for one bit after the other: 27 ns a point in place of 205, and of 284
/// with branches, half of which are mispredicted.
const LANES: usize = 16;
/// Lanes that one thread takes at least: some hundred microseconds.
const GRAIN: usize = 256;

/// A cube with a curve through it.
pub(crate) struct Curve {
    corner: DVec3,
    cells_per_unit: f64,
}

impl Curve {
    /// The smallest cube around all points.
    pub(crate) fn around(points: &[DVec3]) -> Curve {
        let lo = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let hi = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let extent = (hi - lo).max_element();
        let cells = f64::from((1u32 << BITS) - 1);
        // All points in one place: any scale will do.
        let cells_per_unit = if extent > 0.0 && extent.is_finite() { cells / extent } else { 0.0 };
        Curve { corner: lo, cells_per_unit }
    }

    /// How far along the curve the cells of `n` points lie.
    pub(crate) fn positions(&self, n: usize, point: impl Fn(usize) -> DVec3 + Sync) -> Vec<u64> {
        let mut positions = vec![0; n];
        positions.par_chunks_mut(LANES).with_min_len(GRAIN).enumerate().for_each(|(chunk, out)| {
            let mut cells = [[0; LANES]; 3];
            (0..out.len()).for_each(|lane| {
                let cell = self.cell(point(chunk * LANES + lane));
                (0..3).for_each(|axis| cells[axis][lane] = cell[axis]);
            });
            out.copy_from_slice(&positions_of_cells(cells)[..out.len()]);
        });
        positions
    }

    fn cell(&self, p: DVec3) -> [u32; 3] {
        let q = (p - self.corner) * self.cells_per_unit;
        // Casting saturates: a point outside, or 0 times infinity, gets the nearest end of the cube.
        [q.x as u32, q.y as u32, q.z as u32].map(|x| x.min((1 << BITS) - 1))
    }
}

fn positions_of_cells(mut x: [[u32; LANES]; 3]) -> [u64; LANES] {
    for level in (1..BITS).rev() {
        let below = (1 << level) - 1;
        for axis in 0..3 {
            (0..LANES).for_each(|lane| {
                let mirrored = all_ones_if(x[axis][lane], level);
                let swap = (x[0][lane] ^ x[axis][lane]) & below & !mirrored;
                x[0][lane] ^= swap | (below & mirrored);
                x[axis][lane] ^= swap;
            });
        }
    }
    (0..LANES).for_each(|lane| {
        x[1][lane] ^= x[0][lane];
        x[2][lane] ^= x[1][lane];
    });
    let mut parity = [0; LANES];
    for level in 1..BITS {
        let below = (1 << level) - 1;
        (0..LANES).for_each(|lane| parity[lane] ^= all_ones_if(x[2][lane], level) & below);
    }
    std::array::from_fn(|lane| {
        let [a, b, c] = x.map(|axis| spread(axis[lane] ^ parity[lane]));
        a << 2 | b << 1 | c
    })
}

/// Whether a bit is set, as a mask.
fn all_ones_if(x: u32, bit: u32) -> u32 {
    (x >> bit & 1).wrapping_neg()
}

/// Bit i of 21 comes to bit 3 i: the upper half of ever smaller groups moves up by twice its size.
fn spread(x: u32) -> u64 {
    let mut x = u64::from(x);
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_cells_of_the_curve_touch() {
        // The 8³ cells at the corner of the grid are a Hilbert curve of their own.
        let curve = Curve { corner: DVec3::ZERO, cells_per_unit: 1.0 };
        let center = |c: usize| DVec3::new((c & 7) as f64, (c >> 3 & 7) as f64, (c >> 6) as f64) + 0.5;
        let positions = curve.positions(512, center);
        let mut cells: Vec<usize> = (0..512).collect();
        cells.sort_by_key(|&cell| positions[cell]);
        for (place, pair) in cells.windows(2).enumerate() {
            assert_eq!(positions[pair[0]], place as u64, "cell {}", pair[0]);
            let step = (center(pair[0]) - center(pair[1])).abs();
            assert_eq!(step.x + step.y + step.z, 1.0, "{pair:?}");
        }
    }

    #[test]
    fn spread_bits_leave_room_for_two_more() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit), "bit {bit}");
        }
        assert_eq!(spread((1 << BITS) - 1).count_ones(), BITS);
    }

    #[test]
    fn one_place_for_all_points_is_no_trouble() {
        let p = DVec3::new(3.0, 4.0, 5.0);
        assert_eq!(Curve::around(&[p, p]).positions(1, |_| p), [0]);
    }
}
