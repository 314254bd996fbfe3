//! The mesh a command works on: the file and the surface the solver sees, with failures told in the file's numbers.

use std::ops::ControlFlow;
use std::path::Path;

use glam::DVec3;
use pliant_meshfile::{MeshFile, OpenOptions, Weld, Welding};
use pliant_solver::{Mesh, MeshError, SolveError, VertexId};

use super::console::Console;
use super::failure::Failure;

/// Loose components named one by one; the others are only counted.
const LOOSE_NAMED: usize = 5;

/// Reads the mesh file at `path`, welded as is wished.
pub(super) fn read(path: &Path, welding: Welding, console: &mut Console<'_>) -> Result<MeshFile, Failure> {
    let mut progress = |fraction: f64| {
        console.progress(|| format!("reading {}: {:.0} %", path.display(), (100.0 * fraction).floor()));
        ControlFlow::Continue(())
    };
    Ok(OpenOptions { welding, ..OpenOptions::default() }.open_with_progress(path, &mut progress)?)
}

/// Opens the mesh file at `path`, welded as is wished.
pub(super) fn open(path: &Path, welding: Welding, console: &mut Console<'_>) -> Result<(MeshFile, Mesh), Failure> {
    let file = read(path, welding, console)?;
    let mesh = Mesh::new(file.points(), file.point_triangles()).map_err(|source| refused(source, path, &file.weld))?;
    Ok((file, mesh))
}

fn refused(source: MeshError, path: &Path, weld: &Weld) -> Failure {
    let source = match source {
        MeshError::NotFinite { vertex } => MeshError::NotFinite { vertex: weld.vertex_of_point[vertex as usize] },
        other => other,
    };
    Failure::Mesh { path: path.to_owned(), source }
}

/// What the solver says about the surface points of the mesh at `path`, as a failure about its vertices. What it says
/// about handles cannot happen: [`super::handles_file`] has checked them.
pub(super) fn unsolvable(source: SolveError, path: &Path, weld: &Weld) -> Failure {
    let path = path.to_owned();
    match source {
        SolveError::Indefinite { vertex } => {
            Failure::Indefinite { path, vertex: weld.vertex_of_point[vertex as usize] as usize }
        }
        source => Failure::Solve { path, source },
    }
}

/// A result that is not finite must never reach a file.
pub(super) fn check_finite(positions: &[DVec3], weld: &Weld) -> Result<(), Failure> {
    match positions.iter().position(|position| !position.is_finite()) {
        Some(point) => Err(Failure::NotFinite { vertex: weld.vertex_of_point[point] as usize }),
        None => Ok(()),
    }
}

/// Says which parts nothing holds: they stay at rest while the rest moves on.
pub(super) fn loose(loose: &[(usize, VertexId)], weld: &Weld) -> Vec<String> {
    let mut warnings = Vec::new();
    let in_file = |vertex: VertexId| weld.vertex_of_point[vertex.index()];
    let (single, large): (Vec<_>, Vec<_>) = loose.iter().copied().partition(|&(count, _)| count == 1);
    for &(count, first) in large.iter().take(LOOSE_NAMED) {
        let first = in_file(first);
        warnings.push(format!("component of {count} vertices has no handle and stays at rest (first: vertex {first})"));
    }
    if let Some(&(_, first)) = large.get(LOOSE_NAMED) {
        let more = large.len() - LOOSE_NAMED;
        let first = in_file(first);
        warnings.push(format!("{more} more components have no handle and stay at rest (first: vertex {first})"));
    }
    if let Some(&(_, first)) = single.first() {
        let (count, first) = (single.len(), in_file(first));
        let noun = if count == 1 {
            "vertex has no edge, no handle and stays"
        } else {
            "vertices have no edge, no handle and stay"
        };
        warnings.push(format!("{count} {noun} at rest (first: vertex {first})"));
    }
    warnings
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices 0 and 1 are one point, 2 is the second.
    fn weld() -> Weld {
        Weld { point_of_vertex: vec![0, 0, 1], vertex_of_point: vec![0, 2] }
    }

    #[test]
    fn failures_of_the_surface_name_the_file_and_its_own_vertices() {
        let path = Path::new("bar.obj");
        let far = refused(MeshError::NotFinite { vertex: 1 }, path, &weld()).to_string();
        assert!(far.starts_with("bar.obj: vertex 2 "), "{far}");
        let indefinite = unsolvable(SolveError::Indefinite { vertex: 1 }, path, &weld()).to_string();
        assert!(indefinite.starts_with("bar.obj: ") && indefinite.contains("vertex 2)"), "{indefinite}");
        assert!(indefinite.contains("--weights clamped"), "{indefinite}");
    }
}
