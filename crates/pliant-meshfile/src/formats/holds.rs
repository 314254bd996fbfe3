//! What files of a format can hold of a shape, and what is lost otherwise.

use crate::shape::{NONE, Shape};

/// Things a shape may have, each with whether a new file of a format can hold it.
#[derive(Clone, Copy)]
pub(crate) struct Holds {
    pub(super) sharing: bool,
    pub(super) polygons: bool,
    pub(super) uvs: bool,
    pub(super) normals: bool,
    pub(super) colors: bool,
    pub(super) alpha: bool,
    pub(super) materials: bool,
    pub(super) parts: bool,
}

impl Holds {
    pub(super) const ALL: Holds = Holds {
        sharing: true,
        polygons: true,
        uvs: true,
        normals: true,
        colors: true,
        alpha: true,
        materials: true,
        parts: true,
    };

    /// Nothing but the corners of triangles.
    pub(super) const TRIANGLES: Holds = Holds {
        sharing: false,
        polygons: false,
        uvs: false,
        normals: false,
        colors: false,
        alpha: false,
        materials: false,
        parts: false,
    };

    /// What of `shape` is lost, in words that end a sentence.
    pub(crate) fn lost(self, shape: &Shape) -> Vec<&'static str> {
        let is_clear = |colors: &Vec<[f32; 4]>| colors.iter().any(|color| color[3] != 1.0);
        let has_uv = || shape.triangles.iter().flatten().any(|corner| corner.uv != NONE);
        let has_normal = || shape.triangles.iter().flatten().any(|corner| corner.normal != NONE);
        let mut lost = Vec::new();
        let mut check = |held: bool, words: &'static str, has: &dyn Fn() -> bool| {
            if !held && has() {
                lost.push(words);
            }
        };
        check(self.polygons, "polygons of more than three corners", &|| !shape.polygons.is_empty());
        check(self.parts, "names and borders of parts", &|| shape.parts.len() > 1);
        check(self.materials, "materials", &|| shape.parts.iter().any(|part| part.material.is_some()));
        check(self.uvs, "texture coordinates", &has_uv);
        check(self.normals, "normals of vertices", &has_normal);
        check(self.colors, "colors of vertices", &|| shape.colors.is_some());
        check(self.alpha || !self.colors, "transparency of vertices", &|| shape.colors.as_ref().is_some_and(is_clear));
        check(self.sharing, "vertices of no triangle", &|| has_loose(shape));
        check(self.sharing, "the numbering of vertices, of which every triangle gets its own", &|| true);
        lost
    }
}

/// Whether a vertex belongs to no triangle.
fn has_loose(shape: &Shape) -> bool {
    let mut used = vec![false; shape.positions.len()];
    shape.triangles.iter().flatten().for_each(|corner| used[corner.vertex as usize] = true);
    used.contains(&false)
}
