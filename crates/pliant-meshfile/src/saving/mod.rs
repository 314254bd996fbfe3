//! Saving so that a file is the old one or the new one, whole, whenever the program or the machine stops.
//!
//! **One file.** The new content goes into a temporary beside the target and to the disk; the old content gets a second
//! name where it is worth keeping ([`backup`]); the temporary takes the target's name in one step; the folder goes to
//! the disk.
//!
//! **Files that belong together.** A mesh with a sidecar or a material library is several files, and a system renames
//! one at a time. The main file's renaming is the moment that counts for all of them:
//!
//! | step | stopped after it, the folder opens as |
//! |---|---|
//! | 1. temporaries of all files, to the disk | the old set |
//! | 2. a note of what is about to happen ([`unfinished`]) | the old set: the main file is not the one in the note |
//! | 3. the backup | the old set |
//! | 4. the main file renamed, the folder to the disk | the new set: the note fits, and names the temporaries to read |
//! | 5. the other files renamed, the folder to the disk | the new set |
//! | 6. the note removed | the new set |
//!
//! Opening only looks; the next saving finishes or clears away what an earlier one left.

mod backup;
mod staged;
mod stale;
#[cfg(test)]
mod tests;
mod unfinished;

pub(crate) use backup::Known;
pub(crate) use unfinished::Unfinished;

use crate::{SaveError, Warning, files};
use staged::{Group, Staged};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// How a file is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SaveOptions {
    /// Whether the file that was opened is kept as `NAME~` when it is first saved over, and again when another program
    /// has changed it since. A backup that is there already is replaced. Files beside the mesh have none.
    pub backup: bool,
}

impl Default for SaveOptions {
    fn default() -> Self {
        SaveOptions { backup: true }
    }
}

/// Writes `bytes` to `to` and the files `beside` it, named after it and in its folder, all or none.
///
/// A link is saved through for the main file, which a person chose; links in place of the files beside it are replaced,
/// wherever they lead. `known` tells which old content is kept, if any is.
pub(crate) fn write(
    to: &Path,
    bytes: &[u8],
    beside: &[(PathBuf, Vec<u8>)],
    known: Option<&Known>,
) -> Result<Vec<Warning>, SaveError> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |source| SaveError::Write { path, source }
    };
    let target = to.canonicalize().unwrap_or_else(|_| to.to_owned());
    unfinished::recover(to).map_err(failed(to))?;
    stale::clear(files::folder_of(&target));
    if !files::same_folder(&target, to) {
        stale::clear(files::folder_of(to));
    }

    let group = Group::new();
    let mut main = Staged::new(target.clone(), bytes, &group, 0).map_err(failed(to))?;
    let mut others = Vec::new();
    for (i, (path, bytes)) in beside.iter().enumerate() {
        others.push(Staged::new(path.clone(), bytes, &group, i + 1).map_err(failed(path))?);
    }
    let paths: Vec<&Path> = beside.iter().map(|(path, _)| path.as_path()).collect();
    let note = match paths[..] {
        [] => None,
        _ => Some(unfinished::Note::write(to, bytes, &group, &paths).map_err(failed(to))?),
    };
    let kept = known.map_or(Ok(false), |known| known.keep(&target, bytes));
    main.publish().map_err(failed(to))?;
    for (other, path) in others.iter_mut().zip(paths) {
        if let Err(source) = other.publish() {
            // The note stays and makes the whole set readable; so do the temporaries.
            others.iter_mut().for_each(Staged::leave);
            note.into_iter().for_each(unfinished::Note::leave);
            return Err(SaveError::Unfinished { path: to.to_owned(), beside: path.to_owned(), source });
        }
    }
    drop(note);
    if let Some(known) = known {
        known.remember(&target, kept == Ok(true));
    }
    Ok(kept.err().into_iter().collect())
}

/// Writes a file of any kind so that `to` is the old one or the new one, whole, wherever the program or the machine stops.
///
/// `content` is called once with the new file. A link is saved through.
pub fn replace_file(to: &Path, content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), SaveError> {
    let failed = |source| SaveError::Write { path: to.to_owned(), source };
    let target = to.canonicalize().unwrap_or_else(|_| to.to_owned());
    stale::clear(files::folder_of(&target));
    let mut staged = Staged::filled(target, &Group::new(), 0, content).map_err(failed)?;
    staged.publish().map_err(failed)
}

/// Makes the names in a folder durable; a system that cannot bring folders to the disk does so itself.
fn sync_folder(folder: &Path) {
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}
