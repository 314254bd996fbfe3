//! Solves and measures one entry after another.

use std::sync::Arc;
use std::time::Instant;

use pliant_meshfile::MeshFile;
use pliant_solver::{Analysis, Mesh, Method as Other, Rigidity, arap_energies};

use crate::cli::args::{CompareOptions, Entry, Way};
use crate::cli::console::Console;
use crate::cli::failure::Failure;
use crate::cli::handles_file::{self, Handles};
use crate::cli::report::DeformTimes;
use crate::cli::rigidity::{self, ChosenRigidity};
use crate::cli::solve::{Problem, Settings, Solution, milliseconds, solve_analyzed};
use crate::cli::surface;
use crate::comparing::{Hinges, NoVolume, Placed, Ruler, Spread, Stage, Volume, pointed_out, stretches};

/// Everything read, and what is found out of the rest shape once for all entries.
pub(super) struct Bench {
    pub(super) file: MeshFile,
    pub(super) mesh: Arc<Mesh>,
    pub(super) handles: Handles,
    /// One for each entry.
    pub(super) rigidity: Vec<ChosenRigidity>,
    pub(super) stage: Stage,
    pub(super) rest: Placed,
    /// Pairs of triangles that cross at rest, sorted.
    pub(super) rest_crossings: Vec<[u32; 2]>,
    pub(super) volume: Volume,
    hinges: Hinges,
    pub(super) warnings: Vec<String>,
    pub(super) load_ms: f64,
    /// Weights, order and symbolic analysis, for all entries.
    pub(super) order_ms: f64,
}

/// What became of an entry.
pub(super) struct Bent {
    pub(super) energies: Vec<f64>,
    pub(super) converged: bool,
    pub(super) max_handle_error: f64,
    pub(super) times: DeformTimes,
    /// Of every surface point, on the stage.
    pub(super) placed: Placed,
    /// Its energy at r = 1 with the best rotations.
    pub(super) strain: Vec<f32>,
    pub(super) common_energy: f64,
    pub(super) crossings: usize,
    /// Of these, how many cross at rest already.
    pub(super) crossings_at_rest: usize,
    /// Corners of the triangles that cross and do not at rest.
    pub(super) flaws: Vec<[u32; 3]>,
    pub(super) volume_ratio: Result<f64, NoVolume>,
    pub(super) stretch: Spread,
    pub(super) bending: Spread,
    pub(super) folds: usize,
}

/// An entry's result, or why there is none.
pub(super) type Outcome = Result<Bent, Failure>;

