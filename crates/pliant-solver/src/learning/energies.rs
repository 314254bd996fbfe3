//! E(k, r, m) of one pose for all vertices and all r of a range (paper 3.4), with all its digits.
//!
//! | symbol | meaning |
//! |---|---|
//! | e, e' | edge vectors of the reference and of the pose |
//! | F | the frame of a vertex: the best rotation of its spokes |
//! | δ_e | Fᵀe' − e, what the pose does to an edge as seen from there |
//! | s, U, C | Σ w ‖δ‖², Σ w δ eᵀ and Σ w e eᵀ over N(k, r) |
//! | D | FᵀR − I, with R the best rotation of N(k, r) |
//!
//! The textbook way, Σ w (‖e'‖² + ‖e‖²) − 2 ⟨R, Σ w e' eᵀ⟩, is a difference of sums that agree in nearly all digits where
//! a bone has only been turned. Instead everything is seen from the frame of the vertex:
//!
//! ```text
//! E(k, r) = s − 2 ⟨D, U⟩ + tr(D C Dᵀ),  D + I = argmax ⟨·, C + U⟩
//! ```
//!
//! No term is much larger than E. For N(k, r) contains the spokes, so E(k, r) is at least what they have seen from R,
//! and that is E(k, 1) and a positive form of D: a frame that fits the spokes but not their surroundings costs as much
//! energy as it costs digits. (Where the spokes lie on a line, or weights are negative, digits are lost as in the
//! textbook way.) What remains is the rounding of e' itself: δ is off by some units ε of ‖e'‖, so E by 2 ε √(E Σ w ‖e'‖²)
//! and ε² Σ w ‖e'‖².
//!
//! s, U and C grow with r by the edges of one shell after the other, two edges side by side. The rotations are those of
//! [`turning`](crate::kernels::turning), found for a lot of entries of the table at once.

use glam::{DMat3, DQuat, DVec3};
use pulp::Simd;

use crate::analysis::Layout;
use crate::analysis::stars::Flat;
use crate::kernels::lanes::Lanes;
use crate::kernels::nines::{Eight, Nine};
use crate::kernels::quad::Quad;
use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::turning::{LOT, Lot};
use crate::kernels::wide::{Kernel, Wide};
use crate::learning::shells::Shells;

/// What an edge is in a pose and in the reference, in one cache line: √|w| e' with a 0, and −√|w| e with the sign of w.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct EdgePair {
    now: Quad,
    rest: Quad,
}

impl EdgePair {
    /// No edge: adds nothing.
    pub(crate) const ZERO: EdgePair = EdgePair { now: Quad::ZERO, rest: Quad::ZERO };
}

/// The pairs of consecutive edges.
pub(crate) fn edge_pairs(layout: &Layout, positions: &[DVec3], first: usize, out: &mut [EdgePair]) {
    for (e, out) in (first..).zip(out) {
        let ([i, j], w) = (layout.edges[e], layout.weight[e]);
        let root = w.abs().sqrt();
        let DVec3 { x, y, z } = layout.edge_rest[e] * -root;
        let now = (positions[i as usize] - positions[j as usize]) * root;
        *out = EdgePair { now: now.into(), rest: Quad([x, y, z, 1f64.copysign(w)]) };
    }
}

/// A pose as the sums read it.
#[derive(Clone, Copy)]
pub(crate) struct PoseEdges<'a> {
    pub(crate) layout: &'a Layout,
    /// Positions p', internal numbering.
    pub(crate) positions: Flat<'a>,
    /// All edges and, behind the last, none.
    pub(crate) edges: &'a [EdgePair],
    /// Whether any weight is negative, as raw ones may be: only then may energies be.
    pub(crate) has_negative: bool,
}

/// Energies of up to [`LOT`] consecutive vertices from `first` on, which are the vertices from `place` on of the
/// `shells`.
pub(crate) struct LotEnergies<'a> {
    pub(crate) pose: PoseEdges<'a>,
    pub(crate) shells: &'a Shells,
    pub(crate) place: usize,
    pub(crate) first: usize,
    pub(crate) n_columns: usize,
    /// A row per vertex, a column per r.
    pub(crate) out: &'a mut [f64],
}

impl Kernel for LotEnergies<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) {
        // Two loops instead of a question per edge.
        if self.pose.has_negative { self.rows::<W, true>(wide) } else { self.rows::<W, false>(wide) }
    }
}

