//! The bytes that accessors point into.

use super::source::GltfSource;
use super::{base64, compressed, container::Container, json};
use crate::folder::Folder;
use crate::{Fault, budget, files};
use serde_json::Value;

/// Where a buffer's bytes are.
#[derive(Debug)]
pub(super) enum Buffer {
    /// The binary chunk of the GLB file.
    Chunk,
    /// A data URI, decoded.
    Inline(Vec<u8>),
    /// A file beside the model, read.
    File(Vec<u8>),
    /// Nowhere: it stands in for compressed data, which is elsewhere.
    Absent,
}

impl Buffer {
    pub(super) fn bytes<'a>(&'a self, container: &'a Container) -> &'a [u8] {
        match self {
            Buffer::Chunk => container.binary.as_deref().unwrap_or_default(),
            Buffer::Inline(bytes) | Buffer::File(bytes) => bytes,
            Buffer::Absent => &[],
        }
    }
}

/// Loads every buffer of a document, together within the budget of one file.
pub(super) fn load(document: &Value, container: &Container, folder: Option<&Folder>) -> Result<Vec<Buffer>, Fault> {
    let mut total = 0;
    let mut buffers = Vec::new();
    let all = json::list(document, "buffers")?;
    let stands_in = compressed::stand_ins(document, all.len())?;
    for (i, buffer) in all.iter().enumerate() {
        let place = format!("buffer {i}");
        let length = json::number(buffer, "byteLength", &place)?.unwrap_or(0);
        let loaded = match load_one(buffer, i, container, folder, budget::FILE_BYTES - total) {
            Err(_) if stands_in[i] => {
                buffers.push(Buffer::Absent);
                continue;
            }
            loaded => loaded.map_err(|problem| Fault::at(place.as_str(), problem))?,
        };
        let found = loaded.bytes(container).len() as u64;
        if found < length {
            return Err(Fault::at(place, format!("is cut off: it says {length} bytes, {found} are there")));
        }
        total += found;
        budget::check("bytes in buffers", total, budget::FILE_BYTES)?;
        buffers.push(loaded);
    }
    Ok(buffers)
}

fn load_one(
    buffer: &Value,
    index: usize,
    container: &Container,
    folder: Option<&Folder>,
    limit: u64,
) -> Result<Buffer, String> {
    if !buffer.is_object() {
        return Err("is not an object".into());
    }
    let Some(uri) = buffer.get("uri") else {
        return match container.binary {
            Some(_) if index == 0 => Ok(Buffer::Chunk),
            _ => Err("names no data".into()),
        };
    };
    let uri = uri.as_str().ok_or("its URI is not text")?;
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, data) = data.split_once(";base64,").ok_or("its data URI is not base64")?;
        return base64::decode(data).map(Buffer::Inline).ok_or_else(|| "its data URI is not base64".into());
    }
    let shown = crate::rigidity::quoted(uri);
    let reference = files::percent_decoded(uri).ok_or_else(|| format!("its URI {shown} is not text"))?;
    let folder = folder.ok_or_else(|| format!("its file {shown} cannot be read: no folder to look in"))?;
    folder
        .read(&reference, limit)
        .map(Buffer::File)
        .map_err(|reason| format!("its file {shown} cannot be read: {reason}"))
}

/// Whether a view reaches beyond the bytes that each buffer states. A file opens with such views where nothing needs them;
/// whatever is put behind those bytes would be read as part of them.
pub(super) fn reached_beyond(source: &GltfSource) -> Vec<bool> {
    let GltfSource { document, buffers, container, .. } = source;
    let number = |object: &Value, key: &str| object.get(key).and_then(Value::as_f64);
    let declared = json::list(document, "buffers").unwrap_or_default();
    let ends = buffers.iter().zip(declared).map(|(buffer, declared)| match buffer {
        // It has no bytes that anything could be put behind.
        Buffer::Absent => f64::INFINITY,
        _ => number(declared, "byteLength").unwrap_or(buffer.bytes(container).len() as f64),
    });
    let ends: Vec<f64> = ends.collect();
    let mut beyond = vec![false; ends.len()];
    for view in json::list(document, "bufferViews").unwrap_or_default() {
        for part in std::iter::once(view).chain(compressed::meshopt_of(view)) {
            let Some(buffer) = number(part, "buffer").map(|buffer| buffer as usize) else { continue };
            let end = number(part, "byteOffset").unwrap_or(0.0) + number(part, "byteLength").unwrap_or(0.0);
            if ends.get(buffer).is_some_and(|&last| end > last) {
                beyond[buffer] = true;
            }
        }
    }
    beyond
}
