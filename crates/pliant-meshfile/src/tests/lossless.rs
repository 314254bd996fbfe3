//! A document with a bit of everything keeps all of it but what was bent.

use super::support::{assert_near, bent, document, saved};
use crate::{Format, MeshFile, from_bytes};
use glam::DVec3;
use serde_json::Value;

const RICH: &str = include_str!("data/rich.gltf");
/// Kind of a GLB chunk that nobody knows.
const UNKNOWN_CHUNK: &[u8; 4] = b"ACME";

fn rich() -> MeshFile {
    from_bytes(RICH.as_bytes(), Format::Gltf, "rich.gltf").unwrap_or_else(|error| panic!("{error}"))
}

/// The same in one binary file, its text as it was, with a chunk that no reader knows.
fn rich_glb() -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("rich.glb");
    let file = rich();
    file.save(&path, &file.points(), None).expect("saved");
    let mut bytes = std::fs::read(&path).expect("the saved file");
    bytes.extend(8u32.to_le_bytes());
    bytes.extend(UNKNOWN_CHUNK);
    bytes.extend(b"whatever");
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes
}

/// JSON text and what follows it in a GLB file.
fn text_of(glb: &[u8]) -> (String, &[u8]) {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    (String::from_utf8(glb[20..20 + length].to_vec()).expect("text"), &glb[20 + length..])
}

/// Where two documents differ, with members that are in another order; lists that grew are named by their end.
fn differences(old: &Value, new: &Value, at: &str, found: &mut Vec<String>) {
    match (old, new) {
        (Value::Object(old), Value::Object(new)) => {
            for (key, value) in old {
                match new.get(key) {
                    Some(new) => differences(value, new, &format!("{at}/{key}"), found),
                    None => found.push(format!("{at}/{key} is gone")),
                }
            }
            found.extend(new.keys().filter(|key| !old.contains_key(*key)).map(|key| format!("{at}/{key} is new")));
            let kept = new.keys().filter(|key| old.contains_key(*key));
            if !kept.eq(old.keys().filter(|key| new.contains_key(*key))) {
                found.push(format!("{at}: another order"));
            }
        }
        (Value::Array(old), Value::Array(new)) => {
            for (i, (old, new)) in old.iter().zip(new).enumerate() {
                differences(old, new, &format!("{at}/{i}"), found);
            }
            if old.len() != new.len() {
                found.push(format!("{at}: {} more", new.len() as i64 - old.len() as i64));
            }
        }
        _ if old == new => {}
        _ => found.push(at.to_owned()),
    }
}

/// What may differ after bending and setting r: attributes of geometry, and what holds them.
fn allowed(difference: &str) -> bool {
    let attribute =
        ["POSITION", "NORMAL", "TANGENT"].iter().any(|name| difference.ends_with(&format!("/attributes/{name}")));
    let of_primitive = difference.starts_with("/meshes/") && difference.contains("/primitives/");
    let grown = ["/accessors: ", "/bufferViews: ", "/buffers: "].iter().any(|list| difference.starts_with(list));
    of_primitive && (attribute || difference.ends_with("/attributes/_RIGIDITY is new"))
        || grown
        || difference == "/buffers/0/byteLength"
}

#[test]
fn an_untouched_document_comes_back_to_the_byte() {
    let file = rich();
    let (same, _) = saved(&file, "same.gltf", &file.points(), None);
    assert!(same == RICH.as_bytes(), "the text changed");
    let bytes = rich_glb();
    let file = from_bytes(&bytes, Format::Glb, "rich.glb").unwrap_or_else(|error| panic!("{error}"));
    let (same, _) = saved(&file, "same.glb", &file.points(), None);
    assert!(same == bytes, "the binary file changed");
}

#[test]
fn a_bent_document_differs_in_its_geometry_only() {
    let glb = rich_glb();
    for (name, bytes) in [("bent.gltf", RICH.as_bytes()), ("bent.glb", &glb)] {
        let format = if name.ends_with("glb") { Format::Glb } else { Format::Gltf };
        let file = from_bytes(bytes, format, name).unwrap_or_else(|error| panic!("{error}"));
        let points = bent(&file.points());
        let (out, again) = saved(&file, name, &points, Some(&vec![5; points.len()]));
        // Coordinates up to 20 in single precision, through scales of one half.
        assert_near(&again.points(), &points, 20.0 * f64::from(f32::EPSILON));
        let parsed = |bytes: &[u8]| match format {
            Format::Glb => document(bytes),
            _ => serde_json::from_slice(bytes).expect("JSON"),
        };
        let (old, new) = (parsed(bytes), parsed(&out));
        let mut found = Vec::new();
        differences(&old, &new, "", &mut found);
        let wrong: Vec<&String> = found.iter().filter(|difference| !allowed(difference)).collect();
        assert!(wrong.is_empty(), "{name}: {wrong:?}");
        // Eight primitives have positions (one is a line), four of them normals, one tangents.
        let count = |ending: &str| found.iter().filter(|difference| difference.ends_with(ending)).count();
        assert_eq!(count("/attributes/POSITION"), 8, "{name}: {found:?}");
        assert_eq!(count("/attributes/NORMAL"), 4, "{name}: {found:?}");
        assert_eq!(count("/attributes/TANGENT"), 1, "{name}: {found:?}");
        assert_eq!(count("/attributes/_RIGIDITY is new"), 8, "{name}: {found:?}");
        if format == Format::Glb {
            let ((_, old), (_, new)) = (text_of(bytes), text_of(&out));
            let size = |chunks: &[u8]| u32::from_le_bytes([chunks[0], chunks[1], chunks[2], chunks[3]]) as usize;
            assert_eq!(new[8..size(old) + 8], old[8..size(old) + 8], "the old part of the binary chunk");
            assert_eq!(new[8 + size(new)..], old[8 + size(old)..], "the unknown chunk");
        } else {
            assert_eq!(new["buffers"][0], old["buffers"][0], "the old buffer");
        }
    }
}

