//! Files that appear whole or not at all.
//!
//! Links are written through, and the permissions of a file that is replaced stay.

use std::fs::{File, Permissions};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};

use pliant_meshfile::side_files;

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
        let failed = |source| Failure::Write { path: target.to_owned(), source };
        let end = target.canonicalize().unwrap_or_else(|_| target.to_owned());
        let permissions = std::fs::metadata(&end).ok().map(|replaced| replaced.permissions());
        if permissions.as_ref().is_some_and(Permissions::readonly) {
            return Err(failed(std::io::Error::new(std::io::ErrorKind::PermissionDenied, "the file is read-only")));
        }
        let name = end.file_name().unwrap_or_default().to_string_lossy();
        let temporary = end.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
        // A leftover of a killed run with the same process number; it is nobody's by now.
        let _ = std::fs::remove_file(&temporary);
        let file = File::create_new(&temporary).map_err(failed)?;
        let staged = Staged { file, temporary, target: end };
        if let Some(permissions) = permissions {
            staged.file.set_permissions(permissions).map_err(failed)?;
        }
        Ok(staged)
    }

    /// Writes `bytes` and takes `spare` bytes more from the disk: later writing up to that length needs no room.
    pub(super) fn reserve(&mut self, bytes: &[u8], spare: usize) -> Result<(), Failure> {
        self.write(&[bytes, &vec![b' '; spare]].concat())
    }

    /// Replaces what was written before, in place, and waits until the disk has it.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let write = |file: &mut File| {
            file.rewind()?;
            file.write_all(bytes)?;
            file.set_len(bytes.len() as u64)?;
            file.sync_all()
        };
        write(&mut self.file).map_err(|source| self.failed(source))
    }

    /// Writes what is too long to be held in memory as one text, and waits until the disk has it.
    pub(super) fn stream(&mut self, fill: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), Failure> {
        let write = |file: &mut File| {
            let mut buffered = std::io::BufWriter::new(&mut *file);
            fill(&mut buffered)?;
            buffered.flush()?;
            drop(buffered);
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

/// Refuses a target that could not be written: a folder, a device or a pipe, a file in a folder that does not exist.
pub(super) fn check_target(path: &Path) -> Result<(), Failure> {
    if path.is_dir() {
        return Err(Failure::IsFolder { path: path.to_owned() });
    }
    let folder = folder_of(path);
    let Ok(real) = folder.canonicalize() else {
        return Err(Failure::NoFolder { path: path.to_owned(), folder: folder.to_owned() });
    };
    // Names of the process's own streams: a rename would take the file behind one away from whoever reads it.
    let is_stream = cfg!(unix) && (real == Path::new("/dev") || real.starts_with("/proc"));
    if is_stream || (path.exists() && !path.is_file()) {
        return Err(Failure::NotRegular { path: path.to_owned() });
    }
    Ok(())
}

/// Refuses outputs in place of the files that lie beside a mesh and belong to it: its material library, its rigidity.
/// Meshes and outputs come with their names in messages.
pub(super) fn check_side_files(
    meshes: &[(&Path, &'static str)],
    outputs: &[(Option<&Path>, &'static str)],
) -> Result<(), Failure> {
    for (mesh, other) in meshes {
        let side_files = side_files(mesh);
        for (path, what) in outputs.iter().filter_map(|&(path, what)| Some((path?, what))) {
            if side_files.iter().any(|file| same_file(path, file)) {
                return Err(Failure::SamePath { path: path.to_owned(), what, other });
            }
        }
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// Whether two names mean one file, through links and `..` where the files or their folders exist.
pub(super) fn same_file(a: &Path, b: &Path) -> bool {
    let resolve = |path: &Path| {
        path.canonicalize().ok().or_else(|| Some(folder_of(path).canonicalize().ok()?.join(path.file_name()?)))
    };
    a == b || matches!((resolve(a), resolve(b)), (Some(a), Some(b)) if a == b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_text_written_is_the_whole_file() {
        let folder = tempfile::tempdir().expect("a new folder");
        let target = folder.path().join("report.json");
        let mut staged = Staged::create(&target).expect("a folder to write to");
        staged.reserve(b"first", 100).expect("room");
        assert!(!target.exists());
        staged.write(b"the second").expect("room");
        staged.commit().expect("a free name");
        assert_eq!(std::fs::read(&target).expect("committed"), b"the second");
        assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
    }

    #[test]
    fn what_lies_beside_a_mesh_and_belongs_to_it_is_no_output() {
        let folder = tempfile::tempdir().expect("a new folder");
        let at = |name: &str| folder.path().join(name);
        let refused = |mesh: &str, output: &str| {
            let outputs = [(None, "the table"), (Some(&*at(output)), "the report")];
            check_side_files(&[(&at(mesh), "a file that belongs to OUT")], &outputs)
                .err()
                .map(|error| error.to_string())
        };
        for name in ["out.rigidity.json", "./out.rigidity.json", "out.mtl"] {
            let said = refused("out.obj", name).expect(name);
            assert!(
                said.ends_with("the report would overwrite a file that belongs to OUT; name another file"),
                "{said}"
            );
        }
        assert_eq!([refused("out.glb", "out.rigidity.json"), refused("out.obj", "out.json")], [None, None]);
    }

    #[test]
    #[cfg(unix)]
    fn a_link_is_written_through_and_permissions_stay() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a new folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        std::fs::write(&file, "old").expect("a new file");
        std::fs::set_permissions(&file, PermissionsExt::from_mode(0o640)).expect("our own file");
        symlink(&file, &link).expect("a new link");
        let mut staged = Staged::create(&link).expect("a folder to write to");
        staged.write(b"new").expect("room");
        staged.commit().expect("a file to replace");
        assert!(link.is_symlink());
        assert_eq!(std::fs::read(&file).expect("replaced"), b"new");
        assert_eq!(file.metadata().expect("replaced").permissions().mode() & 0o777, 0o640);
    }
}
