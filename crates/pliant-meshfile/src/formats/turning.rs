//! Normals that a file gives to its vertices, for a new shape.

use super::Edit;
use crate::normals;
use glam::{DQuat, Vec3};
use std::collections::HashMap;

/// The rotation of each file vertex's normal, `None` where its faces did not change.
///
/// There is a normal for every file vertex. Copies of a surface point with the same normal turn together (see [`crate::normals`]).
pub(super) fn vertex_turns(edit: &Edit<'_>, of_vertex: &[Vec3]) -> Vec<Option<DQuat>> {
    let mesh = edit.mesh;
    let mut clusters = HashMap::new();
    let cluster_of_vertex: Vec<u32> = mesh
        .weld
        .point_of_vertex
        .iter()
        .zip(of_vertex)
        .map(|(&point, normal)| {
            let next = clusters.len() as u32;
            // Adding 0.0 turns -0.0 into 0.0 and changes nothing else.
            *clusters.entry((point, normal.to_array().map(|x| (x + 0.0).to_bits()))).or_insert(next)
        })
        .collect();
    let cluster = |t: usize, k: usize| Some(cluster_of_vertex[mesh.triangles[t][k] as usize]);
    let turns = normals::turns(mesh.triangles, clusters.len(), cluster, mesh.positions, &edit.positions);
    cluster_of_vertex.iter().map(|&cluster| turns[cluster as usize]).collect()
}

/// Every normal for the new shape, of unit length; +Z where the file's is none. Without normals there are none.
pub(super) fn turned_normals(edit: &Edit<'_>, of_vertex: &[Vec3]) -> Vec<Vec3> {
    if of_vertex.is_empty() {
        return Vec::new();
    }
    let turns = vertex_turns(edit, of_vertex);
    let turned = |(&normal, turn): (&Vec3, Option<DQuat>)| turn.map_or(normal, |turn| normals::turned(normal, turn));
    of_vertex.iter().zip(turns).map(turned).map(|normal| normal.normalize_or(Vec3::Z)).collect()
}
