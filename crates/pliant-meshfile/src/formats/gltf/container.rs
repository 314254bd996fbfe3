//! The two outsides of a glTF document: plain JSON, or GLB chunks.

use crate::{Fault, SaveError, budget};
use std::path::Path;

const MAGIC: &[u8] = b"glTF";
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;

/// JSON text and binary chunks, as they came.
#[derive(Clone, Debug)]
pub(super) struct Container {
    pub(super) is_glb: bool,
    pub(super) json: Vec<u8>,
    pub(super) binary: Option<Vec<u8>>,
    /// Chunks of other kinds, by kind, kept for saving.
    pub(super) others: Vec<(u32, Vec<u8>)>,
}

/// Takes a file apart, whichever of the two its first bytes say it is.
pub(super) fn parse(bytes: Vec<u8>) -> Result<Container, Fault> {
    if !bytes.starts_with(MAGIC) {
        budget::check("bytes of JSON", bytes.len() as u64, budget::JSON_BYTES)?;
        return Ok(Container { is_glb: false, json: bytes, binary: None, others: Vec::new() });
    }
    let word = |at: usize| bytes.get(at..at + 4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let cut = || Fault::Container(format!("is cut off: the GLB file breaks off after {} bytes", bytes.len()));
    let version = word(4).ok_or_else(cut)?;
    if version != 2 {
        return Err(Fault::Container(format!("is GLB version {version}; only version 2 can be read")));
    }
    let length = word(8).ok_or_else(cut)? as usize;
    if length > bytes.len() {
        let problem = format!("is cut off: its header says {length} bytes, it has {}", bytes.len());
        return Err(Fault::Container(problem));
    }
    let mut container = Container { is_glb: true, json: Vec::new(), binary: None, others: Vec::new() };
    let (mut at, mut n_chunks) = (12usize, 0);
    while at + 8 <= length {
        let (size, kind) = (word(at).ok_or_else(cut)? as usize, word(at + 4).ok_or_else(cut)?);
        let start = at + 8;
        let chunk = start.checked_add(size).filter(|&end| end <= length).and_then(|end| bytes.get(start..end));
        let chunk = chunk.ok_or_else(|| {
            Fault::at(format!("GLB chunk {n_chunks}"), format!("says {size} bytes, more than the file has"))
        })?;
        match kind {
            _ if n_chunks == 0 && kind != JSON_CHUNK => {
                return Err(Fault::at("GLB chunk 0", "is not the JSON chunk"));
            }
            JSON_CHUNK if n_chunks == 0 => {
                budget::check("bytes of JSON", size as u64, budget::JSON_BYTES)?;
                container.json = chunk.to_vec();
            }
            BINARY_CHUNK if container.binary.is_none() => container.binary = Some(chunk.to_vec()),
            _ => container.others.push((kind, chunk.to_vec())),
        }
        at = start + size;
        n_chunks += 1;
    }
    if n_chunks == 0 {
        return Err(Fault::Container("is a GLB file without a JSON chunk".into()));
    }
    Ok(container)
}

/// Text as a file, or refused where it would be too long to be opened again.
pub(super) fn text(json: Vec<u8>, to: &Path) -> Result<Vec<u8>, SaveError> {
    let (bytes, limit) = (json.len() as u64, budget::JSON_BYTES);
    if bytes > limit {
        return Err(SaveError::TooMuchText { path: to.to_owned(), bytes, limit });
    }
    Ok(json)
}

/// Puts a GLB file together, or refuses what is beyond the format's 4 GiB or too long to be opened again.
pub(super) fn glb(
    json: Vec<u8>,
    binary: Option<&[u8]>,
    others: &[(u32, Vec<u8>)],
    to: &Path,
) -> Result<Vec<u8>, SaveError> {
    let json = text(json, to)?;
    let mut chunks = vec![(JSON_CHUNK, json.as_slice(), b' ')];
    chunks.extend(binary.map(|binary| (BINARY_CHUNK, binary, 0)));
    chunks.extend(others.iter().map(|(kind, bytes)| (*kind, bytes.as_slice(), 0)));
    let length = chunks.iter().fold(12u64, |sum, chunk| sum + 8 + chunk.1.len().next_multiple_of(4) as u64);
    let too_large = |_| SaveError::TooLarge { path: to.to_owned(), bytes: length };
    let header_length = u32::try_from(length).map_err(too_large)?;
    let mut bytes = Vec::with_capacity(length as usize);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&2u32.to_le_bytes());
    bytes.extend_from_slice(&header_length.to_le_bytes());
    for (kind, content, padding) in chunks {
        let padded = content.len().next_multiple_of(4);
        bytes.extend_from_slice(&(padded as u32).to_le_bytes());
        bytes.extend_from_slice(&kind.to_le_bytes());
        bytes.extend_from_slice(content);
        bytes.resize(bytes.len() + padded - content.len(), padding);
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_that_would_not_be_opened_again_is_not_saved() {
        let most = vec![b' '; budget::JSON_BYTES as usize];
        let to = Path::new("large.gltf");
        let more = [most.as_slice(), b" "].concat();
        assert!(text(most, to).is_ok());
        for refused in [text(more.clone(), to), glb(more, None, &[], to)] {
            let error = refused.expect_err("too long").to_string();
            assert!(error.starts_with("large.gltf: not saved: its 268435457 bytes of JSON"), "{error}");
        }
    }
}
