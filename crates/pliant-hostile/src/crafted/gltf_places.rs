//! glTF scenes and nodes: circles, depth, transforms that flatten or leave numbers.

use super::Case;
use super::gltf::{both, changed};
use super::model::{N_VERTICES, sound_document};
use serde_json::{Value, json};

pub(super) fn cases() -> Vec<Case> {
    [graphs(), scenes(), transforms(), vertices()].concat()
}

fn graphs() -> Vec<Case> {
    let mut cases = Vec::new();
    for (children, expected) in [
        (json!([0]), "node 0: is its own ancestor"),
        (json!([2, 2]), "node 2: has two parents"),
        (json!([3]), "node 0: names a child that does not exist, the file has 3"),
        (json!([-1]), "node 0: names a child that does not exist"),
        (json!([0.5]), "node 0: names a child that does not exist"),
        (json!(["1"]), "node 0: names a child that does not exist"),
        (json!([null]), "node 0: names a child that does not exist"),
        (json!([u64::MAX]), "node 0: names a child that does not exist"),
    ] {
        cases.extend(changed("/nodes/0/children", children, expected));
    }
    cases.extend(changed("/nodes/1/children", json!([0]), "is its own ancestor"));
    cases.extend(changed("/nodes/2/children", json!([1]), "node 1: has two parents"));
    cases.extend(changed("/nodes/0/children", json!("x"), N_VERTICES));
    cases.extend(changed("/nodes/0/children", json!([]), N_VERTICES));
    for (mesh, expected) in [
        (json!(1), "node 2: mesh names mesh 1, the file has 1"),
        (json!(-1), "node 2: mesh is not a whole number"),
        (json!("0"), "node 2: mesh is not a whole number"),
    ] {
        cases.extend(changed("/nodes/2/mesh", mesh, expected));
    }
    cases.extend(changed("/nodes/2/mesh", Value::Null, N_VERTICES));
    cases
}

fn scenes() -> Vec<Case> {
    let mut cases = Vec::new();
    for (pointer, value, expected) in [
        ("/scenes/0/nodes", json!([9]), "scene 0: names a node that does not exist"),
        ("/scenes/0/nodes", json!([-1]), "scene 0: names a node that does not exist"),
        ("/scenes/0/nodes", json!(["0"]), "scene 0: names a node that does not exist"),
        ("/scene", json!(-1), "scene is not a whole number"),
        ("/scene", json!("0"), "scene is not a whole number"),
        ("/scene", json!(1), "scene"),
    ] {
        cases.extend(changed(pointer, value, expected));
    }
    cases.extend(changed("/scenes/0/nodes", json!([2, 2, 2, 0, 0]), N_VERTICES));
    cases.extend(changed("/scenes/0/nodes", json!("x"), N_VERTICES));
    cases.extend(changed("/scenes/0", json!("x"), N_VERTICES));
    cases
}

fn transforms() -> Vec<Case> {
    let (mut plain, binary) = sound_document();
    plain["nodes"][2].as_object_mut().expect("a node").shift_remove("skin");
    let mut cases = Vec::new();
    let mut with = |key: &str, value: Value, opens: bool| {
        let mut document = plain.clone();
        document["nodes"][2][key] = value.clone();
        let shown: String = value.to_string().chars().take(40).collect();
        let name = format!("{key} {shown}");
        if opens {
            cases.extend(both(&name, &document, &binary, N_VERTICES));
        } else {
            cases.extend(both(&name, &document, &binary, "node 2: "));
        }
    };
    let matrix = |last: [f64; 4]| json!([1, 0, 0, last[0], 0, 1, 0, last[1], 0, 0, 1, last[2], 0, 0, 0, last[3]]);
    with("scale", json!([0, 0, 0]), true);
    with("scale", json!([1, 0, 1]), true);
    with("scale", json!([-1, 1, 1]), true);
    with("scale", json!([1e300, 1e300, 1e300]), true);
    with("scale", json!([1e-300, 1e-300, 1e-300]), true);
    with("scale", json!([1, 2]), false);
    with("scale", json!(2), false);
    with("scale", json!([1, "2", 3]), false);
    with("translation", json!([1e308, 1e308, 1e308]), true);
    with("translation", json!([null, 0, 0]), false);
    with("translation", json!([0, 0, 0, 0]), false);
    with("rotation", json!([0, 0, 0, 0]), true);
    with("rotation", json!([1e200, 1e200, 1e200, 1e200]), true);
    with("rotation", json!([1e-300, 0, 0, 0]), true);
    with("rotation", json!([0, 0, 0]), false);
    with("rotation", json!({"x": 0}), false);
    with("matrix", matrix([0.0, 0.0, 0.0, 1.0]), true);
    with("matrix", matrix([0.0, 0.0, 0.0, 0.0]), false);
    with("matrix", matrix([0.5, 0.0, 0.0, 1.0]), false);
    with("matrix", matrix([0.0, 0.0, 1e300, 1.0]), false);
    with("matrix", json!([0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1]), true);
    with("matrix", json!([1, 0, 0, 0]), false);
    with("matrix", json!("identity"), false);
    cases
}

/// Numbers in the buffer itself.
fn vertices() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, number, opens) in [
        ("that is none", f32::NAN, false),
        ("without end", f32::INFINITY, false),
        ("without end below", f32::NEG_INFINITY, false),
        ("that is the largest", f32::MAX, true),
        ("that is the smallest", 1e-45, true),
        ("that is a negative zero", -0.0, true),
    ] {
        let (mut document, mut binary) = sound_document();
        binary[4..8].copy_from_slice(&number.to_le_bytes());
        let name = format!("coordinate {name}");
        if opens {
            cases.extend(both(&name, &document, &binary, N_VERTICES));
        } else {
            let expected = "vertex 0 (element 0 of accessor 0): position is not finite";
            cases.extend(both(&name, &document, &binary, expected));
        }
        // In normals, tangents and texture coordinates it harms nothing.
        for accessor in 1..4 {
            (document, binary) = super::model::sound_document();
            let at = document["bufferViews"][accessor]["byteOffset"].as_u64().expect("an offset") as usize;
            binary[at..at + 4].copy_from_slice(&number.to_le_bytes());
            cases.extend(both(&format!("{name} in accessor {accessor}"), &document, &binary, N_VERTICES).pop());
        }
    }
    for (index, expected) in
        [(5u16, None), (6, Some("names vertex 6, the primitive has 6")), (0xFFFF, Some("names vertex 65535"))]
    {
        let (document, mut binary) = sound_document();
        let at = document["bufferViews"][5]["byteOffset"].as_u64().expect("an offset") as usize;
        binary[at..at + 2].copy_from_slice(&index.to_le_bytes());
        let name = format!("index {index}");
        match expected {
            None => cases.extend(both(&name, &document, &binary, N_VERTICES)),
            Some(expected) => cases.extend(both(&name, &document, &binary, expected)),
        }
    }
    cases
}
