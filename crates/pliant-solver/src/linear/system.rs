//! The sparse symmetric positive definite system of the global step. The only file that knows faer.
//!
//! | object | made | cost |
//! |---|---|---|
//! | [`Pattern`] | once per mesh | fill-reducing order and symbolic factorization |
//! | [`System::factor`] | when d, w or the fixed vertices change | numeric factorization into the same memory |
//! | [`System::solve_in_place`] | every global step | two triangular solves, three right-hand sides |

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use crate::quad::Quad;

/// Below this many unknowns the simplicial factorization is as fast (20 times slower at 100,000).
const SUPERNODAL_FROM: usize = 500;
/// A raw pivot this much smaller than its diagonal entry is rounding, not definiteness: 1e4 times the unit roundoff.
const SMALLEST_PIVOT: f64 = 1e-12;

/// Lower triangle of the mesh Laplacian by columns, diagonal first, and its symbolic factorization.
pub(crate) struct Pattern {
    n: usize,
    columns: Vec<u32>,
    rows: Vec<u32>,
    symbolic: Result<SymbolicCholesky<u32>, OutOfRange>,
}

/// The factor does not fit memory or 32-bit indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutOfRange;

/// Why a factorization failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FactorError {
    /// The pivot of this row was not positive.
    NonPositivePivot { row: usize },
    /// Memory or index range.
    TooLarge,
}

impl Pattern {
    /// `edges`: unordered pairs (lower, upper) of rows. Returns the pattern and the place of each edge's value in it;
    /// row `i` keeps its diagonal at [`Pattern::diagonal`].
    pub(crate) fn new(n: usize, edges: &[[u32; 2]]) -> (Pattern, Vec<u32>) {
        let mut columns = vec![1u32; n + 1];
        columns[0] = 0;
        for edge in edges {
            columns[edge[0] as usize + 1] += 1;
        }
        for i in 0..n {
            columns[i + 1] += columns[i];
        }
        let mut by_ends: Vec<u32> = (0..edges.len() as u32).collect();
        by_ends.sort_unstable_by_key(|&e| edges[e as usize]);
        let mut next: Vec<u32> = columns[..n].to_vec();
        let mut rows = vec![0u32; n + edges.len()];
        for (i, next) in next.iter_mut().enumerate() {
            rows[*next as usize] = i as u32;
            *next += 1;
        }
        let mut slots = vec![0u32; edges.len()];
        for e in by_ends {
            let [lower, upper] = edges[e as usize];
            let slot = &mut next[lower as usize];
            rows[*slot as usize] = upper;
            slots[e as usize] = *slot;
            *slot += 1;
        }
        let symbolic = analyze(n, &columns, &rows);
        (Pattern { n, columns, rows, symbolic }, slots)
    }

    /// Place of the diagonal value of a row.
    pub(crate) fn diagonal(&self, row: usize) -> usize {
        self.columns[row] as usize
    }

    /// Number of values.
    pub(crate) fn n_values(&self) -> usize {
        self.rows.len()
    }
}

fn analyze(n: usize, columns: &[u32], rows: &[u32]) -> Result<SymbolicCholesky<u32>, OutOfRange> {
    let threshold = if n >= SUPERNODAL_FROM {
        SupernodalThreshold::FORCE_SUPERNODAL
    } else {
        SupernodalThreshold::FORCE_SIMPLICIAL
    };
    let params = CholeskySymbolicParams { supernodal_flop_ratio_threshold: threshold, ..Default::default() };
    let matrix = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
    factorize_symbolic_cholesky(matrix, Side::Lower, SymmetricOrdering::Amd, params).map_err(|_| OutOfRange)
}

/// A factored system and the memory to solve with it.
pub(crate) struct System {
    pattern: Arc<Pattern>,
    factor: Vec<f64>,
    factor_memory: MemBuffer,
    solve_memory: MemBuffer,
    /// Three columns, x, y, z.
    columns: Vec<f64>,
}

