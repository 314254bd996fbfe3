//! Which neighborhoods contain an edge: the transpose of M, for d = Mᵀ1 and Q_e = Σ_k M_ke R_k.
//!
//! A run [from, to) of vertex k adds R_k to every edge in it: plus at slot `from`, minus at slot `to`, then a running
//! sum along the block. The pluses and minuses are stored by slot, so that a block gathers them without any two
//! threads writing to the same place. What would be subtracted after the last edge of a block is left out.
//!
//! Where the rim of a neighborhood follows a strip of faces, it leaves out every third edge or so: the side of the
//! strip that lies outside. Such a *hole* of one edge between two runs is no minus followed by a plus, but R_k taken
//! from Q of that edge alone, one sum instead of two. At r = 10 a vertex has 14 holes among 38 runs, so that it takes 61
//! sums in place of 76; at r = 20 127 in place of 157. (For S, the other way round, single edges gain nothing: they would
//! need an array of their own, and loops as short as a vertex has holes are mispredicted.)
//!
//! Lists of different lengths cost more in mispredicted branches than in sums. So those of a slot are cut into *steps*
//! of four entries of one kind, filled up with a matrix of zeros, and a block is one plain loop over steps. Every slot
//! has a step.
//!
//! Entries of a slot, kind by kind, ascend by vertex, whatever the order in which they came to be: sums over them have
//! the same bits after a repainting as after a new build. They lie in chunks of slots, of which a repainting writes only
//! those anew that it touches.

mod chunk;

use std::ops::Range;

use chunk::{Chunk, HOLE, MINUS, MINUS_STEP, PLUS, SLOTS, STEP, entry};
use rayon::prelude::*;

use crate::analysis::Layout;
use crate::kernels::nines::{Eight, NinesRef};
use crate::kernels::wide::Wide;
use crate::rings::neighborhoods::{Changes, Neighborhoods};
use crate::rings::search::{Batch, SOURCES};

/// How steps count that are added, and that are subtracted.
const SIGNS: [f64; 2] = [1.0, -1.0];

/// Slots whose sums are kept at a time: few enough for the first cache.
pub(crate) const GROUP: usize = 64;

