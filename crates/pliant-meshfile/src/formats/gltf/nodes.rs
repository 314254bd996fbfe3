//! Where meshes stand in the world.

use super::json;
use crate::{Fault, Warning, budget};
use glam::{DMat4, DQuat, DVec3, DVec4};
use serde_json::Value;

/// World transform of each mesh: that of the first node of the default scene that uses it, of the first node anywhere
/// for a mesh outside that scene, and none for a mesh that no node uses or that a skin carries.
pub(super) fn mesh_transforms(
    document: &Value,
    n_meshes: usize,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<DMat4>, Fault> {
    let nodes = json::list(document, "nodes")?;
    budget::check("nodes", nodes.len() as u64, budget::NODES)?;
    let (children, parents) = edges(nodes)?;
    let world = world_transforms(nodes, &children, &parents)?;
    let mut of_mesh: Vec<Option<DMat4>> = vec![None; n_meshes];
    for node in scene_order(document, &children, nodes.len())?.into_iter().chain(0..nodes.len()) {
        let place = format!("node {node}");
        let Some(mesh) = json::reference(&nodes[node], "mesh", &place, "mesh", n_meshes)? else { continue };
        if of_mesh[mesh].is_some() {
            continue;
        }
        // A skin places its mesh by its joints alone.
        let skinned = nodes[node].get("skin").is_some();
        let transform = if skinned { DMat4::IDENTITY } else { world[node] };
        let invertible = transform.is_finite() && transform.inverse().is_finite() && transform.determinant() != 0.0;
        if !invertible {
            warnings.push(Warning(format!("node {node} flattens its mesh, which is shown without its transform")));
        }
        of_mesh[mesh] = Some(if invertible { transform } else { DMat4::IDENTITY });
    }
    Ok(of_mesh.into_iter().map(|transform| transform.unwrap_or(DMat4::IDENTITY)).collect())
}

type Edges = (Vec<Vec<usize>>, Vec<Option<usize>>);

/// Children and parent of each node.
fn edges(nodes: &[Value]) -> Result<Edges, Fault> {
    let mut children = vec![Vec::new(); nodes.len()];
    let mut parents = vec![None; nodes.len()];
    for (i, node) in nodes.iter().enumerate() {
        for child in node.get("children").and_then(Value::as_array).into_iter().flatten() {
            let place = format!("node {i}");
            let child = child.as_u64().filter(|&child| child < nodes.len() as u64).ok_or_else(|| {
                Fault::at(place.as_str(), format!("names a child that does not exist, the file has {}", nodes.len()))
            })? as usize;
            if parents[child].replace(i).is_some() {
                return Err(Fault::at(format!("node {child}"), "has two parents"));
            }
            children[i].push(child);
        }
    }
    Ok((children, parents))
}

fn world_transforms(nodes: &[Value], children: &[Vec<usize>], parents: &[Option<usize>]) -> Result<Vec<DMat4>, Fault> {
    let mut world = vec![None; nodes.len()];
    let mut open: Vec<usize> = (0..nodes.len()).filter(|&node| parents[node].is_none()).collect();
    while let Some(node) = open.pop() {
        let local = local_transform(&nodes[node], node)?;
        let parent = parents[node].and_then(|parent| world[parent]).unwrap_or(DMat4::IDENTITY);
        world[node] = Some(parent * local);
        open.extend(&children[node]);
    }
    // With one parent each, what no root reaches goes in a circle.
    let all: Option<Vec<DMat4>> = world.iter().copied().collect();
    all.ok_or_else(|| {
        let node = world.iter().position(Option::is_none).unwrap_or(0);
        Fault::at(format!("node {node}"), "is its own ancestor")
    })
}

fn local_transform(node: &Value, index: usize) -> Result<DMat4, Fault> {
    let place = format!("node {index}");
    if let Some(matrix) = json::numbers::<16>(node, "matrix", &place)? {
        let matrix = DMat4::from_cols_array(&matrix);
        let last = matrix.row(3);
        // A few units of single precision away is a writer's rounding; more is a projection.
        if !last.abs_diff_eq(DVec4::W, 1e-6) {
            return Err(Fault::at(place, format!("the last row of its matrix is {last}, it must be [0, 0, 0, 1]")));
        }
        return Ok(DMat4 {
            x_axis: matrix.x_axis.with_w(0.0),
            y_axis: matrix.y_axis.with_w(0.0),
            z_axis: matrix.z_axis.with_w(0.0),
            w_axis: matrix.w_axis.with_w(1.0),
        });
    }
    let scale = json::numbers(node, "scale", &place)?.map_or(DVec3::ONE, DVec3::from_array);
    let rotation = json::numbers(node, "rotation", &place)?.map_or(DQuat::IDENTITY, DQuat::from_array);
    let translation = json::numbers(node, "translation", &place)?.map_or(DVec3::ZERO, DVec3::from_array);
    // Single-precision quaternions are a little off unit length; one of zeros turns nothing.
    let length = rotation.length();
    let rotation = if length > 0.0 { rotation / length } else { DQuat::IDENTITY };
    Ok(DMat4::from_scale_rotation_translation(scale, rotation, translation))
}

/// Nodes of the default scene, parents before children, in the order they are listed.
fn scene_order(document: &Value, children: &[Vec<usize>], n_nodes: usize) -> Result<Vec<usize>, Fault> {
    let scenes = json::list(document, "scenes")?;
    let default = json::reference(document, "scene", "document", "scene", scenes.len())?.unwrap_or(0);
    let roots = scenes.get(default).and_then(|scene| scene.get("nodes")).and_then(Value::as_array);
    let mut open: Vec<usize> = Vec::new();
    for root in roots.into_iter().flatten().rev() {
        let place = format!("scene {default}");
        let root = root.as_u64().filter(|&root| root < n_nodes as u64);
        open.push(root.ok_or_else(|| Fault::at(place, "names a node that does not exist"))? as usize);
    }
    let mut seen = vec![false; n_nodes];
    let mut order = Vec::new();
    while let Some(node) = open.pop() {
        if !std::mem::replace(&mut seen[node], true) {
            order.push(node);
            open.extend(children[node].iter().rev());
        }
    }
    Ok(order)
}
