//! Taking bent attributes out of what Draco compresses.
//!
//! A primitive may have attributes of both kinds: those that the extension lists come out of the compressed data, the
//! others are read as usual. So a bent attribute is struck off the list. A list must not be empty, though: a primitive
//! that has none left leaves the extension, with its indices plain, and a document without such primitives its name.

use super::access::Data;
use super::builder::Builder;
use super::compressed::DRACO;
use super::source::GltfSource;
use serde_json::Value;
use std::collections::HashMap;

/// Strikes attributes off the lists of a document's primitives.
pub(super) struct Leaving<'a> {
    source: &'a GltfSource,
    /// Plain indices by the accessor they replace.
    indices: HashMap<usize, usize>,
    /// Whether a primitive left the extension.
    left: bool,
}

impl<'a> Leaving<'a> {
    pub(super) fn new(source: &'a GltfSource) -> Self {
        Leaving { source, indices: HashMap::new(), left: false }
    }

    /// Strikes one attribute off the list of a primitive, if it is there.
    pub(super) fn strike(&mut self, primitive: &mut Value, attribute: &str, added: &mut Builder) {
        let Some(extensions) = primitive.get_mut("extensions").and_then(Value::as_object_mut) else { return };
        let listed = extensions.get_mut(DRACO).and_then(|draco| draco.get_mut("attributes")?.as_object_mut());
        let Some(listed) = listed else { return };
        listed.shift_remove(attribute);
        if !listed.is_empty() {
            return;
        }
        extensions.shift_remove(DRACO);
        if extensions.is_empty() {
            primitive.as_object_mut().map(|members| members.shift_remove("extensions"));
        }
        self.left = true;
        if let Some(accessor) = primitive.get("indices").and_then(Value::as_f64).map(|accessor| accessor as usize) {
            let source = self.source;
            let plain = *self.indices.entry(accessor).or_insert_with(|| match Data::from(source).accessor(accessor) {
                Ok(checked) => {
                    let indices: Vec<u32> = checked.numbers().into_iter().map(|index| index as u32).collect();
                    added.indices(&indices)
                }
                // Unread on opening, as it is in a primitive that shows nothing.
                Err(_) => accessor,
            });
            primitive["indices"] = plain.into();
        }
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
