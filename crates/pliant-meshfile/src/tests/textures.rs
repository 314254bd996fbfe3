//! Pictures on surfaces: which triangles show which, and which are never read.

use super::support::{glb, obj};
use crate::{Format, MeshFile, Textures, Wrapping, from_bytes, open};
use glam::Vec2;
use serde_json::{Value, json};
use std::fs;

/// A folder with an OBJ file of two squares and its library; the second square has a material of its own.
fn textured(library: &str) -> (tempfile::TempDir, MeshFile) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                usemtl one\nf 1/1 2/2 3/3 4/4\nusemtl two\nf 2/1 5/2 6/3 3/4\n";
    let inside = folder.path().join("model");
    fs::create_dir(&inside).expect("a folder");
    fs::write(inside.join("a.obj"), text).expect("written");
    fs::write(inside.join("a.mtl"), library).expect("written");
    fs::write(inside.join("brick wall.png"), b"brick").expect("written");
    fs::create_dir(inside.join("maps")).expect("a folder");
    fs::write(inside.join("maps/wood.jpg"), b"wood").expect("written");
    fs::write(folder.path().join("secret.png"), b"secret").expect("written");
    let file = open(&inside.join("a.obj")).expect("opens");
    (folder, file)
}

fn names(textures: &Textures) -> Vec<(&str, &[u8])> {
    textures.pictures.iter().map(|picture| (picture.name.as_str(), picture.bytes.as_slice())).collect()
}

#[test]
fn obj_materials_bring_their_pictures_in_all_spellings() {
    for (one, two) in [
        ("map_Kd brick wall.png", "map_Kd maps/wood.jpg"),
        ("map_Kd -s 1 1 1 -o 0 0 brick wall.png", "map_Kd maps\\wood.jpg"),
        ("map_Kd -clamp off -mm 0 1 ./brick wall.png", "map_Kd -s 2 2 maps/wood.jpg"),
    ] {
        let library = format!("newmtl one\nKd 0 0 0\n{one}\nnewmtl two\n{two}\nKd 0.1 0.2 0.3\nmap_Kd other.png\n");
        let (_folder, file) = textured(&library);
        let textures = file.textures();
        assert_eq!(names(&textures), [("brick wall.png", &b"brick"[..]), ("maps/wood.jpg", b"wood")], "{one}");
        let runs: Vec<_> = textures.runs.iter().map(|run| (run.triangles.clone(), run.picture, run.tint)).collect();
        assert_eq!(runs, [(0..2, Some(0), [1.0; 4]), (2..4, Some(1), [1.0; 4])], "{one}");
        assert_eq!(textures.uvs[0], [Vec2::ZERO, Vec2::X, Vec2::ONE]);
        assert_eq!(textures.uvs[3], [Vec2::ZERO, Vec2::ONE, Vec2::Y]);
        assert_eq!(textures.missing, [""; 0]);
    }
}

#[test]
fn a_picture_that_cannot_be_had_is_named_and_the_rest_is_shown() {
    for (map, reason) in [
        ("../secret.png", "outside the folder"),
        ("/etc/hostname", "outside the folder"),
        ("C:\\secret.png", "outside the folder"),
        ("nothing.png", "nothing.png"),
    ] {
        let (_folder, file) =
            textured(&format!("newmtl one\nKd 1 0 0\nmap_Kd {map}\nnewmtl two\nmap_Kd maps/wood.jpg\n"));
        let textures = file.textures();
        assert_eq!(names(&textures), [("maps/wood.jpg", &b"wood"[..])], "{map}");
        assert_eq!(textures.missing.len(), 1, "{map}");
        assert!(textures.missing[0].contains(reason), "{map}: {}", textures.missing[0]);
        assert_eq!((textures.runs[0].picture, textures.runs[0].tint), (None, [1.0, 0.0, 0.0, 1.0]), "{map}");
    }
}

