//! Which vertices belong together: rings around a selection, whole components, equal r, parts of the file, and what a
//! fill reaches from a point.
//!
//! Everything here takes one pass over the surface, or less, so that it answers at once on a million vertices.

pub use pliant_meshfile::Part;
use pliant_solver::{Defect, Mesh, Rigidity, VertexId};

use super::{Model, Scene, Selection};

/// What vertices can have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Alike {
    /// Paths along edges: a component of the surface.
    Linked,
    /// r.
    Rigidity,
    /// A part or material of the file.
    Part,
}

/// The selection and the vertices one edge away from it.
pub fn grown(mesh: &Mesh, selection: &Selection) -> Selection {
    let mut is_in = selection.flags(mesh.n_vertices());
    for &v in selection.vertices() {
        mesh.neighbors(v).iter().for_each(|&w| is_in[w as usize] = true);
    }
    Selection::of_flags(&is_in)
}

/// The selection without the vertices that have a neighbor outside it.
pub fn shrunk(mesh: &Mesh, selection: &Selection) -> Selection {
    let is_in = selection.flags(mesh.n_vertices());
    let is_inner = |v: &VertexId| mesh.neighbors(*v).iter().all(|&w| is_in[w as usize]);
    Selection::new(selection.vertices().iter().copied().filter(is_inner).collect())
}

/// Every vertex that is not selected.
pub fn inverted(mesh: &Mesh, selection: &Selection) -> Selection {
    let mut flags = selection.flags(mesh.n_vertices());
    flags.iter_mut().for_each(|flag| *flag = !*flag);
    Selection::of_flags(&flags)
}

/// The vertices at edges with a single face.
pub fn border(mesh: &Mesh) -> Selection {
    if mesh.defects().boundary_edges == 0 {
        return Selection::default();
    }
    Selection::new(mesh.vertices_with(Defect::Boundary))
}

/// The vertices whose r lies in a range.
pub fn of_rigidity(scene: &Scene, range: std::ops::RangeInclusive<u16>) -> Selection {
    let r = scene.rigidity.as_slice();
    Selection::new((0..).zip(r).filter(|&(_, r)| range.contains(r)).map(|(v, _)| VertexId(v)).collect())
}

/// All vertices that have with at least one of `seeds` in common what is asked for.
pub fn alike(model: &Model, scene: &Scene, seeds: &[VertexId], alike: Alike) -> Selection {
    match alike {
        Alike::Linked => {
            let components = model.mesh.components();
            same_value(components.iter().map(|&c| c as usize), model.mesh.n_components(), seeds)
        }
        Alike::Rigidity => {
            let r = scene.rigidity.as_slice();
            same_value(r.iter().map(|&r| usize::from(r)), usize::from(u16::MAX) + 1, seeds)
        }
        Alike::Part => {
            let flags = Selection::new(seeds.to_vec()).flags(model.mesh.n_vertices());
            let is_in = |&v: &u32| flags[v as usize];
            let faces = |part: &Part| &model.triangles[part.triangles.clone()];
            // A seam between parts belongs to both, so that whole faces say more than single vertices.
            let holds_face = |part: &&Part| faces(part).iter().any(|face| face.iter().all(is_in));
            let holds_vertex = |part: &&Part| faces(part).as_flattened().iter().any(is_in);
            let parts = model.file.parts.iter();
            let chosen: Vec<&Part> = parts.clone().filter(holds_face).collect();
            of_parts(model, if chosen.is_empty() { parts.filter(holds_vertex).collect() } else { chosen })
        }
    }
}

/// The vertices with one of the values that `seeds` have; values are below `n_values`.
fn same_value(values: impl Iterator<Item = usize> + Clone, n_values: usize, seeds: &[VertexId]) -> Selection {
    let mut is_wanted = vec![false; n_values];
    let is_seed = Selection::new(seeds.to_vec());
    let mut seeds = is_seed.vertices().iter().map(|v| v.index()).peekable();
    for (v, value) in values.clone().enumerate() {
        if seeds.next_if_eq(&v).is_some() {
            is_wanted[value] = true;
        }
    }
    Selection::new((0..).zip(values).filter(|&(_, value)| is_wanted[value]).map(|(v, _)| VertexId(v)).collect())
}

/// The vertices at the faces of some parts of the file.
pub fn of_parts<'a>(model: &Model, parts: impl IntoIterator<Item = &'a Part>) -> Selection {
    of_faces(model.mesh.n_vertices(), parts.into_iter().flat_map(|part| &model.triangles[part.triangles.clone()]))
}

/// The part of the file that a triangle belongs to. O(log parts).
pub fn part_of_triangle(model: &Model, triangle: usize) -> Option<&Part> {
    let parts = &model.file.parts;
    let part = &parts[parts.partition_point(|part| part.triangles.start <= triangle).checked_sub(1)?];
    part.triangles.contains(&triangle).then_some(part)
}

/// Of some vertices, those next to one that is not among them: the rim of what is held.
pub fn rim(mesh: &Mesh, vertices: &[VertexId]) -> Vec<VertexId> {
    let is_in = Selection::new(vertices.to_vec()).flags(mesh.n_vertices());
    let is_inner = |&v: &VertexId| mesh.neighbors(v).iter().all(|&w| is_in[w as usize]);
    vertices.iter().copied().filter(|v| !is_inner(v)).collect()
}

/// The vertices that can be reached from `seed` along edges without leaving its value of r.
pub fn region_of_equal_rigidity(mesh: &Mesh, rigidity: &Rigidity, seed: VertexId) -> Selection {
    let r = rigidity.as_slice();
    flood(mesh, seed, |v| r[v.index()] == r[seed.index()])
}

/// The vertices that can be reached from `seed` along edges without crossing the edge of the selection, from either side.
pub fn region_by_selection(mesh: &Mesh, selection: &Selection, seed: VertexId) -> Selection {
    let is_selected = selection.flags(mesh.n_vertices());
    flood(mesh, seed, |v| is_selected[v.index()] == is_selected[seed.index()])
}

/// All vertices that hang together with `seed`.
pub fn region_of_piece(mesh: &Mesh, seed: VertexId) -> Selection {
    same_value(mesh.components().iter().map(|&c| c as usize), mesh.n_components(), &[seed])
}

/// The vertices at the faces that `of_face` puts where it puts `face`.
pub fn region_of_faces(mesh: &Mesh, of_face: &[u32], face: u32) -> Selection {
    let Some(&label) = of_face.get(face as usize) else { return Selection::default() };
    let inside = mesh.triangles().iter().zip(of_face).filter(|&(_, &other)| other == label);
    of_faces(mesh.n_vertices(), inside.map(|(face, _)| face))
}

/// The vertices at the faces of the part of the file that holds a triangle.
pub fn region_of_part(model: &Model, triangle: u32) -> Selection {
    of_parts(model, part_of_triangle(model, triangle as usize))
}

fn of_faces<'a>(n_vertices: usize, faces: impl IntoIterator<Item = &'a [u32; 3]>) -> Selection {
    let mut flags = vec![false; n_vertices];
    faces.into_iter().flatten().for_each(|&v| flags[v as usize] = true);
    Selection::of_flags(&flags)
}

fn flood(mesh: &Mesh, seed: VertexId, belongs: impl Fn(VertexId) -> bool) -> Selection {
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
    Selection::of_flags(&is_reached)
}
