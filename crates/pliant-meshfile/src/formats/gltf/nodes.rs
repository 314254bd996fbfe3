//! Where meshes stand in the world.

use super::json;
use crate::{Fault, Warning, budget};
use glam::{DMat4, DQuat, DVec3, DVec4};
use serde_json::Value;

/// Where a mesh stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// The node that places it; none for a mesh that no node uses.
    pub(super) node: Option<usize>,
    /// World transform of that node, or the identity where it is not used: for skins, and for nodes that flatten.
    pub(super) transform: DMat4,
    /// Whether the transform is left aside because it flattens.
    pub(super) flattened: bool,
}

/// The placement of each mesh: by the first node of the default scene that uses it, by the first node anywhere for a
/// mesh outside that scene, and none for a mesh that no node uses or that a skin carries.
pub(super) fn placements(
    document: &Value,
    n_meshes: usize,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Placement>, Fault> {
    let nodes = json::list(document, "nodes")?;
    let graph = Graph::new(nodes)?;
    let world = graph.world_transforms()?;
    let mut of_mesh: Vec<Option<Placement>> = vec![None; n_meshes];
    let mut uses = Uses { n_nodes: vec![0; n_meshes], n_shown: 0, multiplied: None };
    let in_scene = scene_order(document, &graph.children, nodes.len())?;
    let n_in_scene = in_scene.len();
    for (i, node) in in_scene.into_iter().chain(0..nodes.len()).enumerate() {
        let place = format!("node {node}");
        let Some(mesh) = json::reference(&nodes[node], "mesh", &place, "mesh", n_meshes)? else { continue };
        uses.count(&nodes[node], node, mesh, i < n_in_scene);
        if of_mesh[mesh].is_some() {
            continue;
        }
        // A skin places its mesh by its joints alone.
        let skinned = nodes[node].get("skin").is_some();
        let transform = if skinned { DMat4::IDENTITY } else { world[node] };
        let flattened = flattens(transform);
        if flattened {
            warnings.push(Warning(format!("node {node} flattens its mesh, which is shown without its transform")));
        }
        let transform = if flattened { DMat4::IDENTITY } else { transform };
        of_mesh[mesh] = Some(Placement { node: Some(node), transform, flattened });
    }
    uses.tell(document, warnings);
    let nowhere = Placement { node: None, transform: DMat4::IDENTITY, flattened: false };
    Ok(of_mesh.into_iter().map(|placement| placement.unwrap_or(nowhere)).collect())
}

/// How often meshes are used, in the default scene or behind it.
struct Uses {
    /// Nodes of the default scene that use each mesh.
    n_nodes: Vec<usize>,
    /// Meshes in the default scene.
    n_shown: usize,
    /// The first node that stands for many.
    multiplied: Option<usize>,
}

impl Uses {
    fn count(&mut self, node: &Value, index: usize, mesh: usize, in_scene: bool) {
        if !in_scene {
            return;
        }
        self.n_shown += usize::from(self.n_nodes[mesh] == 0);
        self.n_nodes[mesh] += 1;
        let is_many = node.get("extensions").is_some_and(|all| all.get(INSTANCING).is_some());
        if is_many && self.multiplied.is_none() {
            self.multiplied = Some(index);
        }
    }

    /// Says what a person sees otherwise than in a viewer.
    fn tell(&self, document: &Value, warnings: &mut Vec<Warning>) {
        let mut shared = self.n_nodes.iter().enumerate().filter(|&(_, &n)| n > 1);
        if let Some((mesh, n)) = shared.next() {
            let name = document.pointer(&format!("/meshes/{mesh}")).and_then(json::name);
            let name = name.map_or_else(|| format!("mesh {mesh}"), crate::rigidity::quoted);
            let more = match shared.count() {
                0 => String::new(),
                n => format!(", and {n} more like it"),
            };
            let text = format!("{name} stands at {n} places in the scene{more}: shown at the first, all bend alike");
            warnings.push(Warning(text));
        }
        if let Some(node) = self.multiplied {
            let text = format!("node {node} stands for many ({INSTANCING}): its mesh is shown once, all bend alike");
            warnings.push(Warning(text));
        }
        let n_hidden = self.n_nodes.len() - self.n_shown;
        // A file without any scene is a library of meshes.
        if n_hidden > 0 && self.n_shown > 0 {
            let noun = if n_hidden == 1 { "mesh is" } else { "meshes are" };
            warnings.push(Warning(format!("{n_hidden} {noun} outside the default scene and shown all the same")));
        }
    }
}

/// The extension by which a node places its mesh many times.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Of the volume that the longest axis would give, what counts as none: products of transforms that flatten leave the
/// rounding of double precision, and a mesh a millionth as thick as wide in two directions is no surface either.
const FLAT: f64 = 1e-12;

/// Whether a transform cannot be undone: it takes everything to a plane, a line or a point, or beyond numbers.
pub(super) fn flattens(transform: DMat4) -> bool {
    let axes = [transform.x_axis, transform.y_axis, transform.z_axis].map(|axis| axis.truncate());
    let longest = axes.iter().map(|axis| axis.length()).fold(0.0, f64::max);
    let volume = (axes[0] / longest).cross(axes[1] / longest).dot(axes[2] / longest).abs();
    let invertible = transform.is_finite() && transform.inverse().is_finite() && volume > FLAT;
    !invertible
}

/// The nodes as a forest.
#[derive(Debug)]
pub(super) struct Graph {
    pub(super) parents: Vec<Option<usize>>,
    pub(super) locals: Vec<Local>,
    children: Vec<Vec<usize>>,
}

impl Graph {
    /// Checks every node: children exist and have one parent, transforms are finite.
    pub(super) fn new(nodes: &[Value]) -> Result<Graph, Fault> {
        budget::check("nodes", nodes.len() as u64, budget::NODES)?;
        let mut children = vec![Vec::new(); nodes.len()];
        let mut parents = vec![None; nodes.len()];
        for (i, node) in nodes.iter().enumerate() {
            for child in node.get("children").and_then(Value::as_array).into_iter().flatten() {
                let place = format!("node {i}");
                let child = child.as_u64().filter(|&child| child < nodes.len() as u64).ok_or_else(|| {
                    let problem = format!("names a child that does not exist, the file has {}", nodes.len());
                    Fault::at(place.as_str(), problem)
                })? as usize;
                if parents[child].replace(i).is_some() {
                    return Err(Fault::at(format!("node {child}"), "has two parents"));
                }
                children[i].push(child);
            }
        }
        let locals = nodes.iter().enumerate().map(|(i, node)| Local::of(node, i)).collect::<Result<_, _>>()?;
        Ok(Graph { parents, locals, children })
    }

    /// Every node, parents before children.
    pub(super) fn order(&self) -> Result<Vec<usize>, Fault> {
        let n = self.parents.len();
        let mut open: Vec<usize> = (0..n).filter(|&node| self.parents[node].is_none()).collect();
        let mut order = Vec::with_capacity(n);
        while let Some(node) = open.pop() {
            order.push(node);
            open.extend(&self.children[node]);
        }
        if order.len() == n {
            return Ok(order);
        }
        // With one parent each, what no root reaches goes in a circle.
        let mut reached = vec![false; n];
        order.into_iter().for_each(|node| reached[node] = true);
        let node = reached.iter().position(|&reached| !reached).unwrap_or(0);
        Err(Fault::at(format!("node {node}"), "is its own ancestor"))
    }

    fn world_transforms(&self) -> Result<Vec<DMat4>, Fault> {
        let mut world = vec![DMat4::IDENTITY; self.parents.len()];
        for node in self.order()? {
            let parent = self.parents[node].map_or(DMat4::IDENTITY, |parent| world[parent]);
            world[node] = parent * self.locals[node].matrix();
        }
        Ok(world)
    }
}

/// The transform of a node within its parent.
#[derive(Clone, Copy, Debug)]
pub(super) enum Local {
    Matrix(DMat4),
    Parts(Parts),
}

/// A transform that can be animated: scale, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parts {
    pub(super) translation: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: DVec3,
}

