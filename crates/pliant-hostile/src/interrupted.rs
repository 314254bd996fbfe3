//! Savings that are stopped at every call to the system, or have a call fail: what is on the disk afterwards.
//!
//! A saving runs in a process of its own, between two marks in its trace. What it leaves must open as the old set of
//! files or as the new one, to the last number; the next saving must come to the new set and leave nothing behind. Projects
//! are one file of bytes that is replaced whole.

use crate::crafted::{glb_of, sound_document};
use crate::{exercise, strace};
use glam::DVec3;
use pliant_meshfile::{MeshFile, SaveError, open, replace_file};
use serde_json::Value;
use std::collections::HashMap;
use std::io::{Error, Result};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Asked for before and after the saving, to be found in the trace.
const MARKS: [&str; 2] = ["/pliant-saving-begins", "/pliant-saving-ends"];
/// Calls that are made to fail; those that only look are left alone. (So is `close`: what it may have to say was said by
/// `fsync` before, and the standard library ends the program when a folder cannot be closed.)
const FAILING: &[&str] = &["openat", "write", "fsync", "fchmod", "rename", "link", "linkat", "unlink", "flock"];
/// What they fail with.
const ERRORS: &[&str] = &["ENOSPC", "EIO", "EACCES"];

/// A saving: the name of the mesh, and whether another mesh takes its place.
#[derive(Clone, Copy, Debug)]
struct Scenario {
    name: &'static str,
    file: &'static str,
    replaced: bool,
}

const SCENARIOS: &[Scenario] = &[
    Scenario { name: "OBJ with its sidecar", file: "model.obj", replaced: false },
    Scenario { name: "OBJ, library and sidecar of another mesh", file: "model.obj", replaced: true },
    Scenario { name: "GLB", file: "model.glb", replaced: false },
    Scenario { name: "glTF with a buffer beside it", file: "model.gltf", replaced: false },
    Scenario { name: "PLY", file: "model.ply", replaced: false },
    Scenario { name: "STL with its sidecar", file: "model.stl", replaced: false },
    Scenario { name: "project", file: PROJECT, replaced: false },
];

/// Replaced as projects are: how is known to the editor alone.
const PROJECT: &str = "model.pliant";
/// Its pieces after the saving: more than one buffer full.
const PIECES: [(u8, usize); 3] = [(1, 20), (2, 40_000), (3, 7)];

/// What a set of files opens as: places, r, colors of parts; or the bytes of a project.
type Look = (Vec<DVec3>, Option<Vec<u16>>, Vec<[f32; 4]>, Vec<u8>);

fn look(mesh: &Path) -> std::result::Result<Look, String> {
    if mesh.ends_with(PROJECT) {
        let bytes = std::fs::read(mesh).map_err(|error| error.to_string())?;
        return Ok((Vec::new(), None, Vec::new(), bytes));
    }
    let file = open(mesh).map_err(|error| error.to_string())?;
    Ok((file.positions, file.rigidity, file.parts.iter().map(|part| part.base_color).collect(), Vec::new()))
}

fn save_project(to: &Path) -> std::result::Result<(), SaveError> {
    replace_file(to, |file| PIECES.iter().try_for_each(|&(byte, n)| file.write_all(&vec![byte; n])))
}

/// How a run went.
#[derive(Debug, Default)]
pub struct Report {
    /// Savings that were killed.
    pub kills: usize,
    /// Savings with a failed call.
    pub failures: usize,
    /// What went wrong.
    pub troubles: Vec<String>,
}

/// Interrupts every saving at every call.
pub fn run(program: &Path) -> Result<Report> {
    strace::check()?;
    let mut report = Report::default();
    for (index, scenario) in SCENARIOS.iter().enumerate() {
        let stand = Stand::new(program, index)?;
        let before = (report.kills, report.failures);
        stand.kill_everywhere(&mut report)?;
        stand.fail_everywhere(&mut report)?;
        let (kills, failures) = (report.kills - before.0, report.failures - before.1);
        eprintln!("{}: killed {kills} times, {failures} calls failed", scenario.name);
    }
    Ok(report)
}

