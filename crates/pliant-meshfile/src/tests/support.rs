//! Small files and a checker that the tests share.

use crate::{Format, MeshFile, from_bytes, open};
use glam::DVec3;
use serde_json::{Value, json};
use std::path::Path;

/// A quad with texture coordinates, a hard edge and what else OBJ text may hold.
pub(super) const OBJ: &str = "# a comment \\\nmtllib none.mtl\no Thing\nv 0 0 0\nv 1.50 0 0 # keep\nv 1 1 0\nv 0 1 0\n\
v 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nvn 0 -1 0\nusemtl red\ns off\nf 1/1/1 2/2/1 3/3/1 -2/1/1\n\
g side\nf 1//2 2//2 5//2\nl 1 2\n";

pub(super) fn obj(text: &str) -> MeshFile {
    from_bytes(text.as_bytes(), Format::Obj, "test.obj").unwrap_or_else(|error| panic!("{error}"))
}

/// A GLB file of a document and its binary chunk.
pub(super) fn glb(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut json = document.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(((28 + json.len() + binary.len()) as u32).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(&json);
    bytes.extend((binary.len() as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(binary);
    bytes
}

/// The document of a GLB file.
pub(super) fn document(glb: &[u8]) -> Value {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    serde_json::from_slice(&glb[20..20 + length]).expect("JSON")
}

/// Two triangles over a seam (6 vertices, 4 places) with normals, in a scaled and mirrored node, plus what a reader
/// does not know.
pub(super) fn seam() -> (Value, Vec<u8>) {
    let positions: [[f32; 3]; 6] =
        [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.1], [0., 0., 0.], [1., 1., 0.1], [0., 1., 0.]];
    let mut binary: Vec<u8> = positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
    binary.extend((0..6).flat_map(|_| [0f32, 0., 1.]).flat_map(f32::to_le_bytes));
    binary.extend([0u16, 1, 2, 3, 4, 5].iter().flat_map(|i| i.to_le_bytes()));
    let document = json!({
        "asset": {"version": "2.0", "copyright": "nobody"},
        "extras": {"digits": 0.12345678901234568, "tiny": 1e-300, "order": {"z": 1, "a": 2}},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [
            {"mesh": 0, "translation": [10.0, 0.0, 0.0], "scale": [-2.0, 2.0, 4.0]},
            {"mesh": 0, "translation": [0.0, 5.0, 0.0]},
        ],
        "meshes": [{"name": "Seam", "primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0, "unknown": true}
        ]}],
        "materials": [{"name": "Red", "pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.25, 0.0, 1.0]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3",
             "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 0.1]},
            {"bufferView": 0, "byteOffset": 72, "componentType": 5126, "count": 6, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 144},
            {"buffer": 0, "byteOffset": 144, "byteLength": 12},
        ],
        "buffers": [{"byteLength": 156}],
    });
    (document, binary)
}

pub(super) fn seam_glb() -> Vec<u8> {
    let (document, binary) = seam();
    glb(&document, &binary)
}

/// Saves into a fresh folder and gives the bytes and the file opened again.
pub(super) fn saved(file: &MeshFile, name: &str, points: &[DVec3], r: Option<&[u16]>) -> (Vec<u8>, MeshFile) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    file.save(&path, points, r).unwrap_or_else(|error| panic!("{error}"));
    let bytes = std::fs::read(&path).expect("the saved file");
    only_expected_files(folder.path(), &path);
    (bytes, open(&path).unwrap_or_else(|error| panic!("{error}")))
}

fn only_expected_files(folder: &Path, path: &Path) {
    let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
    for entry in std::fs::read_dir(folder).expect("the folder") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        assert!(name.starts_with(&stem), "left behind: {name}");
    }
}

/// A bend that moves every point but the first.
pub(super) fn bent(points: &[DVec3]) -> Vec<DVec3> {
    points
        .iter()
        .enumerate()
        .map(|(i, p)| if i == 0 { *p } else { *p + DVec3::new(0.0, 0.25 * p.x, 0.5 * p.y) })
        .collect()
}

pub(super) fn assert_near(got: &[DVec3], expected: &[DVec3], tolerance: f64) {
    assert_eq!(got.len(), expected.len(), "number of positions");
    for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
        assert!(got.distance(*expected) <= tolerance, "position {i}: got {got}, expected {expected}");
    }
}
