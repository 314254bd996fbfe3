//! The same matrix in the same order, factored and solved by faer alone: to be timed beside ours.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, Par, Side, get_global_parallelism};

use super::pattern::Pattern;
use super::system::System;

/// faer's factor, and three right-hand sides to solve for.
pub(crate) struct ByFaer {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
    rhs: Mat<f64>,
    memory: MemBuffer,
    par: Par,
}

impl ByFaer {
    /// None if the system has no factor.
    pub(crate) fn new(system: &System) -> Option<ByFaer> {
        let (Pattern { columns, rows, plan }, values) = system.matrix();
        let order = &plan.as_ref().ok()?.order;
        let n = order.len();
        let mut inverse = vec![0u32; n];
        (0u32..).zip(order).for_each(|(column, &row)| inverse[row as usize] = column);
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, columns, None, rows);
        let ordering = SymmetricOrdering::Custom(PermRef::new_checked(order, &inverse, n));
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, ordering, Default::default()).ok()?;
        let par = get_global_parallelism();
        let mut factor = vec![0.0; symbolic.len_val()];
        let mut memory = MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(par, Default::default()));
        let matrix = SparseColMatRef::new(pattern, values);
        let stack = MemStack::new(&mut memory);
        let regularization = Default::default();
        symbolic
            .factorize_numeric_llt(&mut factor, matrix, Side::Lower, regularization, par, stack, Default::default())
            .ok()?;
        let rhs = Mat::from_fn(n, 3, |i, j| ((i + j) % 7) as f64);
        let memory = MemBuffer::new(symbolic.solve_in_place_scratch::<f64>(3, par));
        Some(ByFaer { symbolic, values: factor, rhs, memory, par })
    }

    /// Both triangular solves for three right-hand sides.
    pub(crate) fn solve(&mut self) {
        let ByFaer { symbolic, values, rhs, memory, par } = self;
        let factor = LltRef::new(symbolic, values);
        factor.solve_in_place_with_conj(Conj::No, rhs.as_mut(), *par, MemStack::new(memory));
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::kernels::quad::Quad;
    use crate::linear::Ordered;

    #[test]
    fn both_solve_the_same() {
        let n = 300;
        let edges: Vec<[u32; 2]> = (1..n as u32).map(|i| [i / 3, i]).collect();
        let points: Vec<glam::DVec3> = (0..n).map(|i| glam::DVec3::new(i as f64, (i % 5) as f64, 0.0)).collect();
        let (ordered, slots) = Ordered::new(&points, &edges);
        let pattern = ordered.analyzed();
        let mut values = vec![0.0; pattern.n_values()];
        (0..n).for_each(|i| values[pattern.diagonal(i)] = 5.0);
        slots.iter().for_each(|&slot| values[slot as usize] = -1.0);
        let mut system = System::new(Arc::new(pattern)).expect("small");
        system.factor(&values).expect("dominant diagonal");
        let mut by_faer = ByFaer::new(&system).expect("dominant diagonal");
        let row = |i: usize| std::array::from_fn(|j| by_faer.rhs.get(i, j).to_owned());
        let mut rhs: Vec<Quad> = (0..n)
            .map(|i| {
                let [x, y, z] = row(i);
                Quad([x, y, z, 0.0])
            })
            .collect();
        system.solve_in_place(&mut rhs);
        by_faer.solve();
        for (i, Quad(ours)) in rhs.iter().enumerate() {
            for (j, ours) in ours[..3].iter().enumerate() {
                // A condition number of at most 4, some ten sums a row.
                let theirs = by_faer.rhs[(i, j)];
                let off = (ours - theirs).abs();
                assert!(off <= 1e-13 * theirs.abs().max(1.0), "row {i}, column {j}: {ours} and {theirs}");
            }
        }
    }
}
