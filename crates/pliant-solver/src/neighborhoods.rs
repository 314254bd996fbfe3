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

use rayon::prelude::*;

use crate::analysis::{Analysis, Layout};
use crate::edge_set::EdgeSet;
use crate::{Rigidity, SolveError};

/// Vertices that share one search memory.
const BATCH: usize = 256;

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
    /// [`SolveError::WrongLength`] unless there is one size per vertex; [`SolveError::TooLarge`] beyond 2³² runs.
    pub fn new(analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        let r = internal_sizes(analysis, rigidity)?;
        let all: Vec<u32> = (0..r.len() as u32).collect();
        let found = search(&analysis.layout, &r, &all);
        let mut neighborhoods = Neighborhoods { r, offsets: Vec::new(), runs: Vec::new() };
        neighborhoods.replace(&all, &found)?;
        Ok(neighborhoods)
    }

    /// The same for other sizes: only vertices whose size differs are searched from.
    pub(crate) fn updated(&self, analysis: &Analysis, rigidity: &Rigidity) -> Result<Neighborhoods, SolveError> {
        let r = internal_sizes(analysis, rigidity)?;
        let changed: Vec<u32> = (0..r.len() as u32).filter(|&k| r[k as usize] != self.r[k as usize]).collect();
        let found = search(&analysis.layout, &r, &changed);
        let mut next = Neighborhoods { r, offsets: self.offsets.clone(), runs: self.runs.clone() };
        next.replace(&changed, &found)?;
        Ok(next)
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

    /// Puts the runs found for some vertices (ascending) in the place of what they had.
    fn replace(&mut self, changed: &[u32], found: &[Batch]) -> Result<(), SolveError> {
        let n = self.r.len();
        let mut fresh = changed.iter().copied().zip(found.iter().flat_map(Batch::each)).peekable();
        let mut offsets = Vec::with_capacity(n + 1);
        let mut runs = Vec::new();
        offsets.push(0);
        for k in 0..n {
            match fresh.next_if(|(changed, _)| *changed as usize == k) {
                Some((_, found)) => runs.extend_from_slice(found),
                None => runs.extend_from_slice(self.runs(k)),
            }
            offsets.push(
                u32::try_from(runs.len()).map_err(|_| SolveError::TooLarge { what: "the set of neighborhoods" })?,
            );
        }
        (self.offsets, self.runs) = (offsets, runs);
        Ok(())
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

fn search(layout: &Layout, r: &[u16], sources: &[u32]) -> Vec<Batch> {
    sources
        .par_chunks(BATCH)
        .map_init(
            || Search::new(layout),
            |search, sources| {
                let mut batch = Batch { ends: Vec::with_capacity(sources.len()), runs: Vec::new() };
                for &k in sources {
                    search.append_runs(k, r[k as usize], &mut batch.runs);
                    batch.ends.push(batch.runs.len());
                }
                batch
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
