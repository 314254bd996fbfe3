//! Poses one after the other into sums of energies.

use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::analysis::stars::Flat;
use crate::kernels::parallel::chunks;
use crate::kernels::turning::LOT;
use crate::kernels::wide::dispatch;
use crate::learning::areas::mixed_areas;
use crate::learning::energies::{EdgePair, LotEnergies, PoseEdges, edge_pairs};
use crate::learning::shells::{BATCH, Search, Shells, TooLarge};
use crate::learning::table::EnergyTable;
use crate::mesh::is_usable;
use crate::rings::progress::Meter;
use crate::{Analysis, LearnError, Rigidity};

/// Lists of edges up to this many are kept: two gigabytes. A million vertices with r up to 6 have 300 million. Beyond,
/// every pose searches again, which takes several times as long as the energies.
const MOST_KEPT: usize = 1 << 29;
/// Numbers that a table may have: a gigabyte, and three such arrays are needed.
const MOST_ENTRIES: usize = 1 << 27;

/// Where progress goes that nobody wants to know.
fn go_on(_: f64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Adds up the energies of poses of one mesh, one pose in memory at a time (paper 3.4).
///
/// The reference pose is the mesh that was analyzed; weights are those of the analysis. Memory does not depend on the
/// number of poses: three numbers per vertex and r, 64 bytes per edge, and for each vertex four bytes for every edge of
/// its largest neighborhood (at r = 6 some 300; up to two gigabytes together).
pub struct PoseLearner {
    analysis: Arc<Analysis>,
    range: RangeInclusive<u16>,
    /// A(k, r), internal numbering, row by row.
    areas: Vec<f64>,
    /// Shells of every [`BATCH`] of vertices; none where they are too many to be kept.
    shells: Option<Vec<Shells>>,
    vertex_areas: Vec<f64>,
    has_negative: bool,
    /// Σ_m E(k, r, m), and that of the pose at hand.
    sums: Vec<f64>,
    energies: Vec<f64>,
    n_poses: usize,
    /// The pose at hand.
    positions: Vec<DVec3>,
    /// e' and e of every edge, and of none.
    edges: Vec<EdgePair>,
}

impl PoseLearner {
    /// Finds the neighborhoods of all vertices for every r of `range`. `progress` is told the fraction that is done,
    /// ascending up to 1, from any thread but never from two at once, and stops the search by answering
    /// [`ControlFlow::Break`], which is then the result.
    ///
    /// # Errors
    /// [`LearnError::BadRange`] if the range is empty or leaves 1..=[`Rigidity::MAX`]; [`LearnError::TooLarge`] if the
    /// table or the neighborhoods do not fit the memory.
    pub fn new(
        analysis: Arc<Analysis>,
        range: RangeInclusive<u16>,
        progress: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    ) -> Result<ControlFlow<(), PoseLearner>, LearnError> {
        let (&first, &last) = (range.start(), range.end());
        if first < 1 || last > Rigidity::MAX || first > last {
            return Err(LearnError::BadRange { first, last, max: Rigidity::MAX });
        }
        let layout = &analysis.layout;
        let (n, n_columns) = (layout.n_vertices(), range.clone().count());
        if n * n_columns > MOST_ENTRIES {
            return Err(LearnError::TooLarge { last, n_vertices: n });
        }
        let by_caller = mixed_areas(analysis.mesh());
        let vertex_areas: Vec<f64> = layout.to_caller.iter().map(|&v| by_caller[v as usize]).collect();
        let mut areas = vec![0.0; n * n_columns];
        let shells = match find_shells(&analysis, &range, &vertex_areas, &mut areas, progress) {
            Ok(ControlFlow::Continue(shells)) => shells,
            Ok(ControlFlow::Break(())) => return Ok(ControlFlow::Break(())),
            Err(TooLarge) => return Err(LearnError::TooLarge { last, n_vertices: n }),
        };
        Ok(ControlFlow::Continue(PoseLearner {
            has_negative: layout.weight.iter().any(|&w| w < 0.0),
            sums: vec![0.0; n * n_columns],
            energies: vec![0.0; n * n_columns],
            n_poses: 0,
            positions: vec![DVec3::ZERO; n],
            edges: vec![EdgePair::ZERO; layout.n_edges() + 1],
            analysis,
            range,
            areas,
            shells,
            vertex_areas,
        }))
    }

    /// Adds a pose, given in the caller's numbering.
    ///
    /// # Errors
    /// [`LearnError::WrongLength`] unless there is one position per vertex, [`LearnError::NotFinite`] if one is not a
    /// number below [`LARGEST_COORDINATE`](crate::LARGEST_COORDINATE); nothing has changed then.
    pub fn add(&mut self, pose: &[DVec3]) -> Result<(), LearnError> {
        self.add_with_progress(pose, &mut go_on).map(|_| ())
    }

    /// The same with progress as for [`PoseLearner::new`]. If stopped, the pose has not been added.
    ///
    /// # Errors
    /// As for [`PoseLearner::add`].
    pub fn add_with_progress(
        &mut self,
        pose: &[DVec3],
        progress: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    ) -> Result<ControlFlow<()>, LearnError> {
        let expected = self.positions.len();
        if pose.len() != expected {
            return Err(LearnError::WrongLength { got: pose.len(), expected });
        }
        if let Some(vertex) = pose.iter().position(|&p| !is_usable(p)) {
            return Err(LearnError::NotFinite { vertex: vertex as u32 });
        }
        let to_caller = &self.analysis.layout.to_caller;
        self.positions.iter_mut().zip(to_caller).for_each(|(p, &v)| *p = pose[v as usize]);
        match self.measure(progress) {
            Ok(ControlFlow::Continue(())) => {}
            Ok(ControlFlow::Break(())) => return Ok(ControlFlow::Break(())),
            // Found when the learner was made.
            Err(TooLarge) => return Err(LearnError::TooLarge { last: *self.range.end(), n_vertices: expected }),
        }
        let energies = &self.energies;
        chunks(&mut self.sums, |first, sums| {
            sums.iter_mut().zip(&energies[first..]).for_each(|(sum, energy)| *sum += energy);
        });
        self.n_poses += 1;
        Ok(ControlFlow::Continue(()))
    }

    /// E(k, r, m) of the pose at hand into `energies`.
    fn measure(
        &mut self,
        progress: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    ) -> Result<ControlFlow<()>, TooLarge> {
        let PoseLearner { analysis, range, shells, vertex_areas, has_negative, energies, positions, edges, .. } = self;
        let (layout, n_columns) = (&analysis.layout, range.clone().count());
        let n_edges = layout.n_edges();
        chunks(&mut edges[..n_edges], |first, edges| edge_pairs(layout, positions, first, edges));
        let pose = PoseEdges { layout, positions: Flat::new(positions), edges, has_negative: *has_negative };
        let meter = Meter::new(layout.n_vertices() as u64, progress);
        let batches = energies.par_chunks_mut(BATCH * n_columns).enumerate();
        let outcome = match shells {
            Some(shells) => batches.try_for_each(|(batch, out)| {
                batch_energies(pose, &shells[batch], batch * BATCH, n_columns, out);
                advance(&meter, out.len() / n_columns)
            }),
            None => batches.try_for_each_init(
                || (Search::new(layout), Shells::default(), vec![0.0; BATCH * n_columns]),
                |(search, shells, ignored), (batch, out)| {
                    let (first, n) = (batch * BATCH, out.len() / n_columns);
                    search
                        .batch((first, n), range, vertex_areas, (shells, &mut ignored[..out.len()]))
                        .map_err(|TooLarge| Stopped::TooLarge)?;
                    batch_energies(pose, shells, first, n_columns, out);
                    advance(&meter, n)
                },
            ),
        };
        match outcome {
            Ok(()) => Ok(ControlFlow::Continue(())),
            Err(Stopped::Canceled) => Ok(ControlFlow::Break(())),
            Err(Stopped::TooLarge) => Err(TooLarge),
        }
    }

    /// Forgets all poses, but not the neighborhoods.
    pub fn clear(&mut self) {
        self.sums.fill(0.0);
        self.n_poses = 0;
    }

    /// As if shells were too many to be kept.
    #[cfg(test)]
    pub(crate) fn forget_shells(&mut self) {
        self.shells = None;
    }

    /// The r for which energies are added up.
    pub fn r_range(&self) -> RangeInclusive<u16> {
        self.range.clone()
    }

    /// Number of poses added so far.
    pub fn n_poses(&self) -> usize {
        self.n_poses
    }

    /// The means of all poses so far.
    ///
    /// # Errors
    /// [`LearnError::NoPoses`] before the first one.
    pub fn table(&self) -> Result<EnergyTable, LearnError> {
        if self.n_poses == 0 {
            return Err(LearnError::NoPoses);
        }
        let n_columns = self.range.clone().count();
        let n_poses = self.n_poses as f64;
        let mut means = vec![0.0; self.sums.len()];
        let to_internal = &self.analysis.layout.to_internal;
        means.par_chunks_mut(n_columns).zip(to_internal).for_each(|(row, &k)| {
            let places = k as usize * n_columns..(k as usize + 1) * n_columns;
            for ((mean, &sum), &area) in row.iter_mut().zip(&self.sums[places.clone()]).zip(&self.areas[places]) {
                // Without area there is nothing to be measured by.
                *mean = if area > 0.0 { sum / area / n_poses } else { 0.0 };
            }
        });
        Ok(EnergyTable::new(self.range.clone(), means, self.n_poses))
    }
}

/// Why a parallel loop ended early.
enum Stopped {
    Canceled,
    TooLarge,
}

fn advance(meter: &Meter<'_>, n: usize) -> Result<(), Stopped> {
    match meter.advance(n as u64) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(Stopped::Canceled),
    }
}

