//! Files whose moving parts are broken: refused by place, or sound.

use super::super::mutation::{Numbers, mutated};
use super::super::support::glb;
use super::model::{Model, frames};
use crate::poses::{Found, Poses};
use crate::{Format, MeshFile, from_bytes};
use serde_json::{Value, json};

/// A strip with a skin, a target, and an animation of both.
fn moving() -> Model {
    let mut model = Model::strip(2);
    let joints = model.accessor(&[0u8, 1, 0, 0].repeat(6), json!({"componentType": 5121, "count": 6, "type": "VEC4"}));
    let weights = model.floats("VEC4", &[0.5f32, 0.5, 0.0, 0.0].repeat(6));
    let target = model.floats("VEC3", &[0.0f32, 0.0, 0.5].repeat(6));
    let primitive = &mut model.document["meshes"][0]["primitives"][0];
    primitive["attributes"] = json!({"POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights});
    primitive["targets"] = json!([{"POSITION": target}]);
    let unit = [[1f32, 0., 0., 0.], [0., 1., 0., 0.], [0., 0., 1., 0.], [0., 0., 0., 1.]].concat();
    let inverse_bind = model.floats("MAT4", &unit.repeat(2));
    model.document["nodes"] = json!([{"mesh": 0, "skin": 0}, {"children": [2]}, {}]);
    model.document["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": inverse_bind}]);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let scales = model.floats("VEC3", &[1.0, 1.0, 1.0, 2.0, 1.0, 1.0]);
    // Tangent in, value and tangent out of two keys.
    let turns = model.floats("VEC4", &[0.0f32, 0.0, 0.6, 0.8].repeat(6));
    let weights = model.floats("SCALAR", &[0.0, 1.0]);
    model.channel("Both", 2, "scale", [times, scales], "LINEAR");
    model.channel("Both", 1, "rotation", [times, turns], "CUBICSPLINE");
    model.channel("Both", 0, "weights", [times, weights], "STEP");
    model
}

/// Everything that is wrong with a file's poses, one line each; checks that those without fault are sound.
fn faults(file: &MeshFile) -> Vec<String> {
    let most = Poses::count_of_reference(file, 3);
    let poses = match Poses::of_reference(file, frames(3)) {
        Err(error) => return vec![error.to_string()],
        Ok(poses) => poses,
    };
    assert!(poses.n_left() == most && most > 0, "{most} were counted, {} are there", poses.n_left());
    let n = file.weld.n_points();
    let fault = |found: Result<Found, _>| match found {
        Ok(Found::Alike { .. }) => None,
        Ok(Found::Pose(pose)) => {
            assert!(pose.points.len() == n && pose.points.iter().all(|p| p.is_finite()), "{pose:?}");
            None
        }
        Err(error) => Some(crate::poses::PoseError::to_string(&error)),
    };
    poses.filter_map(fault).collect()
}

#[test]
fn broken_parts_are_named_by_place() {
    assert_eq!(faults(&moving().open()), [""; 0]);
    let cases: Vec<(&str, Value, &str)> = vec![
        ("/skins/0/joints/1", json!(9), "skin 0: names a joint that is no node"),
        ("/skins/0/inverseBindMatrices", json!(99), "skin 0: inverseBindMatrices names accessor 99"),
        ("/skins/0/inverseBindMatrices", json!(0), "accessor 0: its type is not MAT4"),
        ("/skins/0/joints", json!([1, 2, 1]), "skin 0: has 3 joints and 2 inverse bind matrices"),
        ("/skins/0/joints", json!([1, 2, 1, 2]), "skin 0: names 4 joints, the file has 3 nodes"),
        ("/skins/0/joints", json!([1]), "mesh 0, primitive 0, vertex 0: follows joint 1 by 0.5, skin 0 has 1 joints"),
        ("/nodes/0/skin", json!(3), "node 0: skin names skin 3, the file has 1"),
        ("/meshes/0/primitives/0/attributes/JOINTS_0", json!(3), "JOINTS_0 is not four whole numbers for each of 6"),
        ("/meshes/0/primitives/0/attributes/WEIGHTS_0", json!(0), "WEIGHTS_0 is not four numbers for each of 6"),
        ("/meshes/0/primitives/0/targets/0/POSITION", json!(77), "POSITION names accessor 77"),
        ("/meshes/0/primitives/0/targets/0/POSITION", json!(3), "accessor 3: displacements are not three numbers"),
        ("/animations/0/samplers/0/input", json!(70), "animation 0, sampler 0: input names accessor 70"),
        ("/animations/0/samplers/0/input", json!(0), "accessor 0: its elements have 3 numbers, not 1"),
        ("/animations/0/samplers/0/output", json!(3), "accessor 3: its elements have 4 numbers, not 3"),
        ("/animations/0/samplers/0/output", json!(0), "sampler 0: has 18 numbers for 2 keys, 6 are needed"),
        ("/animations/0/samplers/1/interpolation", json!("LINEAR"), "has 24 numbers for 2 keys, 8 are needed"),
        ("/animations/0/samplers/1/interpolation", json!("BEZIER"), "is not LINEAR, STEP or CUBICSPLINE"),
        ("/animations/0/channels/0/sampler", json!(5), "animation 0, channel 0: sampler names sampler 5"),
        ("/animations/0/channels/0/target/node", json!(5), "animation 0, channel 0: node names node 5"),
    ];
    for (pointer, value, expected) in cases {
        let mut model = moving();
        let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
        let parent = model.document.pointer_mut(parent).expect(pointer);
        match key.parse::<usize>() {
            Ok(index) if parent.is_array() => parent[index] = value,
            _ => parent[key] = value,
        }
        let faults = faults(&model.open());
        assert!(faults.iter().any(|fault| fault.contains(expected)), "{pointer}: got {faults:?}, expected {expected}");
        assert!(faults.iter().all(|fault| !fault.contains('\n')), "{faults:?}");
    }
}

