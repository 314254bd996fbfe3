//! glTF files that claim much with few bytes, or repeat something many times.

use super::Case;
use super::gltf::both;
use super::model::{N_VERTICES, sound_document};
use serde_json::{Value, json};

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let zeros = |count: u64| {
        let (mut document, binary) = sound_document();
        document["accessors"][0] = json!({"componentType": 5126, "count": count, "type": "VEC3"});
        document["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": 0}}]);
        (document, binary)
    };
    let (document, binary) = zeros(20_000_001);
    let expected = "20000001 elements in an accessor without data are more than";
    cases.extend(both("more zeros than vertices", &document, &binary, expected));
    let (document, binary) = zeros(20_000_000);
    cases.extend(both(
        "as many zeros as vertices",
        &document,
        &binary,
        "vertices without data are more than the limit",
    ));
    let (mut many, binary) = zeros(900_000);
    many["accessors"] = vec![many["accessors"][0].clone(); 20].into();
    many["meshes"][0]["primitives"] = (0..20).map(|i| json!({"attributes": {"POSITION": i}})).collect();
    cases.extend(both("zeros in many accessors", &many, &binary, "vertices without data are more than the limit"));
    let (mut keys, binary) = sound_document();
    keys["accessors"][10] = json!({"componentType": 5126, "count": 15_000_000, "type": "SCALAR"});
    keys["accessors"][11] = json!({"componentType": 5126, "count": 15_000_000, "type": "VEC3"});
    cases.extend(both("keys out of nothing", &keys, &binary, N_VERTICES).into_iter().take(1));
    let (document, binary) = zeros(300_000);
    cases.extend(both("zeros out of nothing", &document, &binary, 300_000).into_iter().take(1));
    let (mut model, binary) = sound_document();
    let primitive = model["meshes"][0]["primitives"][0].clone();
    model["meshes"][0]["primitives"] = vec![primitive; 10_000].into();
    cases.extend(both("ten thousand primitives of one accessor", &model, &binary, N_VERTICES).into_iter().take(1));
    let (mut model, binary) = sound_document();
    model["meshes"][0]["primitives"][0]["targets"] = vec![json!({"POSITION": 6}); 10_000].into();
    cases.extend(both("ten thousand morph targets", &model, &binary, N_VERTICES).into_iter().take(1));
    let (mut model, binary) = sound_document();
    model["animations"] = vec![model["animations"][0].clone(); 2_000].into();
    cases.extend(both("two thousand animations", &model, &binary, N_VERTICES).into_iter().take(1));
    let (mut model, binary) = sound_document();
    model["skins"][0]["joints"] = vec![json!(0); 100_000].into();
    cases.extend(both("a skin of a hundred thousand joints", &model, &binary, N_VERTICES).into_iter().take(1));
    let (mut deep, binary) = sound_document();
    let chain = |n: usize| -> Vec<Value> {
        let mut nodes: Vec<Value> = (0..n).map(|i| json!({"children": [i + 1]})).collect();
        nodes.push(json!({"mesh": 0}));
        nodes
    };
    deep["scenes"] = json!([{"nodes": [0]}]);
    for key in ["skins", "animations"] {
        deep.as_object_mut().expect("a document").shift_remove(key);
    }
    deep["nodes"] = chain(100_000).into();
    cases.extend(both("a hundred thousand nodes in a chain", &deep, &binary, N_VERTICES));
    deep["nodes"] = vec![json!({"mesh": 0}); 100_000].into();
    cases.extend(both("a hundred thousand instances", &deep, &binary, N_VERTICES));
    deep["nodes"] = vec![json!({}); 1_000_001].into();
    cases.extend(both("too many nodes", &deep, &binary, "1000001 nodes are more than the limit of 1000000"));
    cases
}
