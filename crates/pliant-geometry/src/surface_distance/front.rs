//! Vertices that a front has been offered, the nearest first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A heap of distance and vertex in one number each. A distance counts in single precision here, ten times finer than what
/// is worth passing on, and those that are the same go by the number of the vertex.
#[derive(Clone, Debug, Default)]
pub(super) struct Front {
    heap: BinaryHeap<Reverse<u64>>,
}

impl Front {
    /// How a distance is compared. Bits of numbers that are not negative ascend with them.
    pub(super) fn key(distance: f64) -> u32 {
        (distance as f32).to_bits()
    }

    pub(super) fn push(&mut self, distance: f64, v: u32) {
        self.heap.push(Reverse(u64::from(Front::key(distance)) << 32 | u64::from(v)));
    }

    /// The nearest, with its key.
    pub(super) fn pop(&mut self) -> Option<(u32, u32)> {
        self.heap.pop().map(|Reverse(both)| ((both >> 32) as u32, both as u32))
    }

    pub(super) fn clear(&mut self) {
        self.heap.clear();
    }
}
