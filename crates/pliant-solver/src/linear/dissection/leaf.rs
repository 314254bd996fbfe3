//! Pieces that are not cut: minimum degree.
//!
//! Elimination of v joins its neighbors to each other: adj(w) ∪= adj(v) for all w in adj(v). The vertex with the fewest
//! neighbors goes next. With adjacency as bit sets a step costs a few dozen instructions per neighbor, and the
//! surrounding vertices, which are eliminated later, are counted as neighbors too: without them the vertices at the rim
//! of a piece would seem cheaper than they are.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::amd;

use super::piece::Piece;
use super::{Graph, LEAF};

/// Words of a bit set.
const WORDS: usize = 4;
/// Vertices of a leaf and around it that fit. Those around it that do not fit are left out, which only costs quality.
const CAPACITY: usize = 64 * WORDS;

type Bits = [u64; WORDS];

fn insert(bits: &mut Bits, i: usize) {
    bits[i / 64] |= 1 << (i % 64);
}

fn count(bits: &Bits) -> u32 {
    bits.iter().map(|word| word.count_ones()).sum()
}

/// Numbers vertices by first appearance: an open hash table that is at most half full.
struct Numbering {
    slots: [(u32, u16); 2 * CAPACITY],
    len: usize,
}

impl Numbering {
    const EMPTY: u16 = u16::MAX;

    fn new() -> Numbering {
        Numbering { slots: [(0, Self::EMPTY); 2 * CAPACITY], len: 0 }
    }

    /// The number of `id`; a new one if there is room.
    fn number(&mut self, id: u32) -> Option<usize> {
        // Fibonacci hashing: the high bits of a multiple of 2³² / golden ratio.
        let mut slot = (id.wrapping_mul(2_654_435_769) >> 23) as usize % self.slots.len();
        while self.slots[slot].1 != Self::EMPTY {
            if self.slots[slot].0 == id {
                return Some(usize::from(self.slots[slot].1));
            }
            slot = (slot + 1) % self.slots.len();
        }
        if self.len == CAPACITY {
            return None;
        }
        self.slots[slot] = (id, self.len as u16);
        self.len += 1;
        Some(self.len - 1)
    }
}

/// Orders at most [`LEAF`] vertices of the graph, given by ascending `ids`.
pub(super) fn minimum_degree(graph: Graph<'_>, ids: &[u32], order: &mut [u32]) {
    let mut numbering = Numbering::new();
    for &id in ids {
        numbering.number(id);
    }
    let mut adjacent = [[0u64; WORDS]; LEAF];
    for (v, &id) in ids.iter().enumerate() {
        for &w in graph.neighbors(id as usize) {
            if let Some(w) = numbering.number(w)
                && w != v
            {
                insert(&mut adjacent[v], w);
            }
        }
    }
    const GONE: u32 = u32::MAX;
    let mut degree = [GONE; LEAF];
    for v in 0..ids.len() {
        degree[v] = count(&adjacent[v]);
    }
    for slot in order {
        let (mut v, mut least) = (0, GONE);
        for (w, &d) in degree[..ids.len()].iter().enumerate() {
            if d < least {
                (v, least) = (w, d);
            }
        }
        *slot = ids[v];
        degree[v] = GONE;
        let joined = adjacent[v];
        for (base, &word) in joined.iter().enumerate() {
            let mut word = word;
            while word != 0 {
                let w = 64 * base + word.trailing_zeros() as usize;
                word &= word - 1;
                if w >= ids.len() {
                    break;
                }
                let bits = &mut adjacent[w];
                (0..WORDS).for_each(|i| bits[i] |= joined[i]);
                bits[w / 64] &= !(1 << (w % 64));
                bits[v / 64] &= !(1 << (v % 64));
                degree[w] = count(bits);
            }
        }
    }
}

/// Orders a piece that could not be cut, however large.
pub(super) fn approximate_minimum_degree(piece: &Piece, order: &mut [u32]) {
    let graph = piece.graph();
    let n = piece.len();
    order.copy_from_slice(&piece.ids);
    let pattern = SymbolicSparseColMatRef::new_unsorted_checked(n, n, graph.offsets, None, graph.neighbors);
    let scratch = amd::order_maybe_unsorted_scratch::<u32>(n, graph.neighbors.len());
    let Ok(mut memory) = MemBuffer::try_new(scratch) else { return };
    let (mut forward, mut inverse) = (vec![0u32; n], vec![0u32; n]);
    let stack = MemStack::new(&mut memory);
    if amd::order_maybe_unsorted(&mut forward, &mut inverse, pattern, Default::default(), stack).is_ok() {
        order.iter_mut().zip(&forward).for_each(|(slot, &v)| *slot = piece.ids[v as usize]);
    }
}
