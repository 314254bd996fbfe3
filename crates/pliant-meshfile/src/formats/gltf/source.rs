//! A glTF file as it came, and where its vertices are.

use super::buffers::Buffer;
use super::compressed::Decoded;
use super::container::Container;
use crate::folder::Folder;
use glam::{DMat4, DVec3};
use serde_json::Value;
use std::ops::Range;

/// A glTF file as it came.
#[derive(Debug)]
pub(super) struct GltfSource {
    pub(super) container: Container,
    pub(super) document: Value,
    /// Bytes of each buffer; buffer 0 of a GLB file without URI is the container's binary chunk.
    pub(super) buffers: Vec<Buffer>,
    /// What the file holds compressed.
    pub(super) decoded: Decoded,
    pub(super) blocks: Vec<Block>,
    pub(super) primitives: Vec<Primitive>,
    pub(super) folder: Option<Folder>,
}

/// A POSITION accessor: a range of file vertices that move together into world space.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) accessor: usize,
    pub(super) vertices: Range<usize>,
    pub(super) world_from_local: DMat4,
    pub(super) local_from_world: DMat4,
}

impl Block {
    pub(super) fn to_world(&self, local: DVec3) -> DVec3 {
        self.world_from_local.transform_point3(local)
    }
}

/// A primitive with positions.
#[derive(Clone, Debug)]
pub(super) struct Primitive {
    pub(super) mesh: usize,
    pub(super) index: usize,
    pub(super) block: usize,
    pub(super) normal: Option<usize>,
    pub(super) tangent: Option<usize>,
    pub(super) uv: Option<usize>,
    pub(super) material: Option<usize>,
    /// Range of the file's triangles.
    pub(super) triangles: Range<usize>,
}
