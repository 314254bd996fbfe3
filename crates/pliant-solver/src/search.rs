//! Neighborhoods of many vertices at once, a bit for each.
//!
//! Vertices that are neighbors have nearly the same neighborhoods. So up to [`SOURCES`] of them share one breadth-first
//! search, in which each vertex carries a word with a bit per source: a word moves along an edge in one operation. The
//! sources whose neighborhood contains edge (i, j) are then word(i) | word(j). Along ascending edges this changes in the
//! bits of those whose run begins or ends just there: the cost is that of the ends of runs, not of what is between.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::SolveError;
use crate::analysis::Layout;
use crate::edge_set::EdgeSet;
use crate::progress::Meter;

/// Vertices that share a search. Measured: with 64, searches at r = 10 take 1.6 times as long.
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
    /// Where a vertex is among those reached, or [`UNPLACED`].
    place: Vec<u32>,
    reached: Vec<Reached>,
    /// Places of vertices with sources that came by in the last and in this round.
    frontier: Vec<u32>,
    upcoming: Vec<u32>,
    edges: EdgeSet,
    /// (slot, source) of every end of a run, ascending by slot.
    ends: Vec<(u32, u32)>,
}

/// A vertex with the sources that have reached it: at all, in the last round, and in this one.
struct Reached {
    vertex: u32,
    all: Word,
    last: Word,
    now: Word,
}

impl<'a> Search<'a> {
    fn new(layout: &'a Layout) -> Search<'a> {
        Search {
            layout,
            place: vec![UNPLACED; layout.n_vertices()],
            reached: Vec::new(),
            frontier: Vec::new(),
            upcoming: Vec::new(),
            edges: EdgeSet::new(layout.n_edges()),
            ends: Vec::new(),
        }
    }

    fn batch(&mut self, r: &[u16], sources: &[u32]) -> Batch {
        self.grow(r, sources);
        self.find_ends();
        for reached in self.reached.drain(..) {
            self.place[reached.vertex as usize] = UNPLACED;
        }
        runs_by_source(sources.len(), &self.ends)
    }

    /// Finds all vertices within r − 1 edges of each source with r > 1.
    fn grow(&mut self, r: &[u16], sources: &[u32]) {
        let Search { layout, place, reached, frontier, upcoming, .. } = self;
        let mut by_size: Vec<(u16, usize)> =
            sources.iter().enumerate().map(|(bit, &k)| (r[k as usize], bit)).filter(|&(r, _)| r > 1).collect();
        by_size.sort_unstable();
        frontier.clear();
        let mut growing = EMPTY;
        for &(_, bit) in &by_size {
            growing[bit / 64] |= 1 << (bit % 64);
            let mut own = EMPTY;
            own[bit / 64] = 1 << (bit % 64);
            place[sources[bit] as usize] = reached.len() as u32;
            frontier.push(reached.len() as u32);
            reached.push(Reached { vertex: sources[bit], all: own, last: own, now: EMPTY });
        }
        let mut by_size = by_size.into_iter().peekable();
        for distance in 1u16.. {
            while let Some((_, bit)) = by_size.next_if(|&(r, _)| r <= distance) {
                growing[bit / 64] &= !(1 << (bit % 64));
            }
            spread(layout, place, reached, growing, (frontier, upcoming));
            frontier.iter().for_each(|&at| reached[at as usize].last = EMPTY);
            for &at in upcoming.iter() {
                let vertex = &mut reached[at as usize];
                vertex.all = or(vertex.all, vertex.now);
                vertex.last = std::mem::replace(&mut vertex.now, EMPTY);
            }
            std::mem::swap(frontier, upcoming);
            upcoming.clear();
            if frontier.is_empty() {
                return;
            }
        }
    }

    /// Lists where sources begin and end to contain edges, in ascending order.
    fn find_ends(&mut self) {
        let Search { layout, place, reached, edges, ends, .. } = self;
        for reached in reached.iter() {
            layout.spokes(reached.vertex as usize).iter().for_each(|spoke| edges.insert(spoke.edge));
        }
        let word = |vertex: u32| match place[vertex as usize] {
            UNPLACED => EMPTY,
            at => reached[at as usize].all,
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

/// One more edge for all sources that still grow.
fn spread(
    layout: &Layout,
    place: &mut [u32],
    reached: &mut Vec<Reached>,
    growing: Word,
    (frontier, upcoming): (&[u32], &mut Vec<u32>),
) {
    for &at in frontier {
        let moving = and(reached[at as usize].last, growing);
        if moving == EMPTY {
            continue;
        }
        for spoke in layout.spokes(reached[at as usize].vertex as usize) {
            let to = &mut place[spoke.vertex as usize];
            if *to == UNPLACED {
                *to = reached.len() as u32;
                upcoming.push(*to);
                reached.push(Reached { vertex: spoke.vertex, all: EMPTY, last: EMPTY, now: moving });
                continue;
            }
            let other = &mut reached[*to as usize];
            let fresh = and_not(moving, other.all);
            if fresh != EMPTY {
                if other.now == EMPTY {
                    upcoming.push(*to);
                }
                other.now = or(other.now, fresh);
            }
        }
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

#[inline]
fn or(a: Word, b: Word) -> Word {
    std::array::from_fn(|i| a[i] | b[i])
}

#[inline]
fn and(a: Word, b: Word) -> Word {
    std::array::from_fn(|i| a[i] & b[i])
}

#[inline]
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
