//! `cargo hostile`: runs of broken and hostile files that are too long, or need too much, for the tests.

use clap::{Parser, Subcommand};
use pliant_hostile::run::{Batch, Report, run, work};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Broken and hostile files against the readers.
#[derive(Parser)]
#[command(name = "cargo hostile", bin_name = "cargo hostile")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Try all crafted files, then damaged ones for as long as told
    Fuzz {
        /// How long, from when the crafted ones are through
        #[arg(long, default_value_t = 60)]
        seconds: u64,
        /// Where the damage begins; runs of one seed are alike
        #[arg(long, default_value_t = 1)]
        seed: u64,
    },
    /// Write one file to look at it: of the crafted ones, or of a seed
    Show {
        /// `crafted`, or a seed
        batch: String,
        /// Its number
        index: u64,
        /// Where it goes; the ending of its format is added
        output: PathBuf,
    },
    /// Write the small sound files into a folder for each format, for the fuzz targets to begin with
    Seeds {
        /// The folder
        folder: PathBuf,
    },
    /// Look through strace at what is opened while files name others outside their folder
    #[cfg(target_os = "linux")]
    Trace,
    /// Kill savings through strace at every call to the system, and have every call fail
    #[cfg(target_os = "linux")]
    Crash,
    /// One saving, for `crash`
    #[cfg(target_os = "linux")]
    #[command(hide = true)]
    Save {
        /// Which
        index: usize,
        /// Its files
        folder: PathBuf,
    },
    /// What the other tasks start
    #[command(hide = true)]
    Worker {
        /// `crafted`, or a seed
        batch: String,
        /// The first file
        from: u64,
        /// Behind the last file
        to: u64,
    },
}

type Failure = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    match perform(Arguments::parse().task) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Whether all went well.
fn perform(task: Task) -> Result<bool, Failure> {
    let batch = |name: &str| Batch::parse(name).ok_or("a batch is `crafted` or a seed");
    match task {
        Task::Fuzz { seconds, seed } => fuzz(seconds, seed),
        Task::Worker { batch: name, from, to } => {
            work(batch(&name)?, from, to)?;
            Ok(true)
        }
        #[cfg(target_os = "linux")]
        Task::Trace => trace(),
        #[cfg(target_os = "linux")]
        Task::Crash => crash(),
        #[cfg(target_os = "linux")]
        Task::Save { index, folder } => {
            pliant_hostile::interrupted::save(index, &folder)?;
            Ok(true)
        }
        Task::Show { batch: name, index, output } => {
            let files = batch(&name)?.files()?;
            let (extension, bytes) = files.content(index).ok_or("it means something in its folder only")?;
            let output = output.with_extension(extension);
            std::fs::write(&output, bytes)?;
            eprintln!("{}: {}", output.display(), files.name(index));
            Ok(true)
        }
        Task::Seeds { folder } => {
            for (i, case) in pliant_hostile::crafted::seeds().iter().enumerate() {
                let folder = folder.join(case.extension);
                std::fs::create_dir_all(&folder)?;
                std::fs::write(folder.join(format!("{i}.{}", case.extension)), &case.bytes)?;
            }
            Ok(true)
        }
    }
}

fn fuzz(seconds: u64, seed: u64) -> Result<bool, Failure> {
    let program = std::env::current_exe()?;
    let n = pliant_hostile::crafted::all().len() as u64;
    let crafted = run(&program, Batch::Crafted, n, None)?;
    show("crafted", &crafted);
    let until = Instant::now() + Duration::from_secs(seconds);
    let damaged = run(&program, Batch::Damaged(seed), u64::MAX, Some(until))?;
    show("damaged", &damaged);
    Ok(crafted.troubles.is_empty() && damaged.troubles.is_empty())
}

fn show(what: &str, report: &Report) {
    let Report { opened, refused, troubles, slowest, largest } = report;
    for trouble in troubles {
        eprintln!("{what} file {} ({}): {}", trouble.index, trouble.name, trouble.what);
    }
    eprintln!(
        "{what}: {} files, {opened} opened, {refused} refused, {} in trouble; at most {} ms (file {}) and {} MB (file {})",
        opened + refused,
        troubles.len(),
        slowest.0,
        slowest.1,
        largest.0 / 1024,
        largest.1
    );
}

#[cfg(target_os = "linux")]
fn trace() -> Result<bool, Failure> {
    let seen = pliant_hostile::trace::run(&std::env::current_exe()?)?;
    seen.foreign.iter().for_each(|call| eprintln!("outside: {call}"));
    let foreign = seen.foreign.len();
    eprintln!("{} files with references, {} calls, {foreign} of them outside", seen.tried, seen.calls);
    Ok(foreign == 0)
}

#[cfg(target_os = "linux")]
fn crash() -> Result<bool, Failure> {
    let report = pliant_hostile::interrupted::run(&std::env::current_exe()?)?;
    report.troubles.iter().for_each(|trouble| eprintln!("{trouble}"));
    let troubles = report.troubles.len();
    eprintln!("{} savings killed, {} with a failed call, {troubles} in trouble", report.kills, report.failures);
    Ok(troubles == 0)
}
