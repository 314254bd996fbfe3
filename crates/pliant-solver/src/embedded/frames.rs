//! Changes of a node as seen from its own rotation.
//!
//! With Q the rotation nearest to R, a change is δR = Q Σ_m z_m B_m. The basis B is orthonormal: B_0 to B_2 turn (skew
//! matrices), B_3 to B_8 stretch (symmetric ones). E_rot resists stretching alone, as long as R = Q.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DMat3, DQuat, DVec3};

use super::affine::{Affine, affine, linear};
use super::energy::{PRODUCTS, ROTATION};
use super::quadratic::Block;
use crate::kernels::rotations::{Ties, best_rotation};

/// Ways to turn, and to stretch.
pub(super) const TURNS: usize = 3;
pub(super) const STRETCHES: usize = 6;
const BOTH: usize = TURNS + STRETCHES;
/// Rows and columns of the entries of B_3 to B_8.
const SYMMETRIC: [(usize, usize); STRETCHES] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The coefficients of a change.
pub(super) type Local = [f64; BOTH];

/// B_m.
pub(super) fn basis(m: usize) -> DMat3 {
    let unit = |row: usize, column: usize| {
        let mut b = DMat3::ZERO;
        b.col_mut(column)[row] = 1.0;
        b
    };
    if m < TURNS {
        let (a, b) = ((m + 1) % 3, (m + 2) % 3);
        return (unit(b, a) - unit(a, b)) * FRAC_1_SQRT_2;
    }
    let (a, b) = SYMMETRIC[m - TURNS];
    if a == b { unit(a, a) } else { (unit(a, b) + unit(b, a)) * FRAC_1_SQRT_2 }
}

/// Σ_m z_m B_m.
pub(super) fn combined(z: &Local) -> DMat3 {
    let s = FRAC_1_SQRT_2;
    let [x, y, w, a, b, c, ab, ac, bc] = *z;
    DMat3::from_cols(
        DVec3::new(a, s * (ab + w), s * (ac - y)),
        DVec3::new(s * (ab - w), b, s * (bc + x)),
        DVec3::new(s * (ac + y), s * (bc - x), c),
    )
}

/// The coefficients of a matrix.
pub(super) fn coefficients(m: DMat3) -> Local {
    let s = FRAC_1_SQRT_2;
    let at = |row: usize, column: usize| m.col(column)[row];
    [
        s * (at(2, 1) - at(1, 2)),
        s * (at(0, 2) - at(2, 0)),
        s * (at(1, 0) - at(0, 1)),
        at(0, 0),
        at(1, 1),
        at(2, 2),
        s * (at(0, 1) + at(1, 0)),
        s * (at(0, 2) + at(2, 0)),
        s * (at(1, 2) + at(2, 1)),
    ]
}

/// A node's rotation Q, and P = Qᵀ R.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) turn: DQuat,
    pub(super) q: DMat3,
    pub(super) p: DMat3,
}

impl Frame {
    /// `before`: the rotation at the last look, which is mostly near.
    pub(super) fn of(x: &Affine, before: DQuat) -> Frame {
        let r = linear(x);
        let turn = best_rotation(r, before, Ties::Nearest);
        let q = DMat3::from_quat(turn);
        Frame { turn, q, p: q.transpose() * r }
    }

    /// δR seen from here.
    pub(super) fn local(&self, change: &Affine) -> Local {
        coefficients(self.q.transpose() * linear(change))
    }

    /// And back, without t.
    pub(super) fn change(&self, z: &Local) -> Affine {
        affine(self.q * combined(z), DVec3::ZERO)
    }

    /// J of the six numbers of E_rot, seen from here: the change of c_a·c_b is P_a·B_b + P_b·B_a.
    fn jacobian(&self) -> [Local; 6] {
        PRODUCTS.map(|(a, b)| {
            // P_a·B_b for all m is the coefficients of the matrix with P_a as column b.
            let mut m = DMat3::ZERO;
            *m.col_mut(b) += self.p.col(a);
            *m.col_mut(a) += self.p.col(b);
            coefficients(m)
        })
    }

    /// Adds JᵀJ times a change, as E_rot wants it.
    pub(super) fn add_rotation(&self, jacobian: &[Local; 6], change: &Affine, out: &mut Affine) {
        let z = self.local(change);
        let mut sum = [0.0; BOTH];
        for row in jacobian {
            let f: f64 = ROTATION * row.iter().zip(&z).map(|(a, b)| a * b).sum::<f64>();
            sum.iter_mut().zip(row).for_each(|(sum, a)| *sum += f * a);
        }
        for (out, more) in out.as_flattened_mut().iter_mut().zip(self.change(&sum).as_flattened()) {
            *out += more;
        }
    }

    /// J, and the matrix of this node alone without t: JᵀJ and, from the diagonal block of the quadratic part,
    /// tr(B_m L B_nᵀ).
    pub(super) fn own(&self, block: &Block) -> ([Local; 6], [Local; BOTH]) {
        let jacobian = self.jacobian();
        let l = upper_left(block);
        let mut own: [Local; BOTH] = std::array::from_fn(|m| coefficients(basis(m) * l));
        for row in &jacobian {
            for (own, a) in own.iter_mut().zip(row) {
                own.iter_mut().zip(row).for_each(|(own, b)| *own += ROTATION * a * b);
            }
        }
        (jacobian, own)
    }
}

/// The part of a block between R and R.
pub(super) fn upper_left(block: &Block) -> DMat3 {
    let row = |a: usize| DVec3::new(block[a][0], block[a][1], block[a][2]);
    DMat3::from_cols(row(0), row(1), row(2)).transpose()
}
