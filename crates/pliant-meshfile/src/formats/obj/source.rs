//! An OBJ file as it came.

use super::parse::Skipped;
use super::textures::Map;
use crate::folder::Folder;
use crate::shape::{Material, ShapePart};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// An OBJ file as it came.
#[derive(Debug)]
pub(super) struct ObjSource {
    pub(super) bytes: Vec<u8>,
    /// Where each `v` statement begins in `bytes`.
    pub(super) vertex_at: Vec<u64>,
    /// Where each `vn` statement begins.
    pub(super) normal_at: Vec<u64>,
    pub(super) normals: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    /// Texture coordinate and normal of the corners of each triangle.
    pub(super) corners: Vec<[(u32, u32); 3]>,
    pub(super) parts: Vec<ShapePart>,
    pub(super) materials: Vec<Material>,
    /// The picture of each material, if it has one.
    pub(super) maps: Vec<Option<Map>>,
    /// Material libraries the file names.
    pub(super) libraries: Vec<String>,
    /// Triangles that each face of more than three corners was cut into.
    pub(super) polygons: Vec<Range<u32>>,
    pub(super) skipped: Skipped,
    pub(super) folder: Option<Folder>,
}
