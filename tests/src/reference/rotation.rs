//! The rotation that fits best, by a one-sided Jacobi singular value decomposition.

use crate::shapes::Vector;

/// Rows of a 3 × 3 matrix.
pub(super) type Matrix = [Vector; 3];

/// Enough sweeps for any 3 × 3 matrix; convergence is quadratic and takes three to five.
const SWEEPS: usize = 30;

pub(super) fn identity() -> Matrix {
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
}

pub(super) fn times(matrix: &Matrix, v: Vector) -> Vector {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// argmax tr(R S) over rotations. With S = U Σ Vᵀ it is R = V diag(1, 1, ±1) Uᵀ, the sign on the least singular value
/// chosen to make R a rotation.
pub(super) fn best_rotation(s: &Matrix) -> Matrix {
    // Columns of S V; turning pairs of columns until all are orthogonal leaves U Σ and V.
    let mut columns = transposed(s);
    let mut v = identity(); // Its rows are the columns of V.
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            turn(&mut columns, &mut v, p, q);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| dot(columns[b], columns[b]).total_cmp(&dot(columns[a], columns[a])));
    let [first, second, _] = order.map(|index| columns[index]);
    let [v1, v2, _] = order.map(|index| v[index]);
    // Two orthonormal frames whose third axes follow by the right-hand rule: both are rotations, so R is one, and the
    // sign of the least singular value is taken care of.
    let (u1, u2) = (unit(first), unit(second));
    let (u3, v3) = (cross(u1, u2), cross(v1, v2));
    let mut rotation = [[0.0; 3]; 3];
    for (v, u) in [(v1, u1), (v2, u2), (v3, u3)] {
        for row in 0..3 {
            for column in 0..3 {
                rotation[row][column] += v[row] * u[column];
            }
        }
    }
    rotation
}

/// Turns columns `p` and `q` in their plane so that they become orthogonal.
fn turn(columns: &mut Matrix, v: &mut Matrix, p: usize, q: usize) {
    let (alpha, beta) = (dot(columns[p], columns[p]), dot(columns[q], columns[q]));
    let gamma = dot(columns[p], columns[q]);
    if gamma == 0.0 {
        return;
    }
    let zeta = (beta - alpha) / (2.0 * gamma);
    let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = c * t;
    for matrix in [columns, v] {
        let (a, b) = (matrix[p], matrix[q]);
        for axis in 0..3 {
            matrix[p][axis] = c * a[axis] - s * b[axis];
            matrix[q][axis] = s * a[axis] + c * b[axis];
        }
    }
}

fn transposed(matrix: &Matrix) -> Matrix {
    [0, 1, 2].map(|column| [0, 1, 2].map(|row| matrix[row][column]))
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    v.map(|value| value / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace_of_product(a: &Matrix, b: &Matrix) -> f64 {
        (0..3).map(|i| (0..3).map(|k| a[i][k] * b[k][i]).sum::<f64>()).sum()
    }

    /// The rotation by `angle` about a coordinate axis.
    fn about(axis: usize, angle: f64) -> Matrix {
        let (s, c) = angle.sin_cos();
        let mut matrix = identity();
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        (matrix[u][u], matrix[u][v], matrix[v][u], matrix[v][v]) = (c, -s, s, c);
        matrix
    }

    fn product(a: &Matrix, b: &Matrix) -> Matrix {
        let columns = transposed(b).map(|column| times(a, column));
        transposed(&columns)
    }

    #[test]
    fn no_nearby_rotation_fits_better() {
        let samples: [Matrix; 3] = [
            [[2.0, 0.3, -0.4], [0.1, 1.5, 0.2], [0.7, -0.6, 0.9]],
            [[-2.0, 0.3, -0.4], [0.1, 1.5, 0.2], [0.7, -0.6, 0.9]],
            [[1.0, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, -1e-6]],
        ];
        for s in samples {
            let rotation = best_rotation(&s);
            let best = trace_of_product(&rotation, &s);
            for axis in 0..3 {
                for angle in [-1e-2, 1e-2, -1.0, 1.0, 3.0] {
                    let other = trace_of_product(&product(&about(axis, angle), &rotation), &s);
                    assert!(other <= best + 1e-15, "{s:?}: {other} > {best}");
                }
            }
        }
    }

    #[test]
    fn the_result_is_a_rotation_even_for_a_reflection() {
        let rotation = best_rotation(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]);
        let [a, b, c] = rotation;
        assert!((dot(cross(a, b), c) - 1.0).abs() < 1e-14, "{rotation:?}");
    }
}
