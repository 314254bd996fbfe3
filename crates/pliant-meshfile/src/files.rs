//! Reading of files: only regular ones, only so large, only where they belong.

use crate::watch::Stage;
use crate::{Fault, OpenError};
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

/// Reads a regular file of at most `limit` bytes.
pub(crate) fn read(path: &Path, limit: u64) -> Result<Vec<u8>, OpenError> {
    read_in_stages(path, limit, Stage::unwatched())
}

/// Bytes read between two looks at whether they are still wanted: a few milliseconds of the slowest disks.
const PIECE: u64 = 1 << 20;

/// The same, telling how far it is.
pub(crate) fn read_in_stages(path: &Path, limit: u64, stage: Stage<'_>) -> Result<Vec<u8>, OpenError> {
    let failed = |source| OpenError::Read { path: path.to_owned(), source };
    // Asked before opening: opening a pipe without a writer waits for ever.
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(Fault::NotAFile.in_file(path));
    }
    crate::budget::check("bytes in the file", metadata.len(), limit).map_err(|fault| fault.in_file(path))?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(metadata.len() as usize).map_err(|e| failed(std::io::Error::other(e)))?;
    // A file that grows while it is read is cut at the limit.
    let mut file = File::open(path).map_err(failed)?.take(limit);
    while file.by_ref().take(PIECE).read_to_end(&mut bytes).map_err(failed)? > 0 {
        stage.tell(bytes.len(), metadata.len() as usize).map_err(|fault| fault.in_file(path))?;
    }
    Ok(bytes)
}

/// Reads a file that a model names, if it lies in the model's own folder; otherwise says why not.
///
/// `reference` is a plain relative path with forward slashes. Links are followed, and refused when they lead outside.
pub(crate) fn read_beside(folder: &Path, reference: &str, limit: u64) -> Result<Vec<u8>, String> {
    let foreign = reference.is_empty()
        || reference.starts_with('/')
        || reference.contains(['\\', ':', '\0'])
        || reference.split('/').any(|step| step == "..");
    if foreign {
        return Err("outside the folder".into());
    }
    read_inside(folder, &folder.join(reference), limit)
}

/// Reads a regular file of `folder`; links are followed, and refused when they lead outside.
pub(crate) fn read_inside(folder: &Path, path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let root = folder.canonicalize().map_err(|e| e.to_string())?;
    let path = path.canonicalize().map_err(|e| e.to_string())?;
    if !path.starts_with(&root) {
        return Err("outside the folder".into());
    }
    read(&path, limit).map_err(|error| match error {
        OpenError::Read { source, .. } => source.to_string(),
        OpenError::Content { fault, .. } => fault.to_string(),
        other => other.to_string(),
    })
}

/// Whether something has this name already, be it a link to nothing.
pub(crate) fn is_taken(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok()
}

/// Decodes `%20` and its like once; `None` when the result is not text.
pub(crate) fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let digit = |b: Option<u8>| b.and_then(|b| char::from(b).to_digit(16));
        bytes.push((digit(rest.next())? * 16 + digit(rest.next())?) as u8);
    }
    String::from_utf8(bytes).ok()
}

/// The folder a file lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Whether two paths lie in the same existing folder.
pub(crate) fn same_folder(a: &Path, b: &Path) -> bool {
    match (folder_of(a).canonicalize(), folder_of(b).canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}
