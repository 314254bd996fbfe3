//! Documents that tests of several modules begin with: sheets of `row` by `row` vertices, one row after the other.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_meshfile::MeshFile;
use pliant_solver::VertexId;

use crate::document::{Command, Document, GroupKind, Model};

/// A flat sheet with nothing held.
pub(crate) fn flat_sheet(row: u32) -> Document {
    sheet(row, |x, y| DVec3::new(x, y, 0.0))
}

/// An uneven sheet with nothing held: a flat one can stay on a ridge between valleys.
pub(crate) fn uneven_sheet(row: u32) -> Document {
    sheet(row, |x, y| DVec3::new(x, y, 0.9 * (0.7 * x).sin() * (0.5 * y + 0.2).cos() + 0.1 * x))
}

/// The same document with the first row as an anchor and the last as a handle.
pub(crate) fn held_at_two_sides(mut document: Document, row: u32) -> Document {
    for (kind, first) in [(GroupKind::Anchor, 0), (GroupKind::Handle, row * (row - 1))] {
        let vertices = (first..first + row).map(VertexId).collect();
        document.apply(Command::Hold { kind, vertices }).expect("they exist");
    }
    document
}

/// Moves that handle, from where it is at rest.
pub(crate) fn move_handle(document: &mut Document, motion: DAffine3) {
    let group = document.scene().groups[1].id;
    document.apply(Command::Move { group, motion }).expect("finite");
}

fn sheet(row: u32, at: impl Fn(f64, f64) -> DVec3) -> Document {
    let points = (0..row * row).map(|v| at(f64::from(v % row), f64::from(v / row))).collect();
    let cells = (0..row * (row - 1)).filter(|v| v % row < row - 1);
    let triangles = cells.flat_map(|v| [[v, v + 1, v + row + 1], [v, v + row + 1, v + row]]).collect();
    let file = MeshFile::from_triangles("sheet", points, triangles);
    Document::new(Arc::new(Model::from_file(file).expect("a good mesh")))
}
