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
//! Where several rotations are equally good (a straight chain, a single edge), the one nearest to the previous
//! rotation is taken.

use glam::{DMat3, DQuat, DVec3, DVec4};

/// Newton's method doubles the digits each time; more steps than this mean that the start was too far.
const MOST_NEWTON_STEPS: usize = 8;
/// After a step this small the next would be below the unit roundoff, 1e-16.
const LAST_STEP: f64 = 1e-8;
/// Steps beyond this (in radians) leave the region where the quadratic model means anything.
const LARGEST_STEP: f64 = 0.5;
/// Pivots of H, relative to the largest entry of T, below which the maximum is too flat for Newton's method.
const FLAT: f64 = 1e-6;
/// Eigenvalues of N closer than this to the largest (relative) are a tie: some hundred times the rounding of sums.
const TIE: f64 = 1e-12;

/// The rotation R that maximizes ⟨R, T⟩; `previous` is where the search begins and what decides ties.
pub(crate) fn best_rotation(t: DMat3, previous: DQuat) -> DQuat {
    let size = [t.x_axis, t.y_axis, t.z_axis].iter().fold(0.0, |size: f64, c| size.max(c.abs().max_element()));
    // Zero, too small to be divided by, or not finite: nothing to be learned.
    if !(f64::MIN_POSITIVE..=f64::MAX).contains(&size) {
        return previous;
    }
    let t = t * (1.0 / size);
    newton(t, previous).unwrap_or_else(|| {
        let found = horn(t, previous);
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

/// Top eigenvector of N; in a tie, the previous rotation projected to the top eigenspace.
fn horn(t: DMat3, previous: DQuat) -> DQuat {
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
    let before = DVec4::from(previous);
    let (mut projected, mut best) = (DVec4::ZERO, DVec4::W);
    for (&value, &vector) in values.iter().zip(&vectors) {
        if value >= top - TIE * spread {
            projected += vector * vector.dot(before);
            best = vector;
        }
    }
    // A previous rotation at right angles to the whole eigenspace says nothing.
    let chosen = if projected.length() > 1e-6 { projected.normalize() } else { best };
    DQuat::from_vec4(chosen)
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