#[test]
fn one_picture_is_read_once_and_clamped_where_the_library_says_so() {
    let (_folder, file) =
        textured("newmtl one\nmap_Kd -clamp on maps/wood.jpg\nnewmtl two\nmap_Kd -clamp on maps/wood.jpg\n");
    let textures = file.textures();
    assert_eq!(textures.pictures.len(), 1);
    assert_eq!(textures.pictures[0].wrapping, [Wrapping::Clamp; 2]);
    assert_eq!((textures.runs.len(), textures.runs[0].triangles.clone()), (1, 0..4));
}

#[test]
fn files_without_pictures_or_from_memory_have_none() {
    let textures = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl red\nf 1/1 2/1 3/1\n").textures();
    assert_eq!(textures, Textures::default());
}

/// A triangle with texture coordinates and a picture in the binary chunk; `edit` changes the document.
fn gltf(edit: impl FnOnce(&mut Value)) -> MeshFile {
    let positions = [0f32, 0., 0., 1., 0., 0., 0., 1., 0.];
    // From the top, as the format has it.
    let uvs = [0f32, 1., 1., 1., 0., 0.];
    let mut binary: Vec<u8> = positions.iter().chain(&uvs).flat_map(|x| x.to_le_bytes()).collect();
    binary.extend(b"picture!");
    let mut document = json!({
        "asset": {"version": "2.0"},
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1.0, 0.5, 0.25, 1.0], "baseColorTexture": {"index": 0}}}],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 33071, "wrapT": 33648}],
        "images": [{"name": "Skin", "bufferView": 2, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0., 0., 0.], "max": [1., 1., 0.]},
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 24},
            {"buffer": 0, "byteOffset": 60, "byteLength": 8},
        ],
        "buffers": [{"byteLength": 68}],
    });
    edit(&mut document);
    from_bytes(&glb(&document, &binary), Format::Glb, "a.glb").unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn gltf_materials_bring_pictures_out_of_the_file() {
    let textures = gltf(|_| ()).textures();
    assert_eq!(names(&textures), [("Skin", &b"picture!"[..])]);
    assert_eq!(textures.pictures[0].wrapping, [Wrapping::Clamp, Wrapping::Mirror]);
    assert_eq!((textures.runs[0].picture, textures.runs[0].tint), (Some(0), [1.0, 0.5, 0.25, 1.0]));
    assert_eq!(textures.uvs, [[Vec2::ZERO, Vec2::X, Vec2::Y]]);
    let inline = gltf(|document| document["images"][0] = json!({"uri": "data:image/png;base64,aGVsbG8="})).textures();
    assert_eq!(names(&inline), [("image 0", &b"hello"[..])]);
}

#[test]
fn gltf_texture_transforms_move_the_corners() {
    let info = "/materials/0/pbrMetallicRoughness/baseColorTexture";
    let textures = gltf(|document| {
        let turned = json!({"offset": [0.5, 0.0], "scale": [2.0, 2.0], "rotation": std::f64::consts::FRAC_PI_2});
        document.pointer_mut(info).expect("there")["extensions"] = json!({"KHR_texture_transform": turned});
    });
    let textures = textures.textures();
    // (u, v) from the top: scaled, turned a quarter so that (u, v) goes to (v, -u), shifted.
    let expected = [(0.0, 1.0), (1.0, 1.0), (0.0, 0.0)].map(|(u, v)| Vec2::new(2.0 * v + 0.5, 1.0 + 2.0 * u));
    for (got, expected) in textures.uvs[0].into_iter().zip(expected) {
        assert!(got.distance(expected) < 1e-6, "got {got}, expected {expected}");
    }
}

#[test]
fn broken_references_to_gltf_pictures_are_named_or_passed_over() {
    let info = "/materials/0/pbrMetallicRoughness/baseColorTexture";
    for (at, value, n_missing) in [
        ("/images/0", json!({"uri": "../secret.png"}), 1),
        ("/images/0", json!({"uri": "file:///etc/hostname"}), 1),
        ("/images/0", json!({"bufferView": 99}), 1),
        ("/images/0", json!({}), 1),
        ("/images/0", json!(7), 1),
        ("/textures/0", json!({}), 1),
        ("/textures/0", json!({"source": 5}), 1),
        ("/textures/0", json!(null), 1),
        (info, json!({"index": 0, "texCoord": 1}), 1),
        (info, json!({"index": 1e300}), 0),
        (info, json!({"index": 44}), 0),
        (info, json!({}), 0),
    ] {
        let textures = gltf(|document| *document.pointer_mut(at).expect("there") = value.clone()).textures();
        assert_eq!((textures.pictures.len(), textures.missing.len()), (0, n_missing), "{at} {value}");
    }
}

