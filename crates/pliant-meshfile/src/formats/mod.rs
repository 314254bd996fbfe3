//! The formats: what each must offer, and the table of them.

mod gltf;
mod obj;

use crate::shape::Shape;
use crate::{Fault, MeshFile, Part, SaveError, Warning};
use glam::{DVec3, Vec2};
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A way of storing meshes in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ, text.
    Obj,
    /// glTF 2.0, JSON with buffers beside or inside it.
    Gltf,
    /// glTF 2.0, one binary file.
    Glb,
}

impl Format {
    /// Endings of the files that can be opened, for dialogs.
    pub const EXTENSIONS: &[&str] = &["obj", "gltf", "glb"];

    /// The format of a file by the ending of its name, upper or lower case.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?;
        TABLE.iter().find(|entry| entry.extension.eq_ignore_ascii_case(extension)).map(|entry| entry.format)
    }

    pub(crate) fn entry(self) -> &'static Entry {
        TABLE.iter().find(|entry| entry.format == self).expect("every format is in the table")
    }
}

/// What the rest of the crate asks of a format.
pub(crate) struct Entry {
    format: Format,
    extension: &'static str,
    /// Reads a file's bytes.
    pub(crate) read: fn(Input<'_>) -> Result<Opened, Fault>,
    /// Makes a new file of a mesh that came from elsewhere.
    pub(crate) write: fn(&Shape, &Path) -> Result<Output, SaveError>,
    /// Whether r is kept in a sidecar, for want of a place in the file.
    pub(crate) rigidity_in_sidecar: bool,
}

const TABLE: &[Entry] = &[
    Entry { format: Format::Obj, extension: "obj", read: obj::read, write: obj::write, rigidity_in_sidecar: true },
    Entry { format: Format::Gltf, extension: "gltf", read: gltf::read, write: gltf::write, rigidity_in_sidecar: false },
    Entry { format: Format::Glb, extension: "glb", read: gltf::read, write: gltf::write, rigidity_in_sidecar: false },
];

/// What a reader gets.
pub(crate) struct Input<'a> {
    pub(crate) bytes: Vec<u8>,
    /// Where references may be followed; nowhere for files from memory.
    pub(crate) folder: Option<&'a Path>,
    /// Name of the model, for parts that have none.
    pub(crate) name: &'a str,
}

/// What a reader gives.
pub(crate) struct Opened {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) rigidity: Option<Vec<u16>>,
    pub(crate) uvs: Option<Vec<Vec2>>,
    pub(crate) colors: Option<Vec<[f32; 4]>>,
    pub(crate) parts: Vec<Part>,
    pub(crate) warnings: Vec<Warning>,
    pub(crate) source: Arc<dyn Source>,
}

/// A file as it came, able to be written again with another shape.
pub(crate) trait Source: Debug + Send + Sync {
    /// The same file with the edit, touching nothing else; `None` when `format` is not of the source's kind.
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>>;
    /// The edited mesh without its file, for other formats.
    fn shape(&self, edit: &Edit<'_>) -> Shape;
}

/// The new state of a mesh.
pub(crate) struct Edit<'a> {
    pub(crate) mesh: &'a MeshFile,
    /// World position of each file vertex; equal to the opened one to the bit where nothing moved.
    pub(crate) positions: Vec<DVec3>,
    /// r of each file vertex, when it is to be written.
    pub(crate) rigidity: Option<Vec<u16>>,
}

impl Edit<'_> {
    /// Whether a file vertex is not where it was opened.
    pub(crate) fn moved(&self, vertex: usize) -> bool {
        self.positions[vertex] != self.mesh.positions[vertex]
    }
}

/// Finished files, not yet on the disk.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) bytes: Vec<u8>,
    /// Further files that belong to it.
    pub(crate) beside: Vec<(PathBuf, Vec<u8>)>,
    pub(crate) warnings: Vec<Warning>,
}
