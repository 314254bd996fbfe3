//! `pliant deform`: everything is read and checked first, then solved, then written; a refusal leaves no trace.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use pliant_meshfile::{Format, MeshFile, SaveError, Warning};
use pliant_solver::{DeformationGraph, Method as Other};

use super::args::{DeformOptions, Method};
use super::console::Console;
use super::failure::Failure;
use super::handles_file;
use super::report::{DeformReport, MeshCounts, ROOM_FOR_NEWS, RigiditySummary, peak_memory_bytes, to_json};
use super::rigidity::{self, ChosenRigidity};
use super::solve::{Problem, Settings, milliseconds, solve};
use super::staged::{Staged, check_side_files, check_target, same_file};
use super::surface;
use super::threads::on_threads;

pub(super) fn run(options: &DeformOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    check_options(options)?;
    on_threads(options.solving.threads, || run_in_pool(options, console))
}

fn run_in_pool(options: &DeformOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    let clock = Instant::now();
    let mut job = load(options, console)?;
    let load_ms = milliseconds(clock);

    let mut solution = solve(&job.problem, &settings(options), console)
        .map_err(|source| surface::unsolvable(source, &options.mesh, &job.file.weld))?;
    solution.times.load = load_ms;
    surface::check_finite(&solution.positions, &job.file.weld)?;
    job.warnings.extend(surface::loose(&solution.loose, &job.file.weld));

    let mut report = report(options, &job, solution.energies);
    report.converged = solution.converged;
    report.max_handle_error = solution.max_handle_error;
    report.times_ms = solution.times;
    if options.check_intersections {
        console.progress(|| "looking for crossings".to_owned());
        let crossings = pliant_geometry::crossings(&solution.positions, job.problem.mesh.triangles());
        report.self_intersections = Some(crossings.len());
    }
    write(options, &job, &solution.positions, clock, &mut report)?;

    for warning in &report.warnings {
        console.warn(warning);
    }
    console.summarize(&summary(options, &report));
    Ok(())
}

/// Refuses what can be refused without reading a file.
fn check_options(options: &DeformOptions) -> Result<(), Failure> {
    let refuse = |option, value: String, allowed| Err(Failure::OutOfRange { option, value, allowed });
    options.solving.check()?;
    if options.alpha.is_some_and(|alpha| !(alpha >= 0.0 && alpha.is_finite())) {
        return refuse("--alpha", options.alpha.unwrap_or_default().to_string(), "a number of at least 0");
    }
    if let Some(nodes) = options.nodes.filter(|nodes| !DeformationGraph::NODES.contains(nodes)) {
        return refuse("--nodes", nodes.to_string(), "from 1 to 20000");
    }
    if let Some(k) = options.node_neighbors.filter(|k| !DeformationGraph::NEIGHBORS.contains(k)) {
        return refuse("--node-neighbors", k.to_string(), "from 2 to 16");
    }
    check_method(options)?;
    check_paths(options)
}

/// Refuses options of other methods than the one chosen.
fn check_method(options: &DeformOptions) -> Result<(), Failure> {
    let method = options.method;
    let conflict = match method {
        Method::Arap if options.rigidity.is_some() => {
            "--method arap is rigidity 1 everywhere and cannot be used with --rigidity".to_owned()
        }
        _ if method != Method::Rring && options.rigidity.is_some() => {
            format!("--method {} knows no rigidity and cannot be used with --rigidity", method.name())
        }
        _ if method != Method::SrArap && options.alpha.is_some() => "--alpha needs --method sr-arap".to_owned(),
        _ if method != Method::Embedded && options.nodes.is_some() => "--nodes needs --method embedded".to_owned(),
        _ if method != Method::Embedded && options.node_neighbors.is_some() => {
            "--node-neighbors needs --method embedded".to_owned()
        }
        _ => return Ok(()),
    };
    let kind = clap::error::ErrorKind::ArgumentConflict;
    Err(Failure::Usage(clap::Error::raw(kind, format!("{conflict}\n"))))
}

fn check_paths(options: &DeformOptions) -> Result<(), Failure> {
    if Format::of(&options.output).is_none() {
        return Err(SaveError::UnknownFormat { path: options.output.clone() }.into());
    }
    check_target(&options.output)?;
    let mut inputs = vec![(options.handles.as_path(), "the handles")];
    if let Some(file) = options.rigidity.as_deref().filter(|text| text.parse::<i128>().is_err()) {
        // OUT may replace a mesh that carries r, but not a plain list of numbers; the report neither.
        inputs.push((file.as_ref(), "the rigidity"));
    }
    if same_file(&options.output, &options.handles) {
        return Err(Failure::SamePath { path: options.output.clone(), what: "OUT", other: "the handles" });
    }
    // The rigidity may lie there: what is written over it says the same.
    let beside = [(Some(options.handles.as_path()), "a file that belongs to OUT")];
    check_side_files(&[(&options.output, "the handles")], &beside)?;
    let Some(report) = &options.report else {
        return Ok(());
    };
    check_target(report)?;
    let meshes = [
        (options.output.as_path(), "a file that belongs to OUT"),
        (options.mesh.as_path(), "a file that belongs to MESH"),
    ];
    check_side_files(&meshes, &[(Some(report), "the report")])?;
    inputs.extend([(options.mesh.as_path(), "MESH"), (options.output.as_path(), "OUT")]);
    match inputs.into_iter().find(|(path, _)| same_file(report, path)) {
        Some((_, other)) => Err(Failure::SamePath { path: report.clone(), what: "the report", other }),
        None => Ok(()),
    }
}

