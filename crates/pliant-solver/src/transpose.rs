//! Which neighborhoods contain an edge: the transpose of M, for d = Mᵀ1 and Q_e = Σ_k M_ke R_k.
//!
//! A run [from, to) of vertex k adds R_k to every edge in it: plus at slot `from`, minus at slot `to`, then a running
//! sum along the block. The pluses and minuses are stored by slot, so that a block gathers them without any two
//! threads writing to the same place. What would be subtracted after the last edge of a block is left out.
//!
//! Lists of different lengths cost more in mispredicted branches than in sums. So those of a slot are cut into *steps*
//! of four entries, filled up with ones that count nothing, and a block is one plain loop over steps. Every slot has a
//! step.
//!
//! Entries of a slot ascend by vertex, whatever the order in which they came to be: sums over them have the same bits
//! after a repainting as after a new build. They lie in chunks of slots, of which a repainting writes only those anew
//! that it touches.

use std::ops::Range;

use rayon::prelude::*;

use crate::analysis::Layout;
use crate::neighborhoods::{Changes, Neighborhoods};
use crate::nines::{Eight, NinesRef};
use crate::search::{Batch, SOURCES};
use crate::wide::Wide;

/// Set in an entry that is subtracted.
const MINUS: u32 = 1 << 31;
/// An entry that counts nothing. The vertices of a mesh that fits memory are fewer.
const NOBODY: u32 = 1 << 30;
/// How the two highest bits of an entry count.
const SIGNS: [f64; 4] = [1.0, 0.0, -1.0, 0.0];

/// Entries that are added at once. With eight, more of them are empty than the loop gains.
const STEP: usize = 4;

/// Slots per chunk: as many as a block has, some hundred kilobytes at r = 10.
const SLOTS: usize = 2048;

/// Slots whose sums are kept at a time: few enough for the first cache.
pub(crate) const GROUP: usize = 64;

/// The ends of all runs, by slot. Memory: some 5 bytes per end and 8 per slot.
pub(crate) struct Transpose {
    chunks: Vec<Chunk>,
}

/// The ends at [`SLOTS`] consecutive slots.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Chunk {
    /// Steps of the i-th slot: `steps[offsets[i]..offsets[i + 1]]`.
    offsets: Vec<u32>,
    /// Vertex, with [`MINUS`] or without, ascending by vertex at each slot, then [`NOBODY`].
    steps: Vec<[u32; STEP]>,
    /// The slot of each step, in its group.
    slot_of: Vec<u8>,
}

/// Q of the slots of a group.
pub(crate) struct GroupSums {
    pub(crate) eights: [Eight; GROUP],
    pub(crate) ninths: [f64; GROUP],
}

impl GroupSums {
    pub(crate) fn zeros() -> GroupSums {
        GroupSums { eights: [Eight::ZERO; GROUP], ninths: [0.0; GROUP] }
    }
}

impl Transpose {
    /// O(number of runs and edges), in parallel.
    pub(crate) fn new(layout: &Layout, neighborhoods: &Neighborhoods) -> Transpose {
        if !neighborhoods.has_runs() {
            return Transpose { chunks: Vec::new() };
        }
        let closing = closing_slots(layout);
        let batches = neighborhoods.batches();
        let chunks = batches_by_chunk(n_chunks(layout), batches)
            .par_iter()
            .enumerate()
            .map_init(Vec::new, |ends, (c, touching)| {
                ends.clear();
                for &b in touching {
                    let members =
                        (0..batches[b].offsets.len() - 1).map(|i| ((b * SOURCES + i) as u32, batches[b].runs(i)));
                    members.for_each(|(k, runs)| collect_ends(k, runs, c, ends));
                }
                Chunk::of_ends(c, ends, &closing)
            })
            .collect();
        Transpose { chunks }
    }

