//! A new PLY file of a mesh that came from elsewhere: binary, little-endian.

use super::roles::RIGIDITY;
use super::scalar::Scalar;
use crate::SaveError;
use crate::formats::Output;
use crate::formats::outlines::Outlines;
use crate::formats::split::Split;
use crate::shape::{Shape, is_far};
use glam::{Vec2, Vec3};
use std::fmt::Write;
use std::path::Path;

/// Writes bytes that depend on the shape alone. Positions are in single precision unless the mesh lies so far from the
/// origin that its details would drown.
pub(crate) fn write(shape: &Shape, to: &Path) -> Result<Output, SaveError> {
    let split = Split::of(shape);
    let scalar = if is_far(&shape.positions) { Scalar::F64 } else { Scalar::F32 };
    if let Some(vertex) = shape.positions.iter().position(|p| !p.to_array().iter().all(|&x| scalar.holds(x))) {
        return Err(SaveError::NotFinite { path: to.to_owned(), vertex });
    }
    let polygons = Outlines::of(&split.triangles, &shape.polygons);
    let longest = polygons.all().map(<[u32]>::len).max().unwrap_or(0);
    let count = if longest <= 255 { Scalar::U8 } else { Scalar::U32 };
    let n_faces = polygons.all().count();
    let mut bytes = header(shape, &split, scalar, n_faces, count).into_bytes();
    for corner in &split.corners {
        let vertex = corner.vertex as usize;
        for x in shape.positions[vertex].to_array() {
            scalar.write(x, false, &mut bytes);
        }
        let mut put = |numbers: &[f32]| numbers.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        if !shape.normals.is_empty() {
            put(&shape.normals.get(corner.normal as usize).copied().unwrap_or(Vec3::Z).to_array());
        }
        if !shape.uvs.is_empty() {
            put(&shape.uvs.get(corner.uv as usize).copied().unwrap_or(Vec2::ZERO).to_array());
        }
        if let Some(colors) = &shape.colors {
            bytes.extend(colors[vertex].map(byte));
        }
        if let Some(rigidity) = &shape.rigidity {
            bytes.extend(rigidity[vertex].to_le_bytes());
        }
    }
    for face in polygons.all() {
        count.write(face.len() as f64, false, &mut bytes);
        face.iter().for_each(|vertex| bytes.extend((*vertex as i32).to_le_bytes()));
    }
    Ok(Output { bytes, beside: Vec::new(), warnings: Vec::new(), origin: split.origin(shape) })
}

/// A color channel from 0 to 255.
fn byte(channel: f32) -> u8 {
    (channel.clamp(0.0, 1.0) * 255.0).round() as u8
}

fn header(shape: &Shape, split: &Split, scalar: Scalar, n_faces: usize, count: Scalar) -> String {
    let mut text = "ply\nformat binary_little_endian 1.0\ncomment written by Pliant\n".to_owned();
    let mut properties: Vec<(&str, &str)> = ["x", "y", "z"].map(|name| (scalar.name(), name)).to_vec();
    if !shape.normals.is_empty() {
        properties.extend(["nx", "ny", "nz"].map(|name| ("float", name)));
    }
    if !shape.uvs.is_empty() {
        properties.extend(["s", "t"].map(|name| ("float", name)));
    }
    if shape.colors.is_some() {
        properties.extend(["red", "green", "blue", "alpha"].map(|name| ("uchar", name)));
    }
    if shape.rigidity.is_some() {
        properties.push(("ushort", RIGIDITY));
    }
    let mut line = |arguments: std::fmt::Arguments<'_>| writeln!(text, "{arguments}").expect("strings can be written");
    line(format_args!("element vertex {}", split.corners.len()));
    for (scalar, name) in properties {
        line(format_args!("property {scalar} {name}"));
    }
    line(format_args!("element face {n_faces}\nproperty list {} int vertex_indices\nend_header", count.name()));
    text
}
