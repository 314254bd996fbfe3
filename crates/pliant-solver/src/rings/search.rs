//! Neighborhoods of many vertices at once, a bit for each.
//!
//! Vertices that are neighbors have nearly the same neighborhoods. So up to [`SOURCES`] of them share one breadth-first
//! search, in which each vertex carries a word with a bit per source, and in each round takes up the words of its
//! neighbors. The sources whose neighborhood contains edge (i, j) are then word(i) | word(j). Along ascending edges this changes in the
//! bits of those whose run begins or ends just there: the cost is that of the ends of runs, not of what is between.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use pulp::Arch;
use rayon::prelude::*;

use crate::SolveError;
use crate::analysis::Layout;
use crate::rings::edge_set::EdgeSet;
use crate::rings::progress::Meter;

/// Vertices that share a search: a patch some sixteen edges wide, about as wide as usual neighborhoods, and words that
/// fill a vector register. By eye.
pub(crate) const SOURCES: usize = 256;

/// A bit per source.
type Word = [u64; SOURCES / 64];

const EMPTY: Word = [0; SOURCES / 64];
const UNPLACED: u32 = u32::MAX;

/// Runs of up to [`SOURCES`] vertices.
pub(crate) struct Batch {
    /// Runs of the i-th: `runs[offsets[i]..offsets[i + 1]]`.
    pub(crate) offsets: Vec<u32>,
    pub(crate) runs: Vec<[u32; 2]>,
}

impl Batch {
    /// Runs of the i-th vertex.
    #[inline]
    pub(crate) fn runs(&self, i: usize) -> &[[u32; 2]] {
        &self.runs[self.offsets[i] as usize..self.offsets[i + 1] as usize]
    }
}

/// The runs of every source of an ascending list, [`SOURCES`] to a batch; refused as soon as they are more than `most`,
/// before they fill the memory.
pub(crate) fn search(
    layout: &Layout,
    r: &[u16],
    sources: &[u32],
    most: usize,
    meter: &Meter<'_>,
) -> Result<Vec<Batch>, SolveError> {
    let n_found = AtomicUsize::new(0);
    sources
        .par_chunks(SOURCES)
        .map_init(
            || Search::new(layout),
            |search, sources| {
                let batch = search.batch(r, sources);
                let more = batch.runs.len();
                if n_found.fetch_add(more, Ordering::Relaxed) + more > most {
                    return Err(SolveError::TooLarge { what: "the set of neighborhoods" });
                }
                match meter.advance(work(r, sources)) {
                    ControlFlow::Continue(()) => Ok(batch),
                    ControlFlow::Break(()) => Err(SolveError::Canceled),
                }
            },
        )
        .collect()
}

/// What searches from these sources cost, for progress: about as much as the perimeters of their neighborhoods.
pub(crate) fn work(r: &[u16], sources: &[u32]) -> u64 {
    sources.iter().map(|&k| u64::from(r[k as usize])).sum()
}

/// Memory of a search, used for many batches.
struct Search<'a> {
    layout: &'a Layout,
    /// Where a vertex is in the region, or [`UNPLACED`].
    place: Vec<u32>,
    region: Region,
    edges: EdgeSet,
    /// (slot, source) of every end of a run, ascending by slot.
    ends: Vec<(u32, u32)>,
}

/// The vertices that a search has come to, renumbered so that they lie together.
#[derive(Default)]
struct Region {
    vertices: Vec<u32>,
    /// Neighbors of a place that are in the region: the first of `neighbors[begin..begin + room]`, where room is the
    /// vertex's number of spokes, are `n_neighbors` many.
    begins: Vec<u32>,
    n_neighbors: Vec<u32>,
    neighbors: Vec<u32>,
    /// Sources that have come to each place, before and after a round.
    before: Vec<Word>,
    after: Vec<Word>,
    /// Places at which sources may still arrive.
    active: Vec<u32>,
    /// Places whose neighbors need not all be in the region.
    rim: Vec<u32>,
}

