//! `pliant info`: what is in a mesh file, for people or, with `--json`, for programs.

use std::fmt::Write;

use pliant_meshfile::MeshFile;
use pliant_solver::{Defects, Mesh};
use serde::Serialize;

use crate::document::{Finding, bounds_of, findings};

use super::args::InfoOptions;
use super::console::Console;
use super::failure::Failure;
use super::report::{MeshCounts, RigiditySummary};
use super::rigidity;
use super::surface;

/// Everything `info` says; the field names are those of `--json`.
#[derive(Debug, Serialize)]
struct Facts {
    file: String,
    mesh: MeshCounts,
    bounds: Bounds,
    defects: DefectCounts,
    findings: Vec<FindingFacts>,
    parts: Vec<PartFacts>,
    has_uvs: bool,
    has_colors: bool,
    /// Null when the file carries none.
    rigidity: Option<RigiditySummary>,
    warnings: Vec<String>,
}

/// In the file's units and axes.
#[derive(Debug, Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

#[derive(Debug, Serialize)]
struct DefectCounts {
    boundary_edges: usize,
    borders: usize,
    non_manifold_edges: usize,
    non_manifold_vertices: usize,
    inconsistent_edges: usize,
    degenerate_faces: usize,
    duplicate_faces: usize,
    unreferenced_vertices: usize,
}

/// What was found, how bending treats it, and where it is.
#[derive(Debug, Serialize)]
struct FindingFacts {
    kind: &'static str,
    count: usize,
    found: String,
    treatment: &'static str,
    /// The first vertices concerned, as numbered in the file.
    vertices: Vec<u32>,
}

/// As many vertices of a finding as are worth looking at one by one.
const MOST_EXAMPLES: usize = 10;

#[derive(Debug, Serialize)]
struct PartFacts {
    name: String,
    faces: usize,
}

pub(super) fn run(options: &InfoOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    let (file, mesh) = surface::open(&options.mesh, options.weld, console)?;
    let facts = facts(options, &file, &mesh)?;
    let text = if options.json {
        let json = serde_json::to_string_pretty(&facts);
        json.expect("numbers, texts and lists always have a JSON form") + "\n"
    } else {
        describe(&facts)
    };
    console.clear_progress();
    console.print(&text);
    Ok(())
}

fn facts(options: &InfoOptions, file: &MeshFile, mesh: &Mesh) -> Result<Facts, Failure> {
    let chosen = rigidity::choose(None, file)?;
    let (min, max) = bounds_of(&file.positions);
    let mut warnings: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
    warnings.extend(chosen.warning);
    let parts = file.parts.iter().map(|part| PartFacts { name: part.name.clone(), faces: part.triangles.len() });
    Ok(Facts {
        file: options.mesh.display().to_string(),
        mesh: MeshCounts::new(file, mesh),
        bounds: Bounds { min: min.to_array(), max: max.to_array() },
        defects: count(mesh.defects()),
        findings: findings(file, mesh).into_iter().map(|finding| located(finding, file, mesh)).collect(),
        parts: parts.collect(),
        has_uvs: file.uvs.is_some(),
        has_colors: file.colors.is_some(),
        rigidity: chosen.is_explicit.then(|| RigiditySummary::new(&chosen.rigidity)),
        warnings,
    })
}

fn located(finding: Finding, file: &MeshFile, mesh: &Mesh) -> FindingFacts {
    let some = finding.vertices(mesh).into_iter().take(MOST_EXAMPLES);
    let vertices = some.map(|v| file.weld.vertex_of_point[v.index()]).collect();
    let Finding { kind, count, found, treatment, .. } = finding;
    FindingFacts { kind, count, found, treatment, vertices }
}

fn count(defects: Defects) -> DefectCounts {
    DefectCounts {
        boundary_edges: defects.boundary_edges,
        borders: defects.borders,
        non_manifold_edges: defects.non_manifold_edges,
        non_manifold_vertices: defects.non_manifold_vertices,
        inconsistent_edges: defects.inconsistent_edges,
        degenerate_faces: defects.degenerate_faces,
        duplicate_faces: defects.duplicate_faces,
        unreferenced_vertices: defects.unreferenced_vertices,
    }
}

fn describe(facts: &Facts) -> String {
    let Facts { file, mesh, bounds, findings, parts, rigidity, warnings, .. } = facts;
    let mut text = format!("{file}\n{mesh}");
    let mut line = |name: &str, value: String| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {name:<12}{value}");
    };
    let corner = |[x, y, z]: [f64; 3]| format!("({x}, {y}, {z})");
    line("bounds", format!("{} to {}", corner(bounds.min), corner(bounds.max)));
    if findings.is_empty() {
        line("found", "nothing unusual".to_owned());
    }
    for FindingFacts { found, treatment, vertices, .. } in findings {
        let place = vertices.first().map(|v| format!(", first at vertex {v}")).unwrap_or_default();
        line("found", format!("{found}{place} ({treatment})"));
    }
    match rigidity {
        Some(rigidity) => line("rigidity", rigidity.to_string()),
        None => line("rigidity", "none in the file".to_owned()),
    }
    for part in parts {
        line("part", format!("{} ({} faces)", part.name.escape_default(), part.faces));
    }
    for warning in warnings {
        line("warning", warning.clone());
    }
    text
}