    /// Whether there is nothing to sum.
    pub(crate) fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    /// The ends at a slot, each a vertex, with [`MINUS`] or without, ascending by vertex.
    fn entries(&self, slot: usize) -> impl Iterator<Item = u32> {
        self.chunks[slot / SLOTS].entries(slot % SLOTS)
    }

    /// Q of some slots of one group, slot s at place s % [`GROUP`], continuing the `running` sum.
    #[inline(always)]
    pub(crate) fn sum<W: Wide>(
        &self,
        wide: W,
        slots: Range<usize>,
        rotations: NinesRef<'_>,
        running: &mut (W::Eight, f64),
        sums: &mut GroupSums,
    ) {
        let chunk = &self.chunks[slots.start / SLOTS];
        let first = slots.start % SLOTS;
        let steps = chunk.offsets[first] as usize..chunk.offsets[first + slots.len()] as usize;
        let NinesRef { eights, ninths } = rotations.of_one_length();
        let (mut eight, mut ninth) = *running;
        for (step, &slot) in chunk.steps[steps.clone()].iter().zip(&chunk.slot_of[steps]) {
            let (mut one, mut one_ninth) = (wide.eight([0.0; 8]), 0.0);
            let (mut other, mut other_ninth) = (wide.eight([0.0; 8]), 0.0);
            for &[a, b] in step.as_chunks().0 {
                let (sign, k) = (SIGNS[(a >> 30) as usize], (a & !(MINUS | NOBODY)) as usize);
                one = wide.fma8(wide.eight(eights[k].0), wide.splat8(sign), one);
                one_ninth += ninths[k] * sign;
                let (sign, k) = (SIGNS[(b >> 30) as usize], (b & !(MINUS | NOBODY)) as usize);
                other = wide.fma8(wide.eight(eights[k].0), wide.splat8(sign), other);
                other_ninth += ninths[k] * sign;
            }
            eight = wide.add8(eight, wide.add8(one, other));
            ninth += one_ninth + other_ninth;
            let place = slot as usize % GROUP;
            (sums.eights[place], sums.ninths[place]) = (Eight(wide.array8(eight)), ninth);
        }
        *running = (eight, ninth);
    }

    /// The number of neighborhoods with runs that contain each edge of a block.
    pub(crate) fn counts(&self, layout: &Layout, block: usize) -> impl Iterator<Item = u32> {
        let mut running = 0i32;
        (layout.blocks[block] as usize..layout.blocks[block + 1] as usize).map(move |e| {
            if !self.is_empty() {
                running += self.entries(e + block).map(|entry| if entry & MINUS == 0 { 1 } else { -1 }).sum::<i32>();
            }
            running as u32
        })
    }

    /// Replaces the ends of changed vertices, whose old runs are still those of `old`. Returns, for every block, whether
    /// it may have changed.
    pub(crate) fn update(&mut self, layout: &Layout, old: &Neighborhoods, changes: &Changes) -> Vec<bool> {
        let closing = closing_slots(layout);
        let mut is_touched = vec![false; self.chunks.len()];
        let mut is_changed = vec![false; layout.n_vertices()];
        let mut ends = Vec::new();
        for (i, &k) in changes.vertices.iter().enumerate() {
            is_changed[k as usize] = true;
            old.runs(k as usize).iter().flatten().for_each(|&slot| is_touched[slot as usize / SLOTS] = true);
            for &[from, to] in changes.runs(i) {
                ends.push((from, k));
                if closing.binary_search(&to).is_err() {
                    ends.push((to, k | MINUS));
                }
            }
        }
        ends.sort_unstable_by_key(|&(slot, entry)| (slot, entry & !MINUS));
        ends.iter().for_each(|&(slot, _)| is_touched[slot as usize / SLOTS] = true);
        self.chunks.par_iter_mut().enumerate().filter(|(c, _)| is_touched[*c]).for_each(|(c, chunk)| {
            let first = ends.partition_point(|&(slot, _)| (slot as usize) < c * SLOTS);
            let end = ends.partition_point(|&(slot, _)| (slot as usize) < (c + 1) * SLOTS);
            *chunk = chunk.merged(c, &ends[first..end], &is_changed);
        });
        let bounds = layout.slot_bounds();
        let chunks_of = |block: usize| bounds[block] as usize / SLOTS..=(bounds[block + 1] as usize - 1) / SLOTS;
        (0..layout.n_blocks()).map(|block| chunks_of(block).any(|c| is_touched[c])).collect()
    }
}