#[test]
fn gltf_materials_say_what_is_cut_out() {
    let cutout = |material: Value| {
        let textures = gltf(|document| {
            for (key, value) in material.as_object().expect("a record") {
                document["materials"][0][key] = value.clone();
            }
        });
        textures.textures().pictures[0].cutout
    };
    assert_eq!(cutout(json!({})), None);
    assert_eq!(cutout(json!({"alphaMode": "OPAQUE", "alphaCutoff": 0.2})), None);
    assert_eq!(cutout(json!({"alphaMode": "MASK"})), Some(0.5));
    assert_eq!(cutout(json!({"alphaMode": "MASK", "alphaCutoff": 0.25})), Some(0.25));
    let info = json!({"index": 0});
    let faint = json!({"baseColorFactor": [1.0, 1.0, 1.0, 0.5], "baseColorTexture": info});
    assert_eq!(cutout(json!({"alphaMode": "MASK", "alphaCutoff": 0.25, "pbrMetallicRoughness": faint})), Some(0.5));
}

#[test]
fn gltf_pictures_of_extensions_are_brought_or_named_with_their_format() {
    let of = |texture: Value| gltf(|document| document["textures"][0] = texture.clone()).textures();
    let webp = of(json!({"extensions": {"EXT_texture_webp": {"source": 0}}}));
    assert_eq!(names(&webp), [("Skin", &b"picture!"[..])]);
    let ktx = json!({"KHR_texture_basisu": {"source": 0}});
    assert_eq!(of(json!({"extensions": ktx})).missing, ["Skin (it is in KTX2, a format that cannot be shown)"]);
    let both = of(json!({"source": 0, "extensions": ktx}));
    assert_eq!((both.pictures.len(), both.missing.len()), (1, 0), "the picture for readers without the extension");
}

#[test]
fn a_ply_file_brings_the_picture_of_its_comment() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("brick wall.png"), b"brick").expect("written");
    let opened = |comments: &str, uv: bool| {
        let (declared, [a, b, c]) =
            if uv { ("property float s\nproperty float t\n", [" 0 0", " 1 0", " 0 1"]) } else { ("", [""; 3]) };
        let text = format!(
            "ply\nformat ascii 1.0\n{comments}element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             {declared}element face 1\nproperty list uchar int vertex_indices\nend_header\n\
             0 0 0{a}\n1 0 0{b}\n0 1 0{c}\n3 0 1 2\n"
        );
        fs::write(folder.path().join("a.ply"), text).expect("written");
        open(&folder.path().join("a.ply")).expect("opens").textures()
    };
    let named = "comment TextureFile brick wall.png\n";
    let textures = opened(named, true);
    assert_eq!(names(&textures), [("brick wall.png", &b"brick"[..])]);
    assert_eq!((textures.runs[0].picture, textures.uvs[0]), (Some(0), [Vec2::ZERO, Vec2::X, Vec2::Y]));
    for (comments, uv, reason) in [
        (named, false, "no texture coordinates"),
        ("comment TextureFile a.png\ncomment TextureFile b.png\n", true, "several"),
        ("comment TextureFile ../secret.png\n", true, "outside the folder"),
    ] {
        let textures = opened(comments, uv);
        assert!(textures.pictures.is_empty() && !textures.missing.is_empty(), "{comments}");
        assert!(textures.missing[0].contains(reason), "{comments}: {:?}", textures.missing);
    }
    assert_eq!(opened("comment TextureFiles are nice\n", true), Textures::default());
}
