//! Which vertex of a file stands for which vertex of the reference.
//!
//! Files of one format and one program list the same vertices in the same order, and the faces prove it. Other formats
//! list one place several times (STL once for every corner, glTF at every seam), so that vertices cannot be compared;
//! then the *corners* of the triangles are, in order: all corners of one surface point of the reference have to lie at
//! one place of the pose. Places are compared, whatever welding was wished for the files and whatever carries them.
//!
//! Faces prove little where no two triangles share a vertex: then they are 0, 1, 2 and so on in every file. Of a
//! reference that lists places several times, files with the same faces are therefore compared by corners too. Those of
//! one surface point may part at a seam, and are averaged later; where they part by more than a mean edge, two triangles
//! that meet in the reference are no neighbors in the file.

use super::PoseFault;
use crate::MeshFile;
use glam::DVec3;
use std::ops::Range;

/// Marks a vertex of the reference that no triangle uses, and a surface point not met so far.
const NOWHERE: u32 = u32::MAX;

/// How far corners of one surface point may part, in mean edges of the file. Of two soups of triangles in other orders
/// corners are apart by edges up to the whole mesh; the sides of a seam that are bound to different joints by less than
/// the stretch of an edge across it.
const SEAM: f64 = 1.0;

/// The vertex of a pose file for each file vertex of the reference.
#[derive(Debug)]
pub(super) enum Matching {
    /// The same one.
    Same,
    /// Another one, or [`NOWHERE`].
    Listed(Vec<u32>),
}

impl Matching {
    /// Finds the vertices of `file`, or the first difference.
    pub(super) fn new(file: &MeshFile, reference: &MeshFile, reference_faces: bool) -> Result<Matching, PoseFault> {
        let same_vertices = file.positions.len() == reference.positions.len();
        let difference = first_difference(file, reference);
        if same_vertices && reference_faces {
            return Ok(Matching::Same);
        }
        if same_vertices && difference.is_none() {
            return meets(file, reference).map(|()| Matching::Same);
        }
        let vertices = [file.positions.len(), reference.positions.len()];
        let triangles = [file.triangles.len(), reference.triangles.len()];
        if triangles[0] != triangles[1] {
            return Err(PoseFault::Counts { vertices, triangles });
        }
        by_corners(file, reference).map(Matching::Listed).map_err(|apart| match difference {
            // Where as many vertices are listed, a face's numbers say more than that its corners are apart.
            Some(face) if same_vertices => {
                PoseFault::Face { face, found: file.triangles[face], expected: reference.triangles[face] }
            }
            _ => apart,
        })
    }

    /// The positions of the reference's file vertices in a pose of the file; unused vertices stay.
    pub(super) fn apply(&self, pose: Vec<DVec3>, reference: &MeshFile) -> Vec<DVec3> {
        match self {
            Matching::Same => pose,
            Matching::Listed(vertices) => {
                let place = |(&vertex, &rest): (&u32, &DVec3)| pose.get(vertex as usize).copied().unwrap_or(rest);
                vertices.iter().zip(&reference.positions).map(place).collect()
            }
        }
    }
}

/// The first triangle that joins other vertices; polygons that were only cut elsewhere are the same.
fn first_difference(file: &MeshFile, reference: &MeshFile) -> Option<usize> {
    let (found, expected) = (&file.triangles, &reference.triangles);
    let same_polygons = file.polygons() == reference.polygons();
    let mut polygons = if same_polygons { reference.polygons() } else { &[] }.iter().peekable();
    let mut t = 0;
    while t < found.len().min(expected.len()) {
        if found[t] == expected[t] {
            t += 1;
            continue;
        }
        while polygons.next_if(|polygon| polygon.end as usize <= t).is_some() {}
        match polygons.peek().filter(|polygon| polygon.start as usize <= t) {
            Some(polygon) if same_outline(found, expected, polygon) => t = polygon.end as usize,
            _ => return Some(t),
        }
    }
    (found.len() != expected.len()).then_some(t)
}

/// Whether triangles of a polygon cover the same outline: what their edges leave over when inner ones cancel.
fn same_outline(found: &[[u32; 3]], expected: &[[u32; 3]], polygon: &Range<u32>) -> bool {
    let range = polygon.start as usize..polygon.end as usize;
    let outline = |triangles: &[[u32; 3]]| {
        // Each edge from its lower end: forth counts 1, back -1.
        let edges = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let mut edges: Vec<(u32, u32, i32)> = edges.map(|(a, b)| if a < b { (a, b, 1) } else { (b, a, -1) }).collect();
        edges.sort_unstable();
        let sums = edges.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1));
        let sums = sums.map(|same| (same[0].0, same[0].1, same.iter().map(|edge| edge.2).sum::<i32>()));
        sums.filter(|edge| edge.2 != 0).collect::<Vec<_>>()
    };
    match (found.get(range.clone()), expected.get(range)) {
        (Some(found), Some(expected)) => outline(found) == outline(expected),
        _ => false,
    }
}

/// Refuses a file with the reference's faces in which corners of one surface point part by more than [`SEAM`].
fn meets(file: &MeshFile, reference: &MeshFile) -> Result<(), PoseFault> {
    let places = reference.places();
    if places.n_points() == reference.positions.len() {
        return Ok(());
    }
    let (mut sum, mut n) = (0.0, 0.0);
    for &[a, b, c] in &file.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            sum += file.positions[a as usize].distance(file.positions[b as usize]);
            n += 1.0;
        }
    }
    // A file without any extent has no corner that is apart.
    let widest = SEAM * sum / n;
    // The vertex of each surface point that is met first, and the triangle that it is a corner of.
    let mut of_point = vec![(NOWHERE, 0); places.n_points()];
    for (face, triangle) in reference.triangles.iter().enumerate() {
        for &vertex in triangle {
            let known = &mut of_point[places.point_of_vertex[vertex as usize] as usize];
            if known.0 == NOWHERE {
                *known = (vertex, face);
            }
            if file.positions[vertex as usize].distance(file.positions[known.0 as usize]) > widest {
                return Err(PoseFault::Apart { vertex, faces: [known.1, face] });
            }
        }
    }
    Ok(())
}

/// The vertex at the same corner of the same triangle, for each file vertex of the reference.
fn by_corners(file: &MeshFile, reference: &MeshFile) -> Result<Vec<u32>, PoseFault> {
    let mut of_vertex = vec![NOWHERE; reference.positions.len()];
    let (places, their_places) = (reference.places(), file.places());
    // For each surface point of the reference the point of the pose, and the triangle that said so.
    let mut of_point = vec![(NOWHERE, 0); places.n_points()];
    for (face, (found, expected)) in file.triangles.iter().zip(&reference.triangles).enumerate() {
        for (&theirs, &vertex) in found.iter().zip(expected) {
            let point = their_places.point_of_vertex[theirs as usize];
            let known = &mut of_point[places.point_of_vertex[vertex as usize] as usize];
            if known.0 == NOWHERE {
                *known = (point, face);
            } else if known.0 != point {
                return Err(PoseFault::Apart { vertex, faces: [known.1, face] });
            }
            of_vertex[vertex as usize] = theirs;
        }
    }
    Ok(of_vertex)
}
