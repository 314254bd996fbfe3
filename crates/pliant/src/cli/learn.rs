//! `pliant learn`: energies of a reference's neighborhoods in its poses, and the rigidity that follows (paper 3.4).
//!
//! Poses are read one at a time and forgotten; files are written when all is known, so that a refusal leaves no trace.

mod feeding;
mod outcome;

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use pliant_meshfile::poses::PoseOptions;
use pliant_meshfile::{Format, MeshFile, OpenError};
use pliant_solver::{Analysis, EnergyTable, Learned, Mesh, PoseLearner, Rigidity};

use super::args::{LearnOptions, OmegaChoice};
use super::console::Console;
use super::failure::Failure;
use super::report::{LearnReport, LearnTimes};
use super::solve::milliseconds;
use super::staged::{check_side_files, check_target, same_file};
use super::surface;
use super::threads::on_threads;
use crate::learning::sources::{Source, Sources};
use feeding::Feeding;
use outcome::Outcome;

/// Frames of one animation at most: several minutes at the rate of film.
const MOST_FRAMES: i64 = 10_000;

pub(super) fn run(options: &LearnOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    check_options(options)?;
    check_paths(options)?;
    on_threads(options.threads, || run_in_pool(options, console))
}

fn run_in_pool(options: &LearnOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    let clock = Instant::now();
    let mut times = LearnTimes::default();
    let (file, mesh) = surface::open(&options.reference, options.weld, console)?;
    times.load = milliseconds(clock);

    let begun = Instant::now();
    let mut learner = prepare(options, mesh, console)?;
    times.neighborhoods = milliseconds(begun);

    let listed: Vec<Source> = match &options.poses[..] {
        [] => vec![Source::Reference],
        paths => paths.iter().cloned().map(Source::File).collect(),
    };
    let mut sources = Sources::new(&file, &listed, pose_options(options));
    let mut feeding = Feeding::new(&mut learner, options);
    feeding.feed(&mut sources, console)?;
    times.load += 1e3 * sources.load_time().as_secs_f64();
    times.energies = feeding.energies_ms;
    let mut warnings: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
    warnings.append(&mut feeding.warnings());
    warnings.append(&mut sources.into_notes());
    if feeding.n_poses() == 0 {
        return Err(feeding.no_poses());
    }

    let begun = Instant::now();
    console.clear_progress();
    let table = learner.table().map_err(|source| Failure::Learn { path: options.reference.clone(), source })?;
    let omega = match options.omega {
        OmegaChoice::Auto => table.auto_omega(),
        OmegaChoice::Absolute(omega) => omega,
    };
    let learned = table.learn(omega, table.r_range());
    times.energies += milliseconds(begun);

    let mut report = report(options, &file, &table, &learned, omega);
    (report.times_ms, report.warnings) = (times, warnings);
    let outcome = Outcome { options, file: &file, table: &table, learned: &learned };
    outcome.write(clock, &mut report)?;
    for warning in &report.warnings {
        console.warn(warning);
    }
    console.summarize(&summary(options, &report));
    Ok(())
}

/// Refuses what can be refused without reading a file.
fn check_options(options: &LearnOptions) -> Result<(), Failure> {
    let refuse = |option, value: String, allowed| Err(Failure::OutOfRange { option, value, allowed });
    for (option, r) in [("--r-min", options.r_min), ("--r-max", options.r_max)] {
        if !(1..=i64::from(Rigidity::MAX)).contains(&r) {
            // Rigidity::MAX in words, checked by a test.
            return refuse(option, r.to_string(), "between 1 and 1000");
        }
    }
    if options.r_min > options.r_max {
        return refuse("--r-min", options.r_min.to_string(), "at most --r-max");
    }
    if let OmegaChoice::Absolute(omega) = options.omega
        && !(omega >= 0.0 && omega.is_finite())
    {
        return refuse("--omega", omega.to_string(), "auto or a number of at least 0");
    }
    if !(1..=MOST_FRAMES).contains(&options.frames) {
        return refuse("--frames", options.frames.to_string(), "between 1 and 10000");
    }
    if options.threads == Some(0) {
        return refuse("--threads", "0".to_owned(), "at least 1");
    }
    Ok(())
}

