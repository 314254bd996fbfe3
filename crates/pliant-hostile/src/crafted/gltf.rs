//! glTF documents with one member changed: accessors, views, buffers, meshes. Each as GLB and as glTF.

use super::model::{N_VERTICES, glb_of, gltf_of, sound_document};
use super::{Case, Expected};
use serde_json::{Value, json};

/// The sound document with a member replaced, or removed by a value of null, in both containers.
pub(super) fn changed(pointer: &str, value: Value, expected: impl Into<Expected>) -> Vec<Case> {
    let (mut document, binary) = sound_document();
    set(&mut document, pointer, value.clone());
    let mut shown: String = value.to_string().chars().take(200).collect();
    if shown == "null" {
        shown = "nothing".into();
    }
    both(&format!("{pointer} {shown}"), &document, &binary, expected)
}

/// A document as GLB and as glTF.
pub(super) fn both(name: &str, document: &Value, binary: &[u8], expected: impl Into<Expected>) -> Vec<Case> {
    let expected = expected.into();
    let text = document.to_string();
    vec![
        Case::new(format!("glb {name}"), "glb", glb_of(text.as_bytes(), binary), expected.clone()),
        Case::new(format!("gltf {name}"), "gltf", gltf_of(document, binary), expected),
    ]
}

fn set(document: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer has a slash");
    let parent = document.pointer_mut(parent).unwrap_or_else(|| panic!("{pointer} has no parent"));
    match parent {
        Value::Array(items) => items[key.parse::<usize>().expect("an index")] = value,
        Value::Object(members) if value.is_null() => drop(members.shift_remove(key)),
        Value::Object(members) => drop(members.insert(key.into(), value)),
        _ => panic!("{pointer} has no parent"),
    }
}

/// Values that are no index and no count.
fn no_numbers() -> Vec<Value> {
    vec![json!(-1), json!(0.5), json!("0"), json!([]), json!({}), json!(true), json!(1e300), json!(-1e-300)]
}

pub(super) fn cases() -> Vec<Case> {
    [sound(), accessors(), views(), buffers(), primitives(), types()].concat()
}

fn sound() -> Vec<Case> {
    let (mut model, binary) = sound_document();
    let mut cases = both("sound", &model, &binary, N_VERTICES);
    for key in ["skins", "animations", "scene"] {
        cases.extend(changed(&format!("/{key}"), Value::Null, N_VERTICES));
    }
    for (name, part) in [("targets", "/meshes/0/primitives/0/targets"), ("indices", "/meshes/0/primitives/0/indices")] {
        set(&mut model, part, Value::Null);
        cases.extend(both(&format!("without {name}"), &model, &binary, N_VERTICES));
    }
    cases.extend(changed("/scenes", Value::Null, "scene names scene 0, the file has 0"));
    cases.extend(changed("/materials", Value::Null, "material names material 0, the file has 0"));
    cases.extend(changed("/extensionsRequired", json!(7), N_VERTICES));
    cases.extend(changed("/extensionsUsed", json!(["KHR_unheard_of"]), N_VERTICES));
    cases.extend(changed("/extras", json!({"deep": {"er": [null, 1e-300, "\u{0}\u{ffff}"]}}), N_VERTICES));
    cases
}