impl Bench {
    pub(super) fn load(options: &CompareOptions, console: &mut Console<'_>) -> Result<Bench, Failure> {
        let clock = Instant::now();
        let (file, mesh) = surface::open(&options.mesh, options.weld, console)?;
        let mut warnings: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
        let handles = handles_file::read(&options.handles, &file)?;
        let rigidity = options.entries.iter().map(|entry| rigidity_of(entry, &file));
        let rigidity = rigidity.collect::<Result<Vec<_>, Failure>>()?;
        for warning in rigidity.iter().filter_map(|chosen| chosen.warning.clone()) {
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let load_ms = milliseconds(clock);
        console.stage("looking at the rest shape");
        let mut stage = Stage::new(&mesh, &handles.targets);
        Ok(Bench {
            rest: stage.place(mesh.positions()),
            stage,
            rest_crossings: pliant_geometry::crossings(mesh.positions(), mesh.triangles()),
            volume: Volume::of(&mesh),
            hinges: Hinges::new(&mesh),
            mesh: Arc::new(mesh),
            file,
            handles,
            rigidity,
            warnings,
            load_ms,
            order_ms: 0.0,
        })
    }

    /// Solves all entries in order. One that fails does not stop the others, unless all do.
    pub(super) fn solve_all(
        &mut self,
        options: &CompareOptions,
        console: &mut Console<'_>,
    ) -> Result<Vec<Outcome>, Failure> {
        console.stage("analyzing the mesh");
        let clock = Instant::now();
        let analysis = Arc::new(Analysis::new(self.mesh.clone(), options.solving.weights.into()));
        self.order_ms = milliseconds(clock);
        let n = options.entries.len();
        let mut results = Vec::with_capacity(n);
        for (place, entry) in options.entries.iter().enumerate() {
            console.set_task(format!("{entry} ({} of {n}): ", place + 1));
            results.push(self.solve(place, options, &analysis, console));
        }
        console.set_task(String::new());
        if results.iter().any(Result::is_ok) {
            return Ok(results);
        }
        let first = results.into_iter().find_map(Result::err);
        let source = Box::new(first.expect("an entry is required, and all failed"));
        Err(Failure::NoneSolved { entry: options.entries[0].to_string(), source })
    }

    fn solve(
        &mut self,
        place: usize,
        options: &CompareOptions,
        analysis: &Arc<Analysis>,
        console: &mut Console<'_>,
    ) -> Outcome {
        let weld = &self.file.weld;
        let rigidity = self.rigidity[place].rigidity.clone();
        let problem = Problem { mesh: self.mesh.clone(), rigidity, handles: self.handles.clone() };
        let settings = settings(&options.entries[place], options);
        let solution = solve_analyzed(analysis.clone(), &problem, &settings, console)
            .map_err(|source| surface::unsolvable(source, &options.mesh, weld))?;
        surface::check_finite(&solution.positions, weld)?;
        for warning in surface::loose(&solution.loose, weld) {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
        console.stage("measuring");
        let strain = arap_energies(analysis, &solution.positions)
            .map_err(|source| surface::unsolvable(source, &options.mesh, weld))?;
        Ok(self.measure(solution, &strain))
    }

    fn measure(&mut self, solution: Solution, strain: &[f64]) -> Bent {
        let (positions, triangles) = (&solution.positions, self.mesh.triangles());
        let crossings = pliant_geometry::crossings(positions, triangles);
        let is_new = |pair: &&[u32; 2]| self.rest_crossings.binary_search(pair).is_err();
        let new: Vec<[u32; 2]> = crossings.iter().filter(is_new).copied().collect();
        let bending = self.hinges.bending(positions);
        Bent {
            converged: solution.converged,
            max_handle_error: solution.max_handle_error,
            times: solution.times,
            placed: self.stage.place(positions),
            common_energy: strain.iter().sum(),
            strain: strain.iter().map(|&energy| energy as f32).collect(),
            crossings: crossings.len(),
            crossings_at_rest: crossings.len() - new.len(),
            flaws: pointed_out(&new, triangles),
            volume_ratio: self.volume.ratio(positions, triangles),
            stretch: Spread::new(&Ruler::stretch(), stretches(&self.mesh, positions)),
            bending: Spread::new(&Ruler::bending(), bending.changes),
            folds: bending.folds,
            energies: solution.energies,
        }
    }
}

fn rigidity_of(entry: &Entry, file: &MeshFile) -> Result<ChosenRigidity, Failure> {
    match &entry.way {
        Way::Rring(wish) => rigidity::choose_by("r of --entry", wish.as_deref(), file),
        Way::Arap | Way::SrArap { .. } | Way::Embedded { .. } => Ok(rigidity::ones(file)),
    }
}

/// As `deform` has them for the same method.
fn settings(entry: &Entry, options: &CompareOptions) -> Settings {
    let solving = &options.solving;
    Settings {
        other: match entry.way {
            Way::Rring(_) | Way::Arap => None,
            Way::SrArap { alpha } => Some(Other::SrArap { alpha }),
            Way::Embedded { nodes, node_neighbors } => Some(Other::Embedded { nodes, neighbors: node_neighbors }),
        },
        weights: solving.weights.into(),
        minimizer: solving.minimizer(),
        start: solving.start(),
        max_iterations: solving.max_iterations,
        tolerance: solving.tolerance,
    }
}

/// Whether r differs from vertex to vertex.
pub(super) fn is_painted(rigidity: &Rigidity) -> bool {
    rigidity.min() < rigidity.max()
}
