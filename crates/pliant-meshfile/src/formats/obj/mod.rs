//! Wavefront OBJ: text, one statement a line, several index spaces.
//!
//! Read by a scanner of our own: keeping every byte for saving needs the place of each number in the text, and the
//! guard in front of the usual parser (continuation, marks, text that is not UTF-8, concave polygons) is larger than a
//! reader. That parser checks this reader in the tests, and runs beside it in the benchmark.

mod export;
mod materials;
mod parse;
mod rewrite;
mod source;
mod text;
mod textures;

pub(super) use export::{beside, write};

use super::source::{Before, Edit, Input, Opened, Output, Source};
use crate::shape::{Corner, NO_MATERIAL, NONE, Part, Shape, ShapePart};
use crate::textures::Textures;
use crate::{Fault, Format, SaveError};
use glam::{Vec2, Vec3};
use source::ObjSource;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Reads an OBJ file.
pub(super) fn read(input: Input<'_>) -> Result<Opened, Fault> {
    let mut parsed = parse::parse(&input.bytes, input.name, input.stage)?;
    let (materials, maps) = materials::load(&mut parsed, input.folder, input.unfinished);
    let color_of = |material: Option<usize>| material.map_or(NO_MATERIAL, |m| materials[m].base_color);
    let part = |part: &ShapePart| Part {
        name: part.name.clone(),
        triangles: part.triangles.clone(),
        base_color: color_of(part.material),
    };
    let parts = parsed.parts.iter().map(part).collect();
    let uvs = display_uvs(&parsed);
    let source = ObjSource {
        bytes: input.bytes,
        vertex_at: parsed.vertex_at,
        normal_at: parsed.normal_at,
        normals: parsed.normals,
        uvs: parsed.uvs,
        corners: parsed.corners,
        parts: parsed.parts,
        materials,
        maps,
        libraries: parsed.libraries,
        polygons: parsed.polygons,
        skipped: parsed.skipped,
        folder: input.folder.cloned(),
    };
    Ok(Opened {
        positions: parsed.positions,
        triangles: parsed.triangles,
        rigidity: None,
        uvs,
        colors: parsed.colors,
        parts,
        warnings: parsed.warnings,
        source: Arc::new(source),
    })
}

/// The first texture coordinate each vertex is used with.
fn display_uvs(parsed: &parse::Parsed) -> Option<Vec<Vec2>> {
    if parsed.uvs.is_empty() {
        return None;
    }
    let mut uvs: Vec<Option<Vec2>> = vec![None; parsed.positions.len()];
    for (triangle, corners) in parsed.triangles.iter().zip(&parsed.corners) {
        for (&vertex, &(uv, _)) in triangle.iter().zip(corners) {
            if uv != NONE {
                uvs[vertex as usize].get_or_insert(parsed.uvs[uv as usize]);
            }
        }
    }
    Some(uvs.into_iter().map(Option::unwrap_or_default).collect())
}

impl ObjSource {
    /// What a shape does not keep of this very file.
    fn left_behind(&self) -> Vec<&'static str> {
        let materials = (!self.libraries.is_empty()).then_some("textures and material settings beyond the base color");
        let lines = (self.skipped.lines > 0).then_some("lines and points");
        let curves = (self.skipped.curves > 0).then_some("curves and surfaces");
        materials.into_iter().chain(lines).chain(curves).collect()
    }
}

impl Source for ObjSource {
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>> {
        (format == Format::Obj).then(|| rewrite::rewrite(self, edit, to))
    }

    fn unpacked(&self, to: &Path) -> Vec<(String, Vec<u8>)> {
        let Some(pack) = self.folder.as_ref().filter(|folder| folder.path().is_none()) else { return Vec::new() };
        if Format::of(to) != Some(Format::Obj) {
            return Vec::new();
        }
        // The sidecar is in the pack too, and is written with the mesh.
        let named = |name: &String| {
            let is_whole = |line: &String| line == name;
            let is_word = |line: &String| line.split_whitespace().any(|word| word == name);
            self.libraries.iter().any(|line| is_whole(line) || is_word(line))
        };
        let files = pack.kept().into_iter().filter(|(name, _)| named(name));
        files.map(|(name, bytes)| (name, Arc::unwrap_or_clone(bytes))).collect()
    }

    fn polygons(&self) -> &[Range<u32>] {
        &self.polygons
    }

    fn textures(&self, _mesh: Before<'_>) -> Textures {
        textures::textures(self)
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        let corner = |vertex: u32, (uv, normal): (u32, u32)| Corner { vertex, uv, normal };
        let join = |(t, c): (&[u32; 3], &[(u32, u32); 3])| [corner(t[0], c[0]), corner(t[1], c[1]), corner(t[2], c[2])];
        let normals = rewrite::turned_normals(self, edit);
        let normals = normals.into_iter().map(|(normal, _)| normal.normalize_or(Vec3::Z)).collect();
        Shape {
            positions: edit.positions.clone(),
            uvs: self.uvs.clone(),
            normals,
            colors: edit.mesh.colors.clone(),
            triangles: edit.mesh.triangles.iter().zip(&self.corners).map(join).collect(),
            polygons: self.polygons.clone(),
            parts: self.parts.clone(),
            materials: self.materials.clone(),
            rigidity: edit.rigidity.clone().or_else(|| edit.mesh.rigidity.clone()),
            left_behind: self.left_behind(),
        }
    }
}
