//! Files that appear whole or not at all.

use std::fs::{File, OpenOptions};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

use super::failure::Failure;

/// A file being written under a temporary name beside its target. Dropped without [`Staged::commit`] it leaves no trace.
#[derive(Debug)]
pub(super) struct Staged {
    file: File,
    temporary: PathBuf,
    target: PathBuf,
}

impl Staged {
    /// Creates the temporary file: that the folder can be written to is known before any work is done.
    pub(super) fn create(target: &Path) -> Result<Staged, Failure> {
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let temporary = target.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
        // A leftover of a killed run with the same process number; it is nobody's by now.
        let _ = std::fs::remove_file(&temporary);
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&temporary)
            .map_err(|source| Failure::Write { path: target.to_owned(), source })?;
        Ok(Staged { file, temporary, target: target.to_owned() })
    }

    /// Replaces what was written before and waits until the disk has it.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let write = |file: &mut File| {
            file.set_len(0)?;
            file.rewind()?;
            file.write_all(bytes)?;
            file.sync_all()
        };
        write(&mut self.file).map_err(|source| self.failed(source))
    }

    /// Puts the file in place of the target in one step.
    pub(super) fn commit(self) -> Result<(), Failure> {
        std::fs::rename(&self.temporary, &self.target).map_err(|source| self.failed(source))
    }

    fn failed(&self, source: std::io::Error) -> Failure {
        Failure::Write { path: self.target.clone(), source }
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        // After a commit there is nothing under this name any more, and nothing to do.
        let _ = std::fs::remove_file(&self.temporary);
    }
}

/// Refuses a target that could not be written: a folder, or a file in a folder that does not exist.
pub(super) fn check_target(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::IsFolder { path: path.to_owned() });
    }
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    if folder.is_dir() { Ok(()) } else { Err(Failure::NoFolder { path: path.to_owned(), folder: folder.to_owned() }) }
}

/// Whether two names mean one file, through links and `..` where the files or their folders exist.
pub(super) fn same_file(a: &Path, b: &Path) -> bool {
    let resolve = |path: &Path| {
        path.canonicalize().ok().or_else(|| {
            let folder = match path.parent() {
                Some(parent) if parent != Path::new("") => parent,
                _ => Path::new("."),
            };
            Some(folder.canonicalize().ok()?.join(path.file_name()?))
        })
    };
    a == b || matches!((resolve(a), resolve(b)), (Some(a), Some(b)) if a == b)
}
