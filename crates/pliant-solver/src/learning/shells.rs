//! Nested neighborhoods, ring by ring: what N(k, r) has and N(k, r − 1) has not.
//!
//! | symbol | meaning |
//! |---|---|
//! | N(k, r) | edges with an end within r − 1 edges of k |
//! | shell of column 0 | N(k, r_min) |
//! | shell of column c | N(k, r_min + c) without N(k, r_min + c − 1): edges whose nearer end is exactly r_min + c − 1 edges from k |
//! | A(k, r) | sum of the areas of all vertices within r edges of k |
//!
//! Edges are taken two at a time, so a shell with an odd number of them gets one more without length, whose number is that
//! behind the last edge.
//!
//! A breadth-first search around k meets each edge once. All shells together are N(k, r_max), some 8.7 r² edges and four
//! bytes for each, so the lists are kept as long as they fit a budget, and otherwise searched for again in every pose.

use std::ops::RangeInclusive;

use crate::analysis::Layout;

/// Vertices whose shells are kept together, and between two reports of progress: about half a millisecond of work.
pub(crate) const BATCH: usize = 256;

/// Edges around the vertices of a batch.
#[derive(Default)]
pub(crate) struct Shells {
    /// Column c of the i-th vertex: `edges[bounds[i n_columns + c]..bounds[i n_columns + c + 1]]`.
    bounds: Vec<u32>,
    edges: Vec<u32>,
    n_columns: usize,
}

impl Shells {
    /// Edges of column `c` around the i-th vertex, two and two.
    #[inline(always)]
    pub(crate) fn pairs(&self, i: usize, c: usize) -> &[[u32; 2]] {
        let place = i * self.n_columns + c;
        self.edges[self.bounds[place] as usize..self.bounds[place + 1] as usize].as_chunks::<2>().0
    }

    pub(crate) fn n_edges(&self) -> usize {
        self.edges.len()
    }

    /// Gives back memory that was reserved for more.
    pub(crate) fn shrink(&mut self) {
        self.bounds.shrink_to_fit();
        self.edges.shrink_to_fit();
    }
}

/// Memory of breadth-first searches.
pub(crate) struct Search<'a> {
    layout: &'a Layout,
    /// Distance of each vertex that was met, [`FAR`] elsewhere.
    distance: Vec<u16>,
    met: Vec<u32>,
}

const FAR: u16 = u16::MAX;
/// More edges than this around the vertices of one batch are refused: half a gigabyte for each thread. At r = 100 there
/// are a sixth of it.
const MOST_EDGES: usize = 1 << 27;

/// The neighborhoods of a batch do not fit the memory.
#[derive(Debug)]
pub(crate) struct TooLarge;

impl<'a> Search<'a> {
    pub(crate) fn new(layout: &'a Layout) -> Search<'a> {
        Search { layout, distance: vec![FAR; layout.n_vertices()], met: Vec::new() }
    }

    /// The shells of consecutive vertices from `first` on, and their A(k, r), row by row; `areas` are those of single
    /// vertices.
    pub(crate) fn batch(
        &mut self,
        (first, n): (usize, usize),
        range: &RangeInclusive<u16>,
        areas: &[f64],
        (shells, sums): (&mut Shells, &mut [f64]),
    ) -> Result<(), TooLarge> {
        let n_columns = range.clone().count();
        shells.n_columns = n_columns;
        shells.edges.clear();
        shells.bounds.clear();
        shells.bounds.push(0);
        for (k, sums) in (first..first + n).zip(sums.chunks_mut(n_columns)) {
            self.around(k, range, areas, (shells, sums));
            if shells.edges.len() > MOST_EDGES {
                return Err(TooLarge);
            }
        }
        Ok(())
    }

    fn around(
        &mut self,
        k: usize,
        range: &RangeInclusive<u16>,
        areas: &[f64],
        (shells, sums): (&mut Shells, &mut [f64]),
    ) {
        let Search { layout, distance, met } = self;
        let edges = &mut shells.edges;
        distance[k] = 0;
        met.clear();
        met.push(k as u32);
        let (mut ring_first, mut area) = (0, areas[k]);
        let mut n_edges = edges.len();
        for r in 1..=*range.end() {
            // Vertices r − 1 edges away are known: the ring. It lists its edges and finds the next ring.
            let ring_end = met.len();
            let mut n_met = ring_end;
            for place in ring_first..ring_end {
                let v = met[place];
                let spokes = layout.spokes(v as usize);
                // What is not to be kept is written over: a question per spoke would be answered wrong half of the time
                // by a processor that guesses ahead, which made the search twice as long.
                met.resize(n_met + spokes.len(), 0);
                edges.resize(n_edges + spokes.len(), 0);
                for spoke in spokes {
                    let there = &mut distance[spoke.vertex as usize];
                    let (is_new, before) = (*there == FAR, *there);
                    *there = if is_new { r } else { before };
                    met[n_met] = spoke.vertex;
                    n_met += usize::from(is_new);
                    // An edge within the ring is met from both ends.
                    let is_within = (before == r - 1) & (v < spoke.vertex);
                    edges[n_edges] = spoke.edge;
                    n_edges += usize::from(is_new | (before == r) | is_within);
                }
            }
            met.truncate(n_met);
            edges.truncate(n_edges);
            ring_first = ring_end;
            area += met[ring_end..].iter().map(|&v| areas[v as usize]).sum::<f64>();
            if let Some(column) = r.checked_sub(*range.start()) {
                let before = shells.bounds.last().map_or(0, |&bound| bound as usize);
                if !(n_edges - before).is_multiple_of(2) {
                    edges.push(layout.n_edges() as u32);
                    n_edges += 1;
                }
                shells.bounds.push(n_edges as u32);
                sums[usize::from(column)] = area;
            }
        }
        met.iter().for_each(|&v| distance[v as usize] = FAR);
    }
}
