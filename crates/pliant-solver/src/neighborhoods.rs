//! The edges of N(k, r_k), as runs of consecutive edges in locality order (paper 3.1).
//!
//! Edge (i, j) lies in N(k, r) if and only if the nearer of its ends is within r − 1 edges of k: for r = 1 the spokes of
//! k, for r = 2 all edges at k and its neighbors, and so on. Because edges near each other in space have numbers near
//! each other, a neighborhood of 870 edges (r = 10) is some fifty runs: its perimeter, not its area.
//!
//! Runs are cut at block borders, where prefix sums begin anew. A run is kept as two *slots*: block b with m edges has
//! m + 1 slots, for the sums of its first 0, 1, … m edges, so slot = edge + b.
//!
//! Vertices with r = 1 keep no runs; their spokes are at hand anyway.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::analysis::{Analysis, Layout};
use crate::edge_set::EdgeSet;
use crate::{Rigidity, SolveError};

/// Vertices that share one search memory.
const BATCH: usize = 256;

/// More runs than this are refused: with their transpose and the copy while they are put together they take 6 GB, and
/// twice their number still fits 32 bits. A million vertices with r = 10 have a fifth of it.
const MOST_RUNS: usize = 1 << 28;

/// N(k, r_k) of every vertex. Made in parallel; O(Σ |N(k, r_k)|) time, memory 8 bytes per run and 8 per vertex.
pub struct Neighborhoods {
    /// r_k in internal numbering.
    pub(crate) r: Vec<u16>,
    /// Runs of vertex k: `runs[offsets[k]..offsets[k + 1]]`.
    pub(crate) offsets: Vec<u32>,
    /// Slots (from, to) with from < to in the same block.
    pub(crate) runs: Vec<[u32; 2]>,
}

impl Neighborhoods {
    /// Searches around every vertex with r > 1.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`] unless there is one size per vertex; [`SolveError::TooLarge`] beyond 2²⁸
    /// runs, as where r exceeds the diameter of a very large mesh.
    pub fn new(analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        let r = internal_sizes(analysis, rigidity)?;
        Neighborhoods { offsets: vec![0; r.len() + 1], r: vec![1; r.len()], runs: Vec::new() }.with_sizes(analysis, r)
    }

    /// The same for other sizes: only vertices whose size differs are searched from, and the runs of the others are
    /// copied once, O(runs).
    pub(crate) fn updated(&self, analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        self.with_sizes(analysis, internal_sizes(analysis, rigidity)?)
    }

    /// As [`Neighborhoods::updated`]; the very same if no size differs.
    pub(crate) fn into_updated(self, analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        let r = internal_sizes(analysis, rigidity)?;
        if r == self.r { Ok(self) } else { self.with_sizes(analysis, r) }
    }

    fn with_sizes(&self, analysis: &Analysis, r: Vec<u16>) -> Result<Neighborhoods, SolveError> {
        let (changed, kept): (Vec<u32>, Vec<u32>) =
            (0..r.len() as u32).partition(|&k| r[k as usize] != self.r[k as usize]);
        let n_kept = kept.iter().map(|&k| self.runs(k as usize).len()).sum::<usize>();
        let found = search(&analysis.layout, &r, &changed, MOST_RUNS.saturating_sub(n_kept))?;
        let n_found = found.iter().map(|batch| batch.runs.len()).sum::<usize>();
        let mut fresh = changed.iter().copied().zip(found.iter().flat_map(Batch::each)).peekable();
        let mut offsets = Vec::with_capacity(r.len() + 1);
        let mut runs = Vec::with_capacity(n_kept + n_found);
        offsets.push(0);
        for k in 0..r.len() {
            match fresh.next_if(|(changed, _)| *changed as usize == k) {
                Some((_, found)) => runs.extend_from_slice(found),
                None => runs.extend_from_slice(self.runs(k)),
            }
            offsets.push(runs.len() as u32);
        }
        Ok(Neighborhoods { r, offsets, runs })
    }

    /// Runs of vertex `k`.
    pub(crate) fn runs(&self, k: usize) -> &[[u32; 2]] {
        &self.runs[self.offsets[k] as usize..self.offsets[k + 1] as usize]
    }

