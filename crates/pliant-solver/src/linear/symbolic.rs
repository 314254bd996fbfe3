//! Which entries of L are not zero, as supernodes: columns with the same rows below them. By faer.

use faer::Side;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, SymbolicSupernodalParams};

use super::pattern::OutOfRange;

/// Supernodes are merged with their parents as long as no more than such a share of their entries are zeros: (up to so
/// many columns, share). Measured at 100,000 vertices.
const MERGED: &[(usize, f64)] = &[(4, 0.5), (16, 0.3), (48, 0.1), (usize::MAX, 0.05)];

/// The structure of L. Columns are counted in elimination order.
pub(super) struct Supernodes {
    /// Supernode s has the columns `begin[s]..begin[s + 1]`.
    pub(super) begin: Vec<u32>,
    /// And rows below them `rows[rows_at[s]..rows_at[s + 1]]`, ascending.
    pub(super) rows_at: Vec<usize>,
    pub(super) rows: Vec<u32>,
}

impl Supernodes {
    /// Structure of the factor of the matrix with the given lower triangle (by columns, diagonal first), eliminated in a
    /// postordered `order`.
    pub(super) fn new(columns: &[u32], rows: &[u32], order: &[u32]) -> Result<Supernodes, OutOfRange> {
        let n = order.len();
        let mut inverse = vec![0u32; n];
        for (column, &row) in order.iter().enumerate() {
            inverse[row as usize] = column as u32;
        }
        let matrix = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            supernodal_params: SymbolicSupernodalParams { relax: Some(MERGED) },
            ..Default::default()
        };
        let order = SymmetricOrdering::Custom(PermRef::new_checked(order, &inverse, n));
        let symbolic = factorize_symbolic_cholesky(matrix, Side::Lower, order, params).map_err(|_| OutOfRange)?;
        let SymbolicCholeskyRaw::Supernodal(found) = symbolic.raw() else {
            return Err(OutOfRange);
        };
        let mut supernodes = Supernodes { begin: vec![0], rows_at: vec![0], rows: Vec::new() };
        for s in 0..found.n_supernodes() {
            supernodes.begin.push(found.supernode_end()[s]);
            let first = supernodes.rows.len();
            supernodes.rows.extend_from_slice(found.supernode(s).pattern());
            supernodes.rows[first..].sort_unstable();
            supernodes.rows_at.push(supernodes.rows.len());
        }
        Ok(supernodes)
    }

    pub(super) fn len(&self) -> usize {
        self.begin.len() - 1
    }

    pub(super) fn columns(&self, s: usize) -> std::ops::Range<u32> {
        self.begin[s]..self.begin[s + 1]
    }

    pub(super) fn rows(&self, s: usize) -> &[u32] {
        &self.rows[self.rows_at[s]..self.rows_at[s + 1]]
    }
}
