//! Regions for the flood fill, each from where it was clicked.

use pliant_solver::{Mesh, Rigidity, VertexId};

use super::{Model, Selection};

/// The vertices that can be reached from `seed` along edges without leaving its value of r; sorted. O(region) and one
/// bit of work a vertex.
pub fn region_of_equal_rigidity(mesh: &Mesh, rigidity: &Rigidity, seed: VertexId) -> Vec<VertexId> {
    let r = rigidity.as_slice();
    flood(mesh, seed, |v| r[v.index()] == r[seed.index()])
}

/// The vertices that can be reached from `seed` along edges without crossing the edge of the selection, from either side;
/// sorted.
pub fn region_by_selection(mesh: &Mesh, selection: &Selection, seed: VertexId) -> Vec<VertexId> {
    let mut is_selected = vec![false; mesh.n_vertices()];
    selection.vertices().iter().for_each(|v| is_selected[v.index()] = true);
    flood(mesh, seed, |v| is_selected[v.index()] == is_selected[seed.index()])
}

/// All vertices that hang together with `seed`; sorted.
pub fn region_of_piece(mesh: &Mesh, seed: VertexId) -> Vec<VertexId> {
    let pieces = mesh.components();
    let piece = pieces[seed.index()];
    (0..).zip(pieces).filter(|&(_, &other)| other == piece).map(|(v, _)| VertexId(v)).collect()
}

/// Corners of the triangles that `of_face` puts where it puts `face`; sorted.
pub fn region_of_faces(mesh: &Mesh, of_face: &[u32], face: u32) -> Vec<VertexId> {
    let Some(&label) = of_face.get(face as usize) else { return Vec::new() };
    let inside = mesh.triangles().iter().zip(of_face).filter(|&(_, &other)| other == label);
    let mut is_reached = vec![false; mesh.n_vertices()];
    inside.for_each(|(corners, _)| corners.iter().for_each(|&v| is_reached[v as usize] = true));
    flagged(&is_reached)
}

/// Corners of the triangles in the part of the file that holds triangle `face`; sorted.
pub fn region_of_part(model: &Model, face: u32) -> Vec<VertexId> {
    let mut is_reached = vec![false; model.mesh.n_vertices()];
    let holds = |range: &std::ops::Range<usize>| range.contains(&(face as usize));
    if let Some(part) = model.file.parts.iter().find(|part| holds(&part.triangles)) {
        let faces = model.mesh.triangles().get(part.triangles.clone()).unwrap_or_default();
        faces.as_flattened().iter().for_each(|&v| is_reached[v as usize] = true);
    }
    flagged(&is_reached)
}

fn flood(mesh: &Mesh, seed: VertexId, belongs: impl Fn(VertexId) -> bool) -> Vec<VertexId> {
    let mut is_reached = vec![false; mesh.n_vertices()];
    is_reached[seed.index()] = true;
    let mut open = vec![seed];
    while let Some(v) = open.pop() {
        for &w in mesh.neighbors(v) {
            if !is_reached[w as usize] && belongs(VertexId(w)) {
                is_reached[w as usize] = true;
                open.push(VertexId(w));
            }
        }
    }
    flagged(&is_reached)
}

/// The vertices whose flag is set, ascending.
fn flagged(flags: &[bool]) -> Vec<VertexId> {
    (0..).zip(flags).filter(|&(_, &flag)| flag).map(|(v, _)| VertexId(v)).collect()
}
