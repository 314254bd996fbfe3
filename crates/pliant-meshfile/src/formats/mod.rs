//! What each format must offer, and the table of them.

mod faces;
mod gltf;
mod holds;
mod obj;
mod off;
mod outlines;
mod ply;
mod source;
mod split;
mod stl;
mod turning;
mod words;

pub(crate) use gltf::with_morphs;
pub(crate) use source::{Before, Bindings, Broken, Edit, Input, Motion, Opened, Output, Source};

use crate::shape::Shape;
use crate::{Fault, Format, SaveError};
use holds::Holds;
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
    /// What of a shape `write` can put into a file.
    pub(crate) holds: Holds,
}

const TABLE: &[Entry] = &[
    Entry {
        format: Format::Obj,
        read: obj::read,
        write: obj::write,
        beside: obj::beside,
        rigidity_in_sidecar: true,
        holds: Holds { alpha: false, ..Holds::ALL },
    },
    Entry {
        format: Format::Gltf,
        read: gltf::read,
        write: gltf::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: false,
        holds: Holds { polygons: false, ..Holds::ALL },
    },
    Entry {
        format: Format::Glb,
        read: gltf::read,
        write: gltf::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: false,
        holds: Holds { polygons: false, ..Holds::ALL },
    },
    Entry {
        format: Format::Ply,
        read: ply::read,
        write: ply::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: false,
        holds: Holds { parts: false, materials: false, ..Holds::ALL },
    },
    Entry {
        format: Format::Stl,
        read: stl::read,
        write: stl::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: true,
        holds: Holds::TRIANGLES,
    },
    Entry {
        format: Format::Off,
        read: off::read,
        write: off::write,
        beside: |_| Vec::new(),
        rigidity_in_sidecar: true,
        holds: Holds { parts: false, materials: false, ..Holds::ALL },
    },
];

/// What a format offers.
pub(crate) fn entry(format: Format) -> &'static Entry {
    TABLE.iter().find(|entry| entry.format == format).expect("every format is in the table")
}