fn accessors() -> Vec<Case> {
    let mut cases = Vec::new();
    for value in no_numbers() {
        cases.extend(changed("/accessors/0/count", value.clone(), "accessor 0: count is not a whole number"));
        cases.extend(changed("/accessors/0/bufferView", value.clone(), "accessor 0: bufferView is not a whole number"));
        cases.extend(changed("/accessors/0/byteOffset", value, "accessor 0: byteOffset is not a whole number"));
    }
    let changes: Vec<(&str, Value, Expected)> = vec![
        ("count", json!(6.0), 6.into()),
        ("count", json!(5), "index 8 names vertex 5, the primitive has 5".into()),
        ("count", json!(7), "accessor 0: reaches beyond bufferView 0 of 72 bytes".into()),
        ("count", json!(0), "index 0 names vertex 0, the primitive has 0".into()),
        ("count", Value::Null, "index 0 names vertex 0, the primitive has 0".into()),
        ("count", json!(20_000_000), "accessor 0: reaches beyond bufferView 0".into()),
        ("count", json!(120_000_001u64), "elements in an accessor are more than the limit".into()),
        ("count", json!(u32::MAX), "elements in an accessor are more than the limit".into()),
        ("count", json!(u64::MAX), "elements in an accessor are more than the limit".into()),
        ("byteOffset", json!(0), 6.into()),
        ("byteOffset", json!(1), "accessor 0: reaches beyond bufferView 0 of 72 bytes".into()),
        ("byteOffset", json!(u32::MAX), "accessor 0: reaches beyond bufferView 0".into()),
        ("byteOffset", json!(u64::MAX), "accessor 0: reaches beyond bufferView 0".into()),
        ("byteOffset", json!(u64::MAX - 71), "accessor 0: reaches beyond bufferView 0".into()),
        ("bufferView", json!(16), "accessor 0: bufferView names view 16, the file has 16".into()),
        ("bufferView", json!(u64::MAX), "accessor 0: bufferView names view".into()),
        ("bufferView", json!(5), "accessor 0: reaches beyond bufferView 5 of 24 bytes".into()),
        ("bufferView", Value::Null, 6.into()),
        ("componentType", json!(5120), 6.into()),
        ("componentType", json!(5125), "positions are not three numbers".into()),
        ("componentType", json!(5124), "component type 5124 is not known".into()),
        ("componentType", json!(5130), "component type 5130 is not known".into()),
        ("componentType", json!(0), "component type 0 is not known".into()),
        ("componentType", json!(u64::MAX), "is not known".into()),
        ("componentType", Value::Null, "component type 0 is not known".into()),
        ("componentType", json!("FLOAT"), "componentType is not a whole number".into()),
        ("type", json!("SCALAR"), "positions are not three numbers".into()),
        ("type", json!("VEC2"), "positions are not three numbers".into()),
        ("type", json!("MAT4"), "its type is not SCALAR".into()),
        ("type", json!("VEC5"), "its type is not SCALAR".into()),
        ("type", json!("vec3"), "its type is not SCALAR".into()),
        ("type", json!(3), "its type is not SCALAR".into()),
        ("type", Value::Null, "its type is not SCALAR".into()),
        ("min", json!(["x"]), 6.into()),
        ("max", json!([1e300, -1e300, 0]), 6.into()),
        ("normalized", json!("yes"), 6.into()),
        ("sparse", json!({}), "accessor 0, sparse: has no indices".into()),
        ("sparse", json!({"count": 7}), "replaces 7 elements of 6".into()),
        ("sparse", json!({"count": 1, "indices": {}}), "accessor 0, sparse: has no values".into()),
        ("sparse", sparse(1, 5126, 0), "index type 5126 is not unsigned".into()),
        ("sparse", sparse(1, 5121, 0), 6.into()),
        ("sparse", sparse(1, 5125, 0), "accessor 0, sparse: reaches beyond bufferView 6 of 2 bytes".into()),
        ("sparse", sparse(3, 5121, 0), "accessor 0, sparse: reaches beyond bufferView 6 of 2 bytes".into()),
        ("sparse", sparse(1, 5121, u64::MAX), "accessor 0, sparse: reaches beyond bufferView 6".into()),
    ];
    for (key, value, expected) in changes {
        cases.extend(changed(&format!("/accessors/0/{key}"), value, expected));
    }
    cases
}

/// Two elements replaced, with indices in the view that names them in the sound document.
fn sparse(count: u32, component: u32, offset: u64) -> Value {
    json!({
        "count": count,
        "indices": {"bufferView": 6, "componentType": component, "byteOffset": offset},
        "values": {"bufferView": 7},
    })
}

