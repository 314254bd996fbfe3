//! Morph targets and an animation of their weights, added to a document that was just written.
//!
//! **Idea.** Every shape is written as a file of its own, in memory, by what writes any bent shape: so normals turn, parts
//! stand where they stood, and what comes from another format is laid out as always. A target is what the numbers of such a
//! file and those of the file at rest differ by. Both list the same vertices in the same order, whatever is compressed.
//!
//! All primitives of a mesh have as many targets; where nothing moves they share one accessor of zeros.

mod weights;

use super::access::Data;
use super::builder::Builder;
use super::read::source_of;
use super::relocate::relocate;
use super::rewrite::pack;
use super::source::GltfSource;
use super::{json, patch};
use crate::formats::Output;
use crate::mesh_file::Morphs;
use crate::{Fault, Format, SaveError, files};
use serde_json::{Value, json};
use std::collections::{BTreeSet, HashMap};
use std::path::Path;

/// Gives the bytes of a GLB file with the shape of that number; none when it is no longer wanted.
pub(crate) type Shapes<'a> = dyn FnMut(usize) -> Result<Option<Vec<u8>>, SaveError> + 'a;

/// `base`, written for a path in a kind of file, with shapes as targets; none if `shape` gave none.
pub(crate) fn with_morphs(
    base: Output,
    (to, format): (&Path, Format),
    morphs: &Morphs<'_>,
    shape: &mut Shapes<'_>,
) -> Result<Option<Output>, SaveError> {
    let failed = |fault: Fault| SaveError::NoMorphs { path: to.to_owned(), reason: fault.to_string() };
    let glb = format == Format::Glb;
    let source = source_of(base.bytes, files::folder_of(to)).map_err(failed)?;
    let mut place = relocate(&source, to, glb);
    let extended = place.chunk.as_deref().filter(|_| place.extensible);
    let mut added = Builder::after(&place.document, extended);
    let mut differences = Differences::default();
    for k in 0..morphs.shapes.len() {
        let Some(bytes) = shape(k)? else { return Ok(None) };
        let other = source_of(bytes, files::folder_of(to)).map_err(failed)?;
        differences.add(&source, &other, &mut added).map_err(failed)?;
    }
    let meshes = differences.meshes(&source);
    if meshes.is_empty() {
        return Err(failed(Fault::Container("no shape differs from the mesh at rest".into())));
    }
    let mut counts = HashMap::new();
    for &mesh in &meshes {
        let before = put_targets(&mut place.document, (&source, mesh), &differences, &mut added).map_err(failed)?;
        counts.insert(mesh, before);
        name_targets(&mut place.document, mesh, before, morphs);
    }
    weights::extend(&mut place.document, &source, (&counts, morphs), &mut added).map_err(failed)?;
    added.attach(&mut place.document, place.chunk.as_mut().filter(|_| place.extensible));
    let json = match patch::patched(&source.container.json, &source.document, &place.document) {
        Some(text) => text,
        None => serde_json::to_vec(&place.document)
            .map_err(|error| SaveError::Encode { path: to.to_owned(), reason: error.to_string() })?,
    };
    let mut warnings = base.warnings;
    warnings.extend(place.warnings);
    let output = pack(&source, json, place.chunk, glb, to, warnings)?;
    Ok(Some(Output { beside: base.beside, origin: base.origin, ..output }))
}

/// Accessors of what shapes differ by, shape by shape.
#[derive(Default)]
struct Differences {
    /// By block.
    positions: Vec<HashMap<usize, usize>>,
    /// By block, and accessor of the normals at rest.
    normals: Vec<HashMap<(usize, usize), usize>>,
}

impl Differences {
    fn add(&mut self, rest: &GltfSource, other: &GltfSource, added: &mut Builder) -> Result<(), Fault> {
        if rest.blocks.len() != other.blocks.len() || rest.primitives.len() != other.primitives.len() {
            return Err(Fault::Container("a shape is laid out otherwise than the mesh at rest".into()));
        }
        let mut positions = HashMap::new();
        for (k, (a, b)) in rest.blocks.iter().zip(&other.blocks).enumerate() {
            if let Some(numbers) = difference((rest, a.accessor), (other, b.accessor))? {
                positions.insert(k, added.floats(&numbers, 3, true));
            }
        }
        let mut normals = HashMap::new();
        for (a, b) in rest.primitives.iter().zip(&other.primitives) {
            let (Some(old), Some(new)) = (a.normal, b.normal) else { continue };
            if normals.contains_key(&(a.block, old)) {
                continue;
            }
            if let Some(numbers) = difference((rest, old), (other, new))? {
                normals.insert((a.block, old), added.floats(&numbers, 3, false));
            }
        }
        self.positions.push(positions);
        self.normals.push(normals);
        Ok(())
    }

