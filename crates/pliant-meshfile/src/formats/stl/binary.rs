//! Binary STL: a header of 80 bytes, a count, 50 bytes a triangle.

use super::{Parsed, check_count, turned_normal};
use crate::formats::Edit;
use crate::shape::NO_MATERIAL;
use crate::watch::{PIECE, Stage};
use crate::{Fault, SaveError, Warning, budget};
use glam::{DVec3, Vec3};
use std::path::Path;

/// Bytes before the triangles: free ones, and the count.
pub(super) const HEADER: usize = 84;
/// Bytes of the header that are free.
pub(super) const FREE: usize = 80;
/// Bytes of a triangle: normal, three corners, two that mean nothing here.
pub(super) const TRIANGLE: usize = 50;

/// Bytes a binary file has by its own count, if it is long enough to have one.
pub(super) fn size(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(FREE..HEADER)?;
    let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]);
    Some(HEADER as u64 + TRIANGLE as u64 * u64::from(count))
}

/// Three numbers at a place.
fn triple(bytes: &[u8], at: usize) -> Vec3 {
    let number = |i: usize| {
        let at = at + 4 * i;
        f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
    };
    Vec3::new(number(0), number(1), number(2))
}

/// Reads bytes that [`size`] is not more than.
pub(super) fn parse(bytes: &[u8], name: &str, stage: Stage<'_>) -> Result<Parsed, Fault> {
    let end = size(bytes).unwrap_or(0).min(bytes.len() as u64) as usize;
    let n = end.saturating_sub(HEADER) / TRIANGLE;
    check_count(n as u64)?;
    let mut out = Parsed::default();
    out.positions.reserve_exact(3 * n);
    for (t, triangle) in bytes[HEADER.min(end)..end].chunks_exact(TRIANGLE).enumerate() {
        if t.is_multiple_of(PIECE) {
            stage.tell(t, n)?;
        }
        for k in 0..3 {
            let corner: DVec3 = triple(triangle, 12 + 12 * k).into();
            if !corner.is_finite() {
                let at = HEADER + TRIANGLE * t + 12 + 12 * k;
                let place = format!("byte {at}, triangle {t}, corner {k}");
                return Err(Fault::at(place, format!("its position {corner} is not finite")));
            }
            out.positions.push(corner);
        }
        out.has_attributes |= triangle[48..] != [0, 0];
    }
    if n > 0 {
        let object = object_color(bytes);
        out.base_color = object.unwrap_or(NO_MATERIAL);
        // Without any bit set nobody meant black.
        out.colors = if out.has_attributes { colors(&bytes[HEADER..end], object) } else { None };
    }
    out.solids.push((budget::short_name(name.to_owned()), 0..n));
    if end < bytes.len() {
        let surplus = bytes.len() - end;
        out.warnings.push(Warning(format!("{surplus} bytes after the last triangle are kept and not read")));
    }
    Ok(out)
}

/// What the word `COLOR=` in the header (of Materialise Magics) says of all triangles without a color of their own.
fn object_color(bytes: &[u8]) -> Option<[f32; 4]> {
    let header = &bytes[..FREE];
    let at = header.windows(6).position(|word| word == b"COLOR=")? + 6;
    let [red, green, blue] = *header.get(at..at + 4)?.first_chunk()?;
    Some([red, green, blue, 255].map(|channel| f32::from(channel) / 255.0))
}

/// The color that the two bytes behind a triangle give it: five bits a channel, and one that tells whether they do. Magics
/// means the opposite by it, and lists the channels the other way round, than VisCAM and SolidView.
fn triangle_color(bits: u16, magics: bool) -> Option<[f32; 4]> {
    let channel = |shift: u32| f32::from((bits >> shift) & 31) / 31.0;
    let [low, middle, high] = [channel(0), channel(5), channel(10)];
    match (bits & 0x8000 != 0, magics) {
        (true, false) => Some([high, middle, low, 1.0]),
        (false, true) => Some([low, middle, high, 1.0]),
        _ => None,
    }
}

/// A color for each corner, where a triangle has one of its own.
fn colors(triangles: &[u8], object: Option<[f32; 4]>) -> Option<Vec<[f32; 4]>> {
    let of = |triangle: &[u8]| triangle_color(u16::from_le_bytes([triangle[48], triangle[49]]), object.is_some());
    triangles.chunks_exact(TRIANGLE).any(|triangle| of(triangle).is_some()).then(|| {
        let rest = object.unwrap_or(NO_MATERIAL);
        triangles.chunks_exact(TRIANGLE).flat_map(|triangle| [of(triangle).unwrap_or(rest); 3]).collect()
    })
}

/// The file again; a number is touched only if it changed.
pub(super) fn rewrite(bytes: &[u8], edit: &Edit<'_>, to: &Path) -> Result<Vec<u8>, SaveError> {
    let mut out = bytes.to_vec();
    let put = |out: &mut Vec<u8>, at: usize, x: f32| out[at..at + 4].copy_from_slice(&x.to_le_bytes());
    for (vertex, (new, old)) in edit.positions.iter().zip(edit.mesh.positions).enumerate() {
        if new == old {
            continue;
        }
        if !new.as_vec3().is_finite() {
            return Err(SaveError::NotFinite { path: to.to_owned(), vertex });
        }
        let at = HEADER + TRIANGLE * (vertex / 3) + 12 + 12 * (vertex % 3);
        for axis in (0..3).filter(|&axis| new[axis] != old[axis]) {
            put(&mut out, at + 4 * axis, new[axis] as f32);
        }
    }
    for t in 0..edit.positions.len() / 3 {
        let at = HEADER + TRIANGLE * t;
        if let Some(normal) = turned_normal(edit, t, triple(bytes, at)) {
            (0..3).for_each(|axis| put(&mut out, at + 4 * axis, normal[axis]));
        }
    }
    Ok(out)
}
