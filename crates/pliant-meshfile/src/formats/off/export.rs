//! A new OFF file of a mesh that came from elsewhere.

use crate::SaveError;
use crate::formats::Output;
use crate::formats::outlines::Outlines;
use crate::formats::split::Split;
use crate::formats::words::{shortest, shortest_single};
use crate::shape::Shape;
use glam::{Vec2, Vec3};
use std::path::Path;

/// Writes text that depends on the shape alone.
pub(crate) fn write(shape: &Shape, _: &Path) -> Result<Output, SaveError> {
    let split = Split::of(shape);
    let faces = Outlines::of(&split.triangles, &shape.polygons);
    let flag = |has: bool, letters: &'static str| if has { letters } else { "" };
    let mut text = format!(
        "{}{}{}OFF\n{} {} 0\n",
        flag(!shape.uvs.is_empty(), "ST"),
        flag(shape.colors.is_some(), "C"),
        flag(!shape.normals.is_empty(), "N"),
        split.corners.len(),
        faces.all().count()
    );
    let in_bytes = shape.colors.as_ref().is_some_and(|colors| colors.iter().flatten().all(|&x| is_byte(x)));
    for corner in &split.corners {
        let vertex = corner.vertex as usize;
        let mut row: Vec<String> = shape.positions[vertex].to_array().map(shortest).to_vec();
        if !shape.normals.is_empty() {
            let normal = shape.normals.get(corner.normal as usize).copied().unwrap_or(Vec3::Z);
            row.extend(normal.to_array().map(shortest_single));
        }
        if let Some(colors) = &shape.colors {
            // A point tells numbers up to 1 from those up to 255.
            row.extend(
                colors[vertex].map(|x| if in_bytes { (x * 255.0).round().to_string() } else { format!("{x:?}") }),
            );
        }
        if !shape.uvs.is_empty() {
            let uv = shape.uvs.get(corner.uv as usize).copied().unwrap_or(Vec2::ZERO);
            row.extend(uv.to_array().map(shortest_single));
        }
        text.push_str(&row.join(" "));
        text.push('\n');
    }
    for face in faces.all() {
        text.push_str(&face.len().to_string());
        for vertex in face {
            text.push(' ');
            text.push_str(&vertex.to_string());
        }
        text.push('\n');
    }
    Ok(Output { bytes: text.into_bytes(), beside: Vec::new(), warnings: Vec::new(), origin: split.origin(shape) })
}

/// Whether a color channel is a whole number of 255 parts, as nearly as single precision tells.
fn is_byte(channel: f32) -> bool {
    let parts = channel * 255.0;
    (0.0..=255.0).contains(&parts) && (parts - parts.round()).abs() < 1e-4
}
