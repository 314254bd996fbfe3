//! A sound glTF document that uses most of what the format has, small enough to look through.

use serde_json::{Value, json};

/// File vertices of [`sound_document`].
pub(super) const N_VERTICES: usize = 6;

/// Collects the binary part.
#[derive(Default)]
struct Bytes {
    data: Vec<u8>,
    views: Vec<Value>,
}

impl Bytes {
    fn view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        self.data.resize(self.data.len().next_multiple_of(4), 0);
        let start = self.data.len();
        self.data.extend(bytes);
        self.views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": self.data.len() - start}));
        self.views.len() - 1
    }

    fn floats(&mut self, numbers: &[f32]) -> usize {
        self.view(numbers.iter().flat_map(|x| x.to_le_bytes()))
    }
}

fn accessor(view: usize, component: u32, count: usize, kind: &str) -> Value {
    json!({"bufferView": view, "componentType": component, "count": count, "type": kind})
}

/// Two squares of one row of vertices, with a morph target, a skin of two joints and an animation of each kind; and its
/// buffer.
///
/// Accessors: 0 positions, 1 normals, 2 tangents, 3 texture coordinates, 4 colors, 5 indices, 6 displacements (sparse,
/// without a view), 7 joints, 8 weights, 9 inverse bind matrices, 10 times, 11 translations, 12 rotations, 13 weights of
/// the target, 14 r.
pub fn sound_document() -> (Value, Vec<u8>) {
    let mut bytes = Bytes::default();
    let positions = bytes.floats(&[0., 0., 0., 1., 0., 0., 2., 0., 0.5, 0., 1., 0., 1., 1., 0., 2., 1., 0.5]);
    let normals = bytes.floats(&[0., 0., 1.].repeat(6));
    let tangents = bytes.floats(&[1., 0., 0., 1.].repeat(6));
    let uvs = bytes.floats(&[0., 0., 0.5, 0., 1., 0., 0., 1., 0.5, 1., 1., 1.]);
    let colors = bytes.view([255u8, 128, 0, 255].repeat(6));
    let indices = bytes.view([0u16, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4].iter().flat_map(|i| i.to_le_bytes()));
    let moved = bytes.view([2u8, 5]);
    let moves = bytes.floats(&[0., 0., 1., 0., 0., 1.]);
    let joints = bytes.view([0u8, 1, 0, 0].repeat(6));
    let weights = bytes.floats(&[0.75, 0.25, 0., 0.].repeat(6));
    let identity: Vec<f32> = (0..16).map(|i| if i % 5 == 0 { 1.0 } else { 0.0 }).collect();
    let matrices = bytes.floats(&identity.repeat(2));
    let times = bytes.floats(&[0., 0.5, 1.]);
    let translations = bytes.floats(&[0., 0., 0., 0., 1., 0., 0., 0., 1.]);
    let half = 0.5f32.sqrt();
    let rotations = bytes.floats(&[0., 0., 0., 1., 0., 0., half, half, 0., 0., 1., 0.]);
    let target_weights = bytes.floats(&[0., 1., 0.5]);
    let rigidity = bytes.view([1u16, 2, 3, 4, 5, 6].iter().flat_map(|r| r.to_le_bytes()));
    let mut moving = json!({"componentType": 5126, "count": 6, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 1]});
    moving["sparse"] = json!({
        "count": 2,
        "indices": {"bufferView": moved, "componentType": 5121},
        "values": {"bufferView": moves},
    });
    let mut place = accessor(positions, 5126, 6, "VEC3");
    (place["min"], place["max"]) = (json!([0.0, 0.0, 0.0]), json!([2.0, 1.0, 0.5]));
    let mut color = accessor(colors, 5121, 6, "VEC4");
    color["normalized"] = true.into();
    let document = json!({
        "asset": {"version": "2.0", "generator": "by hand"},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"name": "Hip", "children": [1], "translation": [0.0, 0.0, 0.5], "rotation": [0, 0, 0, 1], "scale": [1, 1, 1]},
            {"name": "Knee", "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1]},
            {"name": "Leg", "mesh": 0, "skin": 0},
        ],
        "meshes": [{"name": "Leg", "weights": [0.0], "primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3, "COLOR_0": 4,
                "JOINTS_0": 7, "WEIGHTS_0": 8, "_RIGIDITY": 14},
            "indices": 5, "material": 0, "mode": 4,
            "targets": [{"POSITION": 6}],
        }]}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 9, "skeleton": 0}],
        "animations": [{"name": "Kick", "channels": [
            {"sampler": 0, "target": {"node": 0, "path": "translation"}},
            {"sampler": 1, "target": {"node": 0, "path": "rotation"}},
            {"sampler": 2, "target": {"node": 2, "path": "weights"}},
        ], "samplers": [
            {"input": 10, "output": 11, "interpolation": "LINEAR"},
            {"input": 10, "output": 12},
            {"input": 10, "output": 13, "interpolation": "STEP"},
        ]}],
        "materials": [{"name": "Skin", "pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.5, 0.25, 1.0]}}],
        "accessors": [
            place,
            accessor(normals, 5126, 6, "VEC3"),
            accessor(tangents, 5126, 6, "VEC4"),
            accessor(uvs, 5126, 6, "VEC2"),
            color,
            accessor(indices, 5123, 12, "SCALAR"),
            moving,
            accessor(joints, 5121, 6, "VEC4"),
            accessor(weights, 5126, 6, "VEC4"),
            accessor(matrices, 5126, 2, "MAT4"),
            {"bufferView": times, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0.0], "max": [1.0]},
            accessor(translations, 5126, 3, "VEC3"),
            accessor(rotations, 5126, 3, "VEC4"),
            accessor(target_weights, 5126, 3, "SCALAR"),
            accessor(rigidity, 5123, 6, "SCALAR"),
        ],
        "bufferViews": bytes.views,
        "buffers": [{"byteLength": bytes.data.len()}],
    });
    (document, bytes.data)
}

/// A GLB file of JSON text and a binary chunk.
pub fn glb_of(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let padded = |n: usize| n.next_multiple_of(4);
    let total = 28 + padded(json.len()) + padded(binary.len());
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend((total as u32).to_le_bytes());
    for (kind, content, padding) in [(b"JSON", json, b' '), (b"BIN\0", binary, 0)] {
        file.extend((padded(content.len()) as u32).to_le_bytes());
        file.extend(kind);
        file.extend(content);
        file.resize(padded(file.len()), padding);
    }
    file
}

/// JSON text of a document whose first buffer lies in a data URI, unless it has a URI.
pub fn gltf_of(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut document = document.clone();
    let buffer = document.pointer_mut("/buffers/0").and_then(Value::as_object_mut);
    if let Some(buffer) = buffer.filter(|buffer| !buffer.contains_key("uri")) {
        buffer.insert("uri".into(), format!("data:application/octet-stream;base64,{}", base64(binary)).into());
    }
    document.to_string().into_bytes()
}

pub(super) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in bytes.chunks(3) {
        let bits = (0..3).fold(0u32, |bits, i| bits << 8 | u32::from(*group.get(i).unwrap_or(&0)));
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i)) as usize % 64];
            text.push(if i <= group.len() { char::from(digit) } else { '=' });
        }
    }
    text
}
