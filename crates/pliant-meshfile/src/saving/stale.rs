//! Temporaries of processes that were stopped.

use super::staged::is_temporary;
use super::unfinished;
use std::fs::{self, File};
use std::path::Path;
use std::time::Duration;

/// Between creating a temporary and locking it a process does nothing else. By eye: longer than any system takes.
const YOUNG: Duration = Duration::from_secs(60);

/// Removes temporaries that no process holds any more, but for those that an unfinished saving still needs.
///
/// What cannot be removed stays: it is in nobody's way.
pub(super) fn clear(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut temporaries = Vec::new();
    let mut needed = Vec::new();
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        if is_temporary(name) {
            temporaries.push(entry.path());
        } else if let Some(group) = unfinished::group_of(folder, name) {
            needed.push(format!(".pliant-{group}-"));
        }
    }
    for path in temporaries {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if !needed.iter().any(|group| name.starts_with(group)) && is_left_behind(&path) {
            let _ = fs::remove_file(&path);
        }
    }
}

fn is_left_behind(path: &Path) -> bool {
    // Asked before opening: a pipe by this name would be waited for.
    let Ok(metadata) = fs::symlink_metadata(path) else { return false };
    let age = metadata.modified().ok().and_then(|modified| modified.elapsed().ok());
    let old = age.is_some_and(|age| age > YOUNG);
    old && metadata.is_file() && File::open(path).is_ok_and(|file| file.try_lock().is_ok())
}
