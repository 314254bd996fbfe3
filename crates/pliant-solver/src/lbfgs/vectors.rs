//! The large half of L-BFGS: three passes over memory per step, shared among threads, with sums in a fixed order.

use glam::DVec3;
use rayon::prelude::*;

use super::history::{Direction, PAIRS, Products};
use crate::kernels::parallel::{CHUNK, is_worth_sharing};
use crate::kernels::quad::Quad;

/// What one vertex remembers: s and w of every slot, side by side. Half the digits are plenty for a direction, and
/// memory is what these passes wait for.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub(super) struct Record([[[f32; 4]; 2]; PAIRS]);

/// Products of one chunk: f·s and f·w of every slot, f·v_before.
pub(super) type Partial = [[f64; 4]; 2 * PAIRS + 1];

/// The items of chunk `c`.
fn chunk<T>(items: &[T], c: usize) -> &[T] {
    &items[c * CHUNK..items.len().min((c + 1) * CHUNK)]
}

/// f with every s and w, and with `v_before`. `f` is copied to `f_kept`.
pub(super) fn products(
    f: &[Quad],
    f_kept: &mut [Quad],
    v_before: &[Quad],
    records: &[Record],
    partial: &mut [Partial],
) -> Products {
    let one = |(c, (kept, partial)): (usize, (&mut [Quad], &mut Partial))| {
        kept.copy_from_slice(chunk(f, c));
        *partial = chunk_products(chunk(f, c), chunk(v_before, c), chunk(records, c));
    };
    if is_worth_sharing(f.len()) {
        f_kept.par_chunks_mut(CHUNK).zip(partial.par_iter_mut()).enumerate().for_each(one);
    } else {
        f_kept.chunks_mut(CHUNK).zip(partial.iter_mut()).enumerate().for_each(one);
    }
    let total = |at: usize| partial.iter().map(|sums| sums[at].iter().sum::<f64>()).sum::<f64>();
    Products {
        fs: std::array::from_fn(|slot| total(2 * slot)),
        fw: std::array::from_fn(|slot| total(2 * slot + 1)),
        fv_before: total(2 * PAIRS),
    }
}

fn chunk_products(f: &[Quad], v_before: &[Quad], records: &[Record]) -> Partial {
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || {
            let mut sums = [[0.0; 4]; 2 * PAIRS + 1];
            for ((f, v), record) in f.iter().zip(v_before).zip(records) {
                for (slot, [s, w]) in record.0.iter().enumerate() {
                    for lane in 0..4 {
                        sums[2 * slot][lane] += f.0[lane] * f64::from(s[lane]);
                        sums[2 * slot + 1][lane] += f.0[lane] * f64::from(w[lane]);
                    }
                }
                (0..4).for_each(|lane| sums[2 * PAIRS][lane] += f.0[lane] * v.0[lane]);
            }
            sums
        },
    )
}

/// A chunk of v_before and its records.
type Both<'a> = (&'a mut [Quad], &'a mut [Record]);

/// Keeps `v` as the next `v_before`, and the change of v times a factor as w of a slot if there is one pending; returns
/// f·v.
pub(super) fn remember_change(
    (f, v): (&[Quad], &[Quad]),
    v_before: &mut [Quad],
    records: &mut [Record],
    pending: Option<(usize, f64)>,
    partial: &mut [Partial],
) -> f64 {
    let one = |(c, (both, partial)): (usize, (Both<'_>, &mut Partial))| {
        let (before, records) = both;
        let (f, v) = (chunk(f, c), chunk(v, c));
        let mut sums = [0.0; 4];
        for (f, v) in f.iter().zip(v) {
            (0..4).for_each(|lane| sums[lane] += f.0[lane] * v.0[lane]);
        }
        partial[0] = sums;
        if let Some((slot, factor)) = pending {
            for ((v, before), record) in v.iter().zip(before.iter()).zip(records) {
                record.0[slot][1] = std::array::from_fn(|lane| ((before.0[lane] - v.0[lane]) * factor) as f32);
            }
        }
        before.copy_from_slice(v);
    };
    if is_worth_sharing(f.len()) {
        let lists = v_before.par_chunks_mut(CHUNK).zip(records.par_chunks_mut(CHUNK));
        lists.zip(partial.par_iter_mut()).enumerate().for_each(one);
    } else {
        let lists = v_before.chunks_mut(CHUNK).zip(records.chunks_mut(CHUNK));
        lists.zip(partial.iter_mut()).enumerate().for_each(one);
    }
    partial.iter().map(|sums| sums[0].iter().sum::<f64>()).sum()
}

/// Where a step is to go.
#[derive(Clone, Copy)]
pub(super) struct Course<'a> {
    pub(super) direction: &'a Direction,
    /// Where `d` is remembered as s, times `unit`.
    pub(super) slot: usize,
    pub(super) unit: f64,
}

/// p' ← p'_before + d, with d remembered.
pub(super) fn advance(
    course: Course<'_>,
    v: &[Quad],
    records: &mut [Record],
    before: &[DVec3],
    positions: &mut [DVec3],
) {
    let one = |(c, (records, positions)): (usize, (&mut [Record], &mut [DVec3]))| {
        advance_chunk(course, chunk(v, c), records, chunk(before, c), positions);
    };
    if is_worth_sharing(v.len()) {
        records.par_chunks_mut(CHUNK).zip(positions.par_chunks_mut(CHUNK)).enumerate().for_each(one);
    } else {
        records.chunks_mut(CHUNK).zip(positions.chunks_mut(CHUNK)).enumerate().for_each(one);
    }
}

fn advance_chunk(course: Course<'_>, v: &[Quad], records: &mut [Record], before: &[DVec3], positions: &mut [DVec3]) {
    let Course { direction, slot, unit } = course;
    pulp::Arch::new().dispatch(
        #[inline(always)]
        || {
            for (((v, record), before), position) in v.iter().zip(records).zip(before).zip(positions) {
                let mut d = v.0.map(|x| x * direction.v_part);
                for &i in direction.slots() {
                    let [s, w] = record.0[i];
                    for lane in 0..4 {
                        d[lane] += direction.s_part[i] * f64::from(s[lane]) + direction.w_part[i] * f64::from(w[lane]);
                    }
                }
                record.0[slot][0] = d.map(|x| (x * unit) as f32);
                *position = *before + Quad(d).xyz();
            }
        },
    );
}
