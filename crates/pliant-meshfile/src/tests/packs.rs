//! Files packed with all they refer to.

use super::support::seam;
use crate::{MeshFile, OpenOptions, open};
use serde_json::json;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

fn keeping() -> OpenOptions {
    OpenOptions { keep: true, ..OpenOptions::default() }
}

/// Opens a file, packs it, removes the folder with all that was in it, and opens the pack.
fn through_a_pack(fill: impl FnOnce(&Path), name: &str) -> (MeshFile, MeshFile) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fill(folder.path());
    let file = keeping().open(&folder.path().join(name)).unwrap_or_else(|error| panic!("{error}"));
    let (pack, warnings) = file.pack().expect("kept");
    assert_eq!(warnings, []);
    drop(folder);
    let again = keeping().open_pack(&pack, &mut |_| ControlFlow::Continue(()));
    let again = again.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.pack().expect("kept").0, pack, "what was packed is packed again");
    (file, again)
}

#[test]
fn an_obj_file_keeps_its_materials_and_rigidity_in_a_pack_and_leaves_them_beside_what_is_saved_of_it() {
    let fill = |folder: &Path| {
        let text = "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        fs::write(folder.join("m.obj"), text).expect("a file");
        fs::write(folder.join("m.mtl"), "newmtl a\nKd 0.25 0 0\n").expect("a file");
        fs::write(folder.join("m.rigidity.json"), "[2,3,4]").expect("a file");
    };
    let (file, again) = through_a_pack(fill, "m.obj");
    assert_eq!(again.positions, file.positions);
    assert_eq!(again.rigidity, Some(vec![2, 3, 4]));
    assert_eq!(again.parts, file.parts);
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    let to = elsewhere.path().join("bent.obj");
    assert_eq!(again.save(&to, &again.points(), None).expect("saved"), []);
    assert_eq!(open(&to).expect("opens").parts[0].base_color, [0.25, 0.0, 0.0, 1.0]);
    // What lies there by the same name is another's.
    fs::write(elsewhere.path().join("m.mtl"), "newmtl a\nKd 1 1 1\n").expect("a file");
    let warnings = again.save(&to, &again.points(), None).expect("saved");
    assert!(warnings[0].0.contains("m.mtl"), "{warnings:?}");
    assert_eq!(open(&to).expect("opens").parts[0].base_color, [1.0; 4], "another's file was replaced");
}

#[test]
fn a_gltf_file_keeps_its_buffer_and_textures_in_a_pack_and_takes_them_into_what_is_saved_of_it() {
    let (mut document, binary) = seam();
    document["buffers"] = json!([{"byteLength": binary.len(), "uri": "m.bin"}]);
    document["images"] = json!([{"uri": "a%20picture.png"}]);
    let fill = |folder: &Path| {
        fs::write(folder.join("m.gltf"), document.to_string()).expect("a file");
        fs::write(folder.join("m.bin"), &binary).expect("a file");
        fs::write(folder.join("a picture.png"), b"pixels").expect("a file");
    };
    let (file, again) = through_a_pack(fill, "m.gltf");
    assert_eq!(again.positions, file.positions);
    let elsewhere = tempfile::tempdir().expect("a temporary folder");
    let to = elsewhere.path().join("bent.gltf");
    again.save(&to, &again.points(), None).expect("saved");
    let text = fs::read_to_string(&to).expect("text");
    let saved: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(saved["images"][0]["uri"], "data:image/png;base64,cGl4ZWxz");
    assert_eq!(open(&to).expect("opens alone").positions, file.positions);
}

#[test]
fn what_is_missing_is_said_when_packing_and_a_file_opened_without_keeping_has_no_pack() {
    let (mut document, binary) = seam();
    document["buffers"] = json!([{"byteLength": binary.len(), "uri": "m.bin"}]);
    document["images"] = json!([{"uri": "gone.png"}, {"uri": "data:image/png;base64,AAAA"}]);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("m.gltf");
    fs::write(&path, document.to_string()).expect("a file");
    fs::write(folder.path().join("m.bin"), &binary).expect("a file");
    let (pack, warnings) = keeping().open(&path).expect("opens").pack().expect("kept");
    assert_eq!(pack.beside.keys().collect::<Vec<_>>(), ["m.bin"]);
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].0.starts_with("gone.png is not packed: "), "{warnings:?}");
    assert!(open(&path).expect("opens").pack().is_none());
}
