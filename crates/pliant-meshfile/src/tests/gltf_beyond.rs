//! Views that reach beyond their buffer, unused: what saving adds must not show in them.

use super::support::{assert_near, bent, document, glb, saved, seam, seam_glb};
use crate::{Format, MeshFile, from_bytes, open};
use serde_json::{Value, json};

/// The seam with two views that reach beyond its buffer and accessors of them, which nothing uses.
fn reaching() -> (Value, Vec<u8>) {
    let (mut document, binary) = seam();
    let end = binary.len();
    let views = document["bufferViews"].as_array_mut().expect("views");
    views.push(json!({"buffer": 0, "byteOffset": end - 4, "byteLength": 24}));
    views.push(json!({"buffer": 0, "byteOffset": 10_000_000_000u64, "byteLength": 12}));
    let accessors = document["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}));
    accessors.push(json!({"bufferView": 3, "componentType": 5126, "count": 1, "type": "VEC3"}));
    (document, binary)
}

/// A document with its buffers in files beside it, opened.
fn opened(mut document: Value, buffers: &[&[u8]]) -> MeshFile {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut listed = Vec::new();
    for (i, bytes) in buffers.iter().enumerate() {
        let uri = format!("{i}.bin");
        std::fs::write(folder.path().join(&uri), bytes).expect("written");
        listed.push(json!({"byteLength": bytes.len(), "uri": uri}));
    }
    document["buffers"] = listed.into();
    let path = folder.path().join("beyond.gltf");
    std::fs::write(&path, document.to_string()).expect("written");
    open(&path).unwrap_or_else(|error| panic!("{error}"))
}

/// Views whose end lies beyond what their buffer says it has.
fn beyond(document: &Value) -> Vec<usize> {
    let number = |object: &Value, key: &str| object[key].as_u64().unwrap_or(0);
    let is_beyond = |view: &Value| {
        let buffer = &document["buffers"][number(view, "buffer") as usize];
        number(view, "byteOffset") + number(view, "byteLength") > number(buffer, "byteLength")
    };
    let views = document["bufferViews"].as_array().expect("views");
    (0..views.len()).filter(|&i| is_beyond(&views[i])).collect()
}

fn stays_beyond(file: &MeshFile, n_before: usize) {
    let points = bent(&file.points());
    let r = vec![3; points.len()];
    let (out, again) = saved(file, "bent.glb", &points, Some(&r));
    let new = document(&out);
    assert_eq!(beyond(&new), [n_before - 2, n_before - 1], "{}", new["buffers"]);
    assert_near(&again.points(), &points, 10.0 * f64::from(f32::EPSILON));
    assert_eq!((&again.triangles, &again.rigidity), (&file.triangles, &Some(vec![3; file.positions.len()])));
    // And what was saved can be bent and saved again.
    let further = bent(&again.points());
    let (out, last) = saved(&again, "further.glb", &further, None);
    assert_eq!(beyond(&document(&out)), [n_before - 2, n_before - 1]);
    assert_near(&last.points(), &further, 10.0 * f64::from(f32::EPSILON));
}

#[test]
fn views_beyond_the_chunk_of_a_glb_file_stay_beyond_it() {
    let (document, binary) = reaching();
    let bytes = glb(&document, &binary);
    let file = from_bytes(&bytes, Format::Glb, "beyond").unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(saved(&file, "same.glb", &file.points(), None).0, bytes);
    stays_beyond(&file, 4);
}

#[test]
fn views_beyond_a_buffer_of_a_text_file_stay_beyond_it_in_a_glb_file() {
    let (document, binary) = reaching();
    stays_beyond(&opened(document.clone(), &[&binary]), 4);
    // Another buffer, behind it or before it, does not come under those views either.
    let other = [7; 64];
    stays_beyond(&opened(document.clone(), &[&binary, &other]), 4);
    let mut second = document;
    for view in second["bufferViews"].as_array_mut().expect("views") {
        view["buffer"] = 1.into();
    }
    stays_beyond(&opened(second, &[&other, &binary]), 4);
}

#[test]
fn a_buffer_that_no_view_reaches_beyond_takes_what_is_added() {
    let file = from_bytes(&seam_glb(), Format::Glb, "seam").expect("a sound file");
    let (out, _) = saved(&file, "bent.glb", &bent(&file.points()), None);
    assert_eq!(document(&out)["buffers"].as_array().map(Vec::len), Some(1));
}
