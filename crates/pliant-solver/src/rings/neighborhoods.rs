//! The edges of N(k, r_k), as runs of consecutive edges in locality order (paper 3.1).
//!
//! Edge (i, j) lies in N(k, r) if and only if the nearer of its ends is within r − 1 edges of k: for r = 1 the spokes of
//! k, for r = 2 all edges at k and its neighbors, and so on. Because edges near each other on the surface have numbers
//! near each other, a neighborhood of 870 edges (r = 10) is some forty runs: its perimeter, not its area.
//!
//! Runs are cut at block borders, where prefix sums begin anew. A run is kept as two *slots*: block b with m edges has
//! m + 1 slots, for the sums of its first 0, 1, … m edges, so slot = edge + b.
//!
//! Vertices with r = 1 keep no runs; their spokes are at hand anyway.

use std::ops::ControlFlow;

use crate::analysis::{Analysis, Layout};
use crate::rings::progress::Meter;
use crate::rings::search::{Batch, SOURCES, search, work};
use crate::{Rigidity, SolveError};

/// More runs than this are refused: with their transpose they take 5 GB, and twice their number still fits 32 bits. A
/// million vertices with r = 10 have a seventh of it.
const MOST_RUNS: usize = 1 << 28;

/// N(k, r_k) of every vertex. Made in parallel, neighbors together: for uniform r in about O(n r) time. Memory: 6 bytes
/// per vertex and 8 per run; on an irregular surface a vertex has 7 runs at r = 2, 38 at r = 10 and 80 at r = 20.
pub struct Neighborhoods {
    /// r_k in internal numbering.
    pub(crate) r: Vec<u16>,
    /// Runs of [`SOURCES`] vertices each.
    batches: Vec<Batch>,
    n_runs: usize,
}

/// What other sizes change in neighborhoods.
pub(crate) struct Changes {
    /// The new sizes of all vertices.
    r: Vec<u16>,
    /// Vertices whose size differs, ascending.
    pub(crate) vertices: Vec<u32>,
    /// Their new runs.
    found: Vec<Batch>,
}

impl Changes {
    /// The new size of a vertex.
    pub(crate) fn size(&self, k: u32) -> u16 {
        self.r[k as usize]
    }

    /// New runs of the i-th changed vertex.
    pub(crate) fn runs(&self, i: usize) -> &[[u32; 2]] {
        self.found[i / SOURCES].runs(i % SOURCES)
    }
}

impl Neighborhoods {
    /// Searches around every vertex with r > 1.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`] unless there is one size per vertex; [`SolveError::TooLarge`] beyond 2²⁸
    /// runs, as where r exceeds the diameter of a very large mesh.
    pub fn new(analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        Neighborhoods::with_progress(analysis, rigidity, &mut |_| ControlFlow::Continue(()))
    }

    /// The same, while `progress` is told the fraction that is done, ascending up to 1, and stops the search by
    /// answering [`ControlFlow::Break`]. It is called after every 256 vertices, from any of the threads that search but
    /// never from two at once.
    ///
    /// # Errors
    /// As for [`Neighborhoods::new`]; [`SolveError::Canceled`] if stopped.
    pub fn with_progress(
        analysis: &Analysis,
        rigidity: &Rigidity,
        progress: &mut (impl FnMut(f64) -> ControlFlow<()> + Send),
    ) -> Result<Neighborhoods, SolveError> {
        let r = internal_sizes(analysis, rigidity)?;
        let all: Vec<u32> = (0..r.len() as u32).collect();
        let batches = search(&analysis.layout, &r, &all, MOST_RUNS, &Meter::new(work(&r, &all), progress))?;
        let n_runs = batches.iter().map(|batch| batch.runs.len()).sum();
        Ok(Neighborhoods { r, batches, n_runs })
    }

    /// What these sizes would change: searches only around vertices whose size differs.
    ///
    /// # Errors
    /// As for [`Neighborhoods::new`].
    pub(crate) fn changes(&self, analysis: &Analysis, rigidity: &Rigidity) -> Result<Changes, SolveError> {
        let r = internal_sizes(analysis, rigidity)?;
        let vertices: Vec<u32> = (0..r.len() as u32).filter(|&k| r[k as usize] != self.r[k as usize]).collect();
        let n_lost = vertices.iter().map(|&k| self.runs(k as usize).len()).sum::<usize>();
        let most = MOST_RUNS - (self.n_runs - n_lost);
        let mut go_on = |_| ControlFlow::Continue(());
        let found = search(&analysis.layout, &r, &vertices, most, &Meter::new(work(&r, &vertices), &mut go_on))?;
        Ok(Changes { r, vertices, found })
    }

