//! Morph targets: displacements of a mesh's vertices, by name.

use super::super::access::{Component, Data};
use super::super::json;
use super::super::source::GltfSource;
use crate::{Fault, budget};
use glam::DVec3;
use serde_json::Value;
use std::collections::HashMap;

/// One shape that some meshes can take.
#[derive(Debug)]
pub(super) struct Target {
    /// As in the mesh's `extras.targetNames`, or made up from its number.
    pub(super) name: String,
    /// The blocks it displaces, ascending, each with the accessor of its displacements.
    pub(super) blocks: Vec<(usize, usize)>,
}

/// The lists of targets of a mesh's primitives have one length; the first counts.
pub(super) fn n_targets(mesh: &Value) -> usize {
    let primitives = mesh.get("primitives").and_then(Value::as_array);
    let first = primitives.and_then(|primitives| primitives.first());
    first.and_then(|primitive| primitive.get("targets")?.as_array()).map_or(0, Vec::len)
}

/// The targets of all meshes. Those of one name belong together: the face and the teeth of one smile.
pub(super) fn targets(source: &GltfSource) -> Result<Vec<Target>, Fault> {
    let mut targets: Vec<Target> = Vec::new();
    let mut of_name: HashMap<String, usize> = HashMap::new();
    let mut names = budget::Purse::of_names();
    let meshes = json::list(&source.document, "meshes")?;
    for (block, owner) in owners(source)?.iter().enumerate() {
        let named = meshes[owner.mesh].get("extras").and_then(|extras| extras.get("targetNames"));
        let named = named.and_then(Value::as_array);
        for (t, accessor) in of_block(source, owner)?.into_iter().enumerate() {
            let name = named.and_then(|names| names.get(t)?.as_str()).filter(|name| !name.trim().is_empty());
            let name = name.map_or_else(|| format!("target {t}"), |name| budget::short_name(name.to_owned()));
            names.spend(name.len())?;
            let next = targets.len();
            let target = *of_name.entry(name.clone()).or_insert(next);
            if target == next {
                targets.push(Target { name, blocks: Vec::new() });
            }
            let Some(accessor) = accessor else { continue };
            let blocks = &mut targets[target].blocks;
            // Two targets of one mesh with the same name: the first counts.
            if blocks.last().is_none_or(|&(last, _)| last != block) {
                blocks.push((block, accessor));
            }
        }
    }
    targets.retain(|target| !target.blocks.is_empty());
    Ok(targets)
}

/// The primitive that gave a block its place among the file vertices.
pub(super) struct Owner<'a> {
    pub(super) mesh: usize,
    pub(super) primitive: &'a Value,
    /// For messages.
    pub(super) place: String,
}

/// The owner of each block.
pub(super) fn owners(source: &GltfSource) -> Result<Vec<Owner<'_>>, Fault> {
    let meshes = json::list(&source.document, "meshes")?;
    let mut owners = Vec::with_capacity(source.blocks.len());
    for first in &source.primitives {
        // Blocks are numbered as primitives come to need them.
        if first.block == owners.len() {
            let place = format!("mesh {}, primitive {}", first.mesh, first.index);
            let primitive = meshes.get(first.mesh).and_then(|mesh| mesh.get("primitives")?.get(first.index));
            let primitive = primitive.ok_or_else(|| Fault::at(place.as_str(), "is not there"))?;
            owners.push(Owner { mesh: first.mesh, primitive, place });
        }
    }
    Ok(owners)
}

/// The accessors of a block's displacements, one a target; none for a target that leaves the block alone.
pub(super) fn of_block(source: &GltfSource, owner: &Owner<'_>) -> Result<Vec<Option<usize>>, Fault> {
    let n_accessors = json::list(&source.document, "accessors")?.len();
    let targets = owner.primitive.get("targets").and_then(Value::as_array);
    let position = |target: &Value| json::reference(target, "POSITION", &owner.place, "accessor", n_accessors);
    targets.into_iter().flatten().map(position).collect()
}

/// Adds `weight` times the displacements of an accessor.
pub(super) fn displace(data: Data<'_>, accessor: usize, weight: f64, positions: &mut [DVec3]) -> Result<(), Fault> {
    let checked = data.accessor(accessor)?;
    if checked.width != 3 || checked.component == Component::U32 {
        return Err(Fault::at(format!("accessor {accessor}"), "displacements are not three numbers"));
    }
    if checked.count != positions.len() {
        let problem = format!("displaces {} vertices, the primitive has {}", checked.count, positions.len());
        return Err(Fault::at(format!("accessor {accessor}"), problem));
    }
    for (position, delta) in positions.iter_mut().zip(checked.numbers().chunks_exact(3)) {
        *position += weight * DVec3::new(delta[0], delta[1], delta[2]);
    }
    Ok(())
}
