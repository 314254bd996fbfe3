//! Factorization of a front: the first columns of a dense symmetric matrix are eliminated from the rest.
//!
//! Small fronts are by far the most, and a call of a general routine costs more than they do: they are done here, up to
//! eight columns at a time. Large ones are left to faer, in blocks that may run in parallel and are always the same.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul as triangular_matmul};
use faer::linalg::{matmul::matmul, triangular_solve::solve_lower_triangular_in_place};
use faer::prelude::{Reborrow as _, ReborrowMut as _};
use faer::{Accum, MatMut, MatRef, Par};
use pulp::NullaryFnOnce;

/// Columns eliminated at a time in a small front.
const FEW: usize = 8;
/// Fronts with at least so many columns to eliminate and rows are large (measured: faer is faster from here on).
const LARGE: (usize, usize) = (24, 96);
/// Columns eliminated at a time in a large front, and rows and columns of a block of the remainder.
const BLOCK: usize = 128;
/// Blocks of products below this many multiplications are not shared between threads.
const WORTH_SHARING: usize = 1 << 21;

/// Replaces the lower triangle of the first `width` columns of a symmetric matrix of `n` rows (by columns) by those of
/// its Cholesky factor, and the rest of the lower triangle by what remains. The error is the column of a pivot that is not
/// positive.
pub(super) fn eliminate(front: &mut [f64], n: usize, width: usize) -> Result<(), usize> {
    if width >= LARGE.0 && n >= LARGE.1 {
        return eliminate_large(front, n, width);
    }
    pulp::Arch::new().dispatch(Small { front, n, width })
}

/// Elimination in a small front. A type of its own, since a closure would not be compiled for the vector unit at hand.
struct Small<'a> {
    front: &'a mut [f64],
    n: usize,
    width: usize,
}

impl NullaryFnOnce for Small<'_> {
    type Output = Result<(), usize>;

    #[inline(always)]
    fn call(self) -> Result<(), usize> {
        let Small { front, n, width } = self;
        for first in (0..width).step_by(FEW) {
            eliminate_few(front, n, first, FEW.min(width - first))?;
        }
        Ok(())
    }
}

#[inline(always)]
fn eliminate_few(front: &mut [f64], n: usize, first: usize, few: usize) -> Result<(), usize> {
    let end = first + few;
    let (_, from_first) = front.split_at_mut(first * n);
    let (panel, rest) = from_first.split_at_mut(few * n);
    for j in 0..few {
        let (done, column) = panel.split_at_mut(j * n);
        let column = &mut column[first + j..n];
        for earlier in done.chunks_exact(n) {
            let earlier = &earlier[first + j..];
            let factor = earlier[0];
            column.iter_mut().zip(earlier).for_each(|(c, e)| *c -= factor * e);
        }
        let pivot = column[0];
        if pivot.is_nan() || pivot <= 0.0 || pivot.is_infinite() {
            return Err(first + j);
        }
        let scale = 1.0 / pivot.sqrt();
        column.iter_mut().for_each(|c| *c *= scale);
        column[0] = pivot.sqrt();
    }
    for (j, column) in rest.chunks_exact_mut(n).enumerate() {
        let row = end + j;
        let column = &mut column[row..];
        if few == FEW {
            let [a, b, c, d, e, f, g, h]: [&[f64]; FEW] = std::array::from_fn(|p| &panel[p * n + row..(p + 1) * n]);
            let [fa, fb, fc, fd, fe, ff, fg, fh] = [a[0], b[0], c[0], d[0], e[0], f[0], g[0], h[0]];
            let len = column.len();
            let (a, b, c, d) = (&a[..len], &b[..len], &c[..len], &d[..len]);
            let (e, f, g, h) = (&e[..len], &f[..len], &g[..len], &h[..len]);
            for i in 0..len {
                let one = (fa * a[i] + fb * b[i]) + (fc * c[i] + fd * d[i]);
                let two = (fe * e[i] + ff * f[i]) + (fg * g[i] + fh * h[i]);
                column[i] -= one + two;
            }
        } else {
            for earlier in panel.chunks_exact(n) {
                let earlier = &earlier[row..];
                let factor = earlier[0];
                column.iter_mut().zip(earlier).for_each(|(c, e)| *c -= factor * e);
            }
        }
    }
    Ok(())
}

