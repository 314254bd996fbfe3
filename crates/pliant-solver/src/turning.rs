//! The best rotations of many neighborhoods at once: the Newton method of [`crate::rotations`], a neighborhood per lane.
//!
//! | symbol | meaning |
//! |---|---|
//! | T, R, B, g, H | as there |
//! | q | R as a quaternion (x, y, z, w) |
//! | ω = H⁻¹ g | a step, by cofactors of H |
//! | μ | largest entry of T |
//! | m₁, m₂, m₃ | leading principal minors of H; its pivots are m₁, m₂ / m₁ and m₃ / m₂ |
//!
//! T is not scaled, so sizes whose sixth power leaves the numbers are left to the scalar method, and so is every lane that
//! does not arrive at a maximum within a few steps.
//!
//! The third derivative of a quadratic form along the great circle through a critical point is minus four times the first:
//! zero. So an error of |ω| leaves one of about |ω|³ μ / λ, with λ the least curvature, and one step suffices where
//! that is below rounding.

use glam::{DMat3, DQuat};
use pulp::Simd;

use crate::lanes::{Lanes, Mask};
use crate::nines::{Eight, Nine};
use crate::rotations::{FLAT, LARGEST_STEP, Ties, best_rotation};

/// Neighborhoods treated together: few enough to stay in the first cache, a multiple of any number of lanes.
pub(crate) const LOT: usize = 64;
/// Steps double or triple the digits each time. A lane that needs more began too far away.
const MOST_STEPS: usize = 5;
/// Sizes of T outside of this are left to the scalar method: its sixth power must be a number.
const SIZES: [f64; 2] = [1e-45, 1e45];
/// |ω|⁶ μ² / λ² up to which no other step is needed: an error of 1e-15.
const ARRIVED: f64 = 1e-30;

/// Neighborhoods side by side.
#[repr(align(64))]
pub(crate) struct Lot {
    /// T, column by column.
    pub(crate) t: [[f64; LOT]; 9],
    /// q before and after.
    pub(crate) q: [[f64; LOT]; 4],
    /// R after, column by column.
    r: [[f64; LOT]; 9],
    /// ⟨R, T⟩.
    gain: [f64; LOT],
    /// 0 where a lane was not solved; then q is that of before.
    solved: [f64; LOT],
}

impl Lot {
    pub(crate) fn new() -> Lot {
        let mut lot =
            Lot { t: [[0.0; LOT]; 9], q: [[0.0; LOT]; 4], r: [[0.0; LOT]; 9], gain: [0.0; LOT], solved: [0.0; LOT] };
        (0..LOT).for_each(|lane| lot.load(lane, Nine::from(DMat3::IDENTITY), DQuat::IDENTITY));
        lot
    }

    #[inline(always)]
    pub(crate) fn load(&mut self, lane: usize, t: Nine, turn: DQuat) {
        let entries = t.entries();
        (0..9).for_each(|c| self.t[c][lane] = entries[c]);
        let turn = turn.to_array();
        (0..4).for_each(|c| self.q[c][lane] = turn[c]);
    }

    /// Solves the first `turns.len()` lanes, writes their rotations, and returns Σ ⟨R, T⟩ over them.
    #[inline(always)]
    pub(crate) fn solve<S: Simd>(
        &mut self,
        simd: S,
        ties: Ties,
        turns: &mut [DQuat],
        (eights, ninths): (&mut [Eight], &mut [f64]),
    ) -> f64 {
        let n = turns.len().min(LOT);
        self.newton(simd);
        for lane in 0..n {
            if self.solved[lane] == 0.0 {
                self.solve_alone(lane, ties);
            }
            turns[lane] = DQuat::from_array(lane_of(&self.q, lane));
            let Nine { eight, ninth } = Nine::from_entries(lane_of(&self.r, lane));
            (eights[lane], ninths[lane]) = (eight, ninth);
        }
        self.gain[n..].fill(0.0);
        let mut sums = [0.0; 8];
        for eight in self.gain.chunks_exact(8) {
            (0..8).for_each(|l| sums[l] += eight[l]);
        }
        sums.iter().sum()
    }

    #[cold]
    #[inline(never)]
    fn solve_alone(&mut self, lane: usize, ties: Ties) {
        let t = DMat3::from_cols_array(&lane_of(&self.t, lane));
        let turn = best_rotation(t, DQuat::from_array(lane_of(&self.q, lane)), ties);
        let rotation = DMat3::from_quat(turn);
        let (q, r) = (turn.to_array(), rotation.to_cols_array());
        (0..4).for_each(|c| self.q[c][lane] = q[c]);
        (0..9).for_each(|c| self.r[c][lane] = r[c]);
        self.gain[lane] = crate::sums::inner(rotation, t);
    }

    #[inline(always)]
    fn newton<S: Simd>(&mut self, simd: S) {
        let Lot { t, q, r, gain, solved } = self;
        let t = t.each_ref().map(|c| S::as_simd_f64s(c).0);
        let q = q.each_mut().map(|c| S::as_mut_simd_f64s(c).0);
        let r = r.each_mut().map(|c| S::as_mut_simd_f64s(c).0);
        let (gain, solved) = (S::as_mut_simd_f64s(gain).0, S::as_mut_simd_f64s(solved).0);
        for v in 0..LOT / S::F64_LANES {
            let at = t.each_ref().map(|c| Lanes::new(simd, c[v]));
            let before = [0, 1, 2, 3].map(|c| Lanes::new(simd, q[c][v]));
            let (after, arrived) = turned(simd, &at, before);
            for c in 0..4 {
                q[c][v] = after[c].where_else(arrived, before[c]).value();
            }
            let rotation = matrix(simd, after);
            for c in 0..9 {
                r[c][v] = rotation[c].value();
            }
            gain[v] = (0..9).map(|c| rotation[c] * at[c]).reduce(|a, b| a + b).map_or(gain[v], Lanes::value);
            solved[v] = Lanes::splat(simd, 1.0).where_else(arrived, Lanes::splat(simd, 0.0)).value();
        }
    }
}