/// The saving of scenario `index` in `folder`, between its marks; the message of the error, if there is one.
pub fn save(index: usize, folder: &Path) -> std::result::Result<(), String> {
    let scenario = SCENARIOS.get(index).ok_or("there is no such scenario")?;
    let target = folder.join(scenario.file);
    if scenario.file == PROJECT {
        let _ = std::fs::metadata(MARKS[0]);
        let saved = save_project(&target);
        let _ = std::fs::metadata(MARKS[1]);
        return saved.map_err(|error| error.to_string());
    }
    let source = if scenario.replaced { folder.join("other.glb") } else { target.clone() };
    let file = open(&source).map_err(|error| error.to_string())?;
    let (points, rigidity) = edited(&file);
    let _ = std::fs::metadata(MARKS[0]);
    let saved = file.save(&target, &points, Some(&rigidity));
    let _ = std::fs::metadata(MARKS[1]);
    saved.map(drop).map_err(|error| error.to_string())
}

fn edited(file: &MeshFile) -> (Vec<DVec3>, Vec<u16>) {
    let points: Vec<DVec3> = file.points().iter().map(|point| *point + DVec3::new(0.0, 0.5, point.x)).collect();
    let rigidity = (0..points.len()).map(|point| 5 + point as u16 % 3).collect();
    (points, rigidity)
}

/// A scenario with its files before the saving, and what they open as before and after it.
struct Stand<'a> {
    program: &'a Path,
    index: usize,
    scenario: Scenario,
    files: Vec<(String, Vec<u8>)>,
    old: Look,
    new: Look,
    /// The calls between the marks: the name of each, and how many of that name it is from the start of the process, which
    /// is how strace counts.
    calls: Vec<(String, usize)>,
}