/// Everything read and checked.
struct Job {
    file: MeshFile,
    problem: Problem,
    /// r to be written; none when nobody asked for any.
    rigidity_to_save: Option<Vec<u16>>,
    warnings: Vec<String>,
}

fn load(options: &DeformOptions, console: &mut Console<'_>) -> Result<Job, Failure> {
    let (file, mesh) = surface::open(&options.mesh, options.weld, console)?;
    let mut warnings: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
    let handles = handles_file::read(&options.handles, &file)?;
    let ChosenRigidity { rigidity, is_explicit, warning } = match options.method {
        Method::Rring => rigidity::choose(options.rigidity.as_deref(), &file)?,
        Method::Arap | Method::SrArap | Method::Embedded => rigidity::ones(&file),
    };
    warnings.extend(warning);
    let rigidity_to_save = is_explicit.then(|| rigidity.as_slice().to_vec());
    let problem = Problem { mesh: Arc::new(mesh), rigidity, handles };
    Ok(Job { file, problem, rigidity_to_save, warnings })
}

fn settings(options: &DeformOptions) -> Settings {
    Settings {
        other: match options.method {
            Method::Rring | Method::Arap => None,
            Method::SrArap => Some(Other::SrArap { alpha: options.alpha.unwrap_or(Other::ALPHA) }),
            Method::Embedded => Some(Other::Embedded {
                nodes: options.nodes.unwrap_or(Other::NODES),
                neighbors: options.node_neighbors.unwrap_or(Other::NODE_NEIGHBORS),
            }),
        },
        weights: options.solving.weights.into(),
        minimizer: options.solving.minimizer(),
        start: options.solving.start(),
        max_iterations: options.solving.max_iterations,
        tolerance: options.solving.tolerance,
    }
}

/// The report with everything known before the files are written.
fn report(options: &DeformOptions, job: &Job, energies: Vec<f64>) -> DeformReport {
    DeformReport {
        mesh: MeshCounts::new(&job.file, &job.problem.mesh),
        method: options.method.name(),
        solver: options.solving.solver_of(options.method),
        weights: options.solving.weights.name(),
        threads: rayon::current_num_threads(),
        rigidity: RigiditySummary::new(&job.problem.rigidity),
        converged: false,
        iterations: energies.len(),
        energies,
        max_handle_error: 0.0,
        self_intersections: None,
        times_ms: super::report::DeformTimes::default(),
        peak_memory_bytes: None,
        warnings: job.warnings.clone(),
    }
}

/// Writes OUT and the report. The report's bytes, and room for what is still to be added, are on the disk under another
/// name before OUT is touched, so that a full or read-only disk is noticed in time.
fn write(
    options: &DeformOptions,
    job: &Job,
    positions: &[DVec3],
    clock: Instant,
    report: &mut DeformReport,
) -> Result<(), Failure> {
    let mut staged = match &options.report {
        Some(path) => {
            let mut staged = Staged::create(path)?;
            staged.reserve(&to_json(report), ROOM_FOR_NEWS)?;
            Some(staged)
        }
        None => None,
    };
    let save_clock = Instant::now();
    let lost: Vec<Warning> = job.file.save(&options.output, positions, job.rigidity_to_save.as_deref())?;
    report.times_ms.save = milliseconds(save_clock);
    report.times_ms.total = milliseconds(clock);
    report.peak_memory_bytes = peak_memory_bytes();
    report.warnings.extend(lost.iter().map(ToString::to_string));
    if let Some(mut staged) = staged.take() {
        let written = staged.write(&to_json(report)).and_then(|()| staged.commit());
        written.map_err(|source| Failure::lost("report", &options.output, source))?;
    }
    Ok(())
}

fn summary(options: &DeformOptions, report: &DeformReport) -> String {
    let state = if report.converged { "converged after" } else { "not converged after" };
    let energy = report.energies.last().copied().unwrap_or_default();
    let crossings = match report.self_intersections {
        Some(count) => format!(", {count} pairs of triangles cross"),
        None => String::new(),
    };
    format!(
        "{}: {state} {} iterations, energy {energy:.6e}{crossings}, {:.0} ms",
        options.output.display(),
        report.iterations,
        report.times_ms.total
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::args::{Arguments, Command};
    use clap::Parser;

    #[test]
    fn what_is_written_beside_out_is_neither_the_report_nor_the_handles() {
        let folder = tempfile::tempdir().expect("a new folder");
        let at = |name: &str| folder.path().join(name).display().to_string();
        let refused = |handles: &str, report: &str| {
            let (mesh, handles, out, report) = (at("bar.obj"), at(handles), at("out.obj"), at(report));
            let line = ["pliant", "deform", &mesh, "--handles", &handles, "-o", &out, "--report", &report];
            let parsed = Arguments::try_parse_from(line).expect("a legal command");
            let Some(Command::Deform(options)) = parsed.command else { panic!("not deform") };
            check_paths(&options).err().map(|error| error.to_string()).unwrap_or_default()
        };
        assert_eq!(refused("h.json", "report.json"), "");
        let words = "the report would overwrite a file that belongs to";
        assert!(refused("h.json", "out.rigidity.json").contains(&format!("{words} OUT")));
        assert!(refused("h.json", "bar.rigidity.json").contains(&format!("{words} MESH")));
        let said = refused("out.rigidity.json", "report.json");
        assert!(said.contains("a file that belongs to OUT would overwrite the handles"), "{said}");
    }
}