    /// Whether any vertex has r > 1.
    pub(crate) fn has_runs(&self) -> bool {
        !self.runs.is_empty()
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

/// Runs of consecutive vertices of a list.
struct Batch {
    ends: Vec<usize>,
    runs: Vec<[u32; 2]>,
}

impl Batch {
    fn each(&self) -> impl Iterator<Item = &[[u32; 2]]> {
        (0..self.ends.len()).map(|i| &self.runs[if i == 0 { 0 } else { self.ends[i - 1] }..self.ends[i]])
    }
}

/// The runs of every source; refused as soon as they are more than `most`, before they fill the memory.
fn search(layout: &Layout, r: &[u16], sources: &[u32], most: usize) -> Result<Vec<Batch>, SolveError> {
    let n_found = AtomicUsize::new(0);
    sources
        .par_chunks(BATCH)
        .map_init(
            || Search::new(layout),
            |search, sources| {
                let mut batch = Batch { ends: Vec::with_capacity(sources.len()), runs: Vec::new() };
                for &k in sources {
                    let before = batch.runs.len();
                    search.append_runs(k, r[k as usize], &mut batch.runs);
                    batch.ends.push(batch.runs.len());
                    let more = batch.runs.len() - before;
                    if n_found.fetch_add(more, Ordering::Relaxed) + more > most {
                        return Err(SolveError::TooLarge { what: "the set of neighborhoods" });
                    }
                }
                Ok(batch)
            },
        )
        .collect()
}

/// Memory of a breadth-first search, used for many sources.
struct Search<'a> {
    layout: &'a Layout,
    /// Number of the search that last reached a vertex.
    reached: Vec<u32>,
    round: u32,
    queue: Vec<u32>,
    edges: EdgeSet,
}

impl<'a> Search<'a> {
    fn new(layout: &'a Layout) -> Search<'a> {
        let reached = vec![0; layout.n_vertices()];
        Search { layout, reached, round: 0, queue: Vec::new(), edges: EdgeSet::new(layout.n_edges()) }
    }

    fn append_runs(&mut self, k: u32, r: u16, runs: &mut Vec<[u32; 2]>) {
        if r < 2 {
            return;
        }
        self.round += 1;
        self.queue.clear();
        self.queue.push(k);
        self.reached[k as usize] = self.round;
        let (mut ring, mut next) = (0, 0);
        let mut ring_end = 1;
        while next < self.queue.len() {
            let v = self.queue[next] as usize;
            for spoke in self.layout.spokes(v) {
                self.edges.insert(spoke.edge);
                if ring + 1 < r && self.reached[spoke.vertex as usize] != self.round {
                    self.reached[spoke.vertex as usize] = self.round;
                    self.queue.push(spoke.vertex);
                }
            }
            next += 1;
            if next == ring_end {
                ring += 1;
                ring_end = self.queue.len();
            }
        }
        let layout = self.layout;
        self.edges.drain_runs(|mut first, end| {
            while first < end {
                let block = layout.block_of_edge[first as usize];
                let cut = end.min(layout.blocks[block as usize + 1]);
                runs.push([first + block, cut + block]);
                first = cut;
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::Weights;
    use crate::test_support::{bumpy_sheet, mixed_rigidity, plain_neighborhood};
    use crate::transpose::Transpose;

    #[test]
    fn every_edge_is_counted_as_often_as_a_plain_search_finds_it() {
        let mesh = Arc::new(bumpy_sheet(23));
        let (n, m) = (mesh.n_vertices(), mesh.n_edges());
        let analysis = Analysis::new(mesh.clone(), Weights::Uniform);
        let layout = &analysis.layout;
        // The last goes far beyond the diameter.
        for rigidity in [mixed_rigidity(n, 6), Rigidity::uniform(n, 1), Rigidity::uniform(n, 3), mixed_rigidity(n, 90)]
        {
            let neighborhoods = Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex");
            let counts = Transpose::new(layout, &neighborhoods).counts(layout, &neighborhoods.r);
            let mut plain = vec![0.0; m];
            for k in 0..n {
                plain_neighborhood(&mesh, k as u32, rigidity.as_slice()[k]).iter().for_each(|&e| plain[e] += 1.0);
            }
            for (e, &[i, j]) in layout.edges.iter().enumerate() {
                let [a, b] = [i, j].map(|v| layout.to_caller[v as usize]);
                let place = mesh.edges().binary_search(&[a.min(b), a.max(b)]).expect("an edge of the mesh");
                assert_eq!(counts[e], plain[place], "r to {}, edge {place} between {a} and {b}", rigidity.max());
            }
        }
    }

    #[test]
    fn changed_sizes_give_the_runs_of_a_new_search() {
        let mesh = Arc::new(bumpy_sheet(19));
        let n = mesh.n_vertices();
        let analysis = Analysis::new(mesh, Weights::Uniform);
        let other = mixed_rigidity(n, 4);
        let first = Neighborhoods::new(&analysis, &mixed_rigidity(n, 7)).expect("one size per vertex");
        let updated = first.updated(&analysis, &other).expect("one size per vertex");
        let fresh = Neighborhoods::new(&analysis, &other).expect("one size per vertex");
        assert_eq!((updated.r, updated.offsets, updated.runs), (fresh.r, fresh.offsets, fresh.runs));
    }

    #[test]
    fn more_runs_than_allowed_are_refused_while_searching() {
        let mesh = Arc::new(bumpy_sheet(23));
        let n = mesh.n_vertices();
        let analysis = Analysis::new(mesh, Weights::Uniform);
        let (r, all) = (vec![5; n], (0..n as u32).collect::<Vec<_>>());
        let found = search(&analysis.layout, &r, &all, usize::MAX).expect("no limit");
        let n_runs = found.iter().map(|batch| batch.runs.len()).sum::<usize>();
        assert!(search(&analysis.layout, &r, &all, n_runs).is_ok());
        let refused = search(&analysis.layout, &r, &all, n_runs - 1).err();
        assert_eq!(refused, Some(SolveError::TooLarge { what: "the set of neighborhoods" }));
    }
}
