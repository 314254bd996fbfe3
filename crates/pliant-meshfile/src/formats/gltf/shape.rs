//! A glTF file as a plain mesh for other formats, and its directions for a new shape.

use super::access::Data;
use super::{Block, GltfSource, Primitive, json};
use crate::formats::Edit;
use crate::normals;
use crate::shape::{Corner, Material, NONE, Shape, ShapePart};
use glam::{DMat3, DQuat, DVec3, Vec3};
use serde_json::Value;
use std::collections::HashMap;

/// Base color factor of a material: white where it says none.
pub(super) fn base_color(material: &Value) -> [f32; 4] {
    let rough = material.get("pbrMetallicRoughness");
    let factor = rough.and_then(|rough| json::numbers::<4>(rough, "baseColorFactor", "").ok().flatten());
    factor.unwrap_or([1.0; 4]).map(|x| super::read::finite(x, 1.0))
}

/// The rotation of each file vertex's normal, `None` where its faces did not change.
///
/// Copies of a surface point with the same normal turn together (see [`crate::normals`]).
pub(super) fn vertex_turns(source: &GltfSource, edit: &Edit<'_>) -> Vec<Option<DQuat>> {
    let mesh = edit.mesh;
    let mut keys: Vec<(u32, [u32; 3])> = mesh.weld.point_of_vertex.iter().map(|&point| (point, [0; 3])).collect();
    let mut seen = vec![false; source.blocks.len()];
    for primitive in &source.primitives {
        if primitive.normal.is_none() || std::mem::replace(&mut seen[primitive.block], true) {
            continue;
        }
        let Some(normals) = directions(source, primitive.normal) else { continue };
        for (key, normal) in keys[source.blocks[primitive.block].vertices.clone()].iter_mut().zip(&normals) {
            key.1 = [normal[0], normal[1], normal[2]].map(|x| (x as f32 + 0.0).to_bits());
        }
    }
    let mut clusters = HashMap::new();
    let cluster_of_vertex: Vec<u32> = keys
        .into_iter()
        .map(|key| {
            let next = clusters.len() as u32;
            *clusters.entry(key).or_insert(next)
        })
        .collect();
    let cluster = |t: usize, k: usize| Some(cluster_of_vertex[mesh.triangles[t][k] as usize]);
    let turns = normals::turns(&mesh.triangles, clusters.len(), cluster, &mesh.positions, &edit.positions);
    cluster_of_vertex.iter().map(|&cluster| turns[cluster as usize]).collect()
}

/// The elements of a directional attribute, the fourth number zero where it has three.
pub(super) fn directions(source: &GltfSource, accessor: Option<usize>) -> Option<Vec<[f64; 4]>> {
    let checked = Data::from(source).accessor(accessor?).ok()?;
    let element = |e: &[f64]| [e[0], e[1], e[2], e.get(3).copied().unwrap_or(0.0)];
    Some(checked.numbers().chunks_exact(checked.width).filter(|e| e.len() >= 3).map(element).collect())
}

/// A local normal turned in the world. Normals go to the world by the inverse transpose.
pub(super) fn turned_normal(block: &Block, turn: DQuat, local: DVec3) -> Vec3 {
    let to_world = DMat3::from_mat4(block.local_from_world).transpose();
    let to_local = DMat3::from_mat4(block.world_from_local).transpose();
    (to_local * (turn * (to_world * local))).try_normalize().unwrap_or(local).as_vec3()
}

/// A local tangent turned in the world; tangents go along with positions.
pub(super) fn turned_tangent(block: &Block, turn: DQuat, local: DVec3) -> Vec3 {
    let to_world = DMat3::from_mat4(block.world_from_local);
    let to_local = DMat3::from_mat4(block.local_from_world);
    (to_local * (turn * (to_world * local))).try_normalize().unwrap_or(local).as_vec3()
}

/// The edited mesh in world space. Lists of attributes run along the file vertices.
pub(super) fn shape(source: &GltfSource, edit: &Edit<'_>) -> Shape {
    let mesh = edit.mesh;
    let normals = world_normals(source, edit);
    let uvs = mesh.uvs.clone().unwrap_or_default();
    let mut triangles = Vec::with_capacity(mesh.triangles.len());
    let mut parts = Vec::new();
    let materials = json::list(&source.document, "materials").unwrap_or_default();
    for primitive in &source.primitives {
        let either = |has: bool, vertex: u32| if has { vertex } else { NONE };
        let (has_uv, has_normal) = (primitive.uv.is_some() && !uvs.is_empty(), primitive.normal.is_some());
        let corner = |vertex| Corner { vertex, uv: either(has_uv, vertex), normal: either(has_normal, vertex) };
        triangles.extend(mesh.triangles[primitive.triangles.clone()].iter().map(|t| t.map(corner)));
    }
    let with_faces = source.primitives.iter().filter(|primitive| !primitive.triangles.is_empty());
    for (part, primitive) in mesh.parts.iter().zip(with_faces) {
        parts.push(ShapePart {
            name: part.name.clone(),
            triangles: part.triangles.clone(),
            material: primitive.material,
        });
    }
    let material = |(i, value): (usize, &Value)| Material {
        name: json::name(value).map_or_else(|| format!("material{i}"), str::to_owned),
        base_color: base_color(value),
    };
    Shape {
        positions: edit.positions.clone(),
        uvs,
        normals,
        colors: mesh.colors.clone(),
        triangles,
        parts,
        materials: materials.iter().enumerate().map(material).collect(),
        rigidity: edit.rigidity.clone().or_else(|| mesh.rigidity.clone()),
        left_behind: left_behind(source),
    }
}

fn world_normals(source: &GltfSource, edit: &Edit<'_>) -> Vec<Vec3> {
    if source.primitives.iter().all(|primitive: &Primitive| primitive.normal.is_none()) {
        return Vec::new();
    }
    let turns = vertex_turns(source, edit);
    let mut normals = vec![Vec3::Z; edit.positions.len()];
    let mut seen = vec![false; source.blocks.len()];
    for primitive in &source.primitives {
        if primitive.normal.is_none() || std::mem::replace(&mut seen[primitive.block], true) {
            continue;
        }
        let block = &source.blocks[primitive.block];
        let to_world = DMat3::from_mat4(block.local_from_world).transpose();
        let Some(local) = directions(source, primitive.normal) else { continue };
        for (vertex, local) in block.vertices.clone().zip(local) {
            let world = (to_world * DVec3::new(local[0], local[1], local[2])).normalize_or(DVec3::Z);
            normals[vertex] = turns[vertex].map_or(world, |turn| turn * world).as_vec3();
        }
    }
    normals
}

fn left_behind(source: &GltfSource) -> Vec<&'static str> {
    let kinds = [
        ("textures", "textures"),
        ("skins", "skins"),
        ("animations", "animations"),
        ("cameras", "cameras"),
        ("nodes", "the node tree and instances"),
    ];
    let held = |key: &str| json::list(&source.document, key).is_ok_and(|items| !items.is_empty());
    let mut left: Vec<&str> = kinds.iter().filter(|(key, _)| held(key)).map(|(_, words)| *words).collect();
    let single = json::list(&source.document, "nodes").is_ok_and(|nodes| nodes.len() == 1);
    left.retain(|words| !(single && *words == "the node tree and instances"));
    left
}