impl<'a> Search<'a> {
    fn new(layout: &'a Layout) -> Search<'a> {
        let place = vec![UNPLACED; layout.n_vertices()];
        Search { layout, place, region: Region::default(), edges: EdgeSet::new(layout.n_edges()), ends: Vec::new() }
    }

    fn batch(&mut self, r: &[u16], sources: &[u32]) -> Batch {
        self.grow(r, sources);
        self.find_ends();
        self.region.vertices.iter().for_each(|&v| self.place[v as usize] = UNPLACED);
        self.region.clear();
        runs_by_source(sources.len(), &self.ends)
    }

    /// Finds all vertices within r − 1 edges of each source with r > 1.
    fn grow(&mut self, r: &[u16], sources: &[u32]) {
        let mut by_size: Vec<(u16, usize)> =
            sources.iter().enumerate().map(|(bit, &k)| (r[k as usize], bit)).filter(|&(r, _)| r > 1).collect();
        let mut growing = EMPTY;
        for &(_, bit) in &by_size {
            growing[bit / 64] |= 1 << (bit % 64);
            self.add(sources[bit]);
            let own = self.region.before.len() - 1;
            self.region.before[own][bit / 64] |= 1 << (bit % 64);
        }
        by_size.sort_unstable();
        let mut by_size = by_size.into_iter().peekable();
        for distance in 1u16.. {
            while let Some((_, bit)) = by_size.next_if(|&(r, _)| r <= distance) {
                growing[bit / 64] &= !(1 << (bit % 64));
            }
            if growing == EMPTY {
                return;
            }
            self.add_neighbors(growing);
            let region = &mut self.region;
            if !Arch::new().dispatch(|| region.round(growing)) {
                return;
            }
        }
    }

    /// Adds a vertex to the region, as a neighbor of those that are in it.
    fn add(&mut self, vertex: u32) {
        let Search { layout, place, region, .. } = self;
        let own = region.vertices.len();
        let spokes = layout.spokes(vertex as usize);
        place[vertex as usize] = own as u32;
        region.vertices.push(vertex);
        region.begins.push(region.neighbors.len() as u32);
        region.n_neighbors.push(0);
        region.neighbors.resize(region.neighbors.len() + spokes.len(), 0);
        region.before.push(EMPTY);
        region.after.push(EMPTY);
        region.active.push(own as u32);
        region.rim.push(own as u32);
        for spoke in spokes {
            let other = place[spoke.vertex as usize];
            if other != UNPLACED {
                region.join(own, other as usize);
                region.join(other as usize, own);
            }
        }
    }

    /// Adds the neighbors of all places from which a source will grow.
    fn add_neighbors(&mut self, growing: Word) {
        let layout = self.layout;
        let mut rim = std::mem::take(&mut self.region.rim);
        rim.retain(|&at| {
            let is_left = and(self.region.before[at as usize], growing) != EMPTY;
            if is_left {
                for spoke in layout.spokes(self.region.vertices[at as usize] as usize) {
                    if self.place[spoke.vertex as usize] == UNPLACED {
                        self.add(spoke.vertex);
                    }
                }
            }
            !is_left
        });
        self.region.rim.append(&mut rim);
    }

    /// Lists where sources begin and end to contain edges, in ascending order.
    fn find_ends(&mut self) {
        let Search { layout, place, region, edges, ends } = self;
        for (&vertex, word) in region.vertices.iter().zip(&region.before) {
            if *word != EMPTY {
                layout.spokes(vertex as usize).iter().for_each(|spoke| edges.insert(spoke.edge));
            }
        }
        let word = |vertex: u32| match place[vertex as usize] {
            UNPLACED => EMPTY,
            at => region.before[at as usize],
        };
        ends.clear();
        edges.drain_runs(|mut first, end| {
            while first < end {
                let block = layout.block_of_edge[first as usize];
                let cut = end.min(layout.blocks[block as usize + 1]);
                let mut before = EMPTY;
                for e in first..cut {
                    let [i, j] = layout.edges[e as usize];
                    let here = or(word(i), word(j));
                    list_changes(before, here, e + block, ends);
                    before = here;
                }
                list_changes(before, EMPTY, cut + block, ends);
                first = cut;
            }
        });
    }
}

impl Region {
    fn clear(&mut self) {
        let Region { vertices, begins, n_neighbors, neighbors, before, after, active, rim } = self;
        [vertices, begins, n_neighbors, neighbors, active, rim].into_iter().for_each(Vec::clear);
        [before, after].into_iter().for_each(Vec::clear);
    }

    fn join(&mut self, at: usize, neighbor: usize) {
        self.neighbors[(self.begins[at] + self.n_neighbors[at]) as usize] = neighbor as u32;
        self.n_neighbors[at] += 1;
    }

