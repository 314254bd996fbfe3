//! Skins: what joints make of the vertices bound to them.

use super::super::support::assert_near;
use super::model::{Model, frames, own_poses};
use glam::{DMat4, DQuat, DVec3};
use serde_json::json;

/// Half a right angle about y.
const EIGHTH: [f32; 4] = [0.0, 0.382_683_43, 0.0, 0.923_879_5];
const QUARTER: [f32; 4] = [0.0, 0.707_106_77, 0.0, 0.707_106_77];

/// A strip of four squares with a joint at x = 0 and one at x = 2 below it, which turns by a right angle about y within
/// a second. The vertices at x = 2 follow both by half. Node 0 has the mesh, node 1 the skeleton, 2 and 3 are joints.
fn bending() -> Model {
    let mut model = Model::strip(4);
    let joints: Vec<u8> = [0u8, 1, 0, 0].repeat(10);
    let joints = model.accessor(&joints, json!({"componentType": 5121, "count": 10, "type": "VEC4"}));
    let weight = |v: usize| match v / 2 {
        0 | 1 => [1.0, 0.0, 0.0, 0.0],
        2 => [0.5, 0.5, 0.0, 0.0],
        _ => [0.0, 1.0, 0.0, 0.0],
    };
    let weights: Vec<f32> = (0..10).flat_map(weight).collect();
    let weights = model.floats("VEC4", &weights);
    model.document["meshes"][0]["primitives"][0]["attributes"] =
        json!({"POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights});
    model.document["scenes"][0]["nodes"] = json!([0, 1]);
    model.document["nodes"] = json!([
        // A skinned mesh stands where its joints are: this is to be ignored.
        {"mesh": 0, "skin": 0, "translation": [70.0, 0.0, 0.0], "scale": [3.0, 1.0, 1.0]},
        {"children": [2]},
        {"children": [3]},
        {"translation": [2.0, 0.0, 0.0]},
    ]);
    let back = |x: f64| DMat4::from_translation(DVec3::new(-x, 0.0, 0.0)).to_cols_array().map(|x| x as f32);
    let inverse_bind = model.floats("MAT4", &[back(0.0), back(2.0)].concat());
    model.document["skins"] = json!([{"joints": [2, 3], "inverseBindMatrices": inverse_bind}]);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let turns = model.floats("VEC4", &[[0.0, 0.0, 0.0, 1.0], QUARTER].concat());
    model.channel("Bend", 3, "rotation", [times, turns], "LINEAR");
    model
}

/// The strip with the second joint turned about y: (x, 0, z) about (2, 0, 0), by half at x = 2.
fn bent(angle: f64) -> Vec<DVec3> {
    let turn = DQuat::from_rotation_y(angle);
    let at = |v: i32| {
        let rest = DVec3::new(f64::from(v / 2), 0.0, f64::from(v % 2));
        let turned = DVec3::X * 2.0 + turn * (rest - DVec3::X * 2.0);
        match v / 2 {
            0 | 1 => rest,
            2 => (rest + turned) / 2.0,
            _ => turned,
        }
    };
    (0..10).map(at).collect()
}

#[test]
fn a_strip_with_two_joints_bends_as_computed_by_hand() {
    let file = bending().open();
    assert_eq!(file.positions[9], DVec3::new(4.0, 0.0, 1.0), "opened in bind pose");
    let (poses, n_alike) = own_poses(&file, frames(3));
    assert_eq!(n_alike, 1, "the first frame is the bind pose");
    let names: Vec<&str> = poses.iter().map(|pose| pose.name.as_str()).collect();
    assert_eq!(names, ["the mesh: Bend, frame 2 of 3", "the mesh: Bend, frame 3 of 3"]);
    // Quaternions in single precision are exact to 6e-8, over lengths of up to 3.
    assert_near(&poses[0].points, &bent(std::f64::consts::FRAC_PI_4), 1e-6);
    assert_near(&poses[1].points, &bent(std::f64::consts::FRAC_PI_2), 1e-6);
    // Numbers from the definition alone: x = 4 ends two below x = 2.
    assert_near(&poses[1].points[8..9], &[DVec3::new(2.0, 0.0, -2.0)], 1e-6);
}

#[test]
fn the_skeleton_places_the_mesh_and_another_unit_is_divided_out() {
    let mut model = bending();
    let nodes = &mut model.document["nodes"];
    nodes[1]["translation"] = json!([0.0, 0.0, 0.07]);
    nodes[1]["rotation"] = json!(EIGHTH);
    nodes[1]["scale"] = json!([0.01, 0.01, 0.01]);
    let file = model.open();
    let mut stream = crate::poses::Poses::of_reference(&file, frames(2)).expect("poses");
    let said = stream.warnings();
    assert!(said.len() == 1 && said[0].0.contains("skin 0 shows its bind pose 0.010000 times as large"), "{said:?}");
    let (poses, n_alike) = super::model::collect(stream);
    assert_eq!((poses.len(), n_alike), (1, 1));
    let turn = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4);
    let expected: Vec<DVec3> =
        bent(std::f64::consts::FRAC_PI_2).into_iter().map(|p| turn * p + DVec3::Z * 7.0).collect();
    assert_near(&poses[0].points, &expected, 2e-6);
}

#[test]
fn weights_count_by_their_share_in_any_type_and_set() {
    let expected = own_poses(&bending().open(), frames(2)).0.remove(0).points;
    let of_type = |code: u32, whole: f64, normalized: bool| {
        let mut model = bending();
        let weight = |v: usize| match v / 2 {
            0 | 1 => [1.0, 0.0, 0.0, 0.0],
            2 => [0.4, 0.4, 0.0, 0.0],
            _ => [0.0, 0.6, 0.0, 0.0],
        };
        let numbers = (0..10).flat_map(weight).map(|weight: f64| weight * whole);
        let bytes: Vec<u8> = match code {
            5121 => numbers.map(|x| x as u8).collect(),
            5123 => numbers.flat_map(|x| (x as u16).to_le_bytes()).collect(),
            _ => numbers.flat_map(|x| (x as f32).to_le_bytes()).collect(),
        };
        let mut accessor = json!({"componentType": code, "count": 10, "type": "VEC4"});
        accessor["normalized"] = normalized.into();
        let weights = model.accessor(&bytes, accessor);
        model.document["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights.into();
        model
    };
    for (code, whole, normalized) in
        [(5121, 255.0, true), (5123, 65535.0, true), (5121, 255.0, false), (5126, 1.0, false)]
    {
        let got = own_poses(&of_type(code, whole, normalized).open(), frames(2)).0.remove(0).points;
        assert_near(&got, &expected, 1e-12);
    }
    // The same weights, moved to the second set.
    let mut model = bending();
    let nothing = model.floats("VEC4", &[0.0; 40]);
    let attributes = &mut model.document["meshes"][0]["primitives"][0]["attributes"];
    for (name, from) in [("JOINTS_1", "JOINTS_0"), ("WEIGHTS_1", "WEIGHTS_0")] {
        attributes[name] = attributes[from].clone();
    }
    attributes["WEIGHTS_0"] = nothing.into();
    let got = own_poses(&model.open(), frames(2)).0.remove(0).points;
    assert_near(&got, &expected, 1e-12);
}

#[test]
fn the_usual_crate_reads_the_same_joints_weights_and_keys() {
    let model = bending();
    let expected = own_poses(&model.open(), frames(2)).0.remove(0).points;
    let ::gltf::Gltf { document, blob } = ::gltf::Gltf::from_slice(&model.bytes()).expect("a sound file");
    let data = |_: ::gltf::Buffer<'_>| blob.as_deref();
    let skin = document.skins().next().expect("a skin");
    let inverse: Vec<DMat4> = skin
        .reader(data)
        .read_inverse_bind_matrices()
        .expect("matrices")
        .map(|m| DMat4::from_cols_array(&m.concat().try_into().map(|m: [f32; 16]| m.map(f64::from)).expect("16")))
        .collect();
    let channel = document.animations().next().expect("an animation").channels().next().expect("a channel");
    let Some(::gltf::animation::util::ReadOutputs::Rotations(turns)) = channel.reader(data).read_outputs() else {
        panic!("no rotations")
    };
    let turn = turns.into_f32().last().expect("a key").map(f64::from);
    let at = |x: f64, turn: DQuat| DMat4::from_rotation_translation(turn, DVec3::X * x);
    let joints = [inverse[0], at(2.0, DQuat::from_array(turn)) * inverse[1]];
    let primitive = document.meshes().next().expect("a mesh").primitives().next().expect("a primitive");
    let reader = primitive.reader(data);
    let followed = reader.read_joints(0).expect("joints").into_u16();
    let weights = reader.read_weights(0).expect("weights").into_f32();
    let held = reader.read_positions().expect("positions").zip(followed.zip(weights)).map(|(p, (joint, weight))| {
        let p = DVec3::from_array(p.map(f64::from));
        let part = |k: usize| f64::from(weight[k]) * joints[usize::from(joint[k])].transform_point3(p);
        (0..4).map(part).sum()
    });
    assert_near(&held.collect::<Vec<DVec3>>(), &expected, 1e-6);
}

#[test]
fn a_joint_that_shrinks_what_follows_it_to_a_point_makes_no_pose() {
    let mut model = bending();
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let scales = model.floats("VEC3", &[1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
    model.channel("Bend", 3, "scale", [times, scales], "STEP");
    let n_poses = |model: &Model| own_poses(&model.open(), frames(3)).0.len();
    assert_eq!(n_poses(&model), 1, "the last of three frames is passed over, the first is the bind pose");
    // The same with a third joint that nothing follows.
    model.document["nodes"][3]["children"] = json!([4]);
    model.document["nodes"].as_array_mut().expect("nodes").push(json!({}));
    model.document["skins"][0] = json!({"joints": [2, 3, 4]});
    model.document["animations"][0]["channels"][1]["target"]["node"] = 4.into();
    assert_eq!(n_poses(&model), 3);
}

#[test]
fn vertices_bound_to_nothing_follow_the_first_joint_named() {
    let mut model = bending();
    let mut weights = vec![0.0f32; 40];
    weights[4] = 1.0;
    let weights = model.floats("VEC4", &weights);
    let joints: Vec<u8> = (0..10u8).flat_map(|v| [u8::from(v > 5), 9, 9, 9]).collect();
    let joints = model.accessor(&joints, json!({"componentType": 5121, "count": 10, "type": "VEC4"}));
    let attributes = &mut model.document["meshes"][0]["primitives"][0]["attributes"];
    (attributes["WEIGHTS_0"], attributes["JOINTS_0"]) = (weights.into(), joints.into());
    let got = own_poses(&model.open(), frames(2)).0.remove(0).points;
    let mut expected = bent(std::f64::consts::FRAC_PI_2);
    (expected[4], expected[5]) = (DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 1.0));
    assert_near(&got, &expected, 1e-6);
}
