//! glTF 2.0, as JSON with buffers or as one GLB file.
//!
//! The JSON is kept as it is and read through checks of our own: every accessor, view, index, stride, type and node in
//! 64-bit arithmetic, before anything is reserved or followed. A typed document would lose members it does not know,
//! and the usual crate's reader panics on several broken files; it checks this reader in the tests instead.

mod access;
mod base64;
mod buffers;
mod builder;
mod container;
mod export;
mod json;
mod nodes;
mod read;
mod relocate;
mod rewrite;
mod shape;

pub(super) use export::write;
pub(super) use read::read;

use super::{Edit, Format, Output, Source};
use crate::SaveError;
use crate::shape::Shape;
use glam::{DMat4, DVec3};
use serde_json::Value;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A glTF file as it came.
#[derive(Debug)]
struct GltfSource {
    container: container::Container,
    document: Value,
    /// Bytes of each buffer; buffer 0 of a GLB file without URI is the container's binary chunk.
    buffers: Vec<buffers::Buffer>,
    blocks: Vec<Block>,
    primitives: Vec<Primitive>,
    folder: Option<PathBuf>,
}

/// A POSITION accessor: a range of file vertices that move together into world space.
#[derive(Clone, Debug)]
struct Block {
    accessor: usize,
    vertices: Range<usize>,
    world_from_local: DMat4,
    local_from_world: DMat4,
}

impl Block {
    fn to_world(&self, local: DVec3) -> DVec3 {
        self.world_from_local.transform_point3(local)
    }
}

/// A primitive with positions.
#[derive(Clone, Debug)]
struct Primitive {
    mesh: usize,
    index: usize,
    block: usize,
    normal: Option<usize>,
    tangent: Option<usize>,
    uv: Option<usize>,
    material: Option<usize>,
    /// Range of the file's triangles.
    triangles: Range<usize>,
}

impl Source for GltfSource {
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>> {
        matches!(format, Format::Gltf | Format::Glb).then(|| rewrite::rewrite(self, edit, to, format))
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        shape::shape(self, edit)
    }
}
