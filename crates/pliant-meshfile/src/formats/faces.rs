//! Polygons over vertices, as PLY and OFF list them, into triangles.

use crate::{Fault, Warning, budget, polygon};
use glam::DVec3;
use std::ops::Range;

/// Polygons by their corners, collected before they are cut: a face may come before its vertices.
#[derive(Default)]
pub(super) struct Faces {
    corners: Vec<u32>,
    /// Where each face ends in `corners`.
    ends: Vec<u32>,
    n_triangles: u64,
    n_thin: usize,
    n_vertices: usize,
}

/// What faces were cut into.
pub(super) struct Cut {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Triangles of each face of more than three corners.
    pub(super) polygons: Vec<Range<u32>>,
    pub(super) warnings: Vec<Warning>,
}

impl Faces {
    pub(super) fn new(n_vertices: usize) -> Faces {
        Faces { n_vertices, ..Faces::default() }
    }

    /// Takes one more face, or says what is wrong with it.
    pub(super) fn push(&mut self, corners: &[u32]) -> Result<(), String> {
        if let Some(&corner) = corners.iter().find(|&&corner| corner as usize >= self.n_vertices) {
            return Err(format!("names vertex {corner}, the file has {}", self.n_vertices));
        }
        if corners.len() < 3 {
            self.n_thin += 1;
            return Ok(());
        }
        let checked = |what, found: u64, limit| budget::check(what, found, limit).map_err(|fault| fault.to_string());
        checked("corners of one polygon", corners.len() as u64, budget::POLYGON_CORNERS)?;
        self.n_triangles += corners.len() as u64 - 2;
        checked("triangles", self.n_triangles, budget::TRIANGLES)?;
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len() as u32);
        Ok(())
    }

    /// How many vertices faces may name.
    pub(super) fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Cuts all faces, in order.
    pub(super) fn cut(self, positions: &[DVec3]) -> Cut {
        let mut out = Cut { triangles: Vec::new(), polygons: Vec::new(), warnings: Vec::new() };
        out.triangles.reserve_exact(self.n_triangles as usize);
        let (mut outline, mut cut, mut tests) = (Vec::new(), Vec::new(), polygon::MAX_TESTS);
        let mut start = 0;
        for &end in &self.ends {
            let corners = &self.corners[start..end as usize];
            start = end as usize;
            if let &[a, b, c] = corners {
                out.triangles.push([a, b, c]);
                continue;
            }
            outline.clear();
            outline.extend(corners.iter().map(|&corner| positions[corner as usize]));
            cut.clear();
            polygon::triangulate(&outline, &mut tests, &mut cut);
            let first = out.triangles.len() as u32;
            out.triangles.extend(cut.iter().map(|t| t.map(|local| corners[local as usize])));
            out.polygons.push(first..out.triangles.len() as u32);
        }
        if self.n_thin > 0 {
            let text = format!("{} faces have fewer than three corners and were skipped", self.n_thin);
            out.warnings.push(Warning(text));
        }
        if tests == 0 {
            let text = "polygons are too intricate to cut with care: some triangles may be turned over";
            out.warnings.push(Warning(text.into()));
        }
        out
    }
}

/// What is said of a file without a surface.
pub(super) fn none(n_vertices: usize, others: &str) -> Fault {
    Fault::Container(format!("holds {n_vertices} vertices{others} and no faces: there is no surface to deform"))
}