impl Chunk {
    fn entries(&self, i: usize) -> impl Iterator<Item = u32> {
        let steps = &self.steps[self.offsets[i] as usize..self.offsets[i + 1] as usize];
        steps.as_flattened().iter().copied().filter(|&entry| entry != NOBODY)
    }

    /// Nobody at any slot, but room for so many.
    fn with_room(counts: &[u32]) -> Chunk {
        let mut offsets = vec![0u32];
        let mut slot_of = Vec::new();
        for (i, count) in counts.iter().enumerate() {
            let n = count.div_ceil(STEP as u32).max(1);
            offsets.push(offsets[i] + n);
            slot_of.extend((0..n).map(|_| (i % GROUP) as u8));
        }
        slot_of.shrink_to_fit();
        Chunk { steps: vec![[NOBODY; STEP]; slot_of.len()], offsets, slot_of }
    }

    /// Chunk `c` from its ends (slot, entry), those of one slot ascending by vertex.
    fn of_ends(c: usize, ends: &[(u32, u32)], closing: &[u32]) -> Chunk {
        let mut is_kept = [true; SLOTS];
        let first = closing.partition_point(|&slot| (slot as usize) < c * SLOTS);
        closing[first..]
            .iter()
            .map_while(|&slot| (slot as usize).checked_sub(c * SLOTS).filter(|&i| i < SLOTS))
            .for_each(|i| is_kept[i] = false);
        let place = |slot: u32| slot as usize % SLOTS;
        let mut counts = vec![0u32; SLOTS];
        for &(slot, _) in ends {
            counts[place(slot)] += u32::from(is_kept[place(slot)]);
        }
        let mut chunk = Chunk::with_room(&counts);
        let mut next: Vec<usize> = chunk.offsets.iter().map(|&step| step as usize * STEP).collect();
        let entries = chunk.steps.as_flattened_mut();
        for &(slot, entry) in ends.iter().filter(|&&(slot, _)| is_kept[place(slot)]) {
            let at = &mut next[place(slot)];
            entries[*at] = entry;
            *at += 1;
        }
        chunk
    }

    /// Chunk `c` without the changed vertices, but with their new ends, sorted by slot and vertex.
    fn merged(&self, c: usize, ends: &[(u32, u32)], is_changed: &[bool]) -> Chunk {
        let mut counts = Vec::with_capacity(SLOTS);
        let mut entries = Vec::with_capacity(self.steps.len() * STEP + ends.len());
        let mut fresh = ends.iter().peekable();
        for i in 0..SLOTS {
            let (slot, before) = ((c * SLOTS + i) as u32, entries.len());
            for entry in self.entries(i) {
                let k = entry & !MINUS;
                while let Some(&(_, fresh)) = fresh.next_if(|&&(at, fresh)| at == slot && fresh & !MINUS < k) {
                    entries.push(fresh);
                }
                if !is_changed[k as usize] {
                    entries.push(entry);
                }
            }
            while let Some(&(_, fresh)) = fresh.next_if(|&&(at, _)| at == slot) {
                entries.push(fresh);
            }
            counts.push((entries.len() - before) as u32);
        }
        let mut chunk = Chunk::with_room(&counts);
        let mut rest = &entries[..];
        for (i, &count) in counts.iter().enumerate() {
            let (mine, later) = rest.split_at(count as usize);
            let first = chunk.offsets[i] as usize * STEP;
            chunk.steps.as_flattened_mut()[first..first + mine.len()].copy_from_slice(mine);
            rest = later;
        }
        chunk
    }
}

