//! Every mesh file of some folders through the real program: opened, bent by a pulled handle, and saved as it came.
//!
//! Meshes that people have are the best judges of a reader. Each file gets processes of its own with limits on memory
//! and processor time, so that one that crashes or hangs is named and the others go on. What the program refuses is
//! listed with its reason, for a person to check that the reason is true.

use crate::failure::Failure;
use clap::Args;
use pliant_meshfile::Format;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Address space of each process, KiB: far above the budgets of the readers, far below the machine.
const MEMORY_KIB: u64 = 4 << 20;
/// Processor time of each process, seconds: ten times what a million vertices take.
const CPU_SECONDS: u64 = 30;
/// How far the handle is pulled, in diagonals of the mesh.
const PULL: f64 = 0.1;

/// Options of `cargo xtask corpus`.
#[derive(Args)]
pub(crate) struct Options {
    /// Folders with mesh files, looked through to the bottom
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// The program to try; built if not given
    #[arg(long)]
    program: Option<PathBuf>,
}

/// What became of a file.
#[derive(Debug)]
enum Outcome {
    /// Opened, bent, and saved unbent with the same bytes, or with others because it names further files.
    Bent { seconds: f64, identical: bool },
    /// Refused in one line.
    Refused(String),
    /// Not as promised.
    Broken(String),
}

/// Tries every file and prints what became of them; fails when one was not treated as promised.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let program = match &options.program {
        Some(program) => program.clone(),
        None => build()?,
    };
    let mut files = Vec::new();
    for folder in &options.folders {
        collect(folder, &mut files)?;
    }
    files.sort();
    let mut tally = Tally::default();
    for file in &files {
        let trial = Trial { program: &program, file, folder: tempfile::tempdir().map_err(|source| at(file, source))? };
        tally.add(file, trial.outcome()?);
    }
    tally.print();
    if tally.broken.is_empty() { Ok(()) } else { Err(Failure::Corpus(tally.broken.len())) }
}

/// Builds the program with optimization; where it is then.
fn build() -> Result<PathBuf, Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo).args(["build", "--release", "--package", "pliant"]).status();
    let status = status.map_err(|source| Failure::Start { program: "cargo".into(), source })?;
    if !status.success() {
        return Err(Failure::Stopped { program: "cargo build".into() });
    }
    let here = std::env::current_exe().map_err(|source| at(Path::new("xtask"), source))?;
    let target = here.ancestors().nth(2).unwrap_or(&here);
    Ok(target.join("release").join(format!("pliant{}", std::env::consts::EXE_SUFFIX)))
}

fn at(path: &Path, source: std::io::Error) -> Failure {
    Failure::File { path: path.to_owned(), source }
}

/// Mesh files in a folder and below, without following links.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Failure> {
    for entry in std::fs::read_dir(folder).map_err(|source| at(folder, source))? {
        let entry = entry.map_err(|source| at(folder, source))?;
        let kind = entry.file_type().map_err(|source| at(&entry.path(), source))?;
        if kind.is_dir() {
            collect(&entry.path(), files)?;
        } else if kind.is_file() && Format::of(&entry.path()).is_some() {
            files.push(entry.path());
        }
    }
    Ok(())
}

/// One file under trial.
struct Trial<'a> {
    program: &'a Path,
    file: &'a Path,
    /// For what is written.
    folder: tempfile::TempDir,
}

/// How a process ended.
struct Ended {
    code: Option<i32>,
    out: Vec<u8>,
    err: String,
    time: Duration,
}

