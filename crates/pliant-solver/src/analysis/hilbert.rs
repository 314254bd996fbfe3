//! Position along a three-dimensional Hilbert curve: neighbors in space get numbers close to each other, so that what
//! is used together lies together in memory, and a neighborhood is a few runs of consecutive edges.
//!
//! A cell of a 2²¹-cubed grid is walked to from the coarsest octant down. At each level the curve enters the octants in
//! Gray-code order, mirrored and turned so that it joins up. Those mirrorings and turns are undone bit by bit on the
//! coordinates (Skilling's observation), after which the Gray code of the interleaved bits is the position.

use glam::DVec3;

/// Bits per axis: three times 21 fit a 64-bit key.
const BITS: u32 = 21;

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

    /// How far along the curve the cell of `p` lies.
    pub(crate) fn position(&self, p: DVec3) -> u64 {
        let q = (p - self.corner) * self.cells_per_unit;
        // Casting saturates: a point outside, or 0 times infinity, gets the nearest end of the cube.
        position_of_cell([q.x as u32, q.y as u32, q.z as u32].map(|x| x.min((1 << BITS) - 1)))
    }
}

fn position_of_cell(mut x: [u32; 3]) -> u64 {
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        let below = bit - 1;
        for axis in 0..3 {
            if x[axis] & bit != 0 {
                x[0] ^= below;
            } else {
                let swap = (x[0] ^ x[axis]) & below;
                x[0] ^= swap;
                x[axis] ^= swap;
            }
        }
        bit >>= 1;
    }
    x[1] ^= x[0];
    x[2] ^= x[1];
    let mut parity = 0;
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        if x[2] & bit != 0 {
            parity ^= bit - 1;
        }
        bit >>= 1;
    }
    let x = x.map(|axis| axis ^ parity);
    (0..BITS).rev().fold(0, |key, level| x.iter().fold(key, |key, axis| key << 1 | u64::from(axis >> level & 1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_cells_of_the_curve_touch() {
        // The 8³ cells at the corner of the grid are a Hilbert curve of their own.
        let mut cells: Vec<[u32; 3]> = (0..512).map(|c| [c & 7, c >> 3 & 7, c >> 6]).collect();
        cells.sort_by_key(|&cell| position_of_cell(cell));
        for pair in cells.windows(2) {
            let steps: u32 = (0..3).map(|a| pair[0][a].abs_diff(pair[1][a])).sum();
            assert_eq!(steps, 1, "{pair:?}");
        }
    }

    #[test]
    fn one_place_for_all_points_is_no_trouble() {
        let p = DVec3::new(3.0, 4.0, 5.0);
        assert_eq!(Curve::around(&[p, p]).position(p), 0);
    }
}
