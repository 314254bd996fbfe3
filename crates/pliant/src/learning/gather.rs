//! The energies of poses out of files: every file is read, every pose added, and what cannot be used is named while the
//! rest goes on. Whoever asked decides whether the rest is enough.

use std::ops::{ControlFlow, RangeInclusive};
use std::sync::Arc;

use glam::DVec3;
use pliant_meshfile::MeshFile;
use pliant_meshfile::poses::{PoseError, PoseOptions};
use pliant_solver::{Analysis, EnergyTable, LearnError, PoseLearner};

use super::Progress;
use super::sources::{Source, Sources, n_own_poses};

/// What to read, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// Read in this order.
    pub sources: Vec<Source>,
    /// How files are read.
    pub options: PoseOptions,
    /// The sizes whose energies are wanted.
    pub range: RangeInclusive<u16>,
}

/// What the poses said.
#[derive(Clone, Debug)]
pub struct Gathered {
    /// Their energies.
    pub table: EnergyTable,
    /// What was read.
    pub reading: Reading,
}

/// What was found in the sources.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Names of the poses used.
    pub poses: Vec<String>,
    /// What could not be used: a line each, which names the file.
    pub broken: Vec<String>,
    /// Whether some of these could be used with the faces of the reference.
    pub only_faces_differ: bool,
    /// What else should be known: scales divided out, poses passed over, vertices that came apart.
    pub notes: Vec<String>,
}

/// Why nothing was gathered.
#[derive(Debug, thiserror::Error)]
pub enum GatherError {
    /// Every source was broken, or showed only the reference.
    #[error("{}", no_poses(.0))]
    NoPoses(Reading),
    /// Too many to be held in memory together.
    #[error(
        "a check holds all poses in memory, and there is room for {n_poses} of {n_vertices} vertices: take fewer frames"
    )]
    TooMany {
        /// How many fit.
        n_poses: usize,
        /// Of each.
        n_vertices: usize,
    },
    /// The range, or the size of the mesh.
    #[error(transparent)]
    Learn(#[from] LearnError),
}

fn no_poses(reading: &Reading) -> String {
    match &reading.broken[..] {
        [only] => only.clone(),
        [first, others @ ..] => format!("{first} (and {} more that cannot be used)", others.len()),
        [] => "there is no pose that differs from the mesh itself: name files in which it is bent".into(),
    }
}

/// Reads all poses and adds up their energies. `analysis` is of the surface points of `reference`.
///
/// # Errors
/// Any [`GatherError`]. Files that cannot be used are no error as long as there is a pose: see [`Reading::broken`].
pub fn gather(
    reference: &MeshFile,
    analysis: &Arc<Analysis>,
    wish: &Wish,
    progress: &mut Progress<'_>,
) -> Result<ControlFlow<(), Gathered>, GatherError> {
    let search = search_share(reference, wish);
    let found = PoseLearner::new(analysis.clone(), wish.range.clone(), &mut |done| progress(done * search))?;
    let ControlFlow::Continue(mut learner) = found else {
        return Ok(ControlFlow::Break(()));
    };
    let mut reading = Reading::default();
    let mut sources = Sources::new(reference, &wish.sources, wish.options);
    let (mut found, mut begin) = (sources.next(), 0.0);
    while let Some(item) = found {
        let end = sources.fraction();
        let mut at = |part: f64| progress(search + (1.0 - search) * (begin + (end - begin) * part));
        let flow;
        (flow, found) = match item {
            Ok(Some(pose)) => {
                // While the energies of one are computed, the next is read.
                let add = || learner.add_with_progress(&pose.points, &mut at);
                let (added, next) = rayon::join(add, || sources.next());
                reading.poses.push(pose.name);
                (added?, next)
            }
            Ok(None) => (at(1.0), sources.next()),
            Err(error) => {
                reading.refuse(&error);
                (at(1.0), sources.next())
            }
        };
        if flow.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        begin = end;
    }
    reading.notes = sources.into_notes();
    if learner.n_poses() == 0 {
        return Err(GatherError::NoPoses(reading));
    }
    let table = learner.table()?;
    Ok(if progress(1.0).is_break() {
        ControlFlow::Break(())
    } else {
        ControlFlow::Continue(Gathered { table, reading })
    })
}

impl Reading {
    fn refuse(&mut self, error: &PoseError) {
        self.only_faces_differ |= error.only_faces_differ();
        self.broken.push(error.to_string());
    }
}

/// The search for neighborhoods takes as long as about so many poses (measured at 12,000 and 100,000 vertices).
const SEARCH_IN_POSES: f64 = 40.0;

/// The part of all work that the search for neighborhoods is.
fn search_share(reference: &MeshFile, wish: &Wish) -> f64 {
    let expected = |source: &Source| match source {
        Source::Reference => n_own_poses(reference, wish.options),
        Source::File(_) => 1,
    };
    let n_poses: usize = wish.sources.iter().map(expected).sum();
    SEARCH_IN_POSES / (SEARCH_IN_POSES + n_poses as f64)
}

/// Positions of all poses together that are held in memory for a check: 768 MB.
const MOST_POSITIONS: usize = 1 << 25;

/// The poses themselves, all in memory; broken ones are left out. `watch` may stop it.
///
/// # Errors
/// [`GatherError::TooMany`].
pub fn collect(
    reference: &MeshFile,
    wish: &Wish,
    watch: &mut Progress<'_>,
) -> Result<ControlFlow<(), Vec<Vec<DVec3>>>, GatherError> {
    let mut poses: Vec<Vec<DVec3>> = Vec::new();
    for found in Sources::new(reference, &wish.sources, wish.options) {
        if watch(0.0).is_break() {
            return Ok(ControlFlow::Break(()));
        }
        let Ok(Some(pose)) = found else { continue };
        let n_vertices = pose.points.len();
        if (poses.len() + 1) * n_vertices > MOST_POSITIONS {
            return Err(GatherError::TooMany { n_poses: poses.len(), n_vertices });
        }
        poses.push(pose.points);
    }
    Ok(ControlFlow::Continue(poses))
}
