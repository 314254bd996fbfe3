//! The best rotation of a neighborhood: R = argmax ⟨R, T⟩ over SO(3), with T = Sᵀ = Σ w e' eᵀ (paper 3.2.2).
//!
//! | symbol | meaning |
//! |---|---|
//! | T | 3 × 3, Σ w e' eᵀ; ⟨R, T⟩ = tr(R S) |
//! | B = RᵀT | seen from the current rotation |
//! | g | (B₃₂ − B₂₃, B₁₃ − B₃₁, B₂₁ − B₁₂), the slope |
//! | H = tr(B) I − sym(B) | minus the curvature |
//!
//! ⟨R, T⟩ is a quadratic form qᵀ N q of the unit quaternion, so its only local maximum is the global one: Newton's
//! method ω = H⁻¹g from the previous rotation, ending where g = 0 with H positive definite, has found it. Otherwise
//! (a large turn, or nearly a tie) the top eigenvector of N is taken (Horn 1987), by Jacobi's method. In both ways only
//! rotations are looked at: reflected, flat and straight neighborhoods need no correction of signs.
//!
//! Several rotations are equally good where all edges point one way, at rest (a straight chain, a single edge) or now (a
//! neighborhood that the global step has squeezed onto a line). If the previous rotation is as good as one of them, it
//! stays; otherwise the caller says which to prefer. See [`Ties`].

use glam::{DMat3, DQuat, DVec3, DVec4};

/// Newton's method doubles the digits each time; more steps than this mean that the start was too far.
const MOST_NEWTON_STEPS: usize = 8;
/// After a step this small the next would be below the unit roundoff, 1e-16.
const LAST_STEP: f64 = 1e-8;
/// Steps beyond this (in radians) leave the region where the quadratic model means anything.
pub(crate) const LARGEST_STEP: f64 = 0.5;
/// Pivots of H, relative to the largest entry of T, below which the maximum is too flat for Newton's method.
pub(crate) const FLAT: f64 = 1e-6;
/// Ten times the rounding of positions that a solve
/// leaves after a jump across a bar of a hundred cells, relative to the largest eigenvalue of N.
const TIE: f64 = 1e-10;
/// How well the previous rotation must fit to stay in a tie: the cosine of half the angle to the nearest best one, 0.2.
const SETTLED: f64 = 0.995;
/// A small turn about no particular axis, 0.01 radians: what symmetric motions need to leave their symmetry. Nearly as
/// small as can be, and large enough to grow in few iterations (by eye).
const NUDGE: DVec3 = DVec3::new(0.003, -0.005, 0.008_1);

/// Which of several equally good rotations is taken, unless the previous one is among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ties {
    /// The nearest to the previous one.
    Nearest,
    /// The nearest to the previous one turned by a hundredth of a radian. A neighborhood squeezed onto a line lies on a
    /// ridge between valleys; staying exactly on it costs a bar bent by 180° ten times the energy.
    Nudged,
    /// What the rounding of T makes of it, as with the singular value decomposition of the paper: there are no ties.
    Rounding,
}

impl Ties {
    fn preferred(self, previous: DQuat) -> DQuat {
        match self {
            Ties::Nearest | Ties::Rounding => previous,
            Ties::Nudged => previous * DQuat::from_scaled_axis(NUDGE),
        }
    }

    /// Eigenvalues of N closer than this to the largest, relative to it, are a tie.
    fn width(self) -> f64 {
        match self {
            Ties::Nearest | Ties::Nudged => TIE,
            Ties::Rounding => 0.0,
        }
    }
}

/// The rotation R that maximizes ⟨R, T⟩; the search begins at `previous`.
pub(crate) fn best_rotation(t: DMat3, previous: DQuat, ties: Ties) -> DQuat {
    let size = [t.x_axis, t.y_axis, t.z_axis].iter().fold(0.0, |size: f64, c| size.max(c.abs().max_element()));
    // Zero, too small to be divided by, or not finite: nothing to be learned.
    if !(f64::MIN_POSITIVE..=f64::MAX).contains(&size) {
        return previous;
    }
    // By division: the reciprocal of a very small number overflows.
    let t = DMat3::from_cols(t.x_axis / size, t.y_axis / size, t.z_axis / size);
    newton(t, previous).unwrap_or_else(|| {
        let found = horn(t, previous, ties);
        newton(t, found).unwrap_or(found)
    })
}

/// Newton's method; none if it does not arrive at a maximum.
fn newton(t: DMat3, start: DQuat) -> Option<DQuat> {
    let mut q = start;
    for _ in 0..MOST_NEWTON_STEPS {
        let b = DMat3::from_quat(q).transpose() * t;
        let step = newton_step(b)?;
        let length = step.length();
        if length > LARGEST_STEP {
            return None;
        }
        // Cayley's form of the exponential: equal to third order, and exact in the limit.
        let half = 0.5 * step;
        q = (q * DQuat::from_xyzw(half.x, half.y, half.z, 1.0)).normalize();
        if length < LAST_STEP {
            return Some(q);
        }
    }
    None
}

/// Solves H ω = g by LDLᵀ; none unless every pivot is well above zero.
fn newton_step(b: DMat3) -> Option<DVec3> {
    let g = slope(b);
    let trace = b.x_axis.x + b.y_axis.y + b.z_axis.z;
    let (h11, h22, h33) = (trace - b.x_axis.x, trace - b.y_axis.y, trace - b.z_axis.z);
    let h21 = -0.5 * (b.x_axis.y + b.y_axis.x);
    let h31 = -0.5 * (b.x_axis.z + b.z_axis.x);
    let h32 = -0.5 * (b.y_axis.z + b.z_axis.y);
    if h11 <= FLAT {
        return None;
    }
    let (l21, l31) = (h21 / h11, h31 / h11);
    let d2 = h22 - l21 * h21;
    if d2 <= FLAT {
        return None;
    }
    let l32 = (h32 - l31 * h21) / d2;
    let d3 = h33 - l31 * h31 - l32 * l32 * d2;
    if d3.is_nan() || d3 <= FLAT {
        return None;
    }
    let y2 = g.y - l21 * g.x;
    let y3 = g.z - l31 * g.x - l32 * y2;
    let z = y3 / d3;
    let y = y2 / d2 - l32 * z;
    let x = g.x / h11 - l21 * y - l31 * z;
    Some(DVec3::new(x, y, z))
}