impl LotEnergies<'_> {
    /// Row by row, so that the edges around a vertex are still in the first cache for the next; a lot of entries at a
    /// time is solved.
    #[inline(always)]
    fn rows<W: Wide, const SIGNED: bool>(self, wide: W) {
        let n = self.out.len() / self.n_columns;
        let mut lot = Lot::new();
        let frames = self.frames(wide, &mut lot, n);
        let mut entries = Entries::new();
        let (mut filled, mut done) = (0, 0);
        for (lane, &frame) in frames[..n].iter().enumerate() {
            let mut sums = Sums::new(wide, frame);
            for column in 0..self.n_columns {
                for &[one, other] in self.shells.pairs(self.place + lane, column) {
                    let (one, other) = (self.pose.edges[one as usize], self.pose.edges[other as usize]);
                    sums.add::<SIGNED>(wide, one, other);
                }
                sums.enter(wide, &mut lot, &mut entries, filled);
                filled += 1;
                if filled == LOT {
                    entries.energies(wide, SIGNED, &mut lot, &mut self.out[done..done + filled]);
                    (filled, done) = (0, done + filled);
                }
            }
        }
        if filled > 0 {
            entries.energies(wide, SIGNED, &mut lot, &mut self.out[done..done + filled]);
        }
    }

    /// F of the first `n` vertices. The search begins at the best rotation of all spokes together, wherever the pose may
    /// lie.
    #[inline(always)]
    fn frames<W: Wide>(&self, wide: W, lot: &mut Lot, n: usize) -> [DQuat; LOT] {
        let PoseEdges { layout, positions, .. } = self.pose;
        let (mut all, mut all_ninth, mut squares) = (wide.eight([0.0; 8]), 0.0, wide.splat4(0.0));
        for lane in 0..n {
            let (eight, last) = layout.stars.moment(wide, (layout, positions), self.first + lane, &mut squares);
            let ninth = wide.array4(last)[2];
            all = wide.add8(all, eight);
            all_ninth += ninth;
            lot.load(lane, Nine { eight: Eight(wide.array8(eight)), ninth }, DQuat::IDENTITY);
        }
        let all = Nine { eight: Eight(wide.array8(all)), ninth: all_ninth };
        let [x, y, z, w] = best_rotation(all.into(), DQuat::IDENTITY, Ties::Nearest).to_array();
        lot.q = [[x; LOT], [y; LOT], [z; LOT], [w; LOT]];
        lot.turn(wide, Ties::Nearest, n);
        let mut frames = [DQuat::IDENTITY; LOT];
        for (lane, frame) in frames[..n].iter_mut().enumerate() {
            *frame = DQuat::from_xyzw(lot.q[0][lane], lot.q[1][lane], lot.q[2][lane], lot.q[3][lane]);
        }
        frames
    }
}

/// s, U and C of a vertex while they grow, those of every second edge in the upper half.
struct Sums<W: Wide> {
    /// Columns of Fᵀ.
    frame: [W::Eight; 3],
    /// Columns of −U.
    u: [W::Eight; 3],
    /// xx, yy, zz and xy, yz, zx of C.
    c: [W::Eight; 2],
    /// Coordinate by coordinate.
    s: W::Eight,
}

impl<W: Wide> Sums<W> {
    #[inline(always)]
    fn new(wide: W, frame: DQuat) -> Sums<W> {
        let zero = wide.splat8(0.0);
        let DMat3 { x_axis: x, y_axis: y, z_axis: z } = DMat3::from_quat(frame.conjugate());
        let frame = [
            wide.eight([x.x, x.y, x.z, 0.0, x.x, x.y, x.z, 0.0]),
            wide.eight([y.x, y.y, y.z, 0.0, y.x, y.y, y.z, 0.0]),
            wide.eight([z.x, z.y, z.z, 0.0, z.x, z.y, z.z, 0.0]),
        ];
        Sums { frame, u: [zero; 3], c: [zero; 2], s: zero }
    }

    /// Adds two edges.
    #[inline(always)]
    fn add<const SIGNED: bool>(&mut self, wide: W, one: EdgePair, other: EdgePair) {
        let now = wide.join(wide.four(one.now.0), wide.four(other.now.0));
        let rest = wide.join(wide.four(one.rest.0), wide.four(other.rest.0));
        let delta = wide.fma8(self.frame[0], wide.each::<0>(now), rest);
        let delta = wide.fma8(self.frame[1], wide.each::<1>(now), delta);
        let delta = wide.fma8(self.frame[2], wide.each::<2>(now), delta);
        let (mut signed_delta, mut signed_rest) = (delta, rest);
        if SIGNED {
            let sign = wide.each::<3>(rest);
            (signed_delta, signed_rest) = (wide.mul8(delta, sign), wide.mul8(rest, sign));
        }
        self.u[0] = wide.fma8(signed_delta, wide.each::<0>(rest), self.u[0]);
        self.u[1] = wide.fma8(signed_delta, wide.each::<1>(rest), self.u[1]);
        self.u[2] = wide.fma8(signed_delta, wide.each::<2>(rest), self.u[2]);
        self.c[0] = wide.fma8(signed_rest, rest, self.c[0]);
        self.c[1] = wide.fma8(signed_rest, wide.next(rest), self.c[1]);
        self.s = wide.fma8(signed_delta, delta, self.s);
    }

