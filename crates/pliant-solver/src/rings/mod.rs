//! The neighborhoods of a solver with all that depends on them alone, and what painting other sizes changes of it.

pub(crate) mod edge_set;
pub(crate) mod moments;
pub(crate) mod neighborhoods;
pub(crate) mod progress;
pub(crate) mod search;
pub(crate) mod transpose;

use std::ops::Range;

use glam::DMat3;
use rayon::prelude::*;

use crate::analysis::Layout;
use crate::kernels::energy::FEW_EDGES;
use crate::rings::moments::{moments, update_moments};
use crate::rings::neighborhoods::Neighborhoods;
use crate::rings::transpose::Transpose;
use crate::{Analysis, Rigidity, SolveError};

/// From this share of the vertices on, everything is built anew: sorting the ends of so many runs into the others
/// takes as long.
const MANY: usize = 16;

/// What the sums run over: r-rings, their transpose, and what depends on them alone.
pub(crate) struct Rings {
    pub(crate) neighborhoods: Neighborhoods,
    pub(crate) transpose: Transpose,
    /// d_e, and their sum.
    counts: Vec<u32>,
    total_count: u64,
    /// d_e w_e.
    pub(crate) stiffness: Vec<f64>,
    /// Σ |d_e w_e|.
    pub(crate) total_stiffness: f64,
    /// Whether any weight is negative, as raw ones may be.
    pub(crate) has_negative: bool,
    /// C_k = Σ_{e ∈ N(k)} w_e e eᵀ; empty where a small energy is summed directly.
    pub(crate) moments: Vec<DMat3>,
}

impl Rings {
    pub(crate) fn new(layout: &Layout, neighborhoods: Neighborhoods) -> Rings {
        let transpose = Transpose::new(layout, &neighborhoods);
        let mut rings = Rings {
            neighborhoods,
            transpose,
            counts: vec![0; layout.n_edges()],
            total_count: 0,
            stiffness: vec![0.0; layout.n_edges()],
            total_stiffness: 0.0,
            has_negative: false,
            moments: Vec::new(),
        };
        rings.recount(layout, &Vec::from_iter(0..layout.n_blocks()));
        rings.total();
        if rings.needs_moments() {
            rings.moments = moments(layout, &rings.neighborhoods);
        }
        rings
    }

    /// Other sizes. Only what belongs to vertices whose size differs is computed anew, but everything has the bits that
    /// [`Rings::new`] would give it. Returns the blocks, ascending, outside of which neither d_e nor the transpose has
    /// changed.
    ///
    /// # Errors
    /// As for [`Neighborhoods::new`]; nothing has changed then.
    pub(crate) fn repaint(&mut self, analysis: &Analysis, rigidity: &Rigidity) -> Result<Vec<usize>, SolveError> {
        let layout = &analysis.layout;
        let changes = self.neighborhoods.changes(analysis, rigidity)?;
        let is_little = changes.vertices.len() < layout.n_vertices() / MANY && !self.transpose.is_empty();
        let mut is_touched = vec![!is_little && !changes.vertices.is_empty(); layout.n_blocks()];
        if is_little {
            is_touched = self.transpose.update(layout, &self.neighborhoods, &changes);
        }
        for &k in &changes.vertices {
            if self.neighborhoods.r[k as usize] == 1 || changes.size(k) == 1 {
                let edges = layout.spokes(k as usize).iter().map(|spoke| spoke.edge as usize);
                edges.for_each(|e| is_touched[layout.block_of_edge[e] as usize] = true);
            }
        }
        let vertices = changes.vertices.clone();
        self.neighborhoods.apply(changes);
        if !is_little || !self.neighborhoods.has_runs() {
            self.transpose = Transpose::new(layout, &self.neighborhoods);
        }
        let touched: Vec<usize> = (0..layout.n_blocks()).filter(|&block| is_touched[block]).collect();
        self.recount(layout, &touched);
        self.total();
        if !self.needs_moments() {
            self.moments = Vec::new();
        } else if self.moments.is_empty() || !is_little {
            self.moments = moments(layout, &self.neighborhoods);
        } else {
            update_moments(layout, &self.neighborhoods, &vertices, &mut self.moments);
        }
        Ok(touched)
    }

