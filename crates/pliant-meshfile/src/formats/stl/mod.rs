//! STL: triangles without sharing, as text or bytes.
//!
//! File vertices are the corners in order, three a triangle; welding makes a surface of them. Text keeps every word but
//! the numbers that changed; of a binary file the 80 bytes of header, the two bytes behind each triangle (which some
//! programs fill with colors) and whatever follows the triangles stay.

mod ascii;
mod binary;
mod export;

pub(super) use export::write;

use super::source::{Edit, Input, Opened, Output, Source};
use crate::shape::{Corner, NO_MATERIAL, NONE, Part, Shape, ShapePart};
use crate::{Fault, Format, SaveError, Warning, budget, normals};
use glam::{DVec3, Vec3};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// An STL file as it came.
#[derive(Debug)]
struct StlSource {
    bytes: Vec<u8>,
    is_text: bool,
    /// Whether bytes behind the triangles are used, and not for colors.
    has_unread: bool,
}

/// What is read of a file.
#[derive(Default)]
struct Parsed {
    /// Three corners for each triangle.
    positions: Vec<DVec3>,
    solids: Vec<(String, Range<usize>)>,
    has_attributes: bool,
    /// Of each corner.
    colors: Option<Vec<[f32; 4]>>,
    base_color: [f32; 4],
    warnings: Vec<Warning>,
}

/// Reads an STL file.
pub(super) fn read(input: Input<'_>) -> Result<Opened, Fault> {
    let is_text = is_text(&input.bytes)?;
    let parse = if is_text { ascii::parse } else { binary::parse };
    let parsed = parse(&input.bytes, input.name, input.stage)?;
    let n = parsed.positions.len() as u32 / 3;
    let base_color = if is_text { NO_MATERIAL } else { parsed.base_color };
    let part = |(name, triangles)| Part { name, triangles, base_color };
    let has_unread = parsed.has_attributes && parsed.colors.is_none();
    Ok(Opened {
        positions: parsed.positions,
        triangles: (0..n).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect(),
        rigidity: None,
        uvs: None,
        colors: parsed.colors,
        parts: parsed.solids.into_iter().map(part).collect(),
        warnings: parsed.warnings,
        source: Arc::new(StlSource { bytes: input.bytes, is_text, has_unread }),
    })
}

/// Tells text from bytes. The first word alone does not: headers of binary files may begin with `solid` too, but their
/// size follows from their count of triangles, and no text of any size has a length that its own letters count.
fn is_text(bytes: &[u8]) -> Result<bool, Fault> {
    if binary::size(bytes) == Some(bytes.len() as u64) {
        return Ok(false);
    }
    let start = ascii::start(bytes);
    let says_solid = bytes.get(start..start + 5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    // A text has no zeros; the header of a binary file is filled up with them, or its count has some.
    if says_solid && !bytes.iter().take(binary::HEADER).any(|&byte| byte == 0) {
        return Ok(true);
    }
    match binary::size(bytes) {
        Some(size) if size <= bytes.len() as u64 => Ok(false),
        Some(size) => Err(Fault::Container(format!(
            "is no STL file that is whole: it does not begin with solid as text does, and as a binary file it would have \
             {size} bytes by its count of triangles, where {} are",
            bytes.len()
        ))),
        None => Err(Fault::Container(format!(
            "is not an STL file: it does not begin with solid as text does, and {} bytes are too few for a binary one",
            bytes.len()
        ))),
    }
}

/// The new normal of a triangle: the file's own, turned as the triangle turned; `None` where there is nothing to turn.
fn turned_normal(edit: &Edit<'_>, triangle: usize, old: Vec3) -> Option<Vec3> {
    let corners = 3 * triangle..3 * triangle + 3;
    // Zeros ask readers to find the normal themselves.
    if !old.is_finite() || old == Vec3::ZERO || !corners.clone().any(|corner| edit.moved(corner)) {
        return None;
    }
    let [before, after] = [edit.mesh.positions, &edit.positions].map(|positions| &positions[corners.clone()]);
    let turn = normals::turns(&[[0, 1, 2]], 1, |_, _| Some(0), before, after)[0]?;
    Some(normals::turned(old, turn))
}

impl Source for StlSource {
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>> {
        (format == Format::Stl).then(|| {
            let bytes =
                if self.is_text { ascii::rewrite(&self.bytes, edit) } else { binary::rewrite(&self.bytes, edit, to)? };
            Ok(Output { bytes, beside: Vec::new(), warnings: Vec::new(), origin: None })
        })
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        let corner = |vertex| Corner { vertex, uv: NONE, normal: NONE };
        let part =
            |part: &Part| ShapePart { name: part.name.clone(), triangles: part.triangles.clone(), material: None };
        let left_behind = self.has_unread.then_some("the bytes behind triangles").into_iter().collect();
        Shape {
            positions: edit.positions.clone(),
            colors: edit.mesh.colors.clone(),
            triangles: edit.mesh.triangles.iter().map(|t| t.map(corner)).collect(),
            parts: edit.mesh.parts.iter().map(part).collect(),
            rigidity: edit.rigidity.clone().or_else(|| edit.mesh.rigidity.clone()),
            left_behind,
            ..Shape::default()
        }
    }
}

/// Refuses more triangles than as many corners as three times the vertices of other formats: six corners make a surface
/// point, so that the solver has less to do, while welding them takes more memory.
fn check_count(n: u64) -> Result<(), Fault> {
    budget::check("triangles of an STL file", n, budget::VERTICES)
}
