//! Mean energies by vertex and r, and the sizes that follow from them.

use std::ops::RangeInclusive;

use rayon::prelude::*;

use crate::learning::omega::auto_omega;
use crate::{Rigidity, VertexId};

/// Ẽ(k, r) = mean over poses of E(k, r, m) / A(k, r) (paper 3.4): a row per vertex in the caller's numbering, a column
/// per r. Where A(k, r) is 0 (no faces, or flat ones only), Ẽ is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct EnergyTable {
    range: RangeInclusive<u16>,
    energies: Vec<f64>,
    n_poses: usize,
}

/// Sizes learned from a table.
#[derive(Clone, Debug, PartialEq)]
pub struct Learned {
    /// r_k of every vertex, in the caller's numbering.
    pub rigidity: Rigidity,
    /// For every vertex, by how much the second best r is worse than the best, in units of ω, which is the worth of one
    /// ring: from 0 (as good) to 1 (by that or more; also where there is no other r).
    pub confidence: Vec<f32>,
}

impl EnergyTable {
    pub(crate) fn new(range: RangeInclusive<u16>, energies: Vec<f64>, n_poses: usize) -> EnergyTable {
        EnergyTable { range, energies, n_poses }
    }

    /// The r of the columns.
    pub fn r_range(&self) -> RangeInclusive<u16> {
        self.range.clone()
    }

    /// Number of rows.
    pub fn n_vertices(&self) -> usize {
        self.energies.len() / self.n_columns()
    }

    /// Number of poses of which these are the means, the reference not counted.
    pub fn n_poses(&self) -> usize {
        self.n_poses
    }

    /// Ẽ of one vertex by ascending r. Panics if `v` is not of this mesh.
    pub fn energies(&self, v: VertexId) -> &[f64] {
        &self.energies[v.index() * self.n_columns()..][..self.n_columns()]
    }

    /// Means over all vertices, by ascending r.
    pub fn mean_energies(&self) -> Vec<f64> {
        let mut means = vec![0.0; self.n_columns()];
        for row in self.rows() {
            means.iter_mut().zip(row).for_each(|(mean, energy)| *mean += energy);
        }
        let n = self.n_vertices().max(1) as f64;
        means.iter_mut().for_each(|mean| *mean /= n);
        means
    }

    /// The means over those of the poses that are not among the poses of `part`, as if they had never been added, up to
    /// rounding. None if the tables do not have the same shape, or no pose is left.
    pub fn without(&self, part: &EnergyTable) -> Option<EnergyTable> {
        let is_part = part.range == self.range && part.energies.len() == self.energies.len();
        let n_poses = self.n_poses.checked_sub(part.n_poses).filter(|&left| left > 0 && is_part)?;
        let [all, some, left] = [self.n_poses, part.n_poses, n_poses].map(|n| n as f64);
        let rest = |(mean, part): (&f64, &f64)| (mean * all - part * some) / left;
        let energies = self.energies.iter().zip(&part.energies).map(rest).collect();
        Some(EnergyTable { range: self.range.clone(), energies, n_poses })
    }

    /// An ω at which bones come out stiff and joints soft.
    pub fn auto_omega(&self) -> f64 {
        auto_omega(self)
    }

    /// r_k = argmin Ẽ(k, r) + ω (r_max − r) over the r of `range` that the table has (all of them if it has none). Of
    /// equally good r the larger one is taken. An ω that is not a positive number counts as 0.
    pub fn learn(&self, omega: f64, range: RangeInclusive<u16>) -> Learned {
        let (low, high) = (*self.range.start().max(range.start()), *self.range.end().min(range.end()));
        let (low, high) = if low <= high { (low, high) } else { (*self.range.start(), *self.range.end()) };
        let columns = usize::from(low - self.range.start())..usize::from(high - self.range.start()) + 1;
        let omega = if omega > 0.0 { omega.min(MOST_OMEGA) } else { 0.0 };
        let choose = |row: &[f64]| {
            let (column, confidence) = best_of(&row[columns.clone()], omega);
            (low + column as u16, confidence)
        };
        let (sizes, confidence): (Vec<u16>, Vec<f32>) =
            self.energies.par_chunks(self.n_columns()).with_min_len(CHUNK_OF_ROWS).map(choose).unzip();
        Learned { rigidity: Rigidity::new(sizes).expect("the learner took only sizes in range"), confidence }
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.energies.chunks(self.n_columns())
    }

    fn n_columns(&self) -> usize {
        self.range.clone().count()
    }
}

/// Beyond every energy, but its product with any r is a number.
const MOST_OMEGA: f64 = 1e300;
/// Rows that one thread takes at once: some tens of microseconds.
const CHUNK_OF_ROWS: usize = 4096;

/// The best column of a row and the margin to the second, see [`Learned::confidence`].
fn best_of(row: &[f64], omega: f64) -> (usize, f32) {
    let (mut best, mut second) = ((0, f64::INFINITY), f64::INFINITY);
    for (column, energy) in row.iter().enumerate() {
        let cost = energy + omega * (row.len() - 1 - column) as f64;
        if cost <= best.1 {
            (best, second) = ((column, cost), best.1);
        } else {
            second = second.min(cost);
        }
    }
    let margin = second - best.1;
    let confidence = if margin >= omega && margin > 0.0 { 1.0 } else { margin / omega };
    (best.0, if confidence.is_nan() { 0.0 } else { confidence as f32 })
}
