//! What a node does: x ↦ R x + t, as three rows (R_c1, R_c2, R_c3, t_c).

use glam::{DMat3, DQuat, DVec3};

/// Three rows of four; also a change of one, and a gradient with respect to one.
pub(super) type Affine = [[f64; 4]; 3];

pub(super) const IDENTITY: Affine = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
pub(super) const ZERO: Affine = [[0.0; 4]; 3];

/// From R and t.
pub(super) fn affine(r: DMat3, t: DVec3) -> Affine {
    let rows = r.transpose();
    let row = |r: DVec3, t: f64| [r.x, r.y, r.z, t];
    [row(rows.x_axis, t.x), row(rows.y_axis, t.y), row(rows.z_axis, t.z)]
}

/// R of a node.
pub(super) fn linear(a: &Affine) -> DMat3 {
    let row = |c: usize| DVec3::new(a[c][0], a[c][1], a[c][2]);
    DMat3::from_cols(row(0), row(1), row(2)).transpose()
}

/// t of a node.
pub(super) fn shift(a: &Affine) -> DVec3 {
    DVec3::new(a[0][3], a[1][3], a[2][3])
}

/// A rotation and a t.
pub(super) fn rigid(q: DQuat, t: DVec3) -> Affine {
    affine(DMat3::from_quat(q), t)
}

/// The three products of the rows with four numbers.
#[inline]
pub(super) fn times(a: &Affine, x: &[f64; 4]) -> DVec3 {
    let row = |c: usize| a[c][0] * x[0] + a[c][1] * x[1] + a[c][2] * x[2] + a[c][3] * x[3];
    DVec3::new(row(0), row(1), row(2))
}

/// Adds r xᵀ, the derivative of [`times`] weighted with r.
#[inline]
pub(super) fn add_outer(a: &mut Affine, r: DVec3, x: &[f64; 4]) {
    for (row, r) in a.iter_mut().zip(r.to_array()) {
        row.iter_mut().zip(x).for_each(|(a, x)| *a += r * x);
    }
}

/// The sum of all products of numbers in the same place, node by node.
pub(super) fn dot(a: &[Affine], b: &[Affine]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.as_flattened().iter().zip(b.as_flattened()).map(|(a, b)| a * b).sum::<f64>()).sum()
}

/// y += factor x.
pub(super) fn add_scaled(y: &mut [Affine], factor: f64, x: &[Affine]) {
    for (y, x) in y.as_flattened_mut().as_flattened_mut().iter_mut().zip(x.as_flattened().as_flattened()) {
        *y += factor * x;
    }
}