fn views() -> Vec<Case> {
    let mut cases = Vec::new();
    for value in no_numbers() {
        cases.extend(changed("/bufferViews/0/buffer", value.clone(), "bufferView 0: buffer is not a whole number"));
        cases.extend(changed("/bufferViews/0/byteLength", value, "bufferView 0: byteLength is not a whole number"));
    }
    let beyond = || Expected::from("bufferView 0: reaches beyond its buffer of");
    let changes: Vec<(&str, Value, Expected)> = vec![
        ("byteLength", json!(71), "accessor 0: reaches beyond bufferView 0 of 71 bytes".into()),
        ("byteLength", json!(0), "accessor 0: reaches beyond bufferView 0 of 0 bytes".into()),
        ("byteLength", json!(u32::MAX), beyond()),
        ("byteLength", json!(u64::MAX), beyond()),
        ("byteOffset", json!(u64::MAX), beyond()),
        ("byteOffset", json!(u64::MAX - 71), beyond()),
        ("byteOffset", json!(-4), "bufferView 0: byteOffset is not a whole number".into()),
        ("byteStride", json!(12), 6.into()),
        ("byteStride", json!(0), "byteStride 0 does not fit elements of 12 bytes".into()),
        ("byteStride", json!(4), "byteStride 4 does not fit elements of 12 bytes".into()),
        ("byteStride", json!(16), "accessor 0: reaches beyond bufferView 0 of 72 bytes".into()),
        ("byteStride", json!(256), "byteStride 256 does not fit elements of 12 bytes".into()),
        ("byteStride", json!(u64::MAX), "does not fit elements of 12 bytes".into()),
        ("byteStride", json!(-12), "byteStride is not a whole number".into()),
        ("buffer", json!(1), "bufferView 0: buffer names buffer 1, the file has 1".into()),
        ("buffer", json!(u64::MAX), "bufferView 0: buffer names buffer".into()),
        ("buffer", Value::Null, "bufferView 0: names no buffer".into()),
        ("target", json!("none"), 6.into()),
    ];
    for (key, value, expected) in changes {
        cases.extend(changed(&format!("/bufferViews/0/{key}"), value, expected));
    }
    // Normals out of nowhere stay there, whatever is saved behind the buffer.
    for (key, value) in [("byteLength", json!(10_000)), ("byteOffset", json!(10_000)), ("byteOffset", json!(u64::MAX))]
    {
        cases.extend(changed(&format!("/bufferViews/1/{key}"), value, N_VERTICES));
    }
    cases
}

fn buffers() -> Vec<Case> {
    let (mut model, binary) = sound_document();
    let mut cases = Vec::new();
    let changes: Vec<(&str, Value, Expected)> = vec![
        ("byteLength", json!(0), 6.into()),
        ("byteLength", json!(binary.len() + 4), "buffer 0: is cut off".into()),
        ("byteLength", json!(u64::MAX), "buffer 0: is cut off".into()),
        ("byteLength", json!(-1), "buffer 0: byteLength is not a whole number".into()),
        ("byteLength", json!("0"), "buffer 0: byteLength is not a whole number".into()),
        ("uri", json!(0), "buffer 0: its URI is not text".into()),
        ("uri", json!(""), "buffer 0: its file  cannot be read".into()),
        ("uri", json!("data:"), "its data URI is not base64".into()),
        ("uri", json!("data:;base64,"), "buffer 0: is cut off".into()),
        ("uri", json!("data:;base64,!!!!"), "its data URI is not base64".into()),
        ("uri", json!("data:application/octet-stream,AAAA"), "its data URI is not base64".into()),
        ("uri", json!("data:;base64,A"), "buffer 0: is cut off".into()),
        ("uri", json!("%"), "is not text".into()),
        ("uri", json!("%zz"), "is not text".into()),
        ("uri", json!("%ff%fe"), "is not text".into()),
        ("uri", json!("none.bin"), "its file none.bin cannot be read".into()),
    ];
    for (key, value, expected) in changes {
        cases.extend(changed(&format!("/buffers/0/{key}"), value, expected));
    }
    cases.extend(changed("/buffers", json!([]), "bufferView 0: buffer names buffer 0, the file has 0"));
    cases.extend(changed("/buffers", json!({}), "buffers: is not a list"));
    cases.extend(changed("/bufferViews", json!("x"), "bufferViews: is not a list"));
    cases.extend(changed("/accessors", json!(1), "accessors: is not a list"));
    cases.extend(changed("/accessors", json!([]), "POSITION names accessor 0, the file has 0"));
    set(&mut model, "/buffers", json!([{"byteLength": 4}, {"byteLength": 4}]));
    cases.extend(both("a second buffer without data", &model, &binary, "buffer 1: names no data").into_iter().take(1));
    cases
}

