//! The same glTF document with new positions, normals, tangents and rigidity appended, and nothing else touched.
//!
//! What else depends on the shape stays as its author made it: the weights of skins, which belong to vertices whatever
//! their place, and the displacements of morph targets, which add to the bent shape as they added to the old one. Where
//! bending turned the surface they do not turn along; whether they should only their author could say.

use super::access::Data;
use super::builder::Builder;
use super::leave_draco::Leaving;
use super::relocate::relocate;
use super::source::{Block, GltfSource, Primitive};
use super::{container, patch, shape};
use crate::formats::{Edit, Output};
use crate::{Format, SaveError, Warning};
use glam::{DQuat, DVec3};
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;

/// The file again with the edit. Without any change and of the same kind it is the same file to the byte.
pub(super) fn rewrite(source: &GltfSource, edit: &Edit<'_>, to: &Path, format: Format) -> Result<Output, SaveError> {
    let glb = format == Format::Glb;
    let mut place = relocate(source, to, glb);
    let extended = place.chunk.as_deref().filter(|_| place.extensible);
    let mut added = Builder::after(&place.document, extended);
    let mut replaced = Vec::new();
    let turns =
        edit.positions.iter().enumerate().any(|(v, _)| edit.moved(v)).then(|| shape::vertex_turns(source, edit));
    let rigidity = edit.rigidity.as_deref().filter(|&r| edit.mesh.rigidity.as_deref() != Some(r));
    if let Some(vertex) = first_out_of_range(source, edit) {
        return Err(SaveError::NotFinite { path: to.to_owned(), vertex });
    }
    let writer = Writer { source, edit, turns: turns.as_deref(), rigidity };
    let mut known = HashMap::new();
    for primitive in &source.primitives {
        for attribute in ["POSITION", "NORMAL", "TANGENT", "_RIGIDITY"] {
            let Some(key) = writer.key(primitive, attribute) else { continue };
            let accessor = *known.entry(key).or_insert_with(|| writer.append(primitive, attribute, &mut added));
            if let Some(accessor) = accessor {
                replaced.push((primitive.mesh, primitive.index, attribute, accessor));
            }
        }
    }
    if replaced.is_empty() && !place.changed {
        return pack(source, source.container.json.clone(), place.chunk, glb, to, place.warnings);
    }
    for &(mesh, primitive, attribute, accessor) in &replaced {
        let attributes = format!("/meshes/{mesh}/primitives/{primitive}/attributes");
        if let Some(slot) = place.document.pointer_mut(&attributes).and_then(Value::as_object_mut) {
            slot.insert(attribute.into(), accessor.into());
        }
    }
    let mut leaving = Leaving::new(source);
    for &(mesh, primitive, attribute, _) in &replaced {
        if let Some(primitive) = place.document.pointer_mut(&format!("/meshes/{mesh}/primitives/{primitive}")) {
            leaving.changed(primitive, attribute, &mut added);
        }
    }
    leaving.finish(&mut place.document);
    added.attach(&mut place.document, place.chunk.as_mut().filter(|_| place.extensible));
    let json = match patch::patched(&source.container.json, &source.document, &place.document) {
        Some(text) => text,
        None => serde_json::to_vec(&place.document)
            .map_err(|error| SaveError::Encode { path: to.to_owned(), reason: error.to_string() })?,
    };
    pack(source, json, place.chunk, glb, to, place.warnings)
}

pub(super) fn pack(
    source: &GltfSource,
    json: Vec<u8>,
    chunk: Option<Vec<u8>>,
    glb: bool,
    to: &Path,
    warnings: Vec<Warning>,
) -> Result<Output, SaveError> {
    let bytes = if glb {
        let had_chunk = source.container.binary.is_some();
        let chunk = chunk.filter(|chunk| had_chunk || !chunk.is_empty());
        container::glb(json, chunk.as_deref(), &source.container.others, to)?
    } else {
        container::text(json, to)?
    };
    Ok(Output { bytes, beside: Vec::new(), warnings, origin: None })
}

/// The first vertex whose local position does not fit single precision.
fn first_out_of_range(source: &GltfSource, edit: &Edit<'_>) -> Option<usize> {
    source.blocks.iter().find_map(|block| {
        block.vertices.clone().find(|&vertex| {
            let local = block.local_from_world.transform_point3(edit.positions[vertex]);
            edit.moved(vertex) && !local.as_vec3().is_finite()
        })
    })
}

struct Writer<'a> {
    source: &'a GltfSource,
    edit: &'a Edit<'a>,
    turns: Option<&'a [Option<DQuat>]>,
    rigidity: Option<&'a [u16]>,
}

/// What a new accessor stands for: block, attribute, and the accessor it replaces.
type Key = (usize, &'static str, usize);

impl Writer<'_> {
    fn key(&self, primitive: &Primitive, attribute: &'static str) -> Option<Key> {
        let replaces = match attribute {
            "POSITION" => self.turns.map(|_| self.source.blocks[primitive.block].accessor),
            "NORMAL" => self.turns.and(primitive.normal),
            "TANGENT" => self.turns.and(primitive.tangent),
            _ => self.rigidity.map(|_| usize::MAX),
        };
        replaces.map(|accessor| (primitive.block, attribute, accessor))
    }

    /// A new accessor for an attribute, or `None` when nothing in it changed.
    fn append(&self, primitive: &Primitive, attribute: &str, added: &mut Builder) -> Option<usize> {
        let block = &self.source.blocks[primitive.block];
        match attribute {
            "POSITION" => self.positions(block, added),
            "NORMAL" => self.directions(block, primitive.normal, 3, added),
            "TANGENT" => self.directions(block, primitive.tangent, 4, added),
            _ => Some(added.rigidity(&self.rigidity?[block.vertices.clone()])),
        }
    }

    fn positions(&self, block: &Block, added: &mut Builder) -> Option<usize> {
        if !block.vertices.clone().any(|vertex| self.edit.moved(vertex)) {
            return None;
        }
        let old = Data::from(self.source).accessor(block.accessor).ok()?.numbers();
        let mut numbers = Vec::with_capacity(old.len());
        for (vertex, old) in block.vertices.clone().zip(old.chunks_exact(3)) {
            // What did not move keeps its number to the bit.
            let local = if self.edit.moved(vertex) {
                block.local_from_world.transform_point3(self.edit.positions[vertex])
            } else {
                DVec3::new(old[0], old[1], old[2])
            };
            numbers.extend(local.as_vec3().to_array());
        }
        Some(added.floats(&numbers, 3, true))
    }

    fn directions(&self, block: &Block, accessor: Option<usize>, width: usize, added: &mut Builder) -> Option<usize> {
        let turns = &self.turns?[block.vertices.clone()];
        if turns.iter().all(Option::is_none) {
            return None;
        }
        let old = shape::directions(self.source, accessor)?;
        let mut numbers = Vec::with_capacity(old.len() * width);
        for (old, turn) in old.iter().zip(turns) {
            let direction = DVec3::new(old[0], old[1], old[2]);
            let new = match turn {
                None => direction.as_vec3(),
                Some(turn) if width == 3 => shape::turned_normal(block, *turn, direction),
                Some(turn) => shape::turned_tangent(block, *turn, direction),
            };
            numbers.extend(new.to_array());
            if width == 4 {
                numbers.push(old[3] as f32);
            }
        }
        Some(added.floats(&numbers, width, false))
    }
}
