//! The matrix of the global step: assembling it whole or in part, and factoring it.

use crate::linear::FactorError;
use crate::{Analysis, SolveError, Solver, Weights};

/// From this share of the edges on, the whole matrix is assembled anew: sums at vertices are then asked for by each of
/// their edges, six times.
const MANY_EDGES: usize = 6;

impl Solver {
    /// The matrix of the global step: d w Laplacian, fixed vertices as identity rows.
    pub(crate) fn assemble(&self, stiffness: &[f64], is_fixed: &[bool]) -> Vec<f64> {
        assemble(&self.analysis, stiffness, is_fixed)
    }

    /// The matrix where only the rows of the ends of these edges differ from the one that is factored. The same bits as
    /// from [`Solver::assemble`], since spokes ascend by edge.
    fn reassemble(&self, edges: &[usize], is_fixed: &[bool]) -> Vec<f64> {
        let Analysis { layout, pattern, slots, .. } = &*self.analysis;
        let stiffness = &self.rings.stiffness;
        if edges.len() > layout.n_edges() / MANY_EDGES {
            return self.assemble(stiffness, is_fixed);
        }
        let mut values = self.values.clone();
        for &e in edges {
            let ends = layout.edges[e].map(|end| end as usize);
            let is_free = ends.map(|end| !is_fixed[end]);
            values[slots[e] as usize] = if is_free == [true; 2] { -stiffness[e] } else { 0.0 };
            for (end, is_free) in ends.into_iter().zip(is_free) {
                let spokes = layout.spokes(end).iter();
                values[pattern.diagonal(end)] =
                    if is_free { spokes.fold(0.0, |sum, spoke| sum + stiffness[spoke.edge as usize]) } else { 1.0 };
            }
        }
        values
    }

    /// The matrix after the stiffness of edges of these blocks has changed.
    pub(crate) fn repainted(&self, blocks: &[usize]) -> Vec<f64> {
        let bounds = &self.analysis.layout.blocks;
        let edges = blocks.iter().flat_map(|&block| bounds[block] as usize..bounds[block + 1] as usize);
        self.reassemble(&edges.collect::<Vec<_>>(), &self.held.is_fixed)
    }

    /// The matrix with other fixed vertices.
    pub(crate) fn refixed(&self, is_fixed: &[bool]) -> Vec<f64> {
        let changed = (0..is_fixed.len()).filter(|&v| is_fixed[v] != self.held.is_fixed[v]);
        let spokes = changed.flat_map(|v| self.analysis.layout.spokes(v));
        self.reassemble(&spokes.map(|spoke| spoke.edge as usize).collect::<Vec<_>>(), is_fixed)
    }

    /// Factors new values, or returns to the ones before.
    pub(crate) fn factor(&mut self, values: Vec<f64>) -> Result<(), SolveError> {
        let mut outcome = self.system.factor(&values);
        if outcome.is_ok()
            && self.analysis.weights() == Weights::Cotangent
            && let Some(row) = self.system.doubtful_pivot()
        {
            outcome = Err(FactorError::NonPositivePivot { row });
        }
        match outcome {
            Ok(()) => {
                self.values = values;
                Ok(())
            }
            Err(error) => {
                if !self.values.is_empty() {
                    // These were factored before, with the same order of operations: they succeed again.
                    self.system.factor(&self.values).map_err(|error| explain(&self.analysis, error))?;
                }
                Err(explain(&self.analysis, error))
            }
        }
    }
}

/// The Laplacian with these stiffnesses of the edges, fixed vertices as identity rows.
pub(crate) fn assemble(analysis: &Analysis, stiffness: &[f64], is_fixed: &[bool]) -> Vec<f64> {
    let Analysis { layout, pattern, slots, .. } = analysis;
    let mut values = vec![0.0; pattern.n_values()];
    for (e, &[i, j]) in layout.edges.iter().enumerate() {
        let (i_free, j_free) = (!is_fixed[i as usize], !is_fixed[j as usize]);
        if i_free {
            values[pattern.diagonal(i as usize)] += stiffness[e];
        }
        if j_free {
            values[pattern.diagonal(j as usize)] += stiffness[e];
        }
        if i_free && j_free {
            values[slots[e] as usize] = -stiffness[e];
        }
    }
    for i in (0..layout.n_vertices()).filter(|&i| is_fixed[i]) {
        values[pattern.diagonal(i)] = 1.0;
    }
    values
}

pub(crate) fn explain(analysis: &Analysis, error: FactorError) -> SolveError {
    match error {
        FactorError::NonPositivePivot { row } => SolveError::Indefinite { vertex: analysis.layout.to_caller[row] },
        FactorError::TooLarge => SolveError::TooLarge { what: "the factored system" },
    }
}