#[test]
fn keys_that_go_back_in_time_or_are_not_finite_are_refused() {
    for (key, expected) in [(-1f32, "time of key 1 is before that of key 0"), (f32::NAN, "number 1 is not finite")] {
        let mut model = moving();
        let times = model.floats("SCALAR", &[0.0, key]);
        model.document["animations"][0]["samplers"][0]["input"] = times.into();
        let faults = faults(&model.open());
        assert_eq!(faults.len(), 1, "said once of all three frames: {faults:?}");
        assert!(faults[0].starts_with("the mesh: Both: "), "{faults:?}");
        assert!(faults[0].contains(expected), "{faults:?}");
    }
}

#[test]
fn one_file_has_a_limit_of_poses() {
    let mut model = moving();
    let animation = model.document["animations"][0].clone();
    model.document["animations"] = vec![animation; 1000].into();
    let file = model.open();
    let error = Poses::of_reference(&file, frames(1000)).expect_err("a million").to_string();
    assert_eq!(error, "the mesh: 1000001 poses in one file are more than the limit of 100000");
}

#[test]
fn a_broken_animation_is_said_once_and_the_others_are_read() {
    let mut model = moving();
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let scales = model.floats("VEC3", &[1.0, 1.0, 1.0, 1.0, 3.0, 2.0]);
    model.channel("Sound", 1, "scale", [times, scales], "LINEAR");
    model.document["animations"][0]["samplers"][0]["output"] = 3.into();
    let file = model.open();
    let found: Vec<_> = Poses::of_reference(&file, frames(40)).expect("poses").collect();
    let broken: Vec<String> = found.iter().filter_map(|found| Some(found.as_ref().err()?.to_string())).collect();
    assert_eq!(broken, ["the mesh: Both: accessor 3: its elements have 4 numbers, not 3"]);
    // The target, and the frames of the sound animation.
    assert_eq!(found.len() - broken.len(), 1 + 40);
    assert_eq!(Poses::count_of_reference(&file, 40), 1 + 80, "keys are not looked at to count");
    // Displacements that only some frames need: those without them are sound.
    let mut model = moving();
    model.document["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 3.into();
    let file = model.open();
    let found: Vec<_> = Poses::of_reference(&file, frames(4)).expect("poses").collect();
    let broken: Vec<String> = found.iter().filter_map(|found| Some(found.as_ref().err()?.to_string())).collect();
    let words = "accessor 3: displacements are not three numbers";
    let mix = format!("the mesh: Both, frame 4 of 4: {words}");
    assert_eq!(broken, [format!("the mesh: target 0: {words}"), mix]);
    assert_eq!(found.len(), 5);
}

/// A file of a thousand bytes with 200,000 vertices: zeros that take no room in it.
fn claims() -> Model {
    let mut model = moving();
    let primitive = model.document["meshes"][0]["primitives"][0].clone();
    let listed = primitive["attributes"].as_object().expect("attributes").values();
    for accessor in listed.chain([&primitive["targets"][0]["POSITION"]]) {
        let accessor = &mut model.document["accessors"][accessor.as_u64().expect("an accessor") as usize];
        accessor.as_object_mut().expect("an object").remove("bufferView");
        accessor["count"] = 200_000.into();
    }
    model
}

#[test]
fn joints_named_in_many_sets_are_refused_before_they_are_read() {
    let mut model = claims();
    let attributes = &mut model.document["meshes"][0]["primitives"][0]["attributes"];
    for set in 1..300 {
        attributes[format!("JOINTS_{set}")] = attributes["JOINTS_0"].clone();
        attributes[format!("WEIGHTS_{set}")] = attributes["WEIGHTS_0"].clone();
    }
    let faults = faults(&model.open());
    assert_eq!(faults.len(), 1);
    assert!(faults[0].contains("bytes kept for poses are more than the limit"), "{faults:?}");
}

#[test]
fn of_a_long_list_of_matrices_only_those_of_joints_are_read() {
    let mut model = moving();
    let used = model.document["skins"][0]["inverseBindMatrices"].as_u64().expect("an accessor") as usize;
    let indices = model.view(&[0, 1]);
    let values = model.document["accessors"][used]["bufferView"].clone();
    // All but the first two are zeros, which are no inverse of anything.
    model.document["accessors"][used] = json!({
        "componentType": 5126, "count": 20_000_000, "type": "MAT4",
        "sparse": {
            "count": 2, "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values},
        },
    });
    assert_eq!(faults(&model.open()), [""; 0]);
}

#[test]
fn an_animation_that_would_take_for_ever_is_refused() {
    let mut model = claims();
    let primitive = &mut model.document["meshes"][0]["primitives"][0];
    primitive["targets"] = vec![primitive["targets"][0].clone(); 200].into();
    let options = frames(10_000);
    let error = Poses::of_reference(&model.open(), options).map(|_| ()).expect_err("days").to_string();
    assert!(error.contains("steps to compute all poses in one file are more than the limit"), "{error}");
    // Keys that are read anew for each of many animations.
    let mut model = moving();
    let clip = model.document["animations"][0].clone();
    model.document["animations"] = vec![clip; 1000].into();
    let keys = model.document["animations"][0]["samplers"][0]["output"].as_u64().expect("an accessor") as usize;
    let accessor = &mut model.document["accessors"][keys];
    accessor.as_object_mut().expect("an object").remove("bufferView");
    accessor["count"] = 20_000_000.into();
    let error = Poses::of_reference(&model.open(), frames(1)).map(|_| ()).expect_err("hours").to_string();
    assert!(error.contains("steps to compute all poses in one file are more than the limit"), "{error}");
}

#[test]
fn targets_named_over_and_over_are_refused_before_they_are_read() {
    let mut model = moving();
    let target = model.document["meshes"][0]["primitives"][0]["targets"][0].clone();
    // Zeros that take no room in the file, for as many vertices.
    for accessor in [0, target["POSITION"].as_u64().expect("an accessor") as usize] {
        let accessor = &mut model.document["accessors"][accessor];
        accessor.as_object_mut().expect("an object").remove("bufferView");
        accessor["count"] = 200_000.into();
    }
    let primitive = &mut model.document["meshes"][0]["primitives"][0];
    primitive["targets"] = vec![target; 2000].into();
    primitive["attributes"] = json!({"POSITION": 0});
    let faults = faults(&model.open());
    assert_eq!(faults.len(), 1);
    assert!(faults[0].contains("elements read for poses are more than the limit"), "{faults:?}");
}

#[test]
fn damaged_documents_give_sound_poses_or_say_what_is_wrong() {
    let model = moving();
    let text = model.document.to_string().into_bytes();
    let mut numbers = Numbers(0x5eed_0004);
    for _ in 0..2000 {
        let json = mutated(&text, &mut numbers);
        let Ok(document) = serde_json::from_slice(&json) else { continue };
        let Ok(file) = from_bytes(&glb(&document, &model.binary), Format::Glb, "mutated") else { continue };
        for fault in faults(&file) {
            assert!(!fault.contains('\n'), "{fault}");
        }
    }
}

#[test]
fn damaged_numbers_give_sound_poses_or_say_what_is_wrong() {
    let model = moving();
    let mut numbers = Numbers(0x5eed_0005);
    for _ in 0..1000 {
        let mut damaged = model.clone();
        for _ in 0..3 {
            let at = numbers.below(damaged.binary.len());
            damaged.binary[at] = [0xff, 0x7f, 0x80, 0][numbers.below(4)];
        }
        if let Ok(file) = from_bytes(&damaged.bytes(), Format::Glb, "damaged") {
            faults(&file);
        }
    }
}
