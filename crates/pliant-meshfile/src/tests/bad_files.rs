//! Files that are refused, each with one line that says where and what.

use super::support::{glb, seam};
use crate::{Format, from_bytes, open};
use serde_json::{Value, json};

pub(super) fn refused(bytes: &[u8], format: Format, expected: &str) {
    let error = match from_bytes(bytes, format, "bad") {
        Ok(_) => panic!("opened, expected: {expected}"),
        Err(error) => error.to_string(),
    };
    assert!(error.starts_with("bad: "), "got {error}, expected the path first");
    assert!(error.contains(expected), "got {error}, expected {expected}");
    assert!(!error.contains('\n'), "more than one line: {error}");
}

#[test]
fn bad_obj_text_is_refused_by_line() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (text, expected) in [
        ("", "holds no faces"),
        ("v 0 0 0\n", "holds no faces"),
        ("f 1 2 4\n", "line 4: face names vertex 4, the file has 3"),
        ("f 1 2 0\n", "line 4, face corner 0: vertices are numbered from 1"),
        ("f 1 2 -4\n", "line 4, face corner -4: there are 3 vertices so far"),
        ("f 1 2 x\n", "line 4, face corner x: is not a vertex number"),
        ("f 1 2 3/1/1/1\n", "has more than three indices"),
        ("f 1 2 99999999999999999999\n", "is not a vertex number"),
        ("v 1 nan 2\nf 1 2 3\n", "line 4, vertex 3: coordinate nan is not finite"),
        ("v 1 1e999 2\n", "line 4, vertex 3: coordinate 1e999 is not finite"),
        ("v 1 2\n", "line 4, vertex 3: has 2 coordinates, 3 are needed"),
        ("v 1 2 z\n", "line 4, vertex 3: z is not a number"),
    ] {
        refused(format!("{vertices}{text}").as_bytes(), Format::Obj, expected);
    }
    let polygon: String = (0..65_537).map(|_| " 1").collect();
    refused(format!("{vertices}f{polygon}\n").as_bytes(), Format::Obj, "65537 corners of one polygon are more than");
}

#[test]
fn bad_documents_are_refused_by_place() {
    let cases: Vec<(&str, Value, &str)> = vec![
        ("/asset/version", json!("1.0"), "is glTF version 1.0"),
        ("/meshes", json!([]), "node 0: mesh names mesh 0, the file has 0"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(99), "POSITION names accessor 99, the file has 3"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(-1), "POSITION is not a whole number"),
        ("/meshes/0/primitives/0/indices", json!(0), "accessor 0: indices are not unsigned whole numbers"),
        ("/meshes/0/primitives/0/mode", json!(9), "mode 9 is not known"),
        ("/accessors/0/count", json!(4294967295u64), "elements in an accessor are more than the limit"),
        ("/accessors/0/count", json!(13), "accessor 0: reaches beyond bufferView 0 of 144 bytes"),
        ("/accessors/0/count", json!(3), "index 3 names vertex 3, the primitive has 3"),
        ("/accessors/0/type", json!("MAT4"), "its type is not SCALAR"),
        ("/accessors/0/type", json!("SCALAR"), "positions are not three numbers"),
        ("/accessors/0/componentType", json!(7), "component type 7 is not known"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "reaches beyond bufferView 0"),
        ("/accessors/0/bufferView", json!(5), "bufferView names view 5, the file has 2"),
        ("/bufferViews/0/byteLength", json!(u64::MAX), "bufferView 0: reaches beyond its buffer of 156 bytes"),
        ("/bufferViews/0/byteStride", json!(4), "byteStride 4 does not fit elements of 12 bytes"),
        ("/bufferViews/0/buffer", json!(1), "buffer names buffer 1, the file has 1"),
        ("/buffers/0/byteLength", json!(157), "buffer 0: is cut off: it says 157 bytes, 156 are there"),
        ("/buffers/0/uri", json!("../secret.bin"), "its file ../secret.bin cannot be read"),
        ("/buffers/0/uri", json!("%ff%fe"), "is not text"),
        ("/nodes/0/children", json!([0]), "node 0: is its own ancestor"),
        ("/nodes/0/children", json!([7]), "node 0: names a child that does not exist"),
        ("/nodes/0/scale", json!([1, 2]), "scale is not 3 finite numbers"),
        (
            "/meshes/0/primitives/0/extensions",
            json!({"KHR_draco_mesh_compression": {"bufferView": 1, "attributes": {"POSITION": 0}}}),
            "mesh 0, primitive 0, Draco compression: cannot be decoded",
        ),
        (
            "/bufferViews/0/extensions",
            json!({"EXT_meshopt_compression": {"buffer": 0, "byteLength": 60, "byteStride": 12, "count": 6,
                "mode": "ATTRIBUTES"}}),
            "bufferView 0, meshopt compression: is of an unknown version",
        ),
    ];
    for (pointer, value, expected) in cases {
        let (mut document, binary) = seam();
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        document.pointer_mut(parent).expect(pointer)[key] = value;
        refused(&glb(&document, &binary), Format::Glb, expected);
    }
}

