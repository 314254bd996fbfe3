//! Which neighborhoods contain an edge: the transpose of M, for d = Mᵀ1 and Q_e = Σ_k M_ke R_k.
//!
//! A run [from, to) of vertex k adds R_k to every edge in it: plus at slot `from`, minus at slot `to`, then a running
//! sum along the block. The pluses and minuses are stored by slot, so that a block gathers them without any two
//! threads writing to the same place. What would be subtracted after the last edge of a block is left out.

use crate::analysis::Layout;
use crate::neighborhoods::Neighborhoods;

/// Set in an entry that is subtracted.
const MINUS: u32 = 1 << 31;

/// The ends of all runs, by slot.
pub(crate) struct Transpose {
    /// Entries of slot s: `entries[offsets[s]..offsets[s + 1]]`.
    offsets: Vec<u32>,
    /// Vertex, with [`MINUS`] or without.
    entries: Vec<u32>,
}

impl Transpose {
    /// O(number of runs and edges).
    pub(crate) fn new(layout: &Layout, neighborhoods: &Neighborhoods) -> Transpose {
        if !neighborhoods.has_runs() {
            return Transpose { offsets: Vec::new(), entries: Vec::new() };
        }
        let n_slots = layout.n_edges() + layout.n_blocks();
        let mut is_last = vec![false; n_slots];
        for block in 0..layout.n_blocks() {
            is_last[layout.blocks[block + 1] as usize + block] = true;
        }
        let mut offsets = vec![0u32; n_slots + 1];
        let ends = || {
            (0..layout.n_vertices()).flat_map(|k| {
                neighborhoods.runs(k).iter().flat_map(move |&[from, to]| [(from, k as u32), (to, k as u32 | MINUS)])
            })
        };
        for (slot, _) in ends().filter(|&(slot, _)| !is_last[slot as usize]) {
            offsets[slot as usize + 1] += 1;
        }
        for slot in 0..n_slots {
            offsets[slot + 1] += offsets[slot];
        }
        let mut next = offsets.clone();
        let mut entries = vec![0u32; offsets[n_slots] as usize];
        for (slot, entry) in ends().filter(|&(slot, _)| !is_last[slot as usize]) {
            entries[next[slot as usize] as usize] = entry;
            next[slot as usize] += 1;
        }
        Transpose { offsets, entries }
    }

    /// Whether there is nothing to sum.
    pub(crate) fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Calls `plus(k)` or `minus(k)` for every run that begins or ends at a slot.
    #[inline]
    pub(crate) fn at(&self, slot: usize, mut f: impl FnMut(usize, bool)) {
        for &entry in &self.entries[self.offsets[slot] as usize..self.offsets[slot + 1] as usize] {
            f((entry & !MINUS) as usize, entry & MINUS == 0);
        }
    }

    /// d_e: how many neighborhoods contain each edge.
    pub(crate) fn counts(&self, layout: &Layout, r: &[u16]) -> Vec<f64> {
        let mut counts = Vec::with_capacity(layout.n_edges());
        for block in 0..layout.n_blocks() {
            let mut running = 0i64;
            for e in layout.blocks[block] as usize..layout.blocks[block + 1] as usize {
                if !self.is_empty() {
                    self.at(e + block, |_, plus| running += if plus { 1 } else { -1 });
                }
                let own = layout.edges[e].iter().filter(|&&end| r[end as usize] == 1).count() as i64;
                counts.push((running + own) as f64);
            }
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::neighborhoods::block_of_slot;
    use crate::test_support::{bumpy_sheet, mixed_rigidity};
    use crate::{Analysis, Weights};

    #[test]
    fn counts_by_running_sums_are_those_of_plain_membership() {
        let analysis = Analysis::new(Arc::new(bumpy_sheet(23)), Weights::Uniform);
        let layout = &analysis.layout;
        let neighborhoods =
            Neighborhoods::new(&analysis, &mixed_rigidity(layout.n_vertices(), 6)).expect("one size per vertex");
        let counts = Transpose::new(layout, &neighborhoods).counts(layout, &neighborhoods.r);
        let mut plain = vec![0.0; layout.n_edges()];
        for k in 0..layout.n_vertices() {
            neighborhoods.for_each_edge(layout, k, |e| plain[e] += 1.0);
        }
        assert_eq!(counts, plain);
        assert_eq!(block_of_slot(layout, 0), 0);
    }
}
