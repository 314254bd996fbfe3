//! A sheet with small hills, of any size.

use glam::DVec3;
use pliant_meshfile::MeshFile;
use pliant_solver::VertexId;

/// Cells along each side: 100,489 vertices.
pub(crate) const CELLS: u32 = 316;

/// A sheet with small hills, two triangles a cell.
pub(crate) fn bumpy_sheet(n: u32) -> MeshFile {
    let at = |i: u32, j: u32| {
        let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
        DVec3::new(x, y, 0.02 * (31.0 * x).sin() * (23.0 * y).cos())
    };
    let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| j * (n + 1) + i);
        [[a, b, c], [a, c, d]]
    });
    MeshFile::from_triangles("hills", positions, triangles.collect())
}

/// The vertices within so many rings of a vertex of the sheet: a hexagon.
pub(crate) fn patch(i: i64, j: i64, rings: i64) -> Vec<VertexId> {
    let around = (-rings..=rings).flat_map(|y| (-rings..=rings).map(move |x| (x, y)));
    let inside = around.filter(|(x, y)| (x - y).abs() <= rings).map(|(x, y)| (i + x, j + y));
    inside.map(|(i, j)| VertexId((j * i64::from(CELLS + 1) + i) as u32)).collect()
}
