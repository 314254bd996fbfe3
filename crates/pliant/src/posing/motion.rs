//! Motions of space between two others.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::document::rotation_of;

/// Below this turn the axis of a screw is too far away to be told; its path is straight then (by eye: a millionth of a
/// radian bends a path by a ten-millionth of its length).
const STRAIGHT: f64 = 1e-6;

/// The motion at `t` from 0 to 1 on the way from `a` to `b` of something whose middle was `center`: the rotations of their
/// polar decompositions along a screw, the stretches by equal factors in equal times. Where one of them mirrors or flattens
/// space there is no such way, and the numbers of the matrices go straight.
pub fn between(a: &DAffine3, b: &DAffine3, center: DVec3, t: f64) -> DAffine3 {
    if t <= 0.0 || a == b {
        return *a;
    }
    if t >= 1.0 {
        return *b;
    }
    let (from, to) = (a.transform_point3(center), b.transform_point3(center));
    let (linear, middle) = match (rotation_of(a.matrix3), rotation_of(b.matrix3)) {
        (Some(first), Some(last)) => {
            let (axis, angle) = turn(last * first.transpose());
            let stretch = stretch_between(first.transpose() * a.matrix3, last.transpose() * b.matrix3, t);
            (DMat3::from_axis_angle(axis, t * angle) * first * stretch, screw((from, to), (axis, angle), t))
        }
        _ => (a.matrix3 * (1.0 - t) + b.matrix3 * t, from.lerp(to, t)),
    };
    DAffine3 { matrix3: linear, translation: middle - linear * center }
}

/// Unit axis and angle from 0 to π of a rotation.
fn turn(rotation: DMat3) -> (DVec3, f64) {
    let q = DQuat::from_mat3(&rotation).normalize();
    let q = if q.w < 0.0 { -q } else { q };
    q.to_axis_angle()
}

/// Where a point is on its way between two places while it turns about an axis of that direction: on a helix.
fn screw((from, to): (DVec3, DVec3), (axis, angle): (DVec3, f64), t: f64) -> DVec3 {
    let way = to - from;
    if angle < STRAIGHT {
        return from + way * t;
    }
    let along = axis * way.dot(axis);
    let across = way - along;
    let pivot = from + (across + axis.cross(across) / (0.5 * angle).tan()) * 0.5;
    pivot + DQuat::from_axis_angle(axis, t * angle) * (from - pivot) + along * t
}

/// exp((1 − t) log a + t log b) of symmetric positive matrices.
fn stretch_between(a: DMat3, b: DMat3, t: f64) -> DMat3 {
    if a == b {
        return a;
    }
    let log = |m| of_eigenvalues(m, |x| x.max(f64::MIN_POSITIVE).ln());
    of_eigenvalues(log(a) * (1.0 - t) + log(b) * t, f64::exp)
}

/// Sweeps after which the parts off the diagonal are rounding: six are enough for any 3 × 3 matrix (they square each time).
const SWEEPS: usize = 12;

/// A symmetric matrix with other eigenvalues, by Jacobi's rotations.
fn of_eigenvalues(matrix: DMat3, f: impl Fn(f64) -> f64) -> DMat3 {
    let mut m = (matrix + matrix.transpose()) * 0.5;
    let mut axes = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(q)[p];
            if off == 0.0 {
                continue;
            }
            let theta = 0.5 * (2.0 * off).atan2(m.col(q)[q] - m.col(p)[p]);
            let (sin, cos) = theta.sin_cos();
            let mut rotation = DMat3::IDENTITY;
            rotation.col_mut(p)[p] = cos;
            rotation.col_mut(q)[q] = cos;
            rotation.col_mut(q)[p] = sin;
            rotation.col_mut(p)[q] = -sin;
            m = rotation.transpose() * m * rotation;
            axes *= rotation;
        }
    }
    let values = DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z).map(f);
    axes * DMat3::from_diagonal(values) * axes.transpose()
}
