//! Data-parallel loops whose results do not depend on the number of threads: work is cut at fixed places and partial
//! sums are added in a fixed order.

use rayon::prelude::*;

/// Items per piece of a loop over vertices or edges: some tens of microseconds of work.
pub(crate) const CHUNK: usize = 1024;
/// Below this many items a second thread costs more than it brings (measured at a few thousand vertices).
const WORTH_SHARING: usize = 4096;

/// Whether a loop over `n` items is shared between threads.
pub(crate) fn is_worth_sharing(n: usize) -> bool {
    n >= WORTH_SHARING
}

/// Calls `f(first item, chunk)` for consecutive chunks of [`CHUNK`] items.
pub(crate) fn chunks<T: Send>(items: &mut [T], f: impl Fn(usize, &mut [T]) + Sync) {
    if is_worth_sharing(items.len()) {
        items.par_chunks_mut(CHUNK).enumerate().for_each(|(c, chunk)| f(c * CHUNK, chunk));
    } else {
        items.chunks_mut(CHUNK).enumerate().for_each(|(c, chunk)| f(c * CHUNK, chunk));
    }
}

/// As [`chunks`] over two lists of equal length, with a number per chunk; returns their sum in order.
/// `partial` must have an entry per chunk.
pub(crate) fn chunks_summed<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    partial: &mut [f64],
    f: impl Fn(usize, &mut [A], &mut [B]) -> f64 + Sync,
) -> f64 {
    debug_assert!(a.len() == b.len() && partial.len() >= a.len().div_ceil(CHUNK));
    let partial = &mut partial[..a.len().div_ceil(CHUNK)];
    if is_worth_sharing(a.len()) {
        let both = a.par_chunks_mut(CHUNK).zip(b.par_chunks_mut(CHUNK));
        both.zip(partial.par_iter_mut()).enumerate().for_each(|(c, ((a, b), sum))| *sum = f(c * CHUNK, a, b));
    } else {
        let both = a.chunks_mut(CHUNK).zip(b.chunks_mut(CHUNK));
        both.zip(partial.iter_mut()).enumerate().for_each(|(c, ((a, b), sum))| *sum = f(c * CHUNK, a, b));
    }
    partial.iter().sum()
}

/// Calls `f(piece, &mut items[bounds[piece]..bounds[piece + 1]])` for every piece. `bounds` ascend from 0 to the number
/// of items.
pub(crate) fn pieces<T: Send>(bounds: &[u32], items: &mut [T], f: &(impl Fn(usize, &mut [T]) + Sync)) {
    let grain = if is_worth_sharing(items.len()) { CHUNK } else { usize::MAX };
    split_pieces(bounds, 0, bounds.len() - 1, items, grain, f);
}

fn split_pieces<T: Send>(
    bounds: &[u32],
    from: usize,
    to: usize,
    items: &mut [T],
    grain: usize,
    f: &(impl Fn(usize, &mut [T]) + Sync),
) {
    if to - from > 1 && items.len() > grain {
        let middle = from.midpoint(to);
        let (left, right) = items.split_at_mut((bounds[middle] - bounds[from]) as usize);
        rayon::join(
            || split_pieces(bounds, from, middle, left, grain, f),
            || split_pieces(bounds, middle, to, right, grain, f),
        );
        return;
    }
    let mut rest = items;
    for piece in from..to {
        let (head, tail) = rest.split_at_mut((bounds[piece + 1] - bounds[piece]) as usize);
        f(piece, head);
        rest = tail;
    }
}
