//! The ends at some consecutive slots, in steps of four of one kind.

use std::ops::Range;

use super::GROUP;

/// Kinds of entries: what is added or subtracted from a slot on, and what is taken from one edge alone.
pub(super) const PLUS: usize = 0;
pub(super) const MINUS: usize = 1;
pub(super) const HOLE: usize = 2;
const KINDS: usize = 3;
/// Where in an entry its kind begins, above the vertex. Meshes have fewer than 2³⁰ vertices: their edges alone would
/// fill a hundred gigabytes.
const KIND: u32 = 30;
/// Set in the place of a step that is subtracted.
pub(super) const MINUS_STEP: u8 = 1 << 7;

/// Entries that are added at once. At r = 10 an edge has some 8 of each sign and, if it is the side of a strip, 14
/// holes, so that one in nine is empty.
pub(super) const STEP: usize = 4;

/// Slots per chunk: as many as a block has, some hundred kilobytes at r = 10.
pub(super) const SLOTS: usize = 2048;

/// The ends at [`SLOTS`] consecutive slots.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Chunk {
    /// What is added or subtracted; at least one step per slot.
    pub(super) ends: Steps,
    pub(super) holes: Steps,
    /// The number of vertices.
    nobody: u32,
}

/// Steps of consecutive slots.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Steps {
    /// Steps of the i-th slot: `steps[offsets[i]..offsets[i + 1]]`.
    offsets: Vec<u32>,
    /// Vertices, ascending at each slot and kind, then `nobody`.
    pub(super) steps: Vec<[u32; STEP]>,
    /// The slot of each step in its group, with [`MINUS_STEP`] or without.
    slot_of: Vec<u8>,
}

impl Steps {
    fn new() -> Steps {
        Steps { offsets: vec![0], steps: Vec::new(), slot_of: Vec::new() }
    }

    /// Appends a slot with so many empty steps, some added and then some subtracted.
    fn push_slot(&mut self, [n_plus, n_minus]: [u32; 2], nobody: u32) {
        let slot = ((self.offsets.len() - 1) % GROUP) as u8;
        self.slot_of.extend((0..n_plus).map(|_| slot));
        self.slot_of.extend((0..n_minus).map(|_| slot | MINUS_STEP));
        self.steps.resize(self.slot_of.len(), [nobody; STEP]);
        self.offsets.push(self.slot_of.len() as u32);
    }

    /// The steps of some slots, with where each belongs.
    #[inline(always)]
    pub(super) fn at(&self, slots: Range<usize>) -> impl Iterator<Item = (&[u32; STEP], u8)> {
        let steps = self.offsets[slots.start] as usize..self.offsets[slots.end] as usize;
        self.steps[steps.clone()].iter().zip(self.slot_of[steps].iter().copied())
    }
}

impl Chunk {
    pub(super) fn entries(&self, i: usize) -> impl Iterator<Item = u32> {
        let ends = self.ends.at(i..i + 1).map(|(step, slot)| (step, usize::from(slot / MINUS_STEP)));
        let holes = self.holes.at(i..i + 1).map(|(step, _)| (step, HOLE));
        ends.chain(holes)
            .flat_map(|(step, kind)| step.iter().filter(|&&k| k != self.nobody).map(move |&k| entry(k, kind)))
    }

    /// By how much the number of neighborhoods grows at the i-th slot, and how many do without its edge alone.
    pub(super) fn growth(&self, i: usize) -> (i32, i32) {
        let (mut growth, mut n_holes) = (0, 0);
        for entry in self.entries(i) {
            match kind_of(entry) {
                PLUS => growth += 1,
                MINUS => growth -= 1,
                _ => n_holes += 1,
            }
        }
        (growth, n_holes)
    }

    /// Nobody at any slot, but room for so many of each kind.
    fn with_room(counts: &[[u32; KINDS]], nobody: u32) -> Chunk {
        let (mut ends, mut holes) = (Steps::new(), Steps::new());
        for counts in counts {
            let [n_plus, n_minus, n_holes] = counts.map(|n| n.div_ceil(STEP as u32));
            ends.push_slot([n_plus.max(u32::from(n_minus == 0)), n_minus], nobody);
            holes.push_slot([n_holes, 0], nobody);
        }
        for Steps { steps, slot_of, .. } in [&mut ends, &mut holes] {
            steps.shrink_to_fit();
            slot_of.shrink_to_fit();
        }
        Chunk { ends, holes, nobody }
    }

    /// The places for entries of each kind at the i-th slot.
    fn places(&self, i: usize) -> [usize; KINDS] {
        let first = self.ends.offsets[i] as usize;
        let n_plus = self.ends.at(i..i + 1).take_while(|&(_, slot)| slot & MINUS_STEP == 0).count();
        [first, first + n_plus, self.holes.offsets[i] as usize].map(|step| step * STEP)
    }

    /// Puts an entry where there is a place for it.
    fn put(&mut self, entry: u32, place: usize) {
        let steps = if kind_of(entry) == HOLE { &mut self.holes.steps } else { &mut self.ends.steps };
        steps.as_flattened_mut()[place] = vertex_of(entry);
    }

    /// A chunk from its ends (slot, entry), those of one slot ascending by vertex.
    pub(super) fn of_ends(ends: &[(u32, u32)], nobody: u32) -> Chunk {
        let place = |slot: u32| slot as usize % SLOTS;
        let mut counts = vec![[0; KINDS]; SLOTS];
        for &(slot, entry) in ends {
            counts[place(slot)][kind_of(entry)] += 1;
        }
        let mut chunk = Chunk::with_room(&counts, nobody);
        let mut next: Vec<[usize; KINDS]> = (0..SLOTS).map(|i| chunk.places(i)).collect();
        for &(slot, entry) in ends {
            let at = &mut next[place(slot)][kind_of(entry)];
            chunk.put(entry, *at);
            *at += 1;
        }
        chunk
    }

    /// Chunk `c` without the changed vertices, but with their new ends, sorted by slot and entry.
    pub(super) fn merged(&self, c: usize, ends: &[(u32, u32)], is_changed: &[bool]) -> Chunk {
        let mut merged = Vec::with_capacity(self.ends.steps.len() * STEP + ends.len());
        let mut fresh = ends.iter().peekable();
        for slot in (c * SLOTS) as u32..((c + 1) * SLOTS) as u32 {
            for entry in self.entries(slot as usize % SLOTS) {
                while let Some(&end) = fresh.next_if(|&&(at, fresh)| at == slot && fresh < entry) {
                    merged.push(end);
                }
                if !is_changed[vertex_of(entry) as usize] {
                    merged.push((slot, entry));
                }
            }
            while let Some(&end) = fresh.next_if(|&&(at, _)| at == slot) {
                merged.push(end);
            }
        }
        Chunk::of_ends(&merged, self.nobody)
    }
}

pub(super) fn entry(k: u32, kind: usize) -> u32 {
    k | (kind as u32) << KIND
}

fn kind_of(entry: u32) -> usize {
    (entry >> KIND) as usize
}

fn vertex_of(entry: u32) -> u32 {
    entry & ((1 << KIND) - 1)
}
