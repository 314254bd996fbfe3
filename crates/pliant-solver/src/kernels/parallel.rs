//! Data-parallel loops whose results do not depend on the number of threads: work is cut at fixed places and partial
//! sums are added in a fixed order.

use std::ops::Range;

/// Items per piece of a loop over vertices or edges: some tens of microseconds of work.
pub(crate) const CHUNK: usize = 512;
/// Below this many items a second thread costs more than it brings (measured at a few thousand vertices).
const WORTH_SHARING: usize = 4096;

/// Whether a loop over `n` items is shared between threads.
pub(crate) fn is_worth_sharing(n: usize) -> bool {
    n >= WORTH_SHARING
}

/// Runs `f`, which has many loops over `n` items, on one of the threads that share them: handing over once costs less
/// than handing over every loop.
pub(crate) fn on_pool<T: Send>(n: usize, f: impl FnOnce() -> T + Send) -> T {
    if is_worth_sharing(n) && rayon::current_thread_index().is_none() { rayon::scope(|_| f()) } else { f() }
}

/// Slices that are cut together.
pub(crate) trait Cut: Sized + Send {
    /// The first `at` items, and the others.
    fn cut(self, at: usize) -> (Self, Self);
}

impl<T: Send> Cut for &mut [T] {
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at_mut(at)
    }
}

impl<A: Cut, B: Cut> Cut for (A, B) {
    fn cut(self, at: usize) -> (Self, Self) {
        let (a, b) = (self.0.cut(at), self.1.cut(at));
        ((a.0, b.0), (a.1, b.1))
    }
}

impl<A: Cut, B: Cut, C: Cut> Cut for (A, B, C) {
    fn cut(self, at: usize) -> (Self, Self) {
        let (a, b, c) = (self.0.cut(at), self.1.cut(at), self.2.cut(at));
        ((a.0, b.0, c.0), (a.1, b.1, c.1))
    }
}

/// Calls `f(first item, chunk)` for consecutive chunks of [`CHUNK`] items.
pub(crate) fn chunks<T: Send>(items: &mut [T], f: impl Fn(usize, &mut [T]) + Sync) {
    let bounds = Bounds::Chunks(items.len());
    let grain = bounds.grain();
    split(&bounds, 0..bounds.n_pieces(), items, None, grain, &|c, chunk| {
        f(c * CHUNK, chunk);
        0.0
    });
}

/// As [`chunks`] over `n` items of some slices, with a result per chunk; `results` must have an entry for each.
pub(crate) fn chunks_with<A: Cut, T: Send>(n: usize, items: A, results: &mut [T], f: impl Fn(usize, A) -> T + Sync) {
    let bounds = Bounds::Chunks(n);
    let results = &mut results[..bounds.n_pieces()];
    split(&bounds, 0..bounds.n_pieces(), items, Some(results), bounds.grain(), &|c, chunk| f(c * CHUNK, chunk));
}

/// Calls `f(piece, items[bounds[piece]..bounds[piece + 1]])` for every piece of some slices. `bounds` ascend from 0 to the
/// number of items; `results` must have an entry per piece.
pub(crate) fn pieces_with<A: Cut, T: Send>(
    bounds: &[u32],
    items: A,
    results: &mut [T],
    f: impl Fn(usize, A) -> T + Sync,
) {
    let bounds = Bounds::Listed(bounds);
    let results = &mut results[..bounds.n_pieces()];
    split(&bounds, 0..bounds.n_pieces(), items, Some(results), bounds.grain(), &f);
}

/// As [`pieces_with`], without results.
pub(crate) fn pieces<A: Cut>(bounds: &[u32], items: A, f: impl Fn(usize, A) + Sync) {
    let bounds = Bounds::Listed(bounds);
    split(&bounds, 0..bounds.n_pieces(), items, None, bounds.grain(), &|piece, items| {
        f(piece, items);
        0.0
    });
}

/// Where items are cut.
enum Bounds<'a> {
    Chunks(usize),
    Listed(&'a [u32]),
}

impl Bounds<'_> {
    fn n_pieces(&self) -> usize {
        match self {
            Bounds::Chunks(n) => n.div_ceil(CHUNK),
            Bounds::Listed(bounds) => bounds.len() - 1,
        }
    }

    fn first(&self, piece: usize) -> usize {
        match self {
            Bounds::Chunks(n) => (piece * CHUNK).min(*n),
            Bounds::Listed(bounds) => bounds[piece] as usize,
        }
    }

    /// Items that one thread takes at once.
    fn grain(&self) -> usize {
        if is_worth_sharing(self.first(self.n_pieces())) { CHUNK } else { usize::MAX }
    }
}

fn split<A: Cut, T: Send>(
    bounds: &Bounds<'_>,
    range: Range<usize>,
    items: A,
    results: Option<&mut [T]>,
    grain: usize,
    f: &(impl Fn(usize, A) -> T + Sync),
) {
    let Range { start, end } = range;
    if end - start > 1 && bounds.first(end) - bounds.first(start) > grain {
        let middle = start.midpoint(end);
        let (left, right) = items.cut(bounds.first(middle) - bounds.first(start));
        let (left_results, right_results) = results.map(|results| results.split_at_mut(middle - start)).unzip();
        rayon::join(
            || split(bounds, start..middle, left, left_results, grain, f),
            || split(bounds, middle..end, right, right_results, grain, f),
        );
        return;
    }
    let mut rest = items;
    let mut results = results.map(|results| results.iter_mut());
    for piece in start..end {
        let (head, tail) = rest.cut(bounds.first(piece + 1) - bounds.first(piece));
        let result = f(piece, head);
        if let Some(place) = results.as_mut().and_then(Iterator::next) {
            *place = result;
        }
        rest = tail;
    }
}
