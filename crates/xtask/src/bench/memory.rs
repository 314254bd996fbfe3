//! The solver's memory, by processes that hold nothing else: resident bytes with a mesh, and with its solver.

use super::Failure;
use super::scene::{Scene, analyze, solver};
use super::stages::name;
use super::table::{Table, digits};
use pliant_solver::Rigidity;
use std::process::Command;

/// Enough for everything that is made in passing to have been made.
const ITERATIONS: usize = 5;
const SIZES: [u16; 3] = [1, 10, 20];

/// The command by which this program measures itself: cuts of the body and r.
#[derive(clap::Args, Clone, Copy, Debug)]
pub(crate) struct Probe {
    /// Cuts of the body
    cuts: u32,
    /// r of every vertex
    r: u16,
}

/// Resident bytes at one moment and the most there ever were.
#[derive(Clone, Copy)]
struct Resident {
    now: u64,
    most: u64,
}

/// Writes to standard error: bytes of the mesh, of the solver at rest, and of the solver at its most.
pub(crate) fn probe(Probe { cuts, r }: Probe) -> Result<(), Failure> {
    let scene = Scene::body(cuts);
    let mesh = scene.mesh();
    let rigidity = Rigidity::uniform(scene.n_vertices(), r);
    forget_the_most();
    let before = resident();
    let mut solver = solver(&scene, &analyze(&mesh), &rigidity)?;
    for _ in 0..ITERATIONS {
        solver.step();
    }
    let after = resident();
    if let (Some(before), Some(after)) = (before, after) {
        eprintln!("{} {} {}", before.now, after.now.saturating_sub(before.now), after.most.saturating_sub(before.now));
    }
    drop(solver);
    Ok(())
}

/// The table of memory by size and r; empty where the system tells no sizes.
pub(crate) fn table(scenes: &[&Scene]) -> Result<String, Failure> {
    let mut table = Table::new(1, &["mesh", "vertices", "r", "solver, MB", "bytes a vertex", "at most, MB"]);
    let here = std::env::current_exe().map_err(|source| Failure::File { path: "xtask".into(), source })?;
    for scene in scenes {
        // 10 cuts² + 2 vertices.
        let cuts = ((scene.n_vertices() as f64 / 10.0).sqrt() as u32).to_string();
        for r in SIZES {
            let output = Command::new(&here).args(["probe-memory", &cuts, &r.to_string()]).output();
            let output = output.map_err(|source| Failure::Start { program: here.display().to_string(), source })?;
            let text = String::from_utf8_lossy(&output.stderr).into_owned();
            let bytes: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
            let &[_, at_rest, most] = &bytes[..] else { continue };
            let cells = [digits(at_rest / 1e6), digits(at_rest / scene.n_vertices() as f64), digits(most / 1e6)];
            table.row(name(scene).into_iter().chain([r.to_string()]).chain(cells));
        }
    }
    Ok(format!(
        "Resident memory of a process that holds the mesh and its solver after {ITERATIONS} iterations, less what it had \
         with the mesh alone; *at most* while the solver was made. Read from `/proc`, so on Linux only.\n\n{}",
        table.into_text()
    ))
}

/// The system's own count of the most restarts here.
fn forget_the_most() {
    // Elsewhere than on Linux there is no such file, and nothing is measured.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

fn resident() -> Option<Resident> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let kilobytes = |key: &str| -> Option<u64> {
        let line = status.lines().find_map(|line| line.strip_prefix(key))?;
        line.split_whitespace().next()?.parse().ok()
    };
    Some(Resident { now: kilobytes("VmRSS:")? * 1024, most: kilobytes("VmHWM:")? * 1024 })
}