/// Energies of a batch of vertices from `first` on.
fn batch_energies(pose: PoseEdges<'_>, shells: &Shells, first: usize, n_columns: usize, out: &mut [f64]) {
    for (lot, out) in out.chunks_mut(LOT * n_columns).enumerate() {
        let place = lot * LOT;
        dispatch(LotEnergies { pose, shells, place, first: first + place, n_columns, out });
    }
}

/// All shells, unless they are too many to be kept, and all A(k, r).
fn find_shells(
    analysis: &Analysis,
    range: &RangeInclusive<u16>,
    vertex_areas: &[f64],
    areas: &mut [f64],
    progress: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
) -> Result<ControlFlow<(), Option<Vec<Shells>>>, TooLarge> {
    let layout = &analysis.layout;
    let n_columns = range.clone().count();
    let meter = Meter::new(layout.n_vertices() as u64, progress);
    let n_found = AtomicUsize::new(0);
    let found: Result<Vec<Shells>, Stopped> = areas
        .par_chunks_mut(BATCH * n_columns)
        .enumerate()
        .map_init(
            || Search::new(layout),
            |search, (batch, sums)| {
                let (mut shells, n) = (Shells::default(), sums.len() / n_columns);
                search
                    .batch((batch * BATCH, n), range, vertex_areas, (&mut shells, sums))
                    .map_err(|TooLarge| Stopped::TooLarge)?;
                advance(&meter, n)?;
                let before = n_found.fetch_add(shells.n_edges(), Ordering::Relaxed);
                shells.shrink();
                Ok(if before < MOST_KEPT { shells } else { Shells::default() })
            },
        )
        .collect();
    match found {
        Ok(shells) => Ok(ControlFlow::Continue(Some(shells).filter(|_| n_found.into_inner() <= MOST_KEPT))),
        Err(Stopped::Canceled) => Ok(ControlFlow::Break(())),
        Err(Stopped::TooLarge) => Err(TooLarge),
    }
}
