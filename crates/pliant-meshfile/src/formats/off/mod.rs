//! OFF: text with vertices, and faces over them.
//!
//! What vertices have is declared by letters before the first word: normals (`N`), colors (`C`), texture coordinates
//! (`ST`), in this order behind the place. Colors are three or four numbers up to 1 or to 255. Faces may end in a color.
//! Of a saved file only places and normals change.

mod export;
mod header;
mod read;
mod rewrite;

pub(super) use export::write;

use super::source::{Edit, Input, Opened, Output, Source};
use super::turning;
use crate::shape::{Corner, NO_MATERIAL, NONE, Part, Shape, ShapePart};
use crate::{Fault, Format, SaveError, budget};
use glam::Vec3;
use header::Header;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// An OFF file as it came.
#[derive(Debug)]
struct OffSource {
    bytes: Vec<u8>,
    header: Header,
    normals: Vec<Vec3>,
    polygons: Vec<Range<u32>>,
    faces_more: bool,
    name: String,
}

/// Reads an OFF file.
pub(super) fn read(input: Input<'_>) -> Result<Opened, Fault> {
    let parsed = read::parse(&input.bytes, input.stage)?;
    let name = budget::short_name(input.name.to_owned());
    let part = Part { name: name.clone(), triangles: 0..parsed.cut.triangles.len(), base_color: NO_MATERIAL };
    Ok(Opened {
        positions: parsed.positions,
        triangles: parsed.cut.triangles,
        rigidity: None,
        uvs: (!parsed.uvs.is_empty()).then_some(parsed.uvs),
        colors: (!parsed.colors.is_empty()).then_some(parsed.colors),
        parts: vec![part],
        warnings: parsed.warnings,
        source: Arc::new(OffSource {
            bytes: input.bytes,
            header: parsed.header,
            normals: parsed.normals,
            polygons: parsed.cut.polygons,
            faces_more: parsed.faces_more,
            name,
        }),
    })
}

impl Source for OffSource {
    fn rewrite(&self, edit: &Edit<'_>, _: &Path, format: Format) -> Option<Result<Output, SaveError>> {
        (format == Format::Off).then(|| Ok(rewrite::rewrite(self, edit)))
    }

    fn polygons(&self) -> &[Range<u32>] {
        &self.polygons
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        let either = |has: bool, vertex: u32| if has { vertex } else { NONE };
        let has = self.header.has;
        let corner = |vertex| Corner { vertex, uv: either(has.uvs, vertex), normal: either(has.normals, vertex) };
        let triangles = edit.mesh.triangles;
        Shape {
            positions: edit.positions.clone(),
            uvs: edit.mesh.uvs.clone().unwrap_or_default(),
            normals: turning::turned_normals(edit, &self.normals),
            colors: edit.mesh.colors.clone(),
            triangles: triangles.iter().map(|t| t.map(corner)).collect(),
            polygons: self.polygons.clone(),
            parts: vec![ShapePart { name: self.name.clone(), triangles: 0..triangles.len(), material: None }],
            materials: Vec::new(),
            rigidity: edit.rigidity.clone().or_else(|| edit.mesh.rigidity.clone()),
            left_behind: self.faces_more.then_some("colors of faces").into_iter().collect(),
        }
    }
}
