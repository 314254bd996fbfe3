//! An iteration's time as anyone can take it: whole processes of the command line, many iterations minus few.

use super::Failure;
use super::scene::Scene;
use super::stages::name;
use super::table::{Table, digits};
use crate::shapes::Shape;
use pliant_meshfile::MeshFile;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

const FEW: u32 = 30;
const MANY: u32 = 130;
/// Pairs of runs, of which the median is told.
const PAIRS: usize = 3;
const SIZES: [u16; 3] = [1, 10, 20];

/// Files of a scene for the command line.
pub(crate) struct Files {
    pub(crate) mesh: PathBuf,
    pub(crate) handles: PathBuf,
}

impl Files {
    /// Written to `folder` by the scene's name and size.
    pub(crate) fn write(scene: &Scene, folder: &Path) -> Result<Files, Failure> {
        let Shape { positions, triangles } = &scene.shape;
        let stem = format!("{}-{}", scene.name, positions.len());
        let files =
            Files { mesh: folder.join(format!("{stem}.obj")), handles: folder.join(format!("{stem}.handles.json")) };
        let mesh = MeshFile::from_triangles(&stem, positions.clone(), triangles.clone());
        mesh.save(&files.mesh, &mesh.points(), None).map_err(|source| Failure::Sample { name: scene.name, source })?;
        std::fs::write(&files.handles, scene.handles.to_json())
            .map_err(|source| Failure::File { path: files.handles.clone(), source })?;
        Ok(files)
    }
}

/// The table of iterations from outside, by size and r.
pub(crate) fn table(program: &Path, scenes: &[&Scene], folder: &Path) -> Result<String, Failure> {
    let mut table = Table::new(1, &["mesh", "vertices", "r", "ms", "/ r = 1", "peak MB"]);
    for scene in scenes {
        let files = Files::write(scene, folder)?;
        // In turn, so that a busy moment is not taken for one r.
        let mut times = SIZES.map(|_| Vec::new());
        let mut peaks = SIZES.map(|_| 0.0);
        for _ in 0..PAIRS {
            for ((&r, times), peak) in SIZES.iter().zip(&mut times).zip(&mut peaks) {
                eprintln!("from outside: {} vertices, r = {r}", scene.n_vertices());
                let few = run(program, &files, folder, (r, FEW))?;
                let many = run(program, &files, folder, (r, MANY))?;
                times.push((many.seconds - few.seconds) / f64::from(MANY - FEW));
                *peak = many.peak_bytes;
            }
        }
        let medians = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        });
        for ((&r, seconds), peak) in SIZES.iter().zip(medians).zip(peaks) {
            let cells = [digits(1e3 * seconds), format!("{:.2}", seconds / medians[0]), digits(peak / 1e6)];
            table.row(name(scene).into_iter().chain([r.to_string()]).chain(cells));
        }
    }
    Ok(format!(
        "An iteration from outside: the time of the whole process of `pliant deform MESH --handles H.json --rigidity R \
         --solver local-global --start rest --tolerance 0 --max-iterations {MANY}` minus that of {FEW} iterations, over \
         {}; and the peak memory of the process.\n\n{}",
        MANY - FEW,
        table.into_text()
    ))
}

struct Run {
    seconds: f64,
    peak_bytes: f64,
}

fn run(program: &Path, files: &Files, folder: &Path, (r, iterations): (u16, u32)) -> Result<Run, Failure> {
    let report = folder.join("report.json");
    let mut command = Command::new(program);
    command.arg("deform").arg(&files.mesh).arg("--handles").arg(&files.handles);
    command.arg("-o").arg(folder.join("out.obj")).arg("--report").arg(&report).arg("--quiet");
    command.args(["--solver", "local-global", "--start", "rest", "--tolerance", "0"]);
    command.args(["--rigidity", &r.to_string(), "--max-iterations", &iterations.to_string()]);
    let begun = Instant::now();
    let status =
        command.status().map_err(|source| Failure::Start { program: program.display().to_string(), source })?;
    let seconds = begun.elapsed().as_secs_f64();
    if !status.success() {
        return Err(Failure::Stopped { program: program.display().to_string() });
    }
    let text = std::fs::read(&report).map_err(|source| Failure::File { path: report, source })?;
    let told: serde_json::Value = serde_json::from_slice(&text).unwrap_or_default();
    Ok(Run { seconds, peak_bytes: told["peak_memory_bytes"].as_f64().unwrap_or(f64::NAN) })
}
