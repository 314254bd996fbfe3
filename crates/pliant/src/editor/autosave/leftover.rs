//! Autosaves of windows that stopped.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use crate::project::{self, Summary};

/// Where files cannot be locked, an autosave that was written for this long is taken for left behind: several times the
/// interval between two.
const OLD: Duration = Duration::from_secs(300);
/// Between making its lock file and locking it a window does nothing else. By eye: longer than any system takes.
const YOUNG: Duration = Duration::from_secs(60);

/// An autosave whose window stopped.
#[derive(Debug)]
pub struct Leftover {
    /// The autosave.
    pub file: PathBuf,
    /// When it was last written.
    pub written: SystemTime,
    /// What it is about, or why it cannot be read.
    pub summary: Result<Summary, String>,
    lock: PathBuf,
    /// Held, so that no other window offers it too; let go of when dropped.
    _held: File,
}

impl Leftover {
    /// Removes it for good.
    pub fn discard(&self) {
        // What cannot be removed is offered again at the next start.
        if fs::remove_file(&self.file).is_ok() {
            let _ = fs::remove_file(&self.lock);
        }
    }
}

/// The autosaves in `folder` that no living window has, newest first. Reads all of each.
pub fn leftovers(folder: &Path) -> Vec<Leftover> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut found = Vec::new();
    for path in entries.flatten().map(|entry| entry.path()) {
        if project::is_project(&path) {
            found.extend(leftover(path));
        } else if path.extension().is_some_and(|extension| extension == "lock") {
            clear_lock(&path);
        }
    }
    found.sort_by_key(|leftover| std::cmp::Reverse(leftover.written));
    found
}

fn leftover(file: PathBuf) -> Option<Leftover> {
    // Asked before opening: a pipe by this name would be waited for.
    let metadata = fs::symlink_metadata(&file).ok().filter(fs::Metadata::is_file)?;
    let written = metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH);
    let lock = file.with_extension("lock");
    let held = File::options().read(true).write(true).create(true).truncate(false).open(&lock).ok()?;
    match held.try_lock() {
        Ok(()) => {}
        Err(TryLockError::WouldBlock) => return None,
        Err(TryLockError::Error(_)) if written.elapsed().is_ok_and(|age| age > OLD) => {}
        Err(TryLockError::Error(_)) => return None,
    }
    // The window may have closed in order between the two looks.
    fs::symlink_metadata(&file).ok()?;
    let summary = project::summary(&file).map_err(|error| error.to_string());
    Some(Leftover { file, written, summary, lock, _held: held })
}

/// Removes the lock of a window that stopped and left no autosave.
fn clear_lock(lock: &Path) {
    let Ok(metadata) = fs::symlink_metadata(lock) else { return };
    let is_old = metadata.modified().ok().and_then(|at| at.elapsed().ok()).is_some_and(|age| age > YOUNG);
    let is_alone = !lock.with_extension(project::EXTENSION).exists();
    if is_old && is_alone && metadata.is_file() && File::open(lock).is_ok_and(|file| file.try_lock().is_ok()) {
        let _ = fs::remove_file(lock);
    }
}
