//! PLY: a header that declares lists of numbers, and the lists, as text or bytes.
//!
//! Read by a scanner of our own: a file may declare whatever else it likes, and keeping that to the byte needs the place
//! of every number. Of a saved file only the numbers x, y, z, nx, ny, nz of vertices change. r is the vertex property
//! `rigidity`, which is appended when there is none.

mod body;
mod export;
mod header;
mod read;
mod rewrite;
mod roles;
mod scalar;
mod textures;

pub(super) use export::write;

use super::source::{Before, Edit, Input, Opened, Output, Source};
use super::turning;
use crate::folder::Folder;
use crate::shape::{Corner, NO_MATERIAL, NONE, Part, Shape, ShapePart};
use crate::{Fault, Format, SaveError, Textures};
use glam::Vec3;
use header::Header;
use roles::Roles;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A PLY file as it came.
#[derive(Debug)]
struct PlySource {
    bytes: Vec<u8>,
    header: Header,
    roles: Roles,
    vertex: usize,
    vertex_at: usize,
    normals: Vec<Vec3>,
    polygons: Vec<Range<u32>>,
    name: String,
    /// Where its pictures are.
    folder: Option<Folder>,
}

/// Reads a PLY file.
pub(super) fn read(input: Input<'_>) -> Result<Opened, Fault> {
    let parsed = read::parse(&input.bytes, input.stage)?;
    let mut warnings = parsed.warnings;
    warnings.extend(parsed.cut.warnings);
    let name = crate::budget::short_name(input.name.to_owned());
    let part = Part { name: name.clone(), triangles: 0..parsed.cut.triangles.len(), base_color: NO_MATERIAL };
    let vertices = parsed.vertices;
    Ok(Opened {
        positions: vertices.positions,
        triangles: parsed.cut.triangles,
        rigidity: parsed.rigidity,
        uvs: (!vertices.uvs.is_empty()).then_some(vertices.uvs),
        colors: (!vertices.colors.is_empty()).then_some(vertices.colors),
        parts: vec![part],
        warnings,
        source: Arc::new(PlySource {
            bytes: input.bytes,
            header: parsed.header,
            roles: parsed.roles,
            vertex: parsed.vertex,
            vertex_at: parsed.vertex_at,
            normals: vertices.normals,
            polygons: parsed.cut.polygons,
            name,
            folder: input.folder.cloned(),
        }),
    })
}

impl PlySource {
    /// What the file holds and a shape does not.
    fn left_behind(&self) -> Vec<&'static str> {
        let elements = &self.header.elements;
        let is_more = |(i, element): (usize, &header::Element)| {
            i != self.vertex && element.count > 0 && !matches!(element.name.as_str(), "face" | "tristrips")
        };
        let of_faces = |element: &header::Element| {
            let more = element.properties.len() > 1 && element.count > 0;
            more && matches!(element.name.as_str(), "face" | "tristrips")
        };
        let kinds = [
            ("further properties of vertices", self.roles.role.iter().any(Option::is_none)),
            ("further properties of faces", elements.iter().any(of_faces)),
            ("further elements", elements.iter().enumerate().any(is_more)),
        ];
        kinds.into_iter().filter(|&(_, held)| held).map(|(words, _)| words).collect()
    }
}

impl Source for PlySource {
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>> {
        (format == Format::Ply).then(|| rewrite::rewrite(self, edit, to))
    }

    fn polygons(&self) -> &[Range<u32>] {
        &self.polygons
    }

    fn textures(&self, mesh: Before<'_>) -> Textures {
        textures::textures(self, mesh)
    }

    fn references(&self) -> Vec<String> {
        self.header.pictures.clone()
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        let either = |list: usize, vertex: u32| if list == 0 { NONE } else { vertex };
        let uvs = edit.mesh.uvs.clone().unwrap_or_default();
        let (n_uvs, n_normals) = (uvs.len(), self.normals.len());
        let corner = |vertex| Corner { vertex, uv: either(n_uvs, vertex), normal: either(n_normals, vertex) };
        let triangles = edit.mesh.triangles;
        Shape {
            positions: edit.positions.clone(),
            uvs,
            normals: turning::turned_normals(edit, &self.normals),
            colors: edit.mesh.colors.clone(),
            triangles: triangles.iter().map(|t| t.map(corner)).collect(),
            polygons: self.polygons.clone(),
            parts: vec![ShapePart { name: self.name.clone(), triangles: 0..triangles.len(), material: None }],
            materials: Vec::new(),
            rigidity: edit.rigidity.clone().or_else(|| edit.mesh.rigidity.clone()),
            left_behind: self.left_behind(),
        }
    }
}
