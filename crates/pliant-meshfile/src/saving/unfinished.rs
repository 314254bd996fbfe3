//! The note that ties the files of one saving together while they take their names one after the other.
//!
//! It says which bytes the main file will have (their number and a checksum) and which temporaries belong to it. As long
//! as the main file holds other bytes, the saving has not happened and the note means nothing; from the moment it holds
//! these, the temporaries count instead of the files they have not replaced yet.

use super::staged::{Group, create_locked};
use super::sync_folder;
use crate::{budget, files};
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// More than a note of all that lies beside a mesh takes.
const NOTE_BYTES: u64 = 4096;
/// Number of a note among the temporaries of its saving, beyond that of any file.
const NOTE_INDEX: usize = 999;

/// Fowler, Noll and Vo's hash with 64 bits (FNV-1a): tells files apart that nobody made to be alike.
fn checksum(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Where the note of a mesh lies: named by a checksum of the mesh's name, since names have a greatest length.
fn path_of(mesh: &Path) -> PathBuf {
    let name = mesh.file_name().unwrap_or_default();
    mesh.with_file_name(format!(".pliant-{:016x}.note", checksum(name.as_encoded_bytes())))
}

/// The group in a note by this name, if it is one.
pub(super) fn group_of(folder: &Path, name: &str) -> Option<Group> {
    let is_note = name.starts_with(".pliant-") && name.ends_with(".note");
    if !is_note {
        return None;
    }
    Content::read(folder, &folder.join(name)).map(|content| content.group)
}

/// What a note says.
struct Content {
    group: Group,
    length: u64,
    checksum: u64,
    /// The names of the other files, after the stem of the mesh.
    endings: Vec<String>,
}

impl Content {
    /// Nothing for notes that are broken, too long, no files, or links out of the folder.
    fn read(folder: &Path, path: &Path) -> Option<Content> {
        if !files::is_taken(path) {
            return None;
        }
        let bytes = files::read_inside(folder, path, NOTE_BYTES).ok()?;
        let mut lines = std::str::from_utf8(&bytes).ok()?.lines();
        let mut words = lines.next()?.split(' ');
        let group = Group::parse(words.next()?)?;
        let length = words.next()?.parse().ok()?;
        let checksum = u64::from_str_radix(words.next()?, 16).ok()?;
        let endings: Vec<String> = lines.map(str::to_owned).collect();
        let plain = |ending: &String| !ending.is_empty() && !ending.contains(['/', '\\', '\0', ':']);
        endings.iter().all(plain).then_some(Content { group, length, checksum, endings })
    }

    fn to_text(&self) -> String {
        let Content { group, length, checksum, endings } = self;
        format!("{group} {length} {checksum:016x}\n{}\n", endings.join("\n"))
    }

    fn is_of(&self, main: &[u8]) -> bool {
        self.length == main.len() as u64 && self.checksum == checksum(main)
    }

    /// The files beside `mesh` that the note names, each with its temporary.
    fn pairs(&self, mesh: &Path) -> Vec<(PathBuf, PathBuf)> {
        let stem = mesh.file_stem().unwrap_or_default();
        let target = |ending: &String| {
            let mut name = OsString::from(stem);
            name.push(ending);
            mesh.with_file_name(name)
        };
        let temporary = |index: usize| mesh.with_file_name(self.group.temporary(index));
        self.endings.iter().enumerate().map(|(i, ending)| (target(ending), temporary(i + 1))).collect()
    }
}

/// A saving that was stopped after its main file took its name and before all others had theirs.
#[derive(Debug)]
pub(crate) struct Unfinished {
    pairs: Vec<(PathBuf, PathBuf)>,
}

impl Unfinished {
    /// What was left of saving `mesh`, which holds `bytes`. Nothing is changed.
    pub(crate) fn of(mesh: &Path, bytes: &[u8]) -> Option<Unfinished> {
        let content = Content::read(files::folder_of(mesh), &path_of(mesh))?;
        content.is_of(bytes).then(|| Unfinished { pairs: content.pairs(mesh) })
    }

    /// What stands for the file of this name beside the mesh, if it has not taken its name yet.
    pub(crate) fn temporary_of(&self, name: &OsStr) -> Option<&Path> {
        let (_, temporary) = self.pairs.iter().find(|(target, _)| target.file_name() == Some(name))?;
        files::is_taken(temporary).then_some(temporary)
    }
}

/// Finishes an earlier saving of `mesh` that was stopped, or clears away one that did not come to its main file.
pub(super) fn recover(mesh: &Path) -> std::io::Result<()> {
    let note = path_of(mesh);
    if !files::is_taken(&note) {
        return Ok(());
    }
    let folder = files::folder_of(mesh);
    let Some(content) = Content::read(folder, &note) else {
        // Nothing this program wrote: whatever it is, it is in the way.
        return fs::remove_file(&note);
    };
    if let Err(fs::TryLockError::WouldBlock) = File::open(&note)?.try_lock() {
        return Err(Error::new(ErrorKind::ResourceBusy, "another program is saving it right now"));
    }
    let happened = files::read(mesh, budget::FILE_BYTES).is_ok_and(|bytes| content.is_of(&bytes));
    if !happened {
        let target = mesh.canonicalize().unwrap_or_else(|_| mesh.to_owned());
        let _ = fs::remove_file(target.with_file_name(content.group.temporary(0)));
    }
    for (target, temporary) in content.pairs(mesh) {
        if files::is_taken(&temporary) {
            if happened { fs::rename(&temporary, &target)? } else { fs::remove_file(&temporary)? }
        }
    }
    sync_folder(folder);
    fs::remove_file(&note)
}

/// A note on the disk, removed when dropped.
#[derive(Debug)]
pub(super) struct Note {
    path: PathBuf,
    /// Locked as long as the process lives.
    _file: File,
    stays: bool,
}

impl Note {
    /// Writes the note of a saving of `mesh` with the files `beside` it, numbered from 1 in `group`.
    pub(super) fn write(mesh: &Path, main: &[u8], group: &Group, beside: &[&Path]) -> std::io::Result<Note> {
        let endings = beside.iter().map(|path| ending(mesh, path)).collect::<Option<Vec<String>>>();
        let endings = endings.ok_or_else(|| Error::other("its name cannot be shared by the files beside it"))?;
        let content = Content { group: group.clone(), length: main.len() as u64, checksum: checksum(main), endings };
        let temporary = mesh.with_file_name(group.temporary(NOTE_INDEX));
        let mut file = create_locked(&temporary)?;
        let path = path_of(mesh);
        let written = file
            .write_all(content.to_text().as_bytes())
            .and_then(|()| file.sync_all())
            .and_then(|()| fs::rename(&temporary, &path));
        if let Err(error) = written {
            let _ = fs::remove_file(&temporary);
            return Err(error);
        }
        sync_folder(files::folder_of(mesh));
        Ok(Note { path, _file: file, stays: false })
    }

    /// Stays on the disk for the next saving.
    pub(super) fn leave(mut self) {
        self.stays = true;
    }
}

impl Drop for Note {
    fn drop(&mut self) {
        if !self.stays {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// What follows the stem of `mesh` in the name of a file beside it.
fn ending(mesh: &Path, beside: &Path) -> Option<String> {
    let stem = mesh.file_stem()?.as_encoded_bytes();
    let ending = beside.file_name()?.as_encoded_bytes().strip_prefix(stem)?;
    let ending = std::str::from_utf8(ending).ok()?;
    (!ending.is_empty() && !ending.contains(['\n', '\r'])).then(|| ending.to_owned())
}
