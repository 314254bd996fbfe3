//! A new binary STL file of a mesh that came from elsewhere.

use super::binary::{FREE, HEADER, TRIANGLE};
use crate::formats::Output;
use crate::shape::{Shape, is_far};
use crate::{SaveError, Warning};
use std::path::Path;

/// Must not begin with `solid`, which readers may take for text.
const TITLE: &[u8] = b"binary STL written by Pliant";

/// Writes bytes that depend on the shape alone.
pub(crate) fn write(shape: &Shape, to: &Path) -> Result<Output, SaveError> {
    if let Some(vertex) = shape.positions.iter().position(|p| !p.as_vec3().is_finite()) {
        return Err(SaveError::NotFinite { path: to.to_owned(), vertex });
    }
    let mut bytes = Vec::with_capacity(HEADER + TRIANGLE * shape.triangles.len());
    bytes.extend(TITLE);
    bytes.resize(FREE, 0);
    bytes.extend((shape.triangles.len() as u32).to_le_bytes());
    for triangle in &shape.triangles {
        let [a, b, c] = triangle.map(|corner| shape.positions[corner.vertex as usize]);
        // A triangle without area has no normal, which zeros say.
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for place in [normal, a, b, c] {
            place.as_vec3().to_array().iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    let mut warnings = Vec::new();
    if is_far(&shape.positions) {
        let text = "the mesh lies so far from the origin that the single precision of STL rounds its details";
        warnings.push(Warning(text.into()));
    }
    let origin = shape.triangles.iter().flatten().map(|corner| corner.vertex).collect();
    Ok(Output { bytes, beside: Vec::new(), warnings, origin: Some(origin) })
}