#[test]
fn bad_containers_are_refused() {
    let whole = super::support::seam_glb();
    for (length, expected) in [(3, "column"), (8, "is cut off"), (40, "is cut off")] {
        refused(&whole[..length], Format::Glb, expected);
    }
    let mut version = whole.clone();
    version[4] = 1;
    refused(&version, Format::Glb, "GLB version 1");
    let mut chunk = whole.clone();
    chunk[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    refused(&chunk, Format::Glb, "GLB chunk 0: says 4294967295 bytes");
    refused(b"{}", Format::Gltf, "names no asset version");
    refused("[".repeat(100_000).as_bytes(), Format::Gltf, "recursion limit");
}

#[test]
fn long_chains_of_nodes_are_walked() {
    let (mut document, binary) = seam();
    let n = 200_000;
    let mut nodes: Vec<Value> = (0..n).map(|i| json!({"children": [i + 1]})).collect();
    nodes.push(json!({"mesh": 0}));
    document["nodes"] = nodes.into();
    document["scenes"] = json!([{"nodes": [0]}]);
    from_bytes(&glb(&document, &binary), Format::Glb, "deep").expect("a mesh");
}

#[test]
fn missing_and_foreign_files_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("missing.obj");
    let error = open(&path).expect_err("missing").to_string();
    assert!(error.starts_with(&format!("{}: cannot be read", path.display())), "{error}");
    let path = folder.path().join("notes.txt");
    std::fs::write(&path, "text").expect("a file");
    let error = open(&path).expect_err("text").to_string();
    assert!(error.contains("GLB (.glb), PLY (.ply), STL (.stl) and OFF (.off) can be opened"), "{error}");
    let path = folder.path().join("folder.obj");
    std::fs::create_dir(&path).expect("a folder");
    let error = open(&path).expect_err("a folder").to_string();
    assert!(error.contains("is not a regular file"), "{error}");
}

#[test]
fn references_out_of_the_folder_are_not_followed() {
    let outer = tempfile::tempdir().expect("a temporary folder");
    let folder = outer.path().join("model");
    std::fs::create_dir(&folder).expect("a folder");
    let (mut document, binary) = seam();
    std::fs::write(outer.path().join("data.bin"), &binary).expect("a file");
    let absolute = outer.path().join("data.bin").display().to_string();
    let mut uris = vec!["../data.bin".to_owned(), "%2e%2e/data.bin".into(), "a/../../data.bin".into()];
    uris.extend([absolute.clone(), format!("file://{absolute}"), "C:\\data.bin".into(), "..\\data.bin".into()]);
    uris.extend(["".into(), ".".into(), "data.bin%00".into(), "\\\\host\\data.bin".into()]);
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(outer.path().join("data.bin"), folder.join("link.bin")).expect("a link");
        uris.extend(["link.bin".to_owned(), "/dev/zero".into()]);
    }
    for uri in uris {
        document["buffers"][0]["uri"] = uri.clone().into();
        let path = folder.join("model.gltf");
        std::fs::write(&path, document.to_string()).expect("a file");
        assert!(open(&path).is_err(), "{uri} was followed");
    }
    std::fs::write(folder.join("da ta.bin"), &binary).expect("a file");
    document["buffers"][0]["uri"] = "da%20ta.bin".into();
    std::fs::write(folder.join("model.gltf"), document.to_string()).expect("a file");
    open(&folder.join("model.gltf")).expect("a file in the folder is read");
}
