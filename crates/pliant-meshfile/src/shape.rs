//! A mesh without its file: what one format hands to another when a model is saved as something else.

use glam::{DVec3, Vec2, Vec3};
use std::ops::Range;

/// A named piece of a file: a group of OBJ, a primitive of glTF, a solid of STL.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// As in the file, or made up from its place there.
    pub name: String,
    /// Its range of [`crate::MeshFile::triangles`].
    pub triangles: Range<usize>,
    /// Base color of its material: red, green, blue, alpha; light gray without one.
    pub base_color: [f32; 4],
}

/// Base color of what has no material.
pub(crate) const NO_MATERIAL: [f32; 4] = [0.8, 0.8, 0.8, 1.0];

/// Marks a corner without texture coordinate or normal.
pub(crate) const NONE: u32 = u32::MAX;

/// One corner of a triangle: indices into the lists of a [`Shape`], or [`NONE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Corner {
    pub(crate) vertex: u32,
    pub(crate) uv: u32,
    pub(crate) normal: u32,
}

/// A named surface material, as far as formats share it.
#[derive(Clone, Debug)]
pub(crate) struct Material {
    pub(crate) name: String,
    pub(crate) base_color: [f32; 4],
}

/// A named range of triangles with one material.
#[derive(Clone, Debug)]
pub(crate) struct ShapePart {
    pub(crate) name: String,
    pub(crate) triangles: Range<usize>,
    pub(crate) material: Option<usize>,
}

/// Geometry in world space with per-corner attributes; texture coordinates have their origin at the lower left.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) uvs: Vec<Vec2>,
    pub(crate) normals: Vec<Vec3>,
    pub(crate) colors: Option<Vec<[f32; 4]>>,
    pub(crate) triangles: Vec<[Corner; 3]>,
    /// Triangles that each polygon of more than three corners was cut into, ascending.
    pub(crate) polygons: Vec<Range<u32>>,
    pub(crate) parts: Vec<ShapePart>,
    pub(crate) materials: Vec<Material>,
    /// One r per position.
    pub(crate) rigidity: Option<Vec<u16>>,
    /// What the source holds that a shape does not, in words that end a sentence: "textures", "skins".
    pub(crate) left_behind: Vec<&'static str>,
}

/// Whether single precision, which counts from the origin, would round positions by more than a millionth of the
/// mesh's extent (finer than any scan), as with coordinates of a map.
pub(crate) fn is_far(positions: &[DVec3]) -> bool {
    let Some(&first) = positions.first() else { return false };
    let (low, high) = positions.iter().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
    // Half the distance of neighbors in single precision is 2⁻²⁴ of a number.
    let rounding = low.abs().max(high.abs()).max_element() * 2f64.powi(-24);
    rounding > 1e-6 * (high - low).max_element()
}