impl Local {
    fn of(node: &Value, index: usize) -> Result<Local, Fault> {
        let place = format!("node {index}");
        if let Some(matrix) = json::numbers::<16>(node, "matrix", &place)? {
            // A few units of single precision away is a writer's rounding; more is a projection.
            return affine(DMat4::from_cols_array(&matrix), 1e-6, &place).map(Local::Matrix);
        }
        let scale = json::numbers(node, "scale", &place)?.map_or(DVec3::ONE, DVec3::from_array);
        let rotation = json::numbers(node, "rotation", &place)?.map_or(DQuat::IDENTITY, DQuat::from_array);
        let translation = json::numbers(node, "translation", &place)?.map_or(DVec3::ZERO, DVec3::from_array);
        Ok(Local::Parts(Parts { translation, rotation: unit(rotation), scale }))
    }

    pub(super) fn matrix(&self) -> DMat4 {
        match *self {
            Local::Matrix(matrix) => matrix,
            Local::Parts(Parts { translation, rotation, scale }) => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }

    /// The same in parts; none for a matrix that flattens.
    pub(super) fn parts(&self) -> Option<Parts> {
        match *self {
            Local::Parts(parts) => Some(parts),
            Local::Matrix(matrix) => {
                let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
                let parts = Parts { translation, rotation, scale };
                (scale.is_finite() && rotation.is_finite() && translation.is_finite()).then_some(parts)
            }
        }
    }
}

/// The matrix with the last row [0, 0, 0, 1] to the bit, from which it may differ by `tolerance`.
pub(super) fn affine(matrix: DMat4, tolerance: f64, place: &str) -> Result<DMat4, Fault> {
    let last = matrix.row(3);
    if !last.abs_diff_eq(DVec4::W, tolerance) {
        return Err(Fault::at(place, format!("the last row of its matrix is {last}, it must be [0, 0, 0, 1]")));
    }
    Ok(DMat4 {
        x_axis: matrix.x_axis.with_w(0.0),
        y_axis: matrix.y_axis.with_w(0.0),
        z_axis: matrix.z_axis.with_w(0.0),
        w_axis: matrix.w_axis.with_w(1.0),
    })
}

/// Single-precision quaternions are a little off unit length; one of zeros turns nothing.
pub(super) fn unit(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length > 0.0 { rotation / length } else { DQuat::IDENTITY }
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
