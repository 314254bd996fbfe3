//! A new glTF file of a mesh that came from elsewhere.
//!
//! One mesh, one list of vertices for all its primitives: the mesh's own vertices first and in their order, so that
//! numbers given for them still hold, then the copies that corners with other attributes need.

use super::builder::Builder;
use super::container;
use super::relocate::data_uri;
use crate::Format;
use crate::formats::Output;
use crate::formats::split::Split;
use crate::shape::{Corner, Material, Shape};
use crate::{SaveError, normals};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::path::Path;

/// Writes a document that depends on the shape alone.
pub(crate) fn write(shape: &Shape, to: &Path) -> Result<Output, SaveError> {
    let vertices = Split::of(shape);
    let mut builder = Builder::default();
    let attributes = attributes(shape, &vertices, &mut builder, to)?;
    let mut primitives = Vec::new();
    for part in &shape.parts {
        let indices: Vec<u32> = vertices.triangles[part.triangles.clone()].iter().flatten().copied().collect();
        if indices.is_empty() {
            continue;
        }
        let indices = builder.indices(&indices);
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        if let Some(material) = part.material {
            primitive["material"] = material.into();
        }
        primitives.push(primitive);
    }
    let name = shape.parts.first().map_or("mesh", |part| part.name.as_str());
    let mut document = json!({
        "asset": {"version": "2.0", "generator": "Pliant"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": name}],
        "meshes": [{"name": name, "primitives": primitives}],
    });
    if !shape.materials.is_empty() {
        document["materials"] = shape.materials.iter().map(material).collect();
    }
    let glb = Format::of(to) == Some(Format::Glb);
    let mut buffer = json!({"byteLength": builder.data.len()});
    if !glb {
        buffer["uri"] = data_uri("application/octet-stream", &builder.data).into();
    }
    document["accessors"] = builder.accessors.into();
    document["bufferViews"] = builder.views.into();
    document["buffers"] = json!([buffer]);
    let json = serde_json::to_vec(&document)
        .map_err(|error| SaveError::Encode { path: to.to_owned(), reason: error.to_string() })?;
    let bytes = if glb { container::glb(json, Some(&builder.data), &[], to)? } else { container::text(json, to)? };
    Ok(Output { bytes, beside: Vec::new(), warnings: Vec::new(), origin: None })
}

fn material(material: &Material) -> Value {
    let mut value = json!({
        "name": material.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": material.base_color.map(|x| f64::from(x.clamp(0.0, 1.0))),
            "metallicFactor": 0.0,
        },
    });
    if material.base_color[3] < 1.0 {
        value["alphaMode"] = "BLEND".into();
    }
    value
}

fn attributes(shape: &Shape, vertices: &Split, builder: &mut Builder, to: &Path) -> Result<Value, SaveError> {
    let mut positions = Vec::with_capacity(vertices.corners.len());
    for corner in &vertices.corners {
        let position = shape.positions[corner.vertex as usize].as_vec3();
        if !position.is_finite() {
            return Err(SaveError::NotFinite { path: to.to_owned(), vertex: corner.vertex as usize });
        }
        positions.push(position);
    }
    let flat: Vec<f32> = positions.iter().flat_map(|p| p.to_array()).collect();
    let mut attributes = json!({"POSITION": builder.floats(&flat, 3, true)});
    if !shape.normals.is_empty() {
        let triangles: Vec<[u32; 3]> = shape.triangles.iter().map(|t| t.map(|c| c.vertex)).collect();
        let smooth = normals::smooth(&shape.positions, &triangles);
        let normal =
            |c: &Corner| -> Vec3 { shape.normals.get(c.normal as usize).copied().unwrap_or(smooth[c.vertex as usize]) };
        let flat: Vec<f32> = vertices.corners.iter().flat_map(|c| normal(c).to_array()).collect();
        attributes["NORMAL"] = builder.floats(&flat, 3, false).into();
    }
    if !shape.uvs.is_empty() {
        let uv = |c: &Corner| shape.uvs.get(c.uv as usize).copied().unwrap_or(Vec2::ZERO);
        let flat: Vec<f32> = vertices.corners.iter().map(uv).flat_map(|uv| [uv.x, 1.0 - uv.y]).collect();
        attributes["TEXCOORD_0"] = builder.floats(&flat, 2, false).into();
    }
    if let Some(colors) = &shape.colors {
        let flat: Vec<f32> = vertices.corners.iter().flat_map(|c| colors[c.vertex as usize]).collect();
        attributes["COLOR_0"] = builder.floats(&flat, 4, false).into();
    }
    if let Some(rigidity) = &shape.rigidity {
        let r: Vec<u16> = vertices.corners.iter().map(|c| rigidity[c.vertex as usize]).collect();
        attributes["_RIGIDITY"] = builder.rigidity(&r).into();
    }
    Ok(attributes)
}
