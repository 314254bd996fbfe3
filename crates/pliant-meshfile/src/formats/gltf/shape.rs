//! A glTF file as a plain mesh for other formats, and its directions for a new shape.

use super::access::Data;
use super::json;
use super::read::base_color;
use super::source::{Block, GltfSource, Primitive};
use crate::formats::Edit;
use crate::normals;
use crate::shape::{Corner, Material, NONE, Shape, ShapePart};
use glam::{DMat3, DQuat, DVec3, Vec3};
use serde_json::Value;
use std::collections::HashMap;

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
    let turns = normals::turns(mesh.triangles, clusters.len(), cluster, mesh.positions, &edit.positions);
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
        polygons: Vec::new(),
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

/// What the document holds and a shape does not.
fn left_behind(source: &GltfSource) -> Vec<&'static str> {
    let list = |key: &str| json::list(&source.document, key).unwrap_or_default();
    let primitives = || list("meshes").iter().filter_map(|mesh| mesh.get("primitives")?.as_array()).flatten();
    let has_attribute = |is: fn(&str) -> bool| {
        let mut attributes = primitives().filter_map(|primitive| primitive.get("attributes")?.as_object());
        attributes.any(|attributes| attributes.keys().any(|name| is(name)))
    };
    let filled = |value: Option<&Value>| value.and_then(Value::as_array).is_some_and(|items| !items.is_empty());
    let mut uses = HashMap::new();
    for mesh in list("nodes").iter().filter_map(|node| node.get("mesh")?.as_u64()) {
        *uses.entry(mesh).or_insert(0) += 1;
    }
    let kinds = [
        ("textures", !list("textures").is_empty()),
        ("tangents", has_attribute(|name| name == "TANGENT")),
        ("further texture coordinates", has_attribute(|name| name.starts_with("TEXCOORD_") && name != "TEXCOORD_0")),
        ("further colors", has_attribute(|name| name.starts_with("COLOR_") && name != "COLOR_0")),
        ("lines and points", primitives().any(|p| p.get("mode").and_then(Value::as_f64).is_some_and(|m| m < 4.0))),
        ("morph targets", primitives().any(|primitive| filled(primitive.get("targets")))),
        ("skins", !list("skins").is_empty()),
        ("animations", !list("animations").is_empty()),
        ("cameras", !list("cameras").is_empty()),
        ("instances of a mesh beyond its first", uses.values().any(|&n| n > 1)),
    ];
    kinds.into_iter().filter(|&(_, held)| held).map(|(words, _)| words).collect()
}
