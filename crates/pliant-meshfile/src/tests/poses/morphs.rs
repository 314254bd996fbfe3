//! Morph targets as poses.

use super::super::support::assert_near;
use super::model::{Model, frames, own_poses, push};
use glam::DVec3;
use serde_json::json;

/// Displacements of the six vertices of a strip of two squares.
fn lifted(height: f32) -> Vec<f32> {
    (0..6).flat_map(|v| [0.0, if v > 3 { height } else { 0.0 }, 0.0]).collect()
}

fn with_targets(targets: &[usize], mut model: Model) -> Model {
    let targets: Vec<_> = targets.iter().map(|t| json!({"POSITION": t})).collect();
    model.document["meshes"][0]["primitives"][0]["targets"] = targets.into();
    model
}

#[test]
fn every_target_is_a_pose_by_its_name() {
    let mut model = Model::strip(2);
    let targets = [lifted(1.0), lifted(-0.5), lifted(0.0)].map(|numbers| model.floats("VEC3", &numbers));
    let mut model = with_targets(&targets, model);
    model.document["meshes"][0]["extras"] = json!({"targetNames": ["Up", " ", "Still"]});
    model.document["nodes"][0]["translation"] = json!([0.0, 10.0, 0.0]);
    let (poses, n_alike) = own_poses(&model.open(), frames(2));
    assert_eq!(n_alike, 1, "a target that moves nothing is passed over");
    let names: Vec<&str> = poses.iter().map(|pose| pose.name.as_str()).collect();
    assert_eq!(names, ["the mesh: Up", "the mesh: target 1"]);
    for (pose, height) in poses.iter().zip([11.0, 9.5]) {
        let tips = [DVec3::new(1.0, 10.0, 1.0), DVec3::new(2.0, height, 0.0)];
        assert_eq!(pose.points[3..5], tips, "{}", pose.name);
    }
}

#[test]
fn sparse_and_short_displacements_are_read() {
    let mut model = Model::strip(2);
    let (indices, values) =
        (model.view(&[4, 5]), model.view(&[0f32, 1., 0., 0., 1., 0.].map(f32::to_le_bytes).concat()));
    let sparse = json!({
        "componentType": 5126, "count": 6, "type": "VEC3",
        "sparse": {"count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}},
    });
    let sparse = push(&mut model.document["accessors"], sparse);
    // As KHR_mesh_quantization stores them, eight bytes apart.
    let short: Vec<u8> =
        (0..6).flat_map(|v| [0i16, if v > 3 { 32767 } else { 0 }, 0, 0]).flat_map(i16::to_le_bytes).collect();
    let accessor = json!({"componentType": 5122, "normalized": true, "count": 6, "type": "VEC3"});
    let short = model.accessor(&short, accessor);
    let view = model.document["accessors"][short]["bufferView"].as_u64().expect("a view") as usize;
    model.document["bufferViews"][view]["byteStride"] = 8.into();
    let model = with_targets(&[sparse, short], model);
    let (poses, _) = own_poses(&model.open(), frames(2));
    assert_eq!(poses.len(), 2);
    for pose in &poses {
        assert_near(&pose.points[3..5], &[DVec3::new(1.0, 0.0, 1.0), DVec3::new(2.0, 1.0, 0.0)], 1e-15);
    }
}

#[test]
fn targets_of_one_name_are_one_pose_of_all_meshes() {
    let mut model = Model::strip(2);
    let up = model.floats("VEC3", &lifted(1.0));
    let mut model = with_targets(&[up], model);
    // A second mesh with positions of its own, which has one more target.
    let copy = model.document["accessors"][0].clone();
    let copy = push(&mut model.document["accessors"], copy);
    let mut second = model.document["meshes"][0].clone();
    second["primitives"][0]["attributes"]["POSITION"] = copy.into();
    push(&mut second["primitives"][0]["targets"], json!({"POSITION": up}));
    model.document["meshes"][0]["extras"] = json!({"targetNames": ["Smile"]});
    second["extras"] = json!({"targetNames": ["Wink", "Smile"]});
    push(&mut model.document["meshes"], second);
    push(&mut model.document["nodes"], json!({"mesh": 1, "translation": [0, 0, 5]}));
    model.document["scenes"][0]["nodes"] = json!([0, 1]);
    let (poses, _) = own_poses(&model.open(), frames(2));
    let tips: Vec<[f64; 2]> = poses.iter().map(|pose| [pose.points[4].y, pose.points[10].y]).collect();
    assert_eq!(tips, [[1.0, 1.0], [0.0, 1.0]]);
    assert!(poses[0].name.ends_with(": Smile") && poses[1].name.ends_with(": Wink"), "{poses:?}");
}

#[test]
fn a_broken_target_names_itself_and_the_others_go_on() {
    let mut model = Model::strip(2);
    let mut numbers = lifted(1.0);
    numbers[4] = f32::NAN;
    let targets = [lifted(1.0), numbers, vec![1.0; 15], lifted(2.0)].map(|numbers| model.floats("VEC3", &numbers));
    let file = with_targets(&targets, model).open();
    let stream = crate::poses::Poses::of_reference(&file, frames(2)).expect("poses");
    assert_eq!(stream.n_left(), 4);
    let said: Vec<String> =
        stream.map(|found| found.map_or_else(|error| error.to_string(), |_| String::new())).collect();
    let expected = [
        "",
        "the mesh: target 1: vertex 1: position is not finite",
        "the mesh: target 2: accessor 4: displaces 5 vertices, the primitive has 6",
        "",
    ];
    assert_eq!(said, expected);
}
