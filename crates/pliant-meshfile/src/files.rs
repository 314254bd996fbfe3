//! Reading and writing of files: only regular ones, only so large, only where they belong, and never half.

use crate::watch::Stage;
use crate::{Fault, OpenError, SaveError};
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

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
pub(crate) fn read_beside(folder: Option<&Path>, reference: &str, limit: u64) -> Result<Vec<u8>, String> {
    let folder = folder.ok_or("no folder to look in")?;
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

/// Writes files so that each is the old one or the new one, never part of one, whenever the program is stopped.
///
/// All are first written in full as temporaries beside their targets and brought to the disk, then renamed in order:
/// list the main file last. When a step before the renaming fails, nothing is left or touched. A link is saved through
/// for the main file, which a person chose; links in place of the files beside it are replaced, wherever they lead.
pub(crate) fn write_all(files: &[(PathBuf, Vec<u8>)]) -> Result<(), SaveError> {
    let mut staged = Vec::new();
    for (i, (path, bytes)) in files.iter().enumerate() {
        let is_main = i + 1 == files.len();
        let target = if is_main { path.canonicalize().ok() } else { None };
        let target = target.unwrap_or_else(|| path.clone());
        staged.push(Staged::new(target, bytes).map_err(|source| SaveError::Write { path: path.clone(), source })?);
    }
    for file in &mut staged {
        file.publish().map_err(|source| SaveError::Write { path: file.target.clone(), source })?;
    }
    Ok(())
}

/// A complete temporary that still has to take its target's name; removed when dropped before.
struct Staged {
    temporary: PathBuf,
    target: PathBuf,
    published: bool,
}

impl Staged {
    fn new(target: PathBuf, bytes: &[u8]) -> std::io::Result<Staged> {
        let permissions = match fs::symlink_metadata(&target) {
            Ok(old) if old.is_symlink() => None,
            Ok(old) if !old.is_file() => return Err(std::io::Error::other("the target is not a regular file")),
            Ok(old) if old.permissions().readonly() => {
                return Err(std::io::Error::new(std::io::ErrorKind::PermissionDenied, "the file is read-only"));
            }
            Ok(old) => Some(old.permissions()),
            Err(_) => None,
        };
        let name = target.file_name().ok_or_else(|| std::io::Error::other("the target has no file name"))?;
        for attempt in 0..100 {
            let mut hidden = std::ffi::OsString::from(".");
            hidden.push(name);
            hidden.push(format!(".{}-{attempt}.tmp", std::process::id()));
            let temporary = folder_of(&target).join(hidden);
            let mut file = match File::create_new(&temporary) {
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => continue,
                other => other?,
            };
            let staged = Staged { temporary, target, published: false };
            file.write_all(bytes)?;
            if let Some(permissions) = permissions {
                file.set_permissions(permissions)?;
            }
            file.sync_all()?;
            return Ok(staged);
        }
        Err(std::io::Error::other("too many temporary files lie beside the target"))
    }

    fn publish(&mut self) -> std::io::Result<()> {
        fs::rename(&self.temporary, &self.target)?;
        self.published = true;
        // The rename is durable once the folder is on the disk; a system that cannot sync folders does so itself.
        if let Ok(folder) = File::open(folder_of(&self.target)) {
            let _ = folder.sync_all();
        }
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if !self.published {
            let _ = fs::remove_file(&self.temporary);
        }
    }
}
