//! Which neighborhoods contain an edge: the transpose of M, for d = Mᵀ1 and Q_e = Σ_k M_ke R_k.
//!
//! A run [from, to) of vertex k adds R_k to every edge in it: plus at slot `from`, minus at slot `to`, then a running
//! sum along the block. The pluses and minuses are stored by slot, so that a block gathers them without any two
//! threads writing to the same place. What would be subtracted after the last edge of a block is left out.
//!
//! Lists of different lengths cost more in mispredicted branches than in sums. So those of a slot are cut into *steps*
//! of four entries of one sign, filled up with a matrix of zeros, and a block is one plain loop over steps. Every slot
//! has a step.
//!
//! Entries of a slot, first those that are added, ascend by vertex, whatever the order in which they came to be: sums over them have the same bits
//! after a repainting as after a new build. They lie in chunks of slots, of which a repainting writes only those anew
//! that it touches.

use std::ops::Range;

use rayon::prelude::*;

use crate::analysis::Layout;
use crate::kernels::nines::{Eight, NinesRef};
use crate::kernels::wide::Wide;
use crate::rings::neighborhoods::{Changes, Neighborhoods};
use crate::rings::search::{Batch, SOURCES};

/// Set in an entry that is subtracted.
const MINUS: u32 = 1 << 31;
/// Set in the place of a step that is subtracted.
const MINUS_STEP: u8 = 1 << 7;
/// How steps count that are added, and that are subtracted.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// Entries that are added at once. At r = 10 an edge has some 13 of each sign, so that one in ten is empty.
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
    /// Vertices, ascending at each slot and sign, then `nobody`.
    steps: Vec<[u32; STEP]>,
    /// The slot of each step in its group, with [`MINUS_STEP`] or without.
    slot_of: Vec<u8>,
    /// The number of vertices.
    nobody: u32,
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
                Chunk::of_ends(c, ends, &closing, layout.n_vertices() as u32)
            })
            .collect();
        Transpose { chunks }
    }

    /// Whether there is nothing to sum.
    pub(crate) fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    /// The ends at a slot, each a vertex, with [`MINUS`] or without, ascending.
    #[cfg(test)]
    fn entries(&self, slot: usize) -> impl Iterator<Item = u32> {
        self.chunks[slot / SLOTS].entries(slot % SLOTS)
    }

    /// Q of some slots of one group, slot s at place s % [`GROUP`], continuing the `running` sum. After the last of the
    /// `rotations` there are zeros.
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
            let &[a, b, c, d] = step;
            let (a, b, c, d) = (a as usize, b as usize, c as usize, d as usize);
            let sign = SIGNS[usize::from(slot / MINUS_STEP)];
            let one = wide.add8(wide.eight(eights[a].0), wide.eight(eights[b].0));
            let other = wide.add8(wide.eight(eights[c].0), wide.eight(eights[d].0));
            eight = wide.fma8(wide.add8(one, other), wide.splat8(sign), eight);
            ninth += ((ninths[a] + ninths[b]) + (ninths[c] + ninths[d])) * sign;
            let place = usize::from(slot) % GROUP;
            (sums.eights[place], sums.ninths[place]) = (Eight(wide.array8(eight)), ninth);
        }
        *running = (eight, ninth);
    }

    /// The number of neighborhoods with runs that contain each edge of a block.
    pub(crate) fn counts(&self, layout: &Layout, block: usize) -> impl Iterator<Item = u32> {
        let mut running = 0i32;
        (layout.blocks[block] as usize..layout.blocks[block + 1] as usize).map(move |e| {
            if !self.is_empty() {
                let slot = e + block;
                running += self.chunks[slot / SLOTS].growth(slot % SLOTS);
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
        ends.sort_unstable();
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
        let steps = self.offsets[i] as usize..self.offsets[i + 1] as usize;
        self.steps[steps.clone()].iter().zip(&self.slot_of[steps]).flat_map(|(step, slot)| {
            let sign = u32::from(slot & MINUS_STEP) << 24;
            step.iter().filter(|&&k| k != self.nobody).map(move |&k| k | sign)
        })
    }

    /// By how much the number of neighborhoods grows at the i-th slot.
    fn growth(&self, i: usize) -> i32 {
        let steps = self.offsets[i] as usize..self.offsets[i + 1] as usize;
        let of_steps = self.steps[steps.clone()].iter().zip(&self.slot_of[steps]).map(|(step, slot)| {
            let n: i32 = step.iter().map(|&k| i32::from(k != self.nobody)).sum();
            if slot & MINUS_STEP == 0 { n } else { -n }
        });
        of_steps.sum()
    }

    /// Nobody at any slot, but room for so many of each sign.
    fn with_room(counts: &[[u32; 2]], nobody: u32) -> Chunk {
        let mut offsets = vec![0];
        let mut slot_of = Vec::new();
        for (i, [plus, minus]) in counts.iter().enumerate() {
            let n_minus = minus.div_ceil(STEP as u32);
            let n_plus = plus.div_ceil(STEP as u32).max(u32::from(n_minus == 0));
            let slot = (i % GROUP) as u8;
            slot_of.extend((0..n_plus).map(|_| slot));
            slot_of.extend((0..n_minus).map(|_| slot | MINUS_STEP));
            offsets.push(slot_of.len() as u32);
        }
        slot_of.shrink_to_fit();
        Chunk { steps: vec![[nobody; STEP]; slot_of.len()], offsets, slot_of, nobody }
    }

    /// The places for entries that are added and that are subtracted at the i-th slot.
    fn places(&self, i: usize) -> [usize; 2] {
        let steps = self.offsets[i] as usize..self.offsets[i + 1] as usize;
        let n_plus = self.slot_of[steps.clone()].iter().take_while(|&&slot| slot & MINUS_STEP == 0).count();
        [steps.start, steps.start + n_plus].map(|step| step * STEP)
    }

    /// Chunk `c` from its ends (slot, entry), those of one slot ascending by vertex.
    fn of_ends(c: usize, ends: &[(u32, u32)], closing: &[u32], nobody: u32) -> Chunk {
        let mut is_kept = [true; SLOTS];
        let first = closing.partition_point(|&slot| (slot as usize) < c * SLOTS);
        closing[first..]
            .iter()
            .map_while(|&slot| (slot as usize).checked_sub(c * SLOTS).filter(|&i| i < SLOTS))
            .for_each(|i| is_kept[i] = false);
        let place = |slot: u32| slot as usize % SLOTS;
        let mut counts = vec![[0; 2]; SLOTS];
        for &(slot, entry) in ends {
            counts[place(slot)][(entry >> 31) as usize] += u32::from(is_kept[place(slot)]);
        }
        let mut chunk = Chunk::with_room(&counts, nobody);
        let mut next: Vec<[usize; 2]> = (0..SLOTS).map(|i| chunk.places(i)).collect();
        let entries = chunk.steps.as_flattened_mut();
        for &(slot, entry) in ends.iter().filter(|&&(slot, _)| is_kept[place(slot)]) {
            let at = &mut next[place(slot)][(entry >> 31) as usize];
            entries[*at] = entry & !MINUS;
            *at += 1;
        }
        chunk
    }

    /// Chunk `c` without the changed vertices, but with their new ends, sorted by slot and entry.
    fn merged(&self, c: usize, ends: &[(u32, u32)], is_changed: &[bool]) -> Chunk {
        let mut counts = vec![[0; 2]; SLOTS];
        let mut entries = Vec::with_capacity(self.steps.len() * STEP + ends.len());
        let mut fresh = ends.iter().peekable();
        for (i, counts) in counts.iter_mut().enumerate() {
            let (slot, before) = ((c * SLOTS + i) as u32, entries.len());
            for entry in self.entries(i) {
                while let Some(&(_, fresh)) = fresh.next_if(|&&(at, fresh)| at == slot && fresh < entry) {
                    entries.push(fresh);
                }
                if !is_changed[(entry & !MINUS) as usize] {
                    entries.push(entry);
                }
            }
            while let Some(&(_, fresh)) = fresh.next_if(|&&(at, _)| at == slot) {
                entries.push(fresh);
            }
            entries[before..].iter().for_each(|entry| counts[(entry >> 31) as usize] += 1);
        }
        let mut chunk = Chunk::with_room(&counts, self.nobody);
        let mut rest = entries.iter().map(|entry| entry & !MINUS);
        for (i, counts) in counts.iter().enumerate() {
            for (first, &count) in chunk.places(i).into_iter().zip(counts) {
                let places = &mut chunk.steps.as_flattened_mut()[first..first + count as usize];
                places.iter_mut().zip(&mut rest).for_each(|(place, k)| *place = k);
            }
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
    use crate::rings::neighborhoods::block_of_slot;
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
    fn entries_ascend_and_none_lies_behind_the_last_edge_of_a_block() {
        let analysis = Analysis::new(Arc::new(bumpy_sheet(43)), Weights::Uniform);
        let layout = &analysis.layout;
        let rigidity = mixed_rigidity(layout.n_vertices(), 9);
        let transpose = Transpose::new(layout, &Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex"));
        for slot in 0..layout.n_edges() + layout.n_blocks() {
            assert!(transpose.entries(slot).is_sorted_by(|a, b| a < b), "slot {slot}");
        }
        for slot in closing_slots(layout) {
            assert_eq!(transpose.entries(slot as usize).next(), None, "slot {slot}");
        }
    }
}