fn primitives() -> Vec<Case> {
    let mut cases = Vec::new();
    let place = "mesh 0, primitive 0";
    for value in no_numbers() {
        let not_whole = |key: &str| format!("{place}: {key} is not a whole number");
        for key in ["attributes/POSITION", "indices", "mode", "material"] {
            let name = key.rsplit('/').next().unwrap_or_default();
            cases.extend(changed(&format!("/meshes/0/primitives/0/{key}"), value.clone(), not_whole(name)));
        }
    }
    let changes: Vec<(&str, Value, Expected)> = vec![
        ("attributes/POSITION", json!(15), "POSITION names accessor 15, the file has 15".into()),
        ("attributes/POSITION", json!(2), "positions are not three numbers".into()),
        ("attributes/POSITION", Value::Null, "holds no faces".into()),
        ("attributes/NORMAL", json!(99), "NORMAL names accessor 99".into()),
        ("attributes/NORMAL", json!(5), 6.into()),
        ("attributes/TANGENT", json!(0), 6.into()),
        ("attributes/TEXCOORD_0", json!(0), 6.into()),
        ("attributes/COLOR_0", json!(9), 6.into()),
        ("attributes/_RIGIDITY", json!(0), "accessor 0: 3 numbers each are no rigidities".into()),
        ("attributes", json!([]), "holds no faces".into()),
        ("attributes", Value::Null, "holds no faces".into()),
        ("indices", json!(15), "indices names accessor 15, the file has 15".into()),
        ("indices", json!(0), "accessor 0: indices are not unsigned whole numbers".into()),
        ("indices", json!(6), "accessor 6: indices".into()),
        ("mode", json!(0), "holds no faces".into()),
        ("mode", json!(3), "holds no faces".into()),
        ("mode", json!(5), 6.into()),
        ("mode", json!(6), 6.into()),
        ("mode", json!(7), "mode 7 is not known".into()),
        ("mode", json!(u64::MAX), "is not known".into()),
        ("material", json!(1), "material names material 1, the file has 1".into()),
        ("targets", json!("x"), 6.into()),
    ];
    for (key, value, expected) in changes {
        cases.extend(changed(&format!("/meshes/0/primitives/0/{key}"), value, expected));
    }
    cases
}

/// Lists that are none and lists of the wrong things.
fn types() -> Vec<Case> {
    let mut cases = Vec::new();
    for (pointer, expected) in [
        ("/meshes", "meshes: is not a list"),
        ("/nodes", "nodes: is not a list"),
        ("/asset", "names no asset version"),
        ("/asset/version", "names no asset version"),
    ] {
        cases.extend(changed(pointer, json!(7), expected));
    }
    for pointer in ["/meshes/0", "/meshes/0/primitives", "/meshes/0/primitives/0"] {
        cases.extend(changed(pointer, json!(7), "holds no faces"));
    }
    for (version, expected) in [
        ("2.1", Expected::from(6)),
        ("1.0", "is glTF version 1.0; only 2.x".into()),
        ("3.0", "is glTF version 3.0; only 2.x".into()),
        ("2", "is glTF version 2; only 2.x".into()),
        ("", "is glTF version ; only 2.x".into()),
        ("2.\n\u{1b}[2J", 6.into()),
    ] {
        cases.extend(changed("/asset/version", json!(version), expected));
    }
    cases
}
