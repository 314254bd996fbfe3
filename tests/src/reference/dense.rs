//! A dense symmetric positive definite system, factored row by row (Cholesky).

use crate::shapes::Vector;

/// L with A = L Lᵀ, rows of growing length.
pub(super) struct Factor {
    rows: Vec<Vec<f64>>,
}

impl Factor {
    /// None if a pivot is not positive.
    pub(super) fn new(matrix: Vec<Vec<f64>>) -> Option<Factor> {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(matrix.len());
        for (i, given) in matrix.iter().enumerate() {
            let mut row = given[..=i].to_vec();
            for j in 0..i {
                row[j] = (row[j] - inner(&row[..j], &rows[j][..j])) / rows[j][j];
            }
            let pivot = row[i] - inner(&row[..i], &row[..i]);
            if pivot <= 0.0 {
                return None;
            }
            row[i] = pivot.sqrt();
            rows.push(row);
        }
        Some(Factor { rows })
    }

    /// Solves for three right-hand sides at once.
    pub(super) fn solve(&self, mut x: Vec<Vector>) -> Vec<Vector> {
        for i in 0..x.len() {
            let (row, done) = (&self.rows[i], &x[..i]);
            let mut value = x[i];
            for (factor, known) in row.iter().zip(done) {
                for axis in 0..3 {
                    value[axis] -= factor * known[axis];
                }
            }
            x[i] = value.map(|v| v / row[i]);
        }
        for i in (0..x.len()).rev() {
            let row = &self.rows[i];
            let known = x[i].map(|v| v / row[i]);
            x[i] = known;
            for (factor, value) in row[..i].iter().zip(&mut x) {
                for axis in 0..3 {
                    value[axis] -= factor * known[axis];
                }
            }
        }
        x
    }
}

/// Sum of products, in four partial sums that the compiler can keep in one register.
fn inner(a: &[f64], b: &[f64]) -> f64 {
    let mut parts = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a4.zip(b4) {
        for lane in 0..4 {
            parts[lane] += x[lane] * y[lane];
        }
    }
    parts.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_satisfies_its_system() {
        let matrix: Vec<Vec<f64>> =
            (0..7).map(|i| (0..7).map(|j| if i == j { 9.0 } else { 1.0 / (1.0 + (i + j) as f64) }).collect()).collect();
        let right: Vec<Vector> = (0..7).map(|i| [i as f64, 1.0, -(i as f64)]).collect();
        let solved = Factor::new(matrix.clone()).expect("diagonally dominant").solve(right.clone());
        for (row, expected) in matrix.iter().zip(&right) {
            for axis in 0..3 {
                let got: f64 = row.iter().zip(&solved).map(|(a, x)| a * x[axis]).sum();
                assert!((got - expected[axis]).abs() < 1e-12, "{got} {}", expected[axis]);
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_is_noticed() {
        assert!(Factor::new(vec![vec![1.0, 2.0], vec![2.0, 1.0]]).is_none());
    }
}