    /// Writes them as entry `place` of a lot.
    #[inline(always)]
    fn enter(&self, wide: W, lot: &mut Lot, entries: &mut Entries, place: usize) {
        let [diagonal, others] = [self.halves(wide, self.c[0]), self.halves(wide, self.c[1])];
        let ([xx, yy, zz], [xy, yz, zx]) = (diagonal, others);
        let c = [xx, xy, zx, xy, yy, yz, zx, yz, zz];
        for column in 0..3 {
            for (row, u) in self.halves(wide, self.u[column]).into_iter().enumerate() {
                let at = 3 * column + row;
                entries.u[at][place] = -u;
                entries.c[at][place] = c[at];
                lot.t[at][place] = c[at] - u;
            }
        }
        let [x, y, z] = self.halves(wide, self.s);
        entries.s[place] = x + y + z;
        // The best rotation is near the frame.
        (lot.q[0][place], lot.q[1][place], lot.q[2][place], lot.q[3][place]) = (0.0, 0.0, 0.0, 1.0);
    }

    #[inline(always)]
    fn halves(&self, wide: W, eight: W::Eight) -> [f64; 3] {
        let [a, b, c, _, d, e, f, _] = wide.array8(eight);
        [a + d, b + e, c + f]
    }
}

/// s, U and C of a lot of entries of the table, column by column, side by side.
#[repr(align(64))]
struct Entries {
    u: [[f64; LOT]; 9],
    c: [[f64; LOT]; 9],
    s: [f64; LOT],
}

impl Entries {
    fn new() -> Entries {
        Entries { u: [[0.0; LOT]; 9], c: [[0.0; LOT]; 9], s: [0.0; LOT] }
    }

    /// E of the first entries, as many as there are places in `out`.
    #[inline(always)]
    fn energies<S: Simd>(&mut self, simd: S, is_signed: bool, lot: &mut Lot, out: &mut [f64]) {
        lot.turn(simd, Ties::Nearest, out.len());
        let Entries { u, c, s } = self;
        let q = lot.q.each_ref().map(|row| S::as_simd_f64s(row).0);
        let u = u.each_ref().map(|row| S::as_simd_f64s(row).0);
        let c = c.each_ref().map(|row| S::as_simd_f64s(row).0);
        let s = S::as_mut_simd_f64s(s).0;
        // No closures with arithmetic: they are not compiled for the processor unless they happen to be inlined.
        for v in 0..LOT / S::F64_LANES {
            let at = |row: &[S::f64s]| Lanes::new(simd, row[v]);
            let d = turn_less_identity(simd, [at(q[0]), at(q[1]), at(q[2]), at(q[3])]);
            let mut energy = Lanes::new(simd, s[v]);
            for row in 0..3 {
                // Of row d of D: d · (C dᵀ − 2 u).
                let [d0, d1, d2] = [d[row], d[3 + row], d[6 + row]];
                for column in 0..3 {
                    let u = Lanes::new(simd, u[3 * column + row][v]);
                    let [c0, c1, c2] = [at(c[3 * column]), at(c[3 * column + 1]), at(c[3 * column + 2])];
                    let turned = d2.times_plus(c2, d1.times_plus(c1, d0 * c0));
                    energy = d[3 * column + row].times_plus(turned - (u + u), energy);
                }
            }
            s[v] = energy.value();
        }
        for (out, &energy) in out.iter_mut().zip(&self.s) {
            *out = if is_signed { energy } else { energy.max(0.0) };
        }
    }
}

/// `R − I = 2 (w [v] + [v]²)` column by column, which keeps its digits for the smallest turns.
#[inline(always)]
fn turn_less_identity<S: Simd>(simd: S, [x, y, z, w]: [Lanes<S>; 4]) -> [Lanes<S>; 9] {
    let zero = Lanes::splat(simd, 0.0);
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (xx, yy, zz) = (x.times_from(x2, zero), y.times_from(y2, zero), z.times_from(z2, zero));
    [
        yy + zz,
        w.times_plus(z2, xy),
        w.times_from(y2, xz),
        w.times_from(z2, xy),
        xx + zz,
        w.times_plus(x2, yz),
        w.times_plus(y2, xz),
        w.times_from(x2, yz),
        xx + yy,
    ]
}
