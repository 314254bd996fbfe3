//! The best rotations of many neighborhoods at once: the Newton method of [`crate::kernels::rotations`], a neighborhood per lane.
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

use crate::kernels::lanes::{Lanes, Mask};
use crate::kernels::nines::{Eight, Nine};
use crate::kernels::rotations::{FLAT, LARGEST_STEP, Ties, best_rotation};

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
        self.turn(simd, ties, n);
        for lane in 0..n {
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

    /// Solves the first `n` lanes, in place.
    #[inline(always)]
    pub(crate) fn turn<S: Simd>(&mut self, simd: S, ties: Ties, n: usize) {
        self.newton(simd);
        for lane in 0..n {
            if self.solved[lane] == 0.0 {
                self.solve_alone(lane, ties);
            }
        }
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
        self.gain[lane] = crate::kernels::sums::inner(rotation, t);
    }

    #[inline(always)]
    fn newton<S: Simd>(&mut self, simd: S) {
        let Lot { t, q, r, gain, solved } = self;
        let t = t.each_ref().map(|c| S::as_simd_f64s(c).0);
        let q = q.each_mut().map(|c| S::as_mut_simd_f64s(c).0);
        let r = r.each_mut().map(|c| S::as_mut_simd_f64s(c).0);
        let (gain, solved) = (S::as_mut_simd_f64s(gain).0, S::as_mut_simd_f64s(solved).0);
        // No closures with arithmetic: they are not compiled for the processor unless they happen to be inlined.
        for v in 0..LOT / S::F64_LANES {
            let mut at = [Lanes::splat(simd, 0.0); 9];
            for c in 0..9 {
                at[c] = Lanes::new(simd, t[c][v]);
            }
            let mut before = [at[0]; 4];
            for c in 0..4 {
                before[c] = Lanes::new(simd, q[c][v]);
            }
            let (after, arrived) = turned(simd, &at, before);
            for c in 0..4 {
                q[c][v] = after[c].where_else(arrived, before[c]).value();
            }
            let rotation = matrix(simd, after);
            let mut sum = Lanes::splat(simd, 0.0);
            for c in 0..9 {
                r[c][v] = rotation[c].value();
                sum = rotation[c].times_plus(at[c], sum);
            }
            gain[v] = sum.value();
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
    let mut size = t[0].abs();
    for entry in &t[1..] {
        size = size.max(entry.abs());
    }
    // A maximum forgets what is not a number; later tests do not.
    let mut sound = number(SIZES[0]).is_less(size).and(size.is_less(number(SIZES[1])));
    let mut arrived = sound.not();
    let mut q = before;
    let flat = number(FLAT) * size;
    for _ in 0..MOST_STEPS {
        let r = matrix(simd, q);
        let (b00, b11, b22) = (entry(&r, t, 0, 0), entry(&r, t, 1, 1), entry(&r, t, 2, 2));
        let (b01, b02, b12) = (entry(&r, t, 0, 1), entry(&r, t, 0, 2), entry(&r, t, 1, 2));
        let (b10, b20, b21) = (entry(&r, t, 1, 0), entry(&r, t, 2, 0), entry(&r, t, 2, 1));
        let g = [b21 - b12, b02 - b20, b10 - b01];
        let half = number(-0.5);
        let (h00, h11, h22) = (b11 + b22, b00 + b22, b00 + b11);
        let (h01, h02, h12) = (half * (b01 + b10), half * (b02 + b20), half * (b12 + b21));
        // Cofactors.
        let (c00, c01, c02) = (minor(h11, h22, h12, h12), minor(h02, h12, h01, h22), minor(h01, h12, h02, h11));
        let (c11, c12, m2) = (minor(h00, h22, h02, h02), minor(h01, h02, h00, h12), minor(h00, h11, h01, h01));
        let m3 = dot([h00, h01, h02], [c00, c01, c02]);
        let definite = flat.is_less(h00).and((flat * h00).is_less(m2)).and((flat * m2).is_less(m3));
        // Half the step.
        let scale = number(0.5) / m3;
        let half_step =
            [scale * dot([c00, c01, c02], g), scale * dot([c01, c11, c12], g), scale * dot([c02, c12, m2], g)];
        let square = dot(half_step, half_step);
        sound = sound.and(definite).and(square.is_less(number(0.25 * LARGEST_STEP * LARGEST_STEP)));
        let next = moved(simd, q, half_step, square);
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
        qz.times_from(y, qy.times_plus(z, qw.times_plus(x, qx))),
        qx.times_from(z, qz.times_plus(x, qw.times_plus(y, qy))),
        qy.times_from(x, qx.times_plus(y, qw.times_plus(z, qz))),
        qz.times_from(z, qy.times_from(y, qx.times_from(x, qw))),
    ];
    let norm = p[3].times_plus(p[3], dot([p[0], p[1], p[2]], [p[0], p[1], p[2]]));
    // 1 / √norm: three terms of its series in `square` ≤ 1/16, good to 8e-5, and two of Newton's steps.
    let mut inverse = square.times_plus(square.times_plus(number(0.375), number(-0.5)), number(1.0));
    for _ in 0..2 {
        inverse = inverse * (norm * inverse).times_from(number(0.5) * inverse, number(1.5));
    }
    [p[0] * inverse, p[1] * inverse, p[2] * inverse, p[3] * inverse]
}

/// The matrix of a unit quaternion, column by column.
#[inline(always)]
fn matrix<S: Simd>(simd: S, [x, y, z, w]: [Lanes<S>; 4]) -> [Lanes<S>; 9] {
    let one = Lanes::splat(simd, 1.0);
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, xy, xz, yz) = (x.times_from(x2, one), x * y2, x * z2, y * z2);
    [
        z.times_from(z2, y.times_from(y2, one)),
        w.times_plus(z2, xy),
        w.times_from(y2, xz),
        w.times_from(z2, xy),
        z.times_from(z2, xx),
        w.times_plus(x2, yz),
        w.times_plus(y2, xz),
        w.times_from(x2, yz),
        y.times_from(y2, xx),
    ]
}

/// Entry (i, j) of B = RᵀT: the product of columns i of R and j of T.
#[inline(always)]
fn entry<S: Simd>(r: &[Lanes<S>; 9], t: &[Lanes<S>; 9], i: usize, j: usize) -> Lanes<S> {
    dot([r[3 * i], r[3 * i + 1], r[3 * i + 2]], [t[3 * j], t[3 * j + 1], t[3 * j + 2]])
}

/// a b − c d.
#[inline(always)]
fn minor<S: Simd>(a: Lanes<S>, b: Lanes<S>, c: Lanes<S>, d: Lanes<S>) -> Lanes<S> {
    c.times_from(d, a * b)
}

#[inline(always)]
fn dot<S: Simd>(a: [Lanes<S>; 3], b: [Lanes<S>; 3]) -> Lanes<S> {
    a[2].times_plus(b[2], a[1].times_plus(b[1], a[0] * b[0]))
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, DVec4};

    use super::*;
    use crate::kernels::wide::{Kernel, Wide, dispatch};
    use crate::test_support::Random;

    struct Solve<'a> {
        matrices: &'a [DMat3],
        turns: &'a mut [DQuat],
        ties: Ties,
        out: (&'a mut [Eight], &'a mut [f64]),
    }

    impl Kernel for Solve<'_> {
        type Output = f64;

        #[inline(always)]
        fn run<W: Wide>(self, wide: W) -> f64 {
            let mut lot = Lot::new();
            (0..self.turns.len()).for_each(|lane| lot.load(lane, self.matrices[lane].into(), self.turns[lane]));
            lot.solve(wide, self.ties, self.turns, self.out)
        }
    }

    /// Good, reflected, flat, straight, tiny, huge, zero and infinite ones, and one that is not a number.
    fn matrix_of_case(case: usize, random: &mut Random) -> DMat3 {
        let t = DMat3::from_cols(random.vector(), random.vector(), random.vector());
        match case % 12 {
            1 => DMat3::from_cols(t.x_axis, t.y_axis, t.x_axis * 0.5),
            2 => DMat3::from_cols(t.x_axis, t.x_axis * 2.0, t.x_axis * -0.3),
            3 => t * 1e-200,
            4 => t * 1e200,
            5 => DMat3::ZERO,
            6 => t * f64::INFINITY,
            7 => DMat3::from_cols(t.x_axis, DVec3::NAN, t.z_axis),
            8 => DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)) + t * 1e-9,
            _ => DMat3::IDENTITY + t * 0.4,
        }
    }

    #[test]
    fn lanes_agree_with_the_scalar_method_for_any_matrix_and_any_number_of_lanes() {
        let mut random = Random::new(21);
        for n in (1..=LOT).chain([1, LOT]) {
            let matrices: Vec<DMat3> = (0..n).map(|case| matrix_of_case(case + n, &mut random)).collect();
            let before: Vec<DQuat> = (0..n)
                .map(|case| match case % 5 {
                    0 => DQuat::from_vec4(DVec4::from((random.vector(), random.signed())).normalize()),
                    _ => DQuat::from_scaled_axis(random.vector() * 0.2),
                })
                .collect();
            let ties = if n % 2 == 0 { Ties::Nearest } else { Ties::Nudged };
            let (mut eights, mut ninths) = (vec![Eight::ZERO; n], vec![0.0; n]);
            let mut turns = before.clone();
            let gain =
                dispatch(Solve { matrices: &matrices, turns: &mut turns, ties, out: (&mut eights, &mut ninths) });
            let mut plain = 0.0;
            for lane in 0..n {
                let (t, case) = (matrices[lane], (lane + n) % 12);
                let expected = best_rotation(t, before[lane], ties);
                let got = DMat3::from(Nine { eight: eights[lane], ninth: ninths[lane] });
                plain += crate::kernels::sums::inner(got, t);
                // Where curvature is a millionth of the size of T, rounding of T moves the rotation by a billionth.
                let off = (turns[lane].dot(expected).abs() - 1.0).abs();
                assert!(off < 1e-13, "{n} lanes, lane {lane}, case {case}: {} and {expected}", turns[lane]);
                let matrix = DMat3::from_quat(turns[lane]);
                assert!(got.abs_diff_eq(matrix, 1e-14), "{n} lanes, lane {lane}, case {case}: {got} and {matrix}");
            }
            assert!(plain.is_nan() && gain.is_nan() || plain == gain || (plain - gain).abs() <= 1e-13 * plain.abs());
        }
    }
}