    /// d_e of some blocks.
    fn recount(&mut self, layout: &Layout, blocks: &[usize]) {
        let Rings { neighborhoods, transpose, counts, total_count, stiffness, .. } = self;
        let count = |&block: &usize| {
            let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
            let by_runs = edges.clone().zip(transpose.counts(layout, block));
            let own = |e: usize| layout.edges[e].iter().filter(|&&end| neighborhoods.r[end as usize] == 1).count();
            (edges, by_runs.map(|(e, by_runs)| by_runs + own(e) as u32).collect())
        };
        let fresh: Vec<(Range<usize>, Vec<u32>)> = blocks.par_iter().map(count).collect();
        for (edges, fresh) in fresh {
            for (e, fresh) in edges.zip(fresh) {
                let before = std::mem::replace(&mut counts[e], fresh);
                *total_count = *total_count + u64::from(fresh) - u64::from(before);
                stiffness[e] = f64::from(fresh) * layout.weight[e];
            }
        }
    }

    fn total(&mut self) {
        self.total_stiffness = self.stiffness.iter().map(|s| s.abs()).sum();
        self.has_negative = self.stiffness.iter().any(|&s| s < 0.0);
    }

    fn needs_moments(&self) -> bool {
        self.total_count as f64 > FEW_EDGES * self.counts.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::test_support::{Random, bumpy_sheet, mixed_rigidity};
    use crate::{VertexId, Weights};

    /// All bits of `rings` against a new build.
    fn assert_fresh(analysis: &Analysis, rings: &Rings, rigidity: &Rigidity, what: &str) {
        let neighborhoods = Neighborhoods::new(analysis, rigidity).expect("one size per vertex");
        let fresh = Rings::new(&analysis.layout, neighborhoods);
        assert_eq!(rings.neighborhoods.r, fresh.neighborhoods.r, "{what}");
        for k in 0..rings.neighborhoods.r.len() {
            assert_eq!(rings.neighborhoods.runs(k), fresh.neighborhoods.runs(k), "{what}, vertex {k}");
        }
        assert_eq!(rings.neighborhoods.has_runs(), fresh.neighborhoods.has_runs(), "{what}");
        assert!(rings.transpose == fresh.transpose, "{what}");
        assert_eq!((&rings.counts, rings.total_count), (&fresh.counts, fresh.total_count), "{what}");
        assert_eq!(rings.stiffness, fresh.stiffness, "{what}");
        assert_eq!(rings.total_stiffness, fresh.total_stiffness, "{what}");
        assert_eq!(rings.moments, fresh.moments, "{what}");
    }

    #[test]
    fn repainting_gives_the_bits_of_a_new_build() {
        let mesh = Arc::new(bumpy_sheet(45));
        let n = mesh.n_vertices();
        let analysis = Analysis::new(mesh.clone(), Weights::Clamped);
        let mut random = Random::new(11);
        for begin in [Rigidity::uniform(n, 1), Rigidity::uniform(n, 3), mixed_rigidity(n, 8)] {
            let mut r = begin.as_slice().to_vec();
            let mut rings = Rings::new(&analysis.layout, Neighborhoods::new(&analysis, &begin).expect("valid"));
            for dab in 0..12 {
                let size = 1 + (random.signed().abs() * 8.0) as u16;
                let mut painted = vec![((random.signed().abs() * n as f64) as u32).min(n as u32 - 1)];
                for place in 0..[1, 40, 150][dab % 3] {
                    painted.extend_from_slice(mesh.neighbors(VertexId(painted[place % painted.len()])));
                }
                painted.iter().for_each(|&v| r[v as usize] = size);
                let rigidity = Rigidity::new(r.clone()).expect("in range");
                let before = rings.counts.clone();
                let touched = rings.repaint(&analysis, &rigidity).expect("one size per vertex");
                for e in (0..before.len()).filter(|&e| before[e] != rings.counts[e]) {
                    let block = analysis.layout.block_of_edge[e] as usize;
                    assert!(touched.contains(&block), "dab {dab}, edge {e} of block {block}: {touched:?}");
                }
                assert_fresh(&analysis, &rings, &rigidity, &format!("from r to {}, dab {dab}", begin.max()));
            }
            for rigidity in [Rigidity::uniform(n, 5), Rigidity::uniform(n, 1), begin] {
                rings.repaint(&analysis, &rigidity).expect("one size per vertex");
                assert_fresh(&analysis, &rings, &rigidity, &format!("all to {}", rigidity.max()));
            }
        }
    }

    #[test]
    fn a_refused_repainting_changes_nothing() {
        let mesh = Arc::new(bumpy_sheet(20));
        let n = mesh.n_vertices();
        let analysis = Analysis::new(mesh, Weights::Clamped);
        let rigidity = mixed_rigidity(n, 4);
        let mut rings = Rings::new(&analysis.layout, Neighborhoods::new(&analysis, &rigidity).expect("valid"));
        assert!(matches!(rings.repaint(&analysis, &Rigidity::uniform(n + 1, 2)), Err(SolveError::WrongLength { .. })));
        assert_fresh(&analysis, &rings, &rigidity, "refused");
    }
}