/// The ends of all runs, by slot. Memory: some 5 bytes per entry and 12 per slot.
#[cfg_attr(test, derive(PartialEq))]
pub(crate) struct Transpose {
    chunks: Vec<Chunk>,
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
        let is_closing = closing_slots(layout);
        let batches = neighborhoods.batches();
        let chunks = batches_by_chunk(n_chunks(layout), batches)
            .par_iter()
            .enumerate()
            .map_init(Vec::new, |ends, (c, touching)| {
                ends.clear();
                let slots = (c * SLOTS) as u32..((c + 1) * SLOTS) as u32;
                for &b in touching {
                    for i in 0..batches[b].offsets.len() - 1 {
                        let k = (b * SOURCES + i) as u32;
                        list_ends((k, batches[b].runs(i)), &slots, &is_closing, ends);
                    }
                }
                Chunk::of_ends(ends, layout.n_vertices() as u32)
            })
            .collect();
        Transpose { chunks }
    }

    /// Whether there is nothing to sum.
    pub(crate) fn is_empty(&self) -> bool {
        self.chunks.is_empty()
    }

    /// The entries at a slot, each a vertex below a kind, ascending.
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
        let rotations = rotations.of_one_length();
        let (mut eight, mut ninth) = *running;
        for (step, slot) in chunk.ends.at(first..first + slots.len()) {
            let sign = SIGNS[usize::from(slot / MINUS_STEP)];
            let (four, ninth_of_four) = sum_of(wide, rotations, step);
            eight = wide.fma8(four, wide.splat8(sign), eight);
            ninth += ninth_of_four * sign;
            let place = usize::from(slot) % GROUP;
            (sums.eights[place], sums.ninths[place]) = (Eight(wide.array8(eight)), ninth);
        }
        for (step, slot) in chunk.holes.at(first..first + slots.len()) {
            let (four, ninth_of_four) = sum_of(wide, rotations, step);
            let place = usize::from(slot) % GROUP;
            let before = wide.eight(sums.eights[place].0);
            sums.eights[place] = Eight(wide.array8(wide.sub8(before, four)));
            sums.ninths[place] -= ninth_of_four;
        }
        *running = (eight, ninth);
    }

    /// The number of neighborhoods with runs that contain each edge of a block.
    pub(crate) fn counts(&self, layout: &Layout, block: usize) -> impl Iterator<Item = u32> {
        let mut running = 0;
        (layout.blocks[block] as usize..layout.blocks[block + 1] as usize).map(move |e| {
            let slot = e + block;
            let (growth, n_holes) = self.chunks.get(slot / SLOTS).map_or((0, 0), |chunk| chunk.growth(slot % SLOTS));
            running += growth;
            (running - n_holes) as u32
        })
    }

    /// Replaces the ends of changed vertices, whose old runs are still those of `old`. Returns, for every block, whether
    /// it may have changed.
    pub(crate) fn update(&mut self, layout: &Layout, old: &Neighborhoods, changes: &Changes) -> Vec<bool> {
        let is_closing = closing_slots(layout);
        let mut is_touched = vec![false; self.chunks.len()];
        let mut is_changed = vec![false; layout.n_vertices()];
        let mut ends = Vec::new();
        for (i, &k) in changes.vertices.iter().enumerate() {
            is_changed[k as usize] = true;
            old.runs(k as usize).iter().flatten().for_each(|&slot| is_touched[slot as usize / SLOTS] = true);
            list_ends((k, changes.runs(i)), &(0..u32::MAX), &is_closing, &mut ends);
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

/// The sum of the matrices of a step.
#[inline(always)]
fn sum_of<W: Wide>(wide: W, rotations: NinesRef<'_>, &[a, b, c, d]: &[u32; STEP]) -> (W::Eight, f64) {
    let NinesRef { eights, ninths } = rotations;
    let (a, b, c, d) = (a as usize, b as usize, c as usize, d as usize);
    let one = wide.add8(wide.eight(eights[a].0), wide.eight(eights[b].0));
    let other = wide.add8(wide.eight(eights[c].0), wide.eight(eights[d].0));
    (wide.add8(one, other), (ninths[a] + ninths[b]) + (ninths[c] + ninths[d]))
}

fn n_chunks(layout: &Layout) -> usize {
    (layout.n_edges() + layout.n_blocks()).div_ceil(SLOTS)
}

/// Whether a slot is the last of its block, which has no edge.
fn closing_slots(layout: &Layout) -> Vec<bool> {
    let mut is_closing = vec![false; layout.n_edges() + layout.n_blocks()];
    layout.slot_bounds()[1..].iter().for_each(|&bound| is_closing[bound as usize - 1] = true);
    is_closing
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

/// Appends the entries of the runs of vertex `k` that lie in some slots.
fn list_ends((k, runs): (u32, &[[u32; 2]]), slots: &Range<u32>, is_closing: &[bool], ends: &mut Vec<(u32, u32)>) {
    // The slot after the last edge of a block is followed by the first edge of the next.
    let is_hole = |before: Option<&[u32; 2]>, after: Option<&[u32; 2]>| match (before, after) {
        (Some(&[_, to]), Some(&[from, _])) => to + 1 == from && !is_closing[to as usize],
        _ => false,
    };
    let first = runs.partition_point(|&[_, to]| to < slots.start);
    let mut follows_hole = first > 0 && is_hole(runs.get(first - 1), runs.get(first));
    for (i, &[from, to]) in (first..).zip(&runs[first..]).take_while(|(_, [from, _])| *from < slots.end) {
        if from >= slots.start && !follows_hole {
            ends.push((from, entry(k, PLUS)));
        }
        follows_hole = is_hole(runs.get(i), runs.get(i + 1));
        if to < slots.end && !is_closing[to as usize] {
            ends.push((to, entry(k, if follows_hole { HOLE } else { MINUS })));
        }
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
        assert!(transpose.chunks.iter().all(|chunk| !chunk.holes.steps.is_empty()), "there should be holes");
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
        for (slot, _) in closing_slots(layout).iter().enumerate().filter(|(_, is_closing)| **is_closing) {
            assert_eq!(transpose.entries(slot).next(), None, "slot {slot}");
        }
    }
}
