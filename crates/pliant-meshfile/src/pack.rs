//! A mesh file with all it refers to, as it was opened, in memory: what a project takes along.

use crate::folder::Folder;
use crate::{Format, MeshFile, Warning, budget};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// A mesh file and the files it refers to, byte for byte. Cheap to clone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pack {
    /// Name of the file; its ending tells the format.
    pub name: String,
    /// The file.
    pub bytes: Arc<Vec<u8>>,
    /// Buffers, images, material libraries and the rigidity sidecar, by the references made to them.
    pub beside: BTreeMap<String, Arc<Vec<u8>>>,
}

/// What a mesh was read from.
#[derive(Clone, Debug)]
pub(crate) struct Original {
    pub(crate) bytes: Arc<Vec<u8>>,
    pub(crate) folder: Folder,
    pub(crate) name: String,
}

/// The name of a file in a format: its own if it ends like one, else with the ending of the format.
pub(crate) fn file_name(name: &str, format: Format) -> String {
    match Format::of(Path::new(name)) {
        Some(own) if own == format => name.to_owned(),
        _ => format!("{name}.{}", format.extension()),
    }
}

impl MeshFile {
    /// The file this mesh was opened from with all it refers to, as they were then, and what could not be taken along.
    ///
    /// Nothing for a mesh that was made in memory, or opened without [`crate::OpenOptions::keep`].
    pub fn pack(&self) -> Option<(Pack, Vec<Warning>)> {
        let Original { bytes, folder, name } = self.original.as_deref()?;
        let mut beside = folder.kept();
        let mut warnings = Vec::new();
        for reference in self.references() {
            if beside.contains_key(&reference) {
                continue;
            }
            match folder.read(&reference, budget::TEXT_BYTES) {
                Ok(bytes) => drop(beside.insert(reference, Arc::new(bytes))),
                Err(reason) => {
                    let shown = crate::rigidity::quoted(&reference);
                    warnings.push(Warning(format!("{shown} is not packed: {reason}")));
                }
            }
        }
        Some((Pack { name: name.clone(), bytes: bytes.clone(), beside }, warnings))
    }

    /// The bytes of the file this mesh was opened from, if they were kept.
    pub fn original_bytes(&self) -> Option<&[u8]> {
        self.original.as_ref().map(|original| original.bytes.as_slice())
    }
}