fn eliminate_large(front: &mut [f64], n: usize, width: usize) -> Result<(), usize> {
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(BLOCK, Par::Seq, Default::default()));
    let mut rest = MatMut::from_column_major_slice_mut(front, n, n);
    let mut first = 0;
    while first < width {
        let block = BLOCK.min(width - first);
        let (mut pivots, _, mut below, remainder) = rest.split_at_mut(block, block);
        let stack = MemStack::new(&mut memory);
        let outcome = cholesky_in_place(pivots.rb_mut(), Default::default(), Par::Seq, stack, Default::default());
        let is_bad = |pivot: f64| pivot.is_nan() || pivot <= 0.0 || pivot.is_infinite();
        let bad = (0..block).find(|&j| is_bad(pivots[(j, j)]));
        if outcome.is_err() || bad.is_some() {
            return Err(first + bad.unwrap_or(0));
        }
        solve_rows(pivots.rb(), below.rb_mut());
        rest = remainder;
        subtract_square(rest.rb_mut(), below.rb());
        first += block;
    }
    Ok(())
}

/// below ← below · L⁻ᵀ, block of rows by block of rows.
fn solve_rows(pivots: MatRef<'_, f64>, below: MatMut<'_, f64>) {
    let n = below.nrows();
    if n <= BLOCK || n * pivots.nrows() * pivots.nrows() < WORTH_SHARING {
        return solve_lower_triangular_in_place(pivots, below.transpose_mut(), Par::Seq);
    }
    let (upper, lower) = below.split_at_row_mut(half(n));
    rayon::join(|| solve_rows(pivots, upper), || solve_rows(pivots, lower));
}

/// Lower triangle of c ← c − l lᵀ.
fn subtract_square(c: MatMut<'_, f64>, l: MatRef<'_, f64>) {
    let n = c.nrows();
    if n <= BLOCK || n * n * l.ncols() < WORTH_SHARING {
        let (lower, all) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
        return triangular_matmul(c, lower, Accum::Add, l, all, l.transpose(), all, -1.0, Par::Seq);
    }
    let (upper_left, _, lower_left, lower_right) = c.split_at_mut(half(n), half(n));
    let (upper, lower) = l.split_at_row(half(n));
    rayon::join(
        || subtract_product(lower_left, lower, upper),
        || rayon::join(|| subtract_square(upper_left, upper), || subtract_square(lower_right, lower)),
    );
}

/// c ← c − a bᵀ.
fn subtract_product(c: MatMut<'_, f64>, a: MatRef<'_, f64>, b: MatRef<'_, f64>) {
    let n = c.nrows();
    if n <= BLOCK || n * c.ncols() * a.ncols() < WORTH_SHARING {
        return matmul(c, Accum::Add, a, b.transpose(), -1.0, Par::Seq);
    }
    let (upper, lower) = c.split_at_row_mut(half(n));
    let (above, below) = a.split_at_row(half(n));
    rayon::join(|| subtract_product(upper, above, b), || subtract_product(lower, below, b));
}

/// Half, in whole blocks.
fn half(n: usize) -> usize {
    (n / 2).next_multiple_of(BLOCK).min(n - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A positive definite matrix by columns: random below the diagonal, and a diagonal that outweighs it.
    fn matrix(n: usize) -> Vec<f64> {
        let mut random = crate::test_support::Random::new(n as u64);
        let mut a = vec![0.0; n * n];
        for j in 0..n {
            for i in j..n {
                let x = if i == j { n as f64 } else { random.signed() };
                (a[j * n + i], a[i * n + j]) = (x, x);
            }
        }
        a
    }

    #[test]
    fn the_factor_times_its_transpose_is_the_matrix_at_any_size() {
        for (n, width) in [(1, 1), (7, 3), (20, 20), (40, 17), (100, 30), (300, 300), (420, 150), (700, 290)] {
            let original = matrix(n);
            let mut front = original.clone();
            eliminate(&mut front, n, width).expect("positive definite");
            // Entry (i, j) of L Lᵀ with the remainder as its own block; 1e-15 n for each of up to n products of size n.
            for j in 0..n {
                for i in (j..n).step_by(if n > 200 { 13 } else { 1 }) {
                    let sum: f64 = (0..width.min(j + 1)).map(|p| front[p * n + i] * front[p * n + j]).sum();
                    let found = sum + if j >= width { front[j * n + i] } else { 0.0 };
                    let expected = original[j * n + i];
                    assert!(
                        (found - expected).abs() < 1e-14 * (n * n) as f64,
                        "{width} of {n} columns, entry ({i}, {j}): got {found}, expected {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_names_its_column() {
        for (n, width) in [(6, 5), (200, 100)] {
            for bad in [0, 4, width - 1] {
                let mut front = matrix(n);
                front[bad * n + bad] = -1e9;
                assert_eq!(eliminate(&mut front, n, width), Err(bad), "column {bad} of {n}");
            }
            let mut front = matrix(n);
            front[0] = f64::NAN;
            assert!(eliminate(&mut front, n, width).is_err());
        }
    }
}