/// (B₃₂ − B₂₃, B₁₃ − B₃₁, B₂₁ − B₁₂); glam stores columns.
fn slope(b: DMat3) -> DVec3 {
    DVec3::new(b.y_axis.z - b.z_axis.y, b.z_axis.x - b.x_axis.z, b.x_axis.y - b.y_axis.x)
}

/// Top eigenvector of N; in a tie, the previous or preferred rotation projected to the top eigenspace.
fn horn(t: DMat3, previous: DQuat, ties: Ties) -> DQuat {
    let trace = t.x_axis.x + t.y_axis.y + t.z_axis.z;
    let g = slope(t);
    let s = t + t.transpose() - DMat3::from_diagonal(DVec3::splat(trace));
    let n = [
        [s.x_axis.x, s.y_axis.x, s.z_axis.x, g.x],
        [s.x_axis.y, s.y_axis.y, s.z_axis.y, g.y],
        [s.x_axis.z, s.y_axis.z, s.z_axis.z, g.z],
        [g.x, g.y, g.z, trace],
    ];
    let (values, vectors) = jacobi(n);
    let top = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let spread = values.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
    let is_top = |value: f64| value >= top - ties.width() * spread;
    let project = |q: DQuat| {
        let best = values.iter().zip(&vectors).filter(|(value, _)| is_top(**value));
        best.fold(DVec4::ZERO, |sum, (_, vector)| sum + *vector * vector.dot(DVec4::from(q)))
    };
    let settled = project(previous);
    let chosen = if settled.length() > SETTLED { settled } else { project(ties.preferred(previous)) };
    // A preferred rotation at right angles to the whole eigenspace says nothing.
    let first = values.iter().zip(&vectors).find(|(value, _)| is_top(**value)).map_or(DVec4::W, |(_, vector)| *vector);
    DQuat::from_vec4(if chosen.length() > 1e-6 { chosen.normalize() } else { first })
}

/// Eigenvalues and eigenvectors of a symmetric 4 × 4 matrix by cyclic Jacobi rotations.
fn jacobi(mut a: [[f64; 4]; 4]) -> ([f64; 4], [DVec4; 4]) {
    /// Convergence is quadratic; six sweeps are usual.
    const MOST_SWEEPS: usize = 20;
    let mut v = [DVec4::X, DVec4::Y, DVec4::Z, DVec4::W];
    for _ in 0..MOST_SWEEPS {
        let mut turned = false;
        for p in 0..3 {
            for q in p + 1..4 {
                let scale = (a[p][p].abs() + a[q][q].abs()).max(f64::MIN_POSITIVE);
                if a[p][q].abs() <= 1e-18 * scale {
                    continue;
                }
                turned = true;
                let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let tan = theta.signum() / (theta.abs() + theta.hypot(1.0));
                let cos = 1.0 / tan.hypot(1.0);
                let sin = tan * cos;
                for row in &mut a {
                    let (x, y) = (row[p], row[q]);
                    (row[p], row[q]) = (cos * x - sin * y, sin * x + cos * y);
                }
                let (x, y) = (a[p], a[q]);
                a[p] = std::array::from_fn(|k| cos * x[k] - sin * y[k]);
                a[q] = std::array::from_fn(|k| sin * x[k] + cos * y[k]);
                (a[p][q], a[q][p]) = (0.0, 0.0);
                (v[p], v[q]) = (v[p] * cos - v[q] * sin, v[p] * sin + v[q] * cos);
            }
        }
        if !turned {
            break;
        }
    }
    (std::array::from_fn(|i| a[i][i]), v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    fn gain(q: DQuat, t: DMat3) -> f64 {
        let r = DMat3::from_quat(q);
        r.x_axis.dot(t.x_axis) + r.y_axis.dot(t.y_axis) + r.z_axis.dot(t.z_axis)
    }

    #[test]
    fn newton_and_the_eigenvector_agree_and_nothing_nearby_is_better() {
        let mut random = Random::new(11);
        for case in 0..2000 {
            let mut t = DMat3::from_cols(random.vector(), random.vector(), random.vector());
            match case % 4 {
                1 => t.z_axis = t.x_axis * 0.5,
                2 => t = DMat3::from_cols(t.x_axis, t.x_axis * 2.0, t.x_axis * -0.3),
                3 => t *= 1e-100,
                _ => {}
            }
            let size = t.x_axis.length() + t.y_axis.length() + t.z_axis.length();
            let start = DQuat::from_vec4(DVec4::from((random.vector(), random.signed())).normalize());
            let best = best_rotation(t, start, Ties::Nearest);
            assert!((best.length() - 1.0).abs() < 1e-14, "case {case}");
            let found = gain(best, t);
            let other = gain(best_rotation(t, DQuat::IDENTITY, Ties::Nearest), t);
            assert!((found - other).abs() <= 1e-12 * size, "case {case}: {found} and {other}");
            for _ in 0..20 {
                let nearby = best * DQuat::from_scaled_axis(random.vector() * 0.3);
                assert!(gain(nearby, t) <= found + 1e-12 * size, "case {case}: {} beats {found}", gain(nearby, t));
            }
        }
    }
}