impl<'a> Stand<'a> {
    fn new(program: &'a Path, index: usize) -> Result<Stand<'a>> {
        let scenario = SCENARIOS[index];
        let folder = exercise::scratch()?;
        lay_out(scenario, folder.path()).map_err(Error::other)?;
        let mut files = Vec::new();
        for entry in std::fs::read_dir(folder.path())? {
            let entry = entry?;
            files.push((entry.file_name().to_string_lossy().into_owned(), std::fs::read(entry.path())?));
        }
        let mesh = folder.path().join(scenario.file);
        let old = look(&mesh).map_err(Error::other)?;
        let mut stand = Stand { program, index, scenario, files, new: old.clone(), old, calls: Vec::new() };
        stand.calls = stand.calls_of_saving(folder.path())?;
        stand.new = look(&mesh).map_err(Error::other)?;
        if stand.new == stand.old {
            return Err(Error::other("the saving changes nothing"));
        }
        Ok(stand)
    }

    fn calls_of_saving(&self, folder: &Path) -> Result<Vec<(String, usize)>> {
        let (_, lines) = self.saving(&["-e", "trace=all"], folder)?;
        let (mut counts, mut calls, mut marks) = (HashMap::<&str, usize>::new(), Vec::new(), 0);
        for line in &lines {
            let Some((name, _)) = line.split_once('(') else { continue };
            let count = counts.entry(name).or_default();
            *count += 1;
            if MARKS.iter().any(|mark| line.contains(mark)) {
                marks += 1;
            } else if marks == 1 {
                calls.push((name.to_owned(), *count));
            }
        }
        if marks != MARKS.len() {
            return Err(Error::other("the saving cannot be found in its trace"));
        }
        Ok(calls)
    }

    /// A folder as it was before the saving.
    fn fresh(&self) -> Result<tempfile::TempDir> {
        let folder = exercise::scratch()?;
        for (name, bytes) in &self.files {
            std::fs::write(folder.path().join(name), bytes)?;
        }
        Ok(folder)
    }

    fn saving(&self, options: &[&str], folder: &Path) -> Result<(std::process::Output, Vec<String>)> {
        let folder = folder.to_string_lossy().into_owned();
        strace::traced(options, self.program, &["save", &self.index.to_string(), &folder])
    }

    fn kill_everywhere(&self, report: &mut Report) -> Result<()> {
        for (name, at) in &self.calls {
            let folder = self.fresh()?;
            let what = format!("{}, killed at {name} {at}", self.scenario.name);
            let kill = format!("inject={name}:signal=SIGKILL:when={at}");
            let (_, lines) = self.saving(&["-e", "trace=all", "-e", &kill], folder.path())?;
            if !lines.last().is_some_and(|line| line.contains("killed by SIGKILL")) {
                report.troubles.push(format!("{what}: was not killed"));
            }
            report.kills += 1;
            self.check(folder.path(), &what, &[&self.old, &self.new], report);
        }
        Ok(())
    }

    fn fail_everywhere(&self, report: &mut Report) -> Result<()> {
        let failing = self.calls.iter().filter(|(name, _)| FAILING.contains(&name.as_str()));
        for ((name, at), error) in failing.flat_map(|call| ERRORS.iter().map(move |error| (call, error))) {
            let folder = self.fresh()?;
            let fail = format!("inject={name}:error={error}:when={at}");
            let (output, _) = self.saving(&["-e", "trace=all", "-e", &fail], folder.path())?;
            report.failures += 1;
            let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
            let what = format!("{}, {error} at {name} {at} ({said})", self.scenario.name);
            let done = output.status.success() || said.contains(": saved, but");
            if !output.status.success() && (!said.starts_with("error: ") || said.contains('\n')) {
                report.troubles.push(format!("{what}: is no clear line"));
            }
            self.check(folder.path(), &what, &[if done { &self.new } else { &self.old }], report);
        }
        Ok(())
    }

    /// What must hold of the folder after an interrupted saving.
    fn check(&self, folder: &Path, what: &str, allowed: &[&Look], report: &mut Report) {
        let mesh = folder.join(self.scenario.file);
        let mut complain = |problem: String| report.troubles.push(format!("{what}: {problem}"));
        match look(&mesh) {
            Err(error) => return complain(format!("does not open: {error}")),
            Ok(found) if !allowed.contains(&&found) => {
                let of = |look: &Look| [found.0 == look.0, found.1 == look.1, found.2 == look.2, found.3 == look.3];
                return complain(format!("places, r, colors, bytes: old {:?}, new {:?}", of(&self.old), of(&self.new)));
            }
            Ok(_) => {}
        }
        let hidden = || -> Vec<PathBuf> {
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
            entries.filter(|path| path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'))).collect()
        };
        // As if the next saving came a while later: what is younger may be another process's.
        let long_ago = SystemTime::now() - Duration::from_secs(600);
        for path in hidden() {
            let _ = std::fs::File::open(path).and_then(|file| file.set_modified(long_ago));
        }
        let save_again = || match self.scenario.file {
            PROJECT => save_project(&mesh).map_err(|error| error.to_string()),
            _ => save_mesh_again(&mesh),
        };
        if let Err(error) = save_again() {
            return complain(format!("cannot be saved again: {error}"));
        }
        let left = hidden();
        if !left.is_empty() {
            complain(format!("leaves {left:?} after the next saving"));
        }
    }
}

fn save_mesh_again(mesh: &Path) -> std::result::Result<(), String> {
    let file = open(mesh).map_err(|error| error.to_string())?;
    let (points, rigidity) = edited(&file);
    file.save(mesh, &points, Some(&rigidity)).map(drop).map_err(|error| error.to_string())
}

/// The files of a scenario before its saving.
fn lay_out(scenario: Scenario, folder: &Path) -> std::result::Result<(), String> {
    let text = |error: std::io::Error| error.to_string();
    let (mut document, binary) = sound_document();
    let target = folder.join(scenario.file);
    if scenario.file == PROJECT {
        return std::fs::write(&target, vec![9; 500]).map_err(text);
    }
    if scenario.file.ends_with(".gltf") {
        document["buffers"][0]["uri"] = "model.bin".into();
        std::fs::write(folder.join("model.bin"), &binary).map_err(text)?;
        return std::fs::write(&target, document.to_string()).map_err(text);
    }
    let source = if scenario.file.ends_with(".glb") { target.clone() } else { folder.join("first.glb") };
    std::fs::write(&source, glb_of(document.to_string().as_bytes(), &binary)).map_err(text)?;
    if source != target {
        let file = open(&source).map_err(|error| error.to_string())?;
        file.save(&target, &file.points(), Some(&[2; 6])).map_err(|error| error.to_string())?;
        std::fs::remove_file(&source).map_err(text)?;
    }
    if scenario.replaced {
        // Other colors and fewer vertices: nothing of one set fits the other.
        document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = serde_json::json!([0, 0, 1, 1]);
        document["meshes"][0]["primitives"][0] = serde_json::json!({"attributes": {"POSITION": 0}, "material": 0});
        document["accessors"][0]["count"] = Value::from(3);
        std::fs::write(folder.join("other.glb"), glb_of(document.to_string().as_bytes(), &binary)).map_err(text)?;
    }
    Ok(())
}