impl Trial<'_> {
    fn outcome(&self) -> Result<Outcome, Failure> {
        let opened = self.run(&["info".as_ref(), self.file.as_ref(), "--json".as_ref()])?;
        if opened.code == Some(1) {
            return Ok(match opened.err.lines().count() {
                1 => Outcome::Refused(opened.err.trim().to_owned()),
                _ => Outcome::Broken(format!("refused in more than one line: {}", opened.err)),
            });
        }
        let Some(facts) = (opened.code == Some(0)).then(|| serde_json::from_slice::<Value>(&opened.out).ok()).flatten()
        else {
            return Ok(Outcome::Broken(format!("info: {}", opened.description())));
        };
        let n = facts["mesh"]["vertices"].as_u64().unwrap_or_default();
        // Another vertex where the last one stands for the same point as the first.
        let mut last = None;
        for pulled in [n - 1, n / 2, n / 3] {
            let bent = self.deform(&pull(&facts, pulled), "bent")?;
            if bent.code == Some(0) {
                return self.saved_unbent(opened.time.as_secs_f64());
            }
            last = Some(bent);
        }
        Ok(Outcome::Broken(format!("deform: {}", last.map(|ended| ended.description()).unwrap_or_default())))
    }

    fn saved_unbent(&self, seconds: f64) -> Result<Outcome, Failure> {
        let saved = self.deform(&json!({"fixed": [0]}), "same")?;
        if saved.code != Some(0) {
            return Ok(Outcome::Broken(format!("deform without a pull: {}", saved.description())));
        }
        let read = |path: &Path| std::fs::read(path).map_err(|source| at(path, source));
        let identical = read(self.file)? == read(&self.target("same"))?;
        // A document is moved away here from the files that it names, and has to change.
        if identical || names_files(&read(self.file)?) {
            return Ok(Outcome::Bent { seconds, identical });
        }
        Ok(Outcome::Broken("saved unbent with other bytes".into()))
    }

    /// A file of the same format in the trial's folder.
    fn target(&self, stem: &str) -> PathBuf {
        let extension = self.file.extension().unwrap_or_default();
        self.folder.path().join(stem).with_extension(extension)
    }

    fn deform(&self, handles: &Value, stem: &str) -> Result<Ended, Failure> {
        let path = self.folder.path().join("handles.json");
        std::fs::write(&path, handles.to_string()).map_err(|source| at(&path, source))?;
        let target = self.target(stem);
        self.run(&[
            "deform".as_ref(),
            self.file.as_ref(),
            "--handles".as_ref(),
            path.as_ref(),
            "-o".as_ref(),
            target.as_ref(),
            "--max-iterations".as_ref(),
            "10".as_ref(),
        ])
    }

    /// Runs the program within the limits, which the shell sets.
    fn run(&self, arguments: &[&std::ffi::OsStr]) -> Result<Ended, Failure> {
        let begun = Instant::now();
        let limited = format!("ulimit -v {MEMORY_KIB}; ulimit -t {CPU_SECONDS}; exec \"$0\" \"$@\"");
        let output = Command::new("sh")
            .arg("-c")
            .arg(limited)
            .arg(self.program)
            .args(arguments)
            .arg("--quiet")
            .stdin(Stdio::null())
            .output()
            .map_err(|source| Failure::Start { program: "sh".into(), source })?;
        Ok(Ended {
            code: output.status.code(),
            out: output.stdout,
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
            time: begun.elapsed(),
        })
    }
}

impl Ended {
    fn description(&self) -> String {
        match self.code {
            Some(code) => format!("exit code {code}: {}", self.err.trim()),
            None => "killed: too much memory or time".into(),
        }
    }
}

/// Whether a glTF document refers to buffers or images in other files.
fn names_files(bytes: &[u8]) -> bool {
    let document: Value = serde_json::from_slice(bytes).unwrap_or_default();
    let uris = ["buffers", "images"].into_iter().filter_map(|list| document[list].as_array()).flatten();
    uris.filter_map(|object| object["uri"].as_str()).any(|uri| !uri.starts_with("data:"))
}

/// The first vertex held, another pulled along x.
fn pull(facts: &Value, pulled: u64) -> Value {
    let corner = |name: &str, axis: usize| facts["bounds"][name][axis].as_f64().unwrap_or_default();
    let diagonal = (0..3).map(|axis| (corner("max", axis) - corner("min", axis)).powi(2)).sum::<f64>().sqrt();
    let matrix = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., PULL * diagonal, 0., 0., 1.];
    json!({"fixed": [0], "groups": [{"vertices": [pulled], "matrix": matrix}]})
}

/// What became of all files.
#[derive(Default)]
struct Tally {
    /// Bent and, of those, saved with the same bytes, by format.
    bent: BTreeMap<&'static str, (usize, usize)>,
    refused: Vec<(PathBuf, String)>,
    broken: Vec<(PathBuf, String)>,
    slowest: Option<(f64, PathBuf)>,
}

impl Tally {
    fn add(&mut self, file: &Path, outcome: Outcome) {
        match outcome {
            Outcome::Bent { seconds, identical } => {
                let format = Format::of(file).map_or("", Format::extension);
                let (bent, same) = self.bent.entry(format).or_default();
                *bent += 1;
                *same += usize::from(identical);
                if self.slowest.as_ref().is_none_or(|(slowest, _)| seconds > *slowest) {
                    self.slowest = Some((seconds, file.to_owned()));
                }
            }
            Outcome::Refused(reason) => self.refused.push((file.to_owned(), reason)),
            Outcome::Broken(reason) => self.broken.push((file.to_owned(), reason)),
        }
    }

    fn print(&self) {
        for (_, reason) in &self.refused {
            eprintln!("refused: {}", reason.trim_start_matches("error: "));
        }
        for (file, reason) in &self.broken {
            eprintln!("BROKEN: {}: {reason}", file.display());
        }
        for (format, (bent, same)) in &self.bent {
            eprintln!("{format}: {bent} opened and bent, {same} of them saved unbent to the byte");
        }
        if let Some((seconds, file)) = &self.slowest {
            eprintln!("slowest to open: {:.2} s, {}", seconds, file.display());
        }
        eprintln!("{} refused, {} not as promised", self.refused.len(), self.broken.len());
    }
}