fn n_chunks(layout: &Layout) -> usize {
    (layout.n_edges() + layout.n_blocks()).div_ceil(SLOTS)
}

/// The last slot of every block, ascending.
fn closing_slots(layout: &Layout) -> Vec<u32> {
    layout.slot_bounds()[1..].iter().map(|bound| bound - 1).collect()
}

/// For every chunk, the batches with runs in it, ascending.
fn batches_by_chunk(n_chunks: usize, batches: &[Batch]) -> Vec<Vec<usize>> {
    let touched = |batch: &Batch| {
        let mut is_touched = vec![false; n_chunks];
        // Slots of one run lie in one block, but may lie in two chunks.
        batch.runs.iter().flatten().for_each(|&slot| is_touched[slot as usize / SLOTS] = true);
        (0..n_chunks).filter(|&c| is_touched[c]).collect::<Vec<_>>()
    };
    let by_batch: Vec<Vec<usize>> = batches.par_iter().map(touched).collect();
    let mut by_chunk = vec![Vec::new(); n_chunks];
    for (b, chunks) in by_batch.iter().enumerate() {
        chunks.iter().for_each(|&c| by_chunk[c].push(b));
    }
    by_chunk
}

/// Appends those ends of the runs of vertex `k` that lie in chunk `c`.
fn collect_ends(k: u32, runs: &[[u32; 2]], c: usize, ends: &mut Vec<(u32, u32)>) {
    let slots = (c * SLOTS) as u32..((c + 1) * SLOTS) as u32;
    let first = runs.partition_point(|&[_, to]| to < slots.start);
    for &[from, to] in runs[first..].iter().take_while(|&&[from, _]| from < slots.end) {
        if from >= slots.start {
            ends.push((from, k));
        }
        if to < slots.end {
            ends.push((to, k | MINUS));
        }
    }
}

#[cfg(test)]
impl Transpose {
    /// Everything, for comparison bit by bit.
    pub(crate) fn contents(&self) -> Vec<(&[u32], &[[u32; STEP]])> {
        self.chunks.iter().map(|chunk| (&chunk.offsets[..], &chunk.steps[..])).collect()
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
        let analysis = Analysis::new(Arc::new(bumpy_sheet(43)), Weights::Uniform);
        let layout = &analysis.layout;
        assert!(n_chunks(layout) > 2, "a run should cross from one chunk to another");
        let neighborhoods =
            Neighborhoods::new(&analysis, &mixed_rigidity(layout.n_vertices(), 6)).expect("one size per vertex");
        let transpose = Transpose::new(layout, &neighborhoods);
        let counts: Vec<u32> = (0..layout.n_blocks()).flat_map(|block| transpose.counts(layout, block)).collect();
        let mut plain = vec![0; layout.n_edges()];
        for k in (0..layout.n_vertices()).filter(|&k| neighborhoods.r[k] > 1) {
            neighborhoods.for_each_edge(layout, k, |e| plain[e] += 1);
        }
        assert_eq!(counts, plain);
        assert_eq!(block_of_slot(layout, 0), 0);
    }

    #[test]
    fn entries_ascend_by_vertex_and_none_lies_behind_the_last_edge_of_a_block() {
        let analysis = Analysis::new(Arc::new(bumpy_sheet(43)), Weights::Uniform);
        let layout = &analysis.layout;
        let rigidity = mixed_rigidity(layout.n_vertices(), 9);
        let transpose = Transpose::new(layout, &Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex"));
        for slot in 0..layout.n_edges() + layout.n_blocks() {
            assert!(transpose.entries(slot).is_sorted_by(|a, b| a & !MINUS < b & !MINUS), "slot {slot}");
        }
        for slot in closing_slots(layout) {
            assert_eq!(transpose.entries(slot as usize).next(), None, "slot {slot}");
        }
    }
}
