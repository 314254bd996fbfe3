//! Temporaries: complete files that still have to take their names.

use super::sync_folder;
use crate::files;
use std::fs::{self, File};
use std::io::{BufWriter, Error, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Bytes gathered before they go to the system: larger writes go there at once, smaller ones cost a call each.
const PIECE: usize = 1 << 16;

/// What the temporaries of one saving share in their names: the process, and a number within it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Group {
    process: u32,
    number: u32,
}

impl Group {
    pub(super) fn new() -> Group {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        Group { process: std::process::id(), number: NEXT.fetch_add(1, Ordering::Relaxed) }
    }

    /// Name of temporary `index`. It does not hold the target's: names have a greatest length.
    pub(super) fn temporary(&self, index: usize) -> String {
        format!(".pliant-{}-{}-{index}.tmp", self.process, self.number)
    }

    /// Reads `PROCESS-NUMBER`.
    pub(super) fn parse(text: &str) -> Option<Group> {
        let (process, number) = text.split_once('-')?;
        Some(Group { process: process.parse().ok()?, number: number.parse().ok()? })
    }
}

impl std::fmt::Display for Group {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-{}", self.process, self.number)
    }
}

/// Whether a file of this name is a temporary of some saving.
pub(super) fn is_temporary(name: &str) -> bool {
    let inner = name.strip_prefix(".pliant-").and_then(|rest| rest.strip_suffix(".tmp"));
    inner.is_some_and(|inner| inner.split('-').count() == 3 && inner.split('-').all(|n| n.parse::<u32>().is_ok()))
}

/// A complete temporary that still has to take its target's name; removed when dropped before.
#[derive(Debug)]
pub(super) struct Staged {
    temporary: PathBuf,
    target: PathBuf,
    /// Locked as long as the process lives, so that others can tell a temporary from a leftover.
    file: File,
    stays: bool,
}

impl Staged {
    pub(super) fn new(target: PathBuf, bytes: &[u8], group: &Group, index: usize) -> std::io::Result<Staged> {
        Staged::filled(target, group, index, |file| file.write_all(bytes))
    }

    /// A temporary with what `content` writes.
    pub(super) fn filled(
        target: PathBuf,
        group: &Group,
        index: usize,
        content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
    ) -> std::io::Result<Staged> {
        let permissions = match fs::symlink_metadata(&target) {
            Ok(old) if old.is_symlink() => None,
            Ok(old) if !old.is_file() => return Err(Error::other("the target is not a regular file")),
            Ok(old) if old.permissions().readonly() => {
                return Err(Error::new(ErrorKind::PermissionDenied, "the file is read-only"));
            }
            Ok(old) => Some(old.permissions()),
            Err(_) => None,
        };
        if target.file_name().is_none() {
            return Err(Error::other("the target has no file name"));
        }
        let temporary = files::folder_of(&target).join(group.temporary(index));
        let staged = Staged { file: create_locked(&temporary)?, temporary, target, stays: false };
        let mut buffered = BufWriter::with_capacity(PIECE, &staged.file);
        content(&mut buffered)?;
        buffered.flush()?;
        drop(buffered);
        if let Some(permissions) = permissions {
            staged.file.set_permissions(permissions)?;
        }
        staged.file.sync_all()?;
        Ok(staged)
    }

    /// Takes the target's name.
    pub(super) fn publish(&mut self) -> std::io::Result<()> {
        fs::rename(&self.temporary, &self.target)?;
        self.stays = true;
        sync_folder(files::folder_of(&self.target));
        Ok(())
    }

    /// Stays on the disk for good.
    pub(super) fn leave(&mut self) {
        self.stays = true;
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        if !self.stays {
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// A new file, locked. Its name is this process's own: what lies there is the leftover of a dead one.
pub(super) fn create_locked(path: &Path) -> std::io::Result<File> {
    let file = match File::create_new(path) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            fs::remove_file(path)?;
            File::create_new(path)?
        }
        other => other?,
    };
    // Where a file system has no locks, leftovers are told by their age alone.
    let _ = file.try_lock();
    Ok(file)
}