impl System {
    /// Reserves memory; nothing is factored yet.
    pub(crate) fn new(pattern: Arc<Pattern>) -> Result<System, FactorError> {
        let symbolic = pattern.symbolic.as_ref().map_err(|_| FactorError::TooLarge)?;
        let reserve = |request| MemBuffer::try_new(request).map_err(|_| FactorError::TooLarge);
        let factor_memory = reserve(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()))?;
        let solve_memory = reserve(symbolic.solve_in_place_scratch::<f64>(3, Par::Seq))?;
        let mut factor = Vec::new();
        factor.try_reserve_exact(symbolic.len_val()).map_err(|_| FactorError::TooLarge)?;
        factor.resize(symbolic.len_val(), 0.0);
        let columns = vec![0.0; 3 * pattern.n];
        Ok(System { pattern, factor, factor_memory, solve_memory, columns })
    }

    /// Factors anew. After an error the factor is unusable until the next success.
    pub(crate) fn factor(&mut self, values: &[f64]) -> Result<(), FactorError> {
        let Pattern { n, columns, rows, symbolic } = &*self.pattern;
        let symbolic = symbolic.as_ref().map_err(|_| FactorError::TooLarge)?;
        let matrix = SparseColMatRef::new(SymbolicSparseColMatRef::new_checked(*n, *n, columns, None, rows), values);
        symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut self.factor_memory),
                Default::default(),
            )
            .map_err(|error| match error {
                LltError::NonPositivePivot { index } => {
                    FactorError::NonPositivePivot { row: row_of_pivot(symbolic, index) }
                }
            })?;
        Ok(())
    }

    /// A row whose pivot is so small against its diagonal entry that it is only rounding away from zero.
    pub(crate) fn doubtful_pivot(&self, values: &[f64]) -> Option<usize> {
        let symbolic = self.pattern.symbolic.as_ref().ok()?;
        let is_doubtful = |pivot: usize, l: f64| {
            let row = row_of_pivot(symbolic, pivot);
            let sound = l * l >= SMALLEST_PIVOT * values[self.pattern.diagonal(row)];
            (!sound).then_some(row)
        };
        match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(s) => s.col_ptr()[..s.ncols()]
                .iter()
                .enumerate()
                .find_map(|(j, &at)| is_doubtful(j, self.factor[at as usize])),
            SymbolicCholeskyRaw::Supernodal(s) => (0..s.n_supernodes()).find_map(|node| {
                let (begin, end) = (s.supernode_begin()[node] as usize, s.supernode_end()[node] as usize);
                let (first, last) = (s.col_ptr_for_val()[node] as usize, s.col_ptr_for_val()[node + 1] as usize);
                let height = (last - first) / (end - begin).max(1);
                (begin..end).find_map(|j| is_doubtful(j, self.factor[first + (j - begin) * (height + 1)]))
            }),
        }
    }

    /// Replaces `rhs` (three right-hand sides, a row of each side by side) by the solution.
    pub(crate) fn solve_in_place(&mut self, rhs: &mut [Quad]) {
        let n = self.pattern.n;
        let Ok(symbolic) = &self.pattern.symbolic else { return };
        for (i, b) in rhs.iter().enumerate() {
            (0..3).for_each(|c| self.columns[c * n + i] = b.0[c]);
        }
        let columns = MatMut::from_column_major_slice_mut(&mut self.columns, n, 3);
        let stack = MemStack::new(&mut self.solve_memory);
        LltRef::new(symbolic, &self.factor).solve_in_place_with_conj(Conj::No, columns, Par::Seq, stack);
        for (i, x) in rhs.iter_mut().enumerate() {
            (0..3).for_each(|c| x.0[c] = self.columns[c * n + i]);
        }
    }
}

/// The row of a pivot. Errors count pivots from 0 or from 1, depending on the factorization; the number is only for the
/// message, so the nearest row that exists will do.
fn row_of_pivot(symbolic: &SymbolicCholesky<u32>, pivot: usize) -> usize {
    let pivot = pivot.min(symbolic.nrows().saturating_sub(1));
    symbolic.perm().map_or(pivot, |perm| perm.arrays().0[pivot] as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path 0 - 1 - … with unit weights, both ends fixed.
    fn path(n: usize, weight: f64) -> (System, Vec<f64>) {
        let edges: Vec<[u32; 2]> = (1..n as u32).map(|i| [i - 1, i]).collect();
        let (pattern, slots) = Pattern::new(n, &edges);
        let mut values = vec![0.0; pattern.n_values()];
        for i in 0..n {
            values[pattern.diagonal(i)] = if i == 0 || i + 1 == n { 1.0 } else { 2.0 * weight };
        }
        for e in 1..edges.len() - 1 {
            values[slots[e] as usize] = -weight;
        }
        (System::new(Arc::new(pattern)).expect("small"), values)
    }

    #[test]
    fn a_path_is_solved_below_and_above_the_supernodal_size() {
        for n in [5, SUPERNODAL_FROM + 7] {
            let (mut system, values) = path(n, 1.0);
            system.factor(&values).expect("definite");
            assert_eq!(system.doubtful_pivot(&values), None);
            // Right-hand side of the straight line x_i = i with ends moved over.
            let mut rhs = vec![Quad::ZERO; n];
            for end in [n - 1, n - 2] {
                rhs[end].0[1] = (n - 1) as f64;
            }
            system.solve_in_place(&mut rhs);
            for (i, x) in rhs.iter().enumerate() {
                assert!((x.0[1] - i as f64).abs() < 1e-9 * n as f64, "row {i} of {n}: {x:?}");
                assert_eq!(x.0[0], 0.0, "row {i} of {n}");
            }
        }
    }

    #[test]
    fn a_pivot_that_is_not_positive_is_reported() {
        for n in [5, SUPERNODAL_FROM + 7] {
            let (mut system, values) = path(n, -1.0);
            assert!(matches!(system.factor(&values), Err(FactorError::NonPositivePivot { .. })));
            let (mut system, values) = path(n, 0.0);
            assert!(matches!(system.factor(&values), Err(FactorError::NonPositivePivot { .. })));
        }
    }
}
