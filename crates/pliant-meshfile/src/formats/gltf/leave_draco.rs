//! Taking bent primitives out of what Draco compresses.
//!
//! The extension allows a primitive to have some attributes in the compressed data and others beside it, but not every
//! viewer looks for the others: one that does not would show the mesh unbent, or without what was bent. So a primitive
//! whose shape changes leaves the extension as a whole, its indices and remaining attributes as they were decoded, and a
//! document without such primitives loses the extension's name. Other primitives stay compressed. Rigidity is read by
//! nobody else, and comes beside the compressed data unless it was in there.

use super::builder::Builder;
use super::compressed::{DRACO, Plain};
use super::source::GltfSource;
use serde_json::{Map, Value};
use std::collections::HashMap;

/// Takes primitives of a document out of the extension.
pub(super) struct Leaving<'a> {
    source: &'a GltfSource,
    /// Plain accessors by the one they replace.
    plain: HashMap<usize, usize>,
    /// Whether a primitive left the extension.
    left: bool,
}

impl<'a> Leaving<'a> {
    pub(super) fn new(source: &'a GltfSource) -> Self {
        Leaving { source, plain: HashMap::new(), left: false }
    }

    /// Takes a primitive of which an attribute was replaced out of the extension, if it is still in there.
    pub(super) fn changed(&mut self, primitive: &mut Value, attribute: &str, added: &mut Builder) {
        let Some(extensions) = primitive.get_mut("extensions").and_then(Value::as_object_mut) else { return };
        let Some(extension) = extensions.get(DRACO) else { return };
        let listed = extension.get("attributes").and_then(Value::as_object).cloned().unwrap_or_default();
        if attribute == "_RIGIDITY" && !listed.contains_key(attribute) {
            return;
        }
        extensions.shift_remove(DRACO);
        if extensions.is_empty() {
            primitive.as_object_mut().map(|members| members.shift_remove("extensions"));
        }
        self.left = true;
        let names = primitive.get_mut("attributes").and_then(Value::as_object_mut).into_iter().flat_map(Map::iter_mut);
        for (_, accessor) in names.filter(|(name, _)| listed.contains_key(*name)) {
            self.replace(accessor, |accessor, plain| stored(accessor, plain, added));
        }
        if let Some(indices) = primitive.get_mut("indices") {
            self.replace(indices, |_, plain| added.indices(&numbers(plain)));
        }
    }

    /// Puts a plain accessor, made once, in the place of one whose numbers are in compressed data.
    fn replace(&mut self, slot: &mut Value, make: impl FnOnce(&Value, &Plain) -> usize) {
        // Those of attributes that were replaced are new, and of no compressed data.
        let Some(index) = slot.as_f64().map(|index| index as usize) else { return };
        let accessor = self.source.document.get("accessors").and_then(|all| all.get(index));
        let (Some(plain), Some(accessor)) = (self.source.decoded.accessor(index), accessor) else { return };
        *slot = (*self.plain.entry(index).or_insert_with(|| make(accessor, plain))).into();
    }

    /// Takes the extension's name from a document in which no primitive uses it any more.
    pub(super) fn finish(self, document: &mut Value) {
        let uses = |primitive: &Value| primitive.get("extensions").is_some_and(|all| all.get(DRACO).is_some());
        let meshes = document.get("meshes").and_then(Value::as_array).into_iter().flatten();
        let mut primitives = meshes.filter_map(|mesh| mesh.get("primitives")?.as_array()).flatten();
        if !self.left || primitives.any(uses) {
            return;
        }
        for key in ["extensionsUsed", "extensionsRequired"] {
            let Some(names) = document.get_mut(key).and_then(Value::as_array_mut) else { continue };
            names.retain(|name| name != DRACO);
            if names.is_empty() {
                document.as_object_mut().map(|members| members.shift_remove(key));
            }
        }
    }
}

fn numbers(indices: &Plain) -> Vec<u32> {
    indices.bytes.as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect()
}

/// An accessor of decoded numbers that says what the compressed one said; bounds are those of the numbers, which
/// compression moved a little.
fn stored(accessor: &Value, plain: &Plain, added: &mut Builder) -> usize {
    let mut accessor = accessor.clone();
    let size = plain.bytes.len() / plain.count.max(1);
    if let Some(members) = accessor.as_object_mut() {
        for place in ["bufferView", "byteOffset", "sparse"] {
            members.shift_remove(place);
        }
        for (key, pick) in [("min", f64::min as fn(f64, f64) -> f64), ("max", f64::max)] {
            if let Some(bounds) = members.get_mut(key) {
                *bounds = bound(plain, size, pick);
            }
        }
    }
    added.stored(&plain.bytes, size, accessor)
}

/// The least or largest of each number in elements of so many bytes, as it is stored.
fn bound(plain: &Plain, size: usize, pick: fn(f64, f64) -> f64) -> Value {
    let width = plain.component.size() as usize;
    let of = |k: usize| plain.bytes.chunks_exact(size).map(move |element| plain.component.stored(&element[k..]));
    (0..size).step_by(width).map(|k| of(k).reduce(pick).map_or(Value::Null, Value::from)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::access::Component;
    use super::*;
    use serde_json::json;

    #[test]
    fn what_an_accessor_says_stays_and_its_bounds_are_those_of_the_numbers() {
        let compressed = json!({
            "bufferView": 7, "byteOffset": 4, "componentType": 5121, "count": 2, "type": "VEC3", "normalized": true,
            "min": [0, 0, 0], "max": [9, 9, 9], "name": "Colors", "extras": {"made": "by hand"},
        });
        let plain = Plain { component: Component::U8, count: 2, bytes: vec![1, 20, 3, 10, 2, 30] };
        let mut added = Builder::default();
        assert_eq!(stored(&compressed, &plain, &mut added), 0);
        // Elements of three bytes begin at multiples of four.
        assert_eq!(added.data, [1, 20, 3, 0, 10, 2, 30, 0]);
        assert_eq!(added.views[0]["byteStride"], 4);
        let mut expected = compressed.clone();
        expected.as_object_mut().expect("an object").retain(|key, _| key != "byteOffset");
        expected["bufferView"] = 0.into();
        (expected["min"], expected["max"]) = (json!([1.0, 2.0, 3.0]), json!([10.0, 20.0, 30.0]));
        assert_eq!(added.accessors[0], expected);
    }
}