/// One lane of several numbers.
#[inline(always)]
fn lane_of<const N: usize>(numbers: &[[f64; LOT]; N], lane: usize) -> [f64; N] {
    std::array::from_fn(|c| numbers[c][lane])
}

/// q of the best rotations, and where they were found.
#[inline(always)]
fn turned<S: Simd>(simd: S, t: &[Lanes<S>; 9], before: [Lanes<S>; 4]) -> ([Lanes<S>; 4], Mask<S>) {
    let number = |x| Lanes::splat(simd, x);
    let size = t.iter().map(|entry| entry.abs()).reduce(Lanes::max).unwrap_or(t[0]);
    // A maximum forgets what is not a number; later tests do not.
    let mut sound = number(SIZES[0]).is_less(size).and(size.is_less(number(SIZES[1])));
    let mut arrived = sound.not();
    let mut q = before;
    let flat = number(FLAT) * size;
    for _ in 0..MOST_STEPS {
        let r = matrix(simd, q);
        // B = RᵀT; entry (i, j) is the product of columns i of R and j of T.
        let b = |i: usize, j: usize| r[3 * i] * t[3 * j] + r[3 * i + 1] * t[3 * j + 1] + r[3 * i + 2] * t[3 * j + 2];
        let (b00, b11, b22) = (b(0, 0), b(1, 1), b(2, 2));
        let (b01, b02, b12, b10, b20, b21) = (b(0, 1), b(0, 2), b(1, 2), b(1, 0), b(2, 0), b(2, 1));
        let g = [b21 - b12, b02 - b20, b10 - b01];
        let half = number(-0.5);
        let (h00, h11, h22) = (b11 + b22, b00 + b22, b00 + b11);
        let (h01, h02, h12) = (half * (b01 + b10), half * (b02 + b20), half * (b12 + b21));
        // Cofactors.
        let c00 = h11 * h22 - h12 * h12;
        let c01 = h02 * h12 - h01 * h22;
        let c02 = h01 * h12 - h02 * h11;
        let c11 = h00 * h22 - h02 * h02;
        let c12 = h01 * h02 - h00 * h12;
        let m2 = h00 * h11 - h01 * h01;
        let m3 = h00 * c00 + h01 * c01 + h02 * c02;
        let definite = flat.is_less(h00).and((flat * h00).is_less(m2)).and((flat * m2).is_less(m3));
        // Half the step.
        let scale = number(0.5) / m3;
        let x = scale * (c00 * g[0] + c01 * g[1] + c02 * g[2]);
        let y = scale * (c01 * g[0] + c11 * g[1] + c12 * g[2]);
        let z = scale * (c02 * g[0] + c12 * g[1] + m2 * g[2]);
        let square = x * x + y * y + z * z;
        sound = sound.and(definite).and(square.is_less(number(0.25 * LARGEST_STEP * LARGEST_STEP)));
        let next = moved(simd, q, [x, y, z], square);
        let open = sound.and(arrived.not());
        for c in 0..4 {
            q[c] = next[c].where_else(open, q[c]);
        }
        // |ω|² is four times `square`, and λ ≥ 4 m₃ / (tr H)², as the product of the other two curvatures is at most the
        // square of their mean.
        let (step, trace, four) = (number(4.0) * square, h00 + h11 + h22, number(4.0));
        let (a, b) = (size * (trace * trace), four * m3);
        let fine = (step * step * step * (a * a)).is_less(number(ARRIVED) * (b * b));
        arrived = arrived.or(fine).or(sound.not());
        if !arrived.not().any() {
            break;
        }
    }
    (q, sound.and(arrived))
}

/// q turned by the Cayley form of a step, normalized; `half` the step has length √`square`.
#[inline(always)]
fn moved<S: Simd>(simd: S, q: [Lanes<S>; 4], half: [Lanes<S>; 3], square: Lanes<S>) -> [Lanes<S>; 4] {
    let number = |x| Lanes::splat(simd, x);
    let ([qx, qy, qz, qw], [x, y, z]) = (q, half);
    let p = [
        qx + (qw * x + qy * z - qz * y),
        qy + (qw * y + qz * x - qx * z),
        qz + (qw * z + qx * y - qy * x),
        qw - (qx * x + qy * y + qz * z),
    ];
    let norm = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
    // 1 / √norm: three terms of its series in `square` ≤ 1/16, good to 8e-5, and two of Newton's steps.
    let mut inverse = number(1.0) + square * (number(0.375) * square - number(0.5));
    for _ in 0..2 {
        inverse = inverse * (number(1.5) - number(0.5) * norm * inverse * inverse);
    }
    p.map(|c| c * inverse)
}

/// The matrix of a unit quaternion, column by column.
#[inline(always)]
fn matrix<S: Simd>(simd: S, [x, y, z, w]: [Lanes<S>; 4]) -> [Lanes<S>; 9] {
    let one = Lanes::splat(simd, 1.0);
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [one - (yy + zz), xy + wz, xz - wy, xy - wz, one - (xx + zz), yz + wx, xz + wy, yz - wx, one - (xx + yy)]
}
