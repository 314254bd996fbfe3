//! The file as it was before it was edited, under a second name.
//!
//! **When.** A mesh that is saved over the file it was opened from, for the first time: what lies there is then what no
//! undo brings back once the program has ended. Savings after that replace what the program itself wrote, and leave the
//! backup alone; unless another program has written the file in between. A new file, and one that a person chose to
//! replace by another mesh, get no backup.
//!
//! **Where.** `NAME~` beside it, as editors of text and pictures do: file managers hide it, no program takes it for a
//! mesh, and renaming it brings the old file back. It is a second name of the old content, so making it copies nothing.

use super::staged::Group;
use crate::{Warning, files};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// Number of a backup among the temporaries of its saving, beyond that of any file.
const BACKUP_INDEX: usize = 998;

/// Which file a mesh came from, and what this program last wrote there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Known {
    opened: Option<PathBuf>,
    written: Arc<Mutex<Option<Stamp>>>,
}

/// Tells whether a file was written since.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    length: u64,
    modified: Option<SystemTime>,
}

impl Stamp {
    fn of(path: &Path) -> Option<Stamp> {
        let metadata = fs::metadata(path).ok()?;
        Some(Stamp { length: metadata.len(), modified: metadata.modified().ok() })
    }
}

impl Known {
    /// A mesh that was opened from `path`, as it is now.
    pub(crate) fn opened(path: &Path) -> Known {
        Known { opened: path.canonicalize().ok(), written: Arc::default() }
    }

    /// Keeps the file at `target`, a path without links, if it is worth keeping when `new` bytes replace it; whether it
    /// was kept. A failure is a warning: what is saved is whole either way.
    pub(super) fn keep(&self, target: &Path, new: &[u8]) -> Result<bool, Warning> {
        if !self.is_worth_keeping(target, new) {
            return Ok(false);
        }
        let backup = name_of(target);
        let failed = |error| Warning(format!("the old file was not kept as {}: {error}", backup.display()));
        keep(target, &backup).map(|()| true).map_err(failed)
    }

    fn is_worth_keeping(&self, target: &Path, new: &[u8]) -> bool {
        let now = Stamp::of(target);
        let written = *self.written.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(now) = now.filter(|_| self.opened.as_deref() == Some(target) && target.is_file()) else {
            return false;
        };
        // The same bytes again would only push an older backup out.
        let alike = || now.length == new.len() as u64 && fs::read(target).is_ok_and(|old| old == new);
        written != Some(now) && !alike()
    }

    /// Takes note of what was saved at `target`, if the old content is safe or was this program's own.
    pub(super) fn remember(&self, target: &Path, kept: bool) {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        if self.opened.as_deref() == Some(target) && (kept || written.is_some()) {
            *written = Stamp::of(target);
        }
    }
}

fn name_of(target: &Path) -> PathBuf {
    let mut name = OsString::from(target.file_name().unwrap_or_default());
    name.push("~");
    target.with_file_name(name)
}

/// Gives `target` a second name, in one step where there is a backup already.
fn keep(target: &Path, backup: &Path) -> std::io::Result<()> {
    let taken = fs::symlink_metadata(backup);
    if taken.is_ok_and(|taken| !taken.is_file() && !taken.is_symlink()) {
        return Err(std::io::Error::other("something else has this name"));
    }
    let temporary = files::folder_of(target).join(Group::new().temporary(BACKUP_INDEX));
    let _ = fs::remove_file(&temporary);
    let made = match fs::hard_link(target, &temporary) {
        // Some file systems (of memory sticks, of networks) give files one name only.
        Err(error) if matches!(error.kind(), ErrorKind::Unsupported | ErrorKind::PermissionDenied) => {
            fs::copy(target, &temporary).and_then(|_| File::open(&temporary)?.sync_all())
        }
        other => other,
    };
    let renamed = made.and_then(|()| fs::rename(&temporary, backup));
    // Of two names of one file the renaming removes none.
    let _ = fs::remove_file(&temporary);
    renamed
}
