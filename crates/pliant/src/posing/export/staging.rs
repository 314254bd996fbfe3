//! The folder in which a set of files lies until all of it is there: hidden, beside the place of the files, and gone when
//! the export is over. One that a process left behind when it was stopped goes with the next export beside it.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::time::Duration;

use tempfile::TempDir;

const PREFIX: &str = ".poses-";
/// Locked as long as the export lives, so that others can tell its folder from one that was left behind.
const LOCK: &str = ".lock";
/// Between making the folder and locking it an export does nothing else. By eye: longer than any system takes.
const YOUNG: Duration = Duration::from_secs(60);

/// Such a folder. Dropped, it is gone with what is in it.
pub(super) struct Staging {
    /// Closed before the folder goes: open files stay on some systems.
    _lock: File,
    folder: TempDir,
}

impl Staging {
    /// Makes one in `folder`, and clears away what others have left there.
    pub(super) fn new(folder: &Path) -> io::Result<Staging> {
        clear(folder);
        let made = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder)?;
        let lock = File::create_new(made.path().join(LOCK))?;
        // Where a file system has no locks, nothing is ever taken for left behind.
        let _ = lock.try_lock();
        Ok(Staging { _lock: lock, folder: made })
    }

    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Names of all that was written into it.
    pub(super) fn names(&self) -> io::Result<Vec<std::ffi::OsString>> {
        let listed = fs::read_dir(self.path())?.map(|entry| entry.map(|entry| entry.file_name()));
        let own = OsStr::new(LOCK);
        listed.filter(|name| name.as_ref().map_or(true, |name| name != own)).collect()
    }
}

/// Removes the folders of exports whose process is gone. What cannot be removed stays: it is in nobody's way.
fn clear(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let is_named = entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX));
        if is_named && entry.file_type().is_ok_and(|kind| kind.is_dir()) && is_left_behind(&entry.path()) {
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

fn is_left_behind(folder: &Path) -> bool {
    let lock = folder.join(LOCK);
    // Asked before opening: a pipe by this name would be waited for.
    let Ok(metadata) = fs::symlink_metadata(&lock) else { return false };
    let age = metadata.modified().ok().and_then(|modified| modified.elapsed().ok());
    let is_old = age.is_some_and(|age| age > YOUNG);
    is_old && metadata.is_file() && File::open(&lock).is_ok_and(|file| file.try_lock().is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::SystemTime;

    #[test]
    fn what_a_stopped_export_left_goes_with_the_next_and_nothing_else_does() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let at = |name: &str| folder.path().join(name);
        let hour_ago = SystemTime::now() - Duration::from_secs(3600);
        for (name, lock) in [(".poses-left", true), (".poses-mine", false), ("poses-kept", true)] {
            fs::create_dir(at(name)).expect("made");
            fs::write(at(name).join("walk.0001.obj"), "v 0 0 0").expect("written");
            if lock {
                File::create(at(name).join(LOCK)).and_then(|file| file.set_modified(hour_ago)).expect("written");
            }
        }
        let running = Staging::new(folder.path()).expect("a folder");
        running._lock.set_modified(hour_ago).expect("its time is set");
        assert!(!at(".poses-left").exists(), "it stays");
        let other = Staging::new(folder.path()).expect("a folder");
        assert!(running.path().exists(), "one that is still at work is gone");
        assert!(at(".poses-mine").exists() && at("poses-kept").exists(), "what is not of an export is gone");
        fs::write(other.path().join("a.obj"), "").expect("written");
        assert_eq!(other.names().expect("listed"), ["a.obj"]);
        let paths = [running.path().to_owned(), other.path().to_owned()];
        drop((running, other));
        assert!(paths.iter().all(|path| !path.exists()), "an export that is over leaves its folder");
    }
}
