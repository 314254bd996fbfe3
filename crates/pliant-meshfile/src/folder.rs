//! Where the files are that a model refers to: its folder on the disk, or a pack in memory.
//!
//! A folder can keep what was read from it, so that the model and all that belongs to it can be packed later, whatever has
//! become of the files by then.

use crate::files;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Files by the references that a model makes to them.
pub(crate) type Files = BTreeMap<String, Arc<Vec<u8>>>;

/// Where a model's references lead. Clones are the same folder.
#[derive(Clone, Debug)]
pub(crate) struct Folder(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    /// Nowhere for a pack.
    disk: Option<PathBuf>,
    /// The files of a pack, or what was read so far, if that is kept.
    files: Option<Mutex<Files>>,
}

impl Folder {
    /// A folder on the disk, which keeps what is read from it if it is to.
    pub(crate) fn on_disk(path: &Path, keeps: bool) -> Folder {
        Folder(Arc::new(Inner { disk: Some(path.to_owned()), files: keeps.then(Mutex::default) }))
    }

    /// The files of a pack, and no others.
    pub(crate) fn packed(files: Files) -> Folder {
        Folder(Arc::new(Inner { disk: None, files: Some(Mutex::new(files)) }))
    }

    /// Reads a file that the model names, if it lies in the folder; otherwise says why not.
    ///
    /// `reference` is a plain relative path with forward slashes.
    pub(crate) fn read(&self, reference: &str, limit: u64) -> Result<Vec<u8>, String> {
        if let Some(disk) = &self.0.disk {
            let bytes = files::read_beside(disk, reference, limit)?;
            self.keep(reference, &bytes);
            return Ok(bytes);
        }
        let bytes = self.kept().remove(reference).ok_or("not in the project")?;
        if bytes.len() as u64 > limit {
            return Err(format!("{} bytes are more than the limit of {limit}", bytes.len()));
        }
        Ok(Arc::unwrap_or_clone(bytes))
    }

    /// Keeps what a reference leads to, if this folder keeps anything.
    pub(crate) fn keep(&self, reference: &str, bytes: &[u8]) {
        if let Some(files) = &self.0.files {
            let mut files = files.lock().unwrap_or_else(PoisonError::into_inner);
            files.entry(reference.to_owned()).or_insert_with(|| Arc::new(bytes.to_vec()));
        }
    }

    /// What is kept, or packed.
    pub(crate) fn kept(&self) -> Files {
        let files = self.0.files.as_ref().map(|files| files.lock().unwrap_or_else(PoisonError::into_inner).clone());
        files.unwrap_or_default()
    }

    /// Its place on the disk, if it has one.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.0.disk.as_deref()
    }

    /// Whether a file of this path would lie in it.
    pub(crate) fn holds(&self, file: &Path) -> bool {
        self.0.disk.as_ref().is_some_and(|disk| files::same_folder(&disk.join("x"), file))
    }
}
