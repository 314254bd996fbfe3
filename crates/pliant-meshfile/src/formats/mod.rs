//! What each format must offer, and the table of them.

mod gltf;
mod obj;
mod source;

pub(crate) use source::{Before, Broken, Edit, Input, Motion, Opened, Output, Source};

use crate::shape::Shape;
use crate::{Fault, Format, SaveError};
use std::path::{Path, PathBuf};

/// What the rest of the crate asks of a format.
pub(crate) struct Entry {
    format: Format,
    /// Reads a file's bytes.
    pub(crate) read: fn(Input<'_>) -> Result<Opened, Fault>,
    /// Makes a new file of a mesh that came from elsewhere.
    pub(crate) write: fn(&Shape, &Path) -> Result<Output, SaveError>,
    /// What `write` may write beside a file of this name.
    pub(crate) beside: fn(&Path) -> Vec<PathBuf>,
    /// Whether r is kept in a sidecar, for want of a place in the file.
    pub(crate) rigidity_in_sidecar: bool,
}

const TABLE: &[Entry] = &[
    Entry { format: Format::Obj, read: obj::read, write: obj::write, beside: obj::beside, rigidity_in_sidecar: true },
    Entry {
        format: Format::Gltf,
        read: gltf::read,
        write: gltf::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: false,
    },
    Entry {
        format: Format::Glb,
        read: gltf::read,
        write: gltf::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: false,
    },
];

/// What a format offers.
pub(crate) fn entry(format: Format) -> &'static Entry {
    TABLE.iter().find(|entry| entry.format == format).expect("every format is in the table")
}