/// Refuses files that could not be written, and poses that are not there, before any work is done.
fn check_paths(options: &LearnOptions) -> Result<(), Failure> {
    let output = options.output.as_path();
    if Format::of(output).is_none() && !is_array(output) {
        return Err(Failure::UnknownOutput { path: output.to_owned() });
    }
    let mut taken: Vec<(&Path, &'static str)> = Vec::new();
    for pose in &options.poses {
        if !options.skip_broken {
            let found = std::fs::metadata(pose);
            found.map_err(|source| OpenError::Read { path: pose.clone(), source })?;
        }
        // The reference's own poses are read before it is replaced.
        if !same_file(pose, &options.reference) {
            taken.push((pose, "a pose"));
        }
    }
    let outputs =
        [(Some(output), "OUT"), (options.table.as_deref(), "the table"), (options.report.as_deref(), "the report")];
    for (path, what) in outputs {
        let Some(path) = path else { continue };
        check_target(path)?;
        if let Some(&(_, other)) = taken.iter().find(|(other, _)| same_file(path, other)) {
            return Err(Failure::SamePath { path: path.to_owned(), what, other });
        }
        // OUT may replace the reference, whose geometry it keeps; a list of numbers may not.
        if same_file(path, &options.reference) && (what != "OUT" || is_array(path)) {
            return Err(Failure::SamePath { path: path.to_owned(), what, other: "REFERENCE" });
        }
        taken.push((path, what));
    }
    // OUT as an array may be what lies beside REFERENCE: that is where its rigidity is kept.
    let protected = [(output, "a file that belongs to OUT"), (&options.reference, "a file that belongs to REFERENCE")];
    let others = [(options.table.as_deref(), "the table"), (options.report.as_deref(), "the report")];
    check_side_files(&protected, &others)
}

/// Whether OUT is to be a plain list of numbers.
fn is_array(output: &Path) -> bool {
    output.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

fn pose_options(options: &LearnOptions) -> PoseOptions {
    PoseOptions {
        // Checked to be positive and small.
        frames: options.frames as usize,
        reference_faces: options.reference_faces,
        match_scale: options.match_scale,
    }
}

/// Weights and neighborhoods of the reference.
fn prepare(options: &LearnOptions, mesh: Mesh, console: &mut Console<'_>) -> Result<PoseLearner, Failure> {
    console.progress(|| "analyzing the mesh".to_owned());
    let analysis = Arc::new(Analysis::new(Arc::new(mesh), options.weights.into()));
    let mut tell = |done: f64| {
        console.progress(|| format!("finding neighborhoods, {:.0} %", 100.0 * done));
        ControlFlow::Continue(())
    };
    // Checked to be in range.
    let range = options.r_min as u16..=options.r_max as u16;
    let refused = |source| Failure::Learn { path: options.reference.clone(), source };
    match PoseLearner::new(analysis, range, &mut tell).map_err(refused)? {
        ControlFlow::Continue(learner) => Ok(learner),
        ControlFlow::Break(()) => unreachable!("nothing here stops the search"),
    }
}

/// The report with everything known before the files are written.
fn report(options: &LearnOptions, file: &MeshFile, table: &EnergyTable, learned: &Learned, omega: f64) -> LearnReport {
    let range = table.r_range();
    let mut histogram = vec![0; range.clone().count()];
    let r = learned.rigidity.as_slice();
    for &point in &file.weld.point_of_vertex {
        histogram[usize::from(r[point as usize] - range.start())] += 1;
    }
    LearnReport {
        vertices: file.positions.len(),
        poses: table.n_poses(),
        r_min: *range.start(),
        r_max: *range.end(),
        omega,
        omega_mode: options.omega.name(),
        histogram,
        mean_energy: table.mean_energies(),
        times_ms: LearnTimes::default(),
        peak_memory_bytes: None,
        warnings: Vec::new(),
    }
}

fn summary(options: &LearnOptions, report: &LearnReport) -> String {
    let n = report.vertices.max(1) as f64;
    let share =
        |(i, &count): (usize, &usize)| format!("{}: {:.0} %", usize::from(report.r_min) + i, 100.0 * count as f64 / n);
    let shares: Vec<String> = report.histogram.iter().enumerate().map(share).collect();
    format!(
        "{}: r of {} vertices from {} poses, omega {:.2e} ({}), {}, {:.0} ms",
        options.output.display(),
        report.vertices,
        report.poses,
        report.omega,
        report.omega_mode,
        shares.join(", "),
        report.times_ms.total
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_r_in_words_is_that_of_the_solver() {
        assert_eq!(Rigidity::MAX, 1000);
        assert_eq!(MOST_FRAMES, 10_000);
    }

    #[test]
    fn an_array_is_known_by_its_name() {
        assert!(is_array("r.JSON".as_ref()) && !is_array("r.obj".as_ref()) && !is_array("json".as_ref()));
    }
}