#[test]
fn numbers_stay_as_they_are_spelled_and_lines_where_they_are() {
    let file = rich();
    let points = bent(&file.points());
    for name in ["bent.gltf", "bent.glb"] {
        let (out, _) = saved(&file, name, &points, Some(&vec![5; points.len()]));
        let text = if name.ends_with("glb") { text_of(&out).0 } else { String::from_utf8(out).expect("text") };
        for spelled in ["10.0", "1e5", "0.10", "123456789012345678901234567890", "4.0", "0.50", "0.80"] {
            let written = |text: &str| [": ", " "].iter().any(|before| text.contains(&format!("{before}{spelled}")));
            assert!(written(RICH) && written(&text), "{name}: {spelled}");
        }
        // Everything in front of the first thing that changes, with all its spaces.
        let untouched = &RICH[..RICH.find("\"NORMAL\"").expect("the first primitive")];
        assert!(text.starts_with(untouched), "{name}: another text");
    }
}

#[test]
fn new_accessors_say_what_is_in_them() {
    let file = rich();
    let points = bent(&file.points());
    let (out, _) = saved(&file, "bent.gltf", &points, None);
    let (old, new): (Value, Value) =
        (serde_json::from_str(RICH).expect("JSON"), serde_json::from_slice(&out).expect("JSON"));
    let list = |document: &Value, key: &str| document[key].as_array().expect(key).clone();
    let (n_accessors, n_views) = (list(&old, "accessors").len(), list(&old, "bufferViews").len());
    let added = &list(&new, "accessors")[n_accessors..];
    assert_eq!(added.len(), 6 + 3 + 1, "positions, normals and tangents: {added:?}");
    for accessor in added {
        assert_eq!((&accessor["componentType"], &accessor["count"]), (&5126.into(), &16.into()), "{accessor}");
        assert!(accessor.get("normalized").is_none() && accessor.get("sparse").is_none(), "{accessor}");
        let view = &new["bufferViews"][accessor["bufferView"].as_u64().expect("a view") as usize];
        assert!(accessor["bufferView"].as_u64() >= Some(n_views as u64), "in a view of its own: {accessor}");
        assert_eq!(view["target"], 34962, "{view}");
        assert_eq!(view["byteOffset"].as_u64().map(|offset| offset % 4), Some(0), "{view}");
    }
    assert_eq!(added.iter().filter(|accessor| accessor.get("min").is_some()).count(), 6, "bounds of positions");
}

#[test]
fn quantized_interleaved_sparse_and_strip_geometry_is_where_it_belongs() {
    let file = rich();
    let names: Vec<&str> = file.parts.iter().map(|part| part.name.as_str()).collect();
    let expected = ["quantized.0", "quantized.1", "skinned", "morphed", "flattened", "unused", "of the other scene"];
    assert_eq!(names, expected);
    // Root: (x, y, z) to (2x, y, z/2), turned by an angle of cosine 0.28 and sine 0.96, and 5 to the right.
    let place = |x: f64, y: f64, z: f64| {
        let (x, y) = (2.0 * x, y);
        DVec3::new(0.28 * x - 0.96 * y + 5.0, 0.96 * x + 0.28 * y, 0.5 * z)
    };
    // Mirrored below the root: x to -x; 32768 of 65535 high.
    let expected =
        [(0, place(0.0, 0.0, 0.0)), (3, place(-1.0, 0.0, 0.0)), (5, place(-1.0 / 3.0, 1.0 / 3.0, 32768.0 / 65535.0))];
    for (vertex, expected) in expected {
        assert_near(&[file.positions[vertex]], &[expected], 1e-12);
    }
    // In the strip the triangles alternate, and a mirrored node turns all of them around.
    assert_eq!(file.triangles[18..21], [[0, 1, 4], [4, 1, 5], [1, 2, 5]]);
    // Skinned meshes are opened in bind pose; the sparse hill is 0.75 high.
    assert_eq!(file.positions[16 + 3], DVec3::new(1.0, 0.0, 0.0));
    assert_eq!(file.positions[32 + 10], DVec3::new(0.5, 0.5, 0.75));
}

#[test]
fn what_is_shown_otherwise_than_in_a_viewer_is_said() {
    let said: Vec<String> = rich().warnings.iter().map(|warning| warning.0.clone()).collect();
    let expected = [
        "node 11 flattens its mesh, which is shown without its transform",
        "quantized stands at 2 places in the scene: shown at the first, all bend alike",
        "node 10 stands for many (EXT_mesh_gpu_instancing): its mesh is shown once, all bend alike",
        "2 meshes are outside the default scene and shown all the same",
    ];
    assert_eq!(said, expected);
}

#[test]
fn morph_targets_keep_their_displacements_from_the_bent_shape() {
    let file = rich();
    let lifted: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::new(0.0, 0.0, 0.25)).collect();
    let (_, again) = saved(&file, "lifted.glb", &lifted, None);
    let poses = |file: &MeshFile| {
        let mut motion = file.motion(2).expect("readable").expect("morph targets");
        (0..2).map(|pose| motion.pose(pose).expect("readable").expect("a pose")).collect::<Vec<_>>()
    };
    for (pose, (old, new)) in poses(&file).iter().zip(poses(&again)).enumerate() {
        let expected: Vec<DVec3> = old.iter().map(|p| *p + DVec3::new(0.0, 0.0, 0.25)).collect();
        assert_near(&new, &expected, 20.0 * f64::from(f32::EPSILON));
        assert_ne!(old[32..48], file.positions[32..48], "pose {pose} moves nothing");
    }
}