    /// Takes the new sizes and runs. Only batches with a changed vertex are written anew.
    pub(crate) fn apply(&mut self, changes: Changes) {
        let mut first = 0;
        for members in changes.vertices.chunk_by(|a, b| *a as usize / SOURCES == *b as usize / SOURCES) {
            let batch = &mut self.batches[members[0] as usize / SOURCES];
            let n_before = batch.runs.len();
            let mut fresh = (first..).zip(members).peekable();
            let mut offsets = vec![0];
            let mut runs = Vec::new();
            for i in 0..batch.offsets.len() - 1 {
                match fresh.next_if(|&(_, &k)| k as usize % SOURCES == i) {
                    Some((place, _)) => runs.extend_from_slice(changes.runs(place)),
                    None => runs.extend_from_slice(batch.runs(i)),
                }
                offsets.push(runs.len() as u32);
            }
            first += members.len();
            runs.shrink_to_fit();
            self.n_runs = self.n_runs - n_before + runs.len();
            *batch = Batch { offsets, runs };
        }
        self.r = changes.r;
    }

    /// With other sizes.
    pub(crate) fn updated(mut self, analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        let changes = self.changes(analysis, rigidity)?;
        self.apply(changes);
        Ok(self)
    }

    /// Runs of vertex `k`.
    #[inline]
    pub(crate) fn runs(&self, k: usize) -> &[[u32; 2]] {
        self.batches[k / SOURCES].runs(k % SOURCES)
    }

    /// Runs of [`SOURCES`] consecutive vertices at a time.
    pub(crate) fn batches(&self) -> &[Batch] {
        &self.batches
    }

    /// Whether any vertex has r > 1.
    pub(crate) fn has_runs(&self) -> bool {
        self.n_runs > 0
    }

    /// Calls `f` for every edge of N(k, r_k), ascending.
    pub(crate) fn for_each_edge(&self, layout: &Layout, k: usize, mut f: impl FnMut(usize)) {
        if self.r[k] == 1 {
            layout.spokes(k).iter().for_each(|spoke| f(spoke.edge as usize));
        }
        for &[from, to] in self.runs(k) {
            let block = block_of_slot(layout, from);
            (from as usize - block..to as usize - block).for_each(&mut f);
        }
    }
}

/// The block to which a slot belongs.
pub(crate) fn block_of_slot(layout: &Layout, slot: u32) -> usize {
    // Block b begins at slot blocks[b] + b. `from` slots are never the last of a block, so the last begin ≤ slot is it.
    let (mut low, mut high) = (0, layout.n_blocks());
    while high - low > 1 {
        let middle = low.midpoint(high);
        if layout.blocks[middle] as usize + middle <= slot as usize { low = middle } else { high = middle }
    }
    low
}

fn internal_sizes(analysis: &Analysis, rigidity: &Rigidity) -> Result<Vec<u16>, SolveError> {
    let (r, expected) = (rigidity.as_slice(), analysis.layout.n_vertices());
    if r.len() != expected {
        return Err(SolveError::WrongLength { what: "rigidity values", got: r.len(), expected });
    }
    Ok(analysis.layout.to_caller.iter().map(|&v| r[v as usize]).collect())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::Weights;
    use crate::test_support::{bumpy_sheet, mixed_rigidity};

    #[test]
    fn progress_ascends_to_one_and_may_stop_the_search() {
        let mesh = Arc::new(bumpy_sheet(40));
        let n = mesh.n_vertices();
        let analysis = Analysis::new(mesh, Weights::Uniform);
        let rigidity = mixed_rigidity(n, 6);
        let mut told = Vec::new();
        let found = Neighborhoods::with_progress(&analysis, &rigidity, &mut |fraction| {
            told.push(fraction);
            ControlFlow::Continue(())
        });
        assert!(found.is_ok() && told.len() == n.div_ceil(SOURCES), "{told:?}");
        assert!(told.is_sorted_by(|a, b| a < b) && told.last() == Some(&1.0), "{told:?}");
        let mut n_told = 0;
        let stopped = Neighborhoods::with_progress(&analysis, &rigidity, &mut |_| {
            n_told += 1;
            ControlFlow::Break(())
        });
        assert_eq!((stopped.err(), n_told), (Some(SolveError::Canceled), 1));
    }
}
