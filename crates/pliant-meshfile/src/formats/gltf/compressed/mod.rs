//! Geometry that extensions store compressed, decoded on opening.
//!
//! Reading asks for views and accessors as ever and finds the decoded bytes in their place. Saving leaves the compressed
//! ones where they are; what is bent gets accessors of its own, without compression. The rest still comes out of the
//! compressed data, but for primitives that Draco compresses, which are saved plain as a whole once they are bent
//! ([`leave_draco`](super::leave_draco)).
//!
//! | extension | compresses | decoded by |
//! |---|---|---|
//! | `EXT_meshopt_compression`, `KHR_meshopt_compression` | a view | [`meshopt`], from the specification |
//! | `KHR_draco_mesh_compression` | indices and attributes of a primitive | the crate `draco-core` |

mod draco;
mod meshopt;

pub(super) use draco::EXTENSION as DRACO;
pub(super) use meshopt::EXTENSIONS as MESHOPT;
pub(super) use meshopt::extension as meshopt_of;

use super::access::{Component, Data};
use super::json;
use crate::{Fault, budget};
use serde_json::Value;
use std::collections::HashMap;

/// Decoded bytes by what they stand for.
#[derive(Debug, Default)]
pub(super) struct Decoded {
    /// The bytes of each compressed view, or what is wrong with them: only what reads them fails.
    views: HashMap<usize, Result<Vec<u8>, String>>,
    /// Accessors whose numbers are in the compressed data of a primitive.
    accessors: HashMap<usize, Plain>,
}

/// The numbers of an accessor, one after the other.
#[derive(Debug)]
pub(super) struct Plain {
    pub(super) component: Component,
    pub(super) count: usize,
    pub(super) bytes: Vec<u8>,
}

impl Decoded {
    /// Decodes all compressed geometry of a document.
    pub(super) fn of(data: Data<'_>) -> Result<Decoded, Fault> {
        let mut purse = budget::Purse::new("bytes of decoded geometry", budget::DECODED_BYTES);
        let mut decoded = Decoded::default();
        for (i, view) in json::list(data.document, "bufferViews")?.iter().enumerate() {
            let Some(extension) = meshopt::extension(view) else { continue };
            let place = format!("bufferView {i}, meshopt compression");
            let bytes = match meshopt::View::of(extension, &place, data.buffers.len()) {
                Ok(view) => {
                    purse.spend(usize::try_from(view.decoded_bytes()).unwrap_or(usize::MAX))?;
                    data.range(view.buffer, view.offset, view.length, &place)
                        .and_then(|bytes| view.decode(bytes).map_err(|problem| Fault::at(place, problem)))
                }
                Err(fault) => Err(fault),
            };
            decoded.views.insert(i, bytes.map_err(|fault| fault.to_string()));
        }
        decoded.accessors = draco::decode(Data { decoded: &decoded, ..data }, &mut purse)?;
        Ok(decoded)
    }

    /// The bytes of a compressed view; none for one that is not compressed.
    pub(super) fn view(&self, index: usize) -> Option<Result<&[u8], &str>> {
        self.views.get(&index).map(|bytes| bytes.as_deref().map_err(String::as_str))
    }

    /// The numbers of an accessor in compressed data.
    pub(super) fn accessor(&self, index: usize) -> Option<&Plain> {
        self.accessors.get(&index)
    }
}

/// Which buffers are there only for readers that cannot decode, and may hold nothing.
pub(super) fn stand_ins(document: &Value, n_buffers: usize) -> Result<Vec<bool>, Fault> {
    let (mut of_compressed, mut needed) = (vec![false; n_buffers], vec![false; n_buffers]);
    let mark = |list: &mut [bool], object: &Value| {
        let buffer = object.get("buffer").and_then(Value::as_f64).map(|buffer| buffer as usize);
        if let Some(slot) = buffer.and_then(|buffer| list.get_mut(buffer)) {
            *slot = true;
        }
    };
    for (slot, buffer) in of_compressed.iter_mut().zip(json::list(document, "buffers")?) {
        *slot = meshopt::extension(buffer).and_then(|extension| extension.get("fallback")) == Some(&Value::Bool(true));
    }
    for view in json::list(document, "bufferViews")? {
        match meshopt::extension(view) {
            Some(extension) => {
                mark(&mut of_compressed, view);
                mark(&mut needed, extension);
            }
            None => mark(&mut needed, view),
        }
    }
    Ok(of_compressed.into_iter().zip(needed).map(|(stands_in, needed)| stands_in && !needed).collect())
}