    /// One more edge for all sources that still grow; returns whether any source came anywhere.
    #[inline(always)]
    fn round(&mut self, growing: Word) -> bool {
        let Region { begins, n_neighbors, neighbors, before, after, active, .. } = self;
        let mut difference = EMPTY;
        let mut n_active = 0;
        for place in 0..active.len() {
            let at = active[place] as usize;
            let mut around = EMPTY;
            for &other in &neighbors[begins[at] as usize..(begins[at] + n_neighbors[at]) as usize] {
                around = or(around, before[other as usize]);
            }
            let own = before[at];
            let now = or(own, and(around, growing));
            difference = or(difference, and_not(now, own));
            after[at] = now;
            // Where all have come that still grow, nothing will change, and it was the same before this round.
            active[n_active] = at as u32;
            n_active += usize::from(and_not(growing, own) != EMPTY);
        }
        active.truncate(n_active);
        std::mem::swap(before, after);
        difference != EMPTY
    }
}

fn list_changes(before: Word, after: Word, slot: u32, ends: &mut Vec<(u32, u32)>) {
    for group in 0..before.len() {
        let mut changed = before[group] ^ after[group];
        while changed != 0 {
            ends.push((slot, (group * 64) as u32 + changed.trailing_zeros()));
            changed &= changed - 1;
        }
    }
}

/// Ends by slot become runs by source.
fn runs_by_source(n_sources: usize, ends: &[(u32, u32)]) -> Batch {
    let mut offsets = vec![0u32; n_sources + 1];
    ends.iter().for_each(|&(_, source)| offsets[source as usize + 1] += 1);
    (0..n_sources).for_each(|i| offsets[i + 1] += offsets[i]);
    let mut next = offsets.clone();
    let mut runs = vec![[0u32; 2]; ends.len() / 2];
    for &(slot, source) in ends {
        // Every source has an even number of ends, so its first one is the beginning of a run.
        let at = &mut next[source as usize];
        runs[*at as usize / 2][*at as usize % 2] = slot;
        *at += 1;
    }
    offsets.iter_mut().for_each(|offset| *offset /= 2);
    Batch { offsets, runs }
}

#[inline(always)]
fn or(a: Word, b: Word) -> Word {
    std::array::from_fn(|i| a[i] | b[i])
}

#[inline(always)]
fn and(a: Word, b: Word) -> Word {
    std::array::from_fn(|i| a[i] & b[i])
}

#[inline(always)]
fn and_not(a: Word, b: Word) -> Word {
    std::array::from_fn(|i| a[i] & !b[i])
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;

    use super::*;
    use crate::test_support::{bumpy_sheet, mixed_rigidity, plain_neighborhood};
    use crate::{Analysis, Mesh, Neighborhoods, Rigidity, Weights};

    /// Two sheets of unequal size and a vertex alone.
    fn several_components() -> Mesh {
        let (a, b) = (bumpy_sheet(21), bumpy_sheet(9));
        let n = a.n_vertices();
        let mut points = a.positions().to_vec();
        points.extend(b.positions().iter().map(|&p| p + DVec3::new(0.0, 0.0, 3.0)));
        points.push(DVec3::ZERO);
        let moved = b.triangles().iter().map(|face| face.map(|v| v + n as u32));
        Mesh::new(points, a.triangles().iter().copied().chain(moved).collect()).expect("valid")
    }

    #[test]
    fn shared_searches_find_the_edges_of_plain_ones() {
        let mesh = Arc::new(several_components());
        let n = mesh.n_vertices();
        assert!(!n.is_multiple_of(SOURCES), "the last batch should not be full");
        let analysis = Analysis::new(mesh.clone(), Weights::Uniform);
        let layout = &analysis.layout;
        let sparse = Rigidity::new((0..n).map(|v| if v % 9 == 0 { 5 } else { 1 }).collect()).expect("in range");
        // The last goes far beyond the diameter.
        for rigidity in [Rigidity::uniform(n, 2), mixed_rigidity(n, 7), sparse, mixed_rigidity(n, 90)] {
            let neighborhoods = Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex");
            for k in 0..n {
                let mut found = Vec::new();
                neighborhoods.for_each_edge(layout, k, |e| {
                    let [a, b] = layout.edges[e].map(|v| layout.to_caller[v as usize]);
                    found.push(mesh.edges().binary_search(&[a.min(b), a.max(b)]).expect("an edge of the mesh"));
                });
                found.sort_unstable();
                let caller = layout.to_caller[k];
                let expected = plain_neighborhood(&mesh, caller, rigidity.as_slice()[caller as usize]);
                assert_eq!(found, expected, "vertex {caller}, r to {}", rigidity.max());
                let runs = neighborhoods.runs(k);
                assert!(runs.is_sorted() && runs.iter().all(|[from, to]| from < to), "vertex {caller}: {runs:?}");
                assert!(runs.is_empty() == (rigidity.as_slice()[caller as usize] == 1 || caller as usize == n - 1));
            }
        }
    }

    #[test]
    fn more_runs_than_allowed_are_refused_while_searching() {
        let mesh = Arc::new(bumpy_sheet(23));
        let n = mesh.n_vertices();
        let analysis = Analysis::new(mesh, Weights::Uniform);
        let (r, all) = (vec![5; n], (0..n as u32).collect::<Vec<_>>());
        let up_to = |most: usize| {
            let mut ignore = |_| ControlFlow::Continue(());
            search(&analysis.layout, &r, &all, most, &Meter::new(5 * n as u64, &mut ignore))
        };
        let n_runs = up_to(usize::MAX).expect("no limit").iter().map(|batch| batch.runs.len()).sum::<usize>();
        assert!(up_to(n_runs).is_ok());
        assert_eq!(up_to(n_runs - 1).err(), Some(SolveError::TooLarge { what: "the set of neighborhoods" }));
    }
}
