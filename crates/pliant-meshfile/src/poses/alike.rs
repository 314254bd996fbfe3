//! Whether two poses show the same shape, wherever they stand.
//!
//! The best rigid motion between them is Horn's: with both moved to their centers, the rotation is the unit quaternion q
//! that maximizes qᵀ N q, the eigenvector of the largest eigenvalue of the symmetric matrix N made of the sums
//! S = Σ a bᵀ. Four numbers a side are few enough for Jacobi's rotations, which need no library.

use glam::{DMat3, DQuat, DVec3};

/// Whether no point of `b` is farther than `tolerance` from its place in `a`, after the best rigid motion.
pub(super) fn alike(a: &[DVec3], b: &[DVec3], tolerance: f64) -> bool {
    let n = a.len().max(1) as f64;
    let center = |points: &[DVec3]| points.iter().sum::<DVec3>() / n;
    let (center_a, center_b) = (center(a), center(b));
    let mut sums = DMat3::ZERO;
    for (&a, &b) in a.iter().zip(b) {
        let (a, b) = (a - center_a, b - center_b);
        sums.x_axis += b * a.x;
        sums.y_axis += b * a.y;
        sums.z_axis += b * a.z;
    }
    let turn = rotation(sums);
    let close = |(&a, &b): (&DVec3, &DVec3)| (turn * (a - center_a)).distance(b - center_b) <= tolerance;
    a.len() == b.len() && a.iter().zip(b).all(close)
}

/// The rotation R that maximizes Σ b · R a for S with the columns Σ b aₓ, Σ b a_y, Σ b a_z.
fn rotation(s: DMat3) -> DQuat {
    // S written the usual way: row by the coordinate of a, column by that of b.
    let [xx, xy, xz] = s.x_axis.to_array();
    let [yx, yy, yz] = s.y_axis.to_array();
    let [zx, zy, zz] = s.z_axis.to_array();
    let n = [
        [xx + yy + zz, yz - zy, zx - xz, xy - yx],
        [yz - zy, xx - yy - zz, xy + yx, zx + xz],
        [zx - xz, xy + yx, yy - xx - zz, yz + zy],
        [xy - yx, zx + xz, yz + zy, zz - xx - yy],
    ];
    let [w, x, y, z] = largest_eigenvector(n);
    DQuat::from_xyzw(x, y, z, w).normalize()
}

/// Sweeps of Jacobi's method: it converges quadratically, and matrices of this size are diagonal to the last digit
/// after four or five.
const SWEEPS: usize = 12;

fn largest_eigenvector(mut m: [[f64; 4]; 4]) -> [f64; 4] {
    let mut vectors = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    for (p, q) in (0..SWEEPS).flat_map(|_| [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]) {
        if m[p][q] == 0.0 {
            continue;
        }
        let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
        let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
        let c = 1.0 / t.hypot(1.0);
        let turn = |x: f64, y: f64| (c * x - c * t * y, c * t * x + c * y);
        for row in &mut m {
            (row[p], row[q]) = turn(row[p], row[q]);
        }
        // Rows of `vectors` are the eigenvectors.
        for rows in [&mut m, &mut vectors] {
            let (upper, lower) = rows.split_at_mut(q);
            for (x, y) in upper[p].iter_mut().zip(&mut lower[0]) {
                (*x, *y) = turn(*x, *y);
            }
        }
    }
    let best = (0..4).max_by(|&i, &j| m[i][i].total_cmp(&m[j][j])).unwrap_or(0);
    let vector = vectors[best];
    // Poses beyond what numbers hold have no rotation; any answer is as good as none.
    if vector.iter().all(|x| x.is_finite()) { vector } else { [1.0, 0.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Vec<DVec3> {
        (0..50).map(f64::from).map(|i| DVec3::new((1.7 * i).sin(), (2.9 * i).cos(), (0.3 * i).sin())).collect()
    }

    #[test]
    fn rigid_motion_of_any_angle_is_found() {
        let rest = cloud();
        for (i, angle) in [0.0, 1e-9, 0.5, 2.0, 3.1, std::f64::consts::PI, 5.0].into_iter().enumerate() {
            for axis in [DVec3::X, DVec3::Y, DVec3::new(1.0, -2.0, 0.5).normalize()] {
                let turn = DQuat::from_axis_angle(axis, angle);
                let moved: Vec<DVec3> = rest.iter().map(|&p| turn * p + DVec3::new(4.0, -7.0, 100.0)).collect();
                // Coordinates of 100 are exact to 1e-14, sums over 50 of them to a few digits less.
                assert!(alike(&rest, &moved, 1e-12), "angle {i} about {axis}");
            }
        }
    }

    #[test]
    fn flat_and_straight_shapes_are_aligned_too() {
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.5);
        for flattened in [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 0.0, 0.0), DVec3::ZERO] {
            let rest: Vec<DVec3> = cloud().into_iter().map(|p| p * flattened).collect();
            let moved: Vec<DVec3> = rest.iter().map(|&p| turn * p).collect();
            assert!(alike(&rest, &moved, 1e-13), "{flattened}");
        }
    }

    #[test]
    fn one_moved_point_and_a_mirror_image_are_seen() {
        let rest = cloud();
        let mut moved = rest.clone();
        moved[7] += DVec3::new(0.0, 0.0, 0.01);
        assert!(!alike(&rest, &moved, 0.009));
        assert!(alike(&rest, &moved, 0.0101));
        let mirrored: Vec<DVec3> = rest.iter().map(|p| *p * DVec3::new(-1.0, 1.0, 1.0)).collect();
        assert!(!alike(&rest, &mirrored, 0.1));
    }
}
