//! Buffers and images of a document that is saved in another kind of file, or in another folder.

use super::base64;
use super::buffers::{self, Buffer};
use super::compressed;
use super::source::GltfSource;
use crate::{Warning, budget, files};
use serde_json::{Value, json};
use std::path::Path;

/// A document whose references hold at its new place.
pub(super) struct Relocated {
    pub(super) document: Value,
    /// The binary chunk, for GLB.
    pub(super) chunk: Option<Vec<u8>>,
    /// Whether new data can go to the end of the chunk. Where a view reaches there already it goes to a buffer of its
    /// own, or the view would show it.
    pub(super) extensible: bool,
    pub(super) warnings: Vec<Warning>,
    /// Whether the document differs from the source's.
    pub(super) changed: bool,
}

/// Makes the references of a document hold in `to`.
///
/// In the source's own folder files beside it stay where they are; elsewhere they are taken into the document, so that
/// saving writes one file and overwrites no other.
pub(super) fn relocate(source: &GltfSource, to: &Path, glb: bool) -> Relocated {
    let mut document = source.document.clone();
    let mut warnings = Vec::new();
    let stays = source.folder.as_ref().is_none_or(|folder| folder.holds(to));
    let starts_with_chunk = matches!(source.buffers.first(), Some(Buffer::Chunk));
    let mut changed = glb != source.container.is_glb;
    let beyond = buffers::reached_beyond(source);
    let (mut chunk, mut n_taken) = (None, 0);
    if glb && (starts_with_chunk || source.buffers.is_empty()) {
        chunk = Some(source.container.binary.clone().unwrap_or_default());
    } else if glb {
        (chunk, n_taken) = match beyond.contains(&true) {
            true => first_alone(source, &mut document),
            false => (Some(merge(source, &mut document)), source.buffers.len()),
        };
        changed = true;
    }
    let extensible = chunk.is_some() && beyond.first() != Some(&true);
    for (i, buffer) in source.buffers.iter().enumerate().skip(n_taken) {
        let embed = match buffer {
            Buffer::Chunk => !glb,
            Buffer::File(_) => !stays,
            Buffer::Inline(_) | Buffer::Absent => false,
        };
        if embed {
            let uri = data_uri("application/octet-stream", buffer.bytes(&source.container));
            if let Some(slot) = document.pointer_mut(&format!("/buffers/{i}")).and_then(Value::as_object_mut) {
                slot.insert("uri".into(), uri.into());
                changed = true;
            }
        }
    }
    if !stays {
        changed |= embed_images(source, &mut document, &mut warnings);
    }
    Relocated { document, chunk, extensible, warnings, changed }
}

pub(super) fn data_uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", base64::encode(bytes))
}

/// The first buffer becomes the chunk, if it holds something, and the others stay as they are: behind one that views
/// reach beyond, another would be read as part of those views. Also how many buffers were taken.
fn first_alone(source: &GltfSource, document: &mut Value) -> (Option<Vec<u8>>, usize) {
    let Some(first) = source.buffers.first().filter(|buffer| !matches!(buffer, Buffer::Absent)) else {
        return (None, 0);
    };
    if let Some(buffer) = document.pointer_mut("/buffers/0").and_then(Value::as_object_mut) {
        buffer.shift_remove("uri");
    }
    (Some(first.bytes(&source.container).to_vec()), 1)
}

/// Joins all buffers that hold something into one, and moves the views; those that hold nothing come behind it.
fn merge(source: &GltfSource, document: &mut Value) -> Vec<u8> {
    let mut chunk = Vec::new();
    // Where each buffer goes: its new number, and how far its first byte moves.
    let mut moves = Vec::new();
    let mut kept = Vec::new();
    for (i, buffer) in source.buffers.iter().enumerate() {
        if matches!(buffer, Buffer::Absent) {
            kept.extend(document.pointer(&format!("/buffers/{i}")).cloned());
            moves.push((kept.len(), 0));
            continue;
        }
        chunk.resize(chunk.len().next_multiple_of(8), 0);
        moves.push((0, chunk.len() as u64));
        chunk.extend_from_slice(buffer.bytes(&source.container));
    }
    for view in document.get_mut("bufferViews").and_then(Value::as_array_mut).into_iter().flatten() {
        move_view(view, &moves);
        for name in compressed::MESHOPT {
            if let Some(extension) = view.get_mut("extensions").and_then(|all| all.get_mut(name)) {
                move_view(extension, &moves);
            }
        }
    }
    let joined = source.buffers.iter().position(|buffer| !matches!(buffer, Buffer::Absent));
    let joined = joined.and_then(|first| document.pointer(&format!("/buffers/{first}")).cloned());
    let mut joined = joined.unwrap_or_else(|| json!({}));
    if let Some(joined) = joined.as_object_mut() {
        joined.shift_remove("uri");
        joined.insert("byteLength".into(), chunk.len().into());
    }
    kept.insert(0, joined);
    document["buffers"] = kept.into();
    chunk
}

/// Moves what names a buffer and a place in it.
fn move_view(view: &mut Value, moves: &[(usize, u64)]) {
    let to = view.get("buffer").and_then(Value::as_f64).and_then(|buffer| moves.get(buffer as usize));
    if let (Some(&(buffer, by)), Some(view)) = (to, view.as_object_mut()) {
        view.insert("buffer".into(), buffer.into());
        let offset = view.get("byteOffset").and_then(Value::as_f64).unwrap_or(0.0) as u64 + by;
        if by > 0 {
            view.insert("byteOffset".into(), offset.into());
        }
    }
}

/// URIs of the images that are files of their own.
pub(super) fn images_beside(document: &Value) -> impl Iterator<Item = &str> {
    let images = document.get("images").and_then(Value::as_array).into_iter().flatten();
    images.filter_map(|image| image.get("uri")?.as_str()).filter(|uri| is_beside(uri))
}

fn is_beside(uri: &str) -> bool {
    !uri.starts_with("data:") && !uri.contains("://")
}

fn embed_images(source: &GltfSource, document: &mut Value, warnings: &mut Vec<Warning>) -> bool {
    let mut changed = false;
    for image in document.get_mut("images").and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(uri) = image.get("uri").and_then(Value::as_str) else { continue };
        if !is_beside(uri) {
            continue;
        }
        let shown = crate::rigidity::quoted(uri);
        let read = files::percent_decoded(uri).ok_or_else(|| "its URI is not text".to_owned()).and_then(|path| {
            let folder = source.folder.as_ref().ok_or("no folder to look in")?;
            folder.read(&path, budget::TEXT_BYTES)
        });
        match read {
            Ok(bytes) => {
                let stated = image.get("mimeType").and_then(Value::as_str).map(str::to_owned);
                let kind = stated.unwrap_or_else(|| kind_of(uri).to_owned());
                image["uri"] = data_uri(&kind, &bytes).into();
                changed = true;
            }
            Err(reason) => warnings.push(Warning(format!("texture {shown} is left behind: {reason}"))),
        }
    }
    if changed {
        warnings.push(Warning("textures beside the file were put into the saved one".into()));
    }
    changed
}

fn kind_of(uri: &str) -> &'static str {
    let ending = uri.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    match ending.as_str() {
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "ktx2" => "image/ktx2",
        _ => "image/png",
    }
}