    /// Meshes in which some shape moves something, ascending.
    fn meshes(&self, source: &GltfSource) -> BTreeSet<usize> {
        let moves = |block: usize| self.positions.iter().any(|of_shape| of_shape.contains_key(&block));
        source.primitives.iter().filter(|primitive| moves(primitive.block)).map(|primitive| primitive.mesh).collect()
    }
}

/// What the second accessor has more than the first, vectors of three; none where they are equal.
fn difference((rest, a): (&GltfSource, usize), (other, b): (&GltfSource, usize)) -> Result<Option<Vec<f32>>, Fault> {
    let (old, new) = (Data::from(rest).accessor(a)?, Data::from(other).accessor(b)?);
    if old.count != new.count || old.width != 3 || new.width != 3 {
        return Err(Fault::Container("a shape has other vertices than the mesh at rest".into()));
    }
    let numbers: Vec<f32> = old.numbers().iter().zip(new.numbers()).map(|(old, new)| (new - old) as f32).collect();
    Ok(numbers.iter().any(|&x| x != 0.0).then_some(numbers))
}

/// Adds a target a shape to each primitive of a mesh; tells how many there were before.
fn put_targets(
    document: &mut Value,
    (source, mesh): (&GltfSource, usize),
    differences: &Differences,
    added: &mut Builder,
) -> Result<usize, Fault> {
    let place = format!("mesh {mesh}");
    let primitives = document.pointer_mut(&format!("/meshes/{mesh}/primitives")).and_then(Value::as_array_mut);
    let mut before = None;
    let mut zeros = HashMap::new();
    for (index, primitive) in primitives.into_iter().flatten().enumerate() {
        let known = source.primitives.iter().find(|known| (known.mesh, known.index) == (mesh, index));
        let known = known.ok_or_else(|| {
            Fault::at(
                place.as_str(),
                format!("primitive {index} has no positions, and cannot have targets as the others"),
            )
        })?;
        let targets = primitive.get("targets").and_then(Value::as_array).cloned().unwrap_or_default();
        if *before.get_or_insert(targets.len()) != targets.len() {
            return Err(Fault::at(place.as_str(), "its primitives have different numbers of morph targets"));
        }
        let count = source.blocks[known.block].vertices.len();
        let mut all = targets;
        for (positions, normals) in differences.positions.iter().zip(&differences.normals) {
            let mut zero = || *zeros.entry(count).or_insert_with(|| added.zeros(count));
            let position = positions.get(&known.block).copied().unwrap_or_else(&mut zero);
            let mut target = json!({"POSITION": position});
            if let Some(normal) = known.normal {
                let normal = normals.get(&(known.block, normal)).copied().unwrap_or_else(&mut zero);
                target["NORMAL"] = normal.into();
            }
            all.push(target);
        }
        primitive["targets"] = all.into();
    }
    Ok(before.unwrap_or(0))
}

/// Says what targets are called where programs look for it.
fn name_targets(document: &mut Value, mesh: usize, before: usize, morphs: &Morphs<'_>) {
    let Some(mesh) = document.pointer_mut(&format!("/meshes/{mesh}")) else { return };
    let old = mesh.pointer("/extras/targetNames").and_then(Value::as_array).cloned().unwrap_or_default();
    let name = |k: usize| old.get(k).cloned().unwrap_or_else(|| format!("target {k}").into());
    let names: Value = (0..before).map(name).chain(morphs.shapes.iter().map(|shape| shape.name.into())).collect();
    match mesh.get_mut("extras") {
        None => mesh["extras"] = json!({"targetNames": names}),
        Some(Value::Object(extras)) => {
            extras.insert("targetNames".into(), names);
        }
        // What an author put there as something else stays.
        Some(_) => {}
    }
}

/// The numbers of a list of weights, cut or filled with zeros to so many.
fn weights_of(object: &Value, n: usize) -> Option<Vec<f64>> {
    let weights = object.get("weights")?.as_array()?;
    Some((0..n).map(|k| weights.get(k).and_then(Value::as_f64).unwrap_or(0.0)).collect())
}

/// Nodes of a document.
fn nodes(document: &Value) -> Vec<Value> {
    json::list(document, "nodes").unwrap_or_default().to_vec()
}
