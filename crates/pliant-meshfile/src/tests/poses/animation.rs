//! Animations: transforms and weights over time, and which frames are taken.

use super::super::support::assert_near;
use super::model::{Model, frames, own_poses};
use glam::DVec3;
use serde_json::json;

/// A strip whose node is stretched along x.
fn stretched(times: &[f32], factors: &[f32], interpolation: &str) -> Model {
    let mut model = Model::strip(2);
    let times = model.floats("SCALAR", times);
    let scales: Vec<f32> = factors.iter().flat_map(|&x| [x, 1.0, 1.0]).collect();
    let scales = model.floats("VEC3", &scales);
    model.channel("Stretch", 0, "scale", [times, scales], interpolation);
    model
}

/// The x of the vertex that rests at x = 1, in each frame taken.
fn factors(model: &Model, n: usize) -> Vec<f64> {
    own_poses(&model.open(), frames(n)).0.iter().map(|pose| pose.points[2].x).collect()
}

#[test]
fn every_interpolation_reaches_the_vertices() {
    let times = [1.0, 3.0];
    assert_eq!(factors(&stretched(&times, &[2.0, 4.0], "LINEAR"), 5), [2.0, 2.5, 3.0, 3.5, 4.0]);
    assert_eq!(factors(&stretched(&times, &[2.0, 4.0], "STEP"), 5), [2.0, 4.0], "the same shape is taken once");
    // From 2 at a slope of 1 to 4 at a slope of -2, over 2 seconds: at the middle 3 + 2/8 + 4/8.
    let keys = [0.0, 2.0, 1.0, -2.0, 4.0, 0.0];
    let got = factors(&stretched(&times, &keys, "CUBICSPLINE"), 3);
    assert_eq!(got, [2.0, 3.75, 4.0]);
    assert_eq!(factors(&stretched(&times, &[2.0, 4.0], "LINEAR"), 1), [3.0], "one frame is the middle");
    assert_eq!(factors(&stretched(&[0.5], &[2.0], "LINEAR"), 4), [2.0], "one key holds for ever");
}

#[test]
fn transforms_multiply_down_the_nodes() {
    let mut model = stretched(&[0.0, 1.0], &[1.0, 2.0], "LINEAR");
    // The mesh hangs below node 0 now, which is above it and a quarter turn about z.
    let turn = std::f64::consts::FRAC_1_SQRT_2;
    model.document["nodes"] = json!([
        {"children": [1]},
        {"children": [2], "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1]},
        {"mesh": 0, "rotation": [0.0, 0.0, -turn, turn], "translation": [0.0, 1.0, 0.0]},
    ]);
    let file = model.open();
    assert_near(&file.positions[2..3], &[DVec3::new(5.0, 0.0, 0.0)], 1e-15);
    let (poses, n_alike) = own_poses(&file, frames(2));
    assert_eq!((poses.len(), n_alike), (1, 1));
    // The strip lies along x again, from x = 4; node 0 stretches all of it away from the origin.
    let expected = [(8.0, 0.0), (8.0, 1.0), (10.0, 0.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
    assert_near(&poses[0].points[..3], &expected, 1e-14);
}

#[test]
fn a_matrix_that_is_animated_counts_by_its_parts() {
    let mut model = stretched(&[0.0, 1.0], &[1.0, 3.0], "LINEAR");
    model.document["nodes"][0]["matrix"] = json!([0, 1, 0, 0, -2, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]);
    let (poses, _) = own_poses(&model.open(), frames(1));
    // Twice as long, turned by a right angle about z, then moved.
    assert_near(&poses[0].points[2..3], &[DVec3::new(5.0, 8.0, 7.0)], 1e-14);
}

#[test]
fn frames_that_only_move_or_repeat_teach_nothing_and_are_passed_over() {
    let mut model = Model::strip(2);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let places = model.floats("VEC3", &[0.0, 0.0, 0.0, 9.0, 8.0, 7.0]);
    model.channel("Fly", 0, "translation", [times, places], "LINEAR");
    let (poses, n_alike) = own_poses(&model.open(), frames(7));
    assert_eq!((poses.len(), n_alike), (0, 7), "flying as a whole bends nothing");
    // There and back: the last frame is the first.
    let model = stretched(&[0.0, 1.0, 2.0], &[2.0, 3.0, 2.0], "LINEAR");
    assert_eq!(factors(&model, 5), [2.0, 2.5, 3.0, 2.5]);
}

/// The strip with a target that lifts one end, mixed in by an animation.
fn lifted() -> Model {
    let mut model = Model::strip(2);
    let lift: Vec<f32> = (0..6).flat_map(|v| [0.0, if v > 3 { 1.0 } else { 0.0 }, 0.0]).collect();
    let target = model.floats("VEC3", &lift);
    model.document["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": target}]);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let weights = model.floats("SCALAR", &[0.5, 1.0]);
    model.channel("Lift", 0, "weights", [times, weights], "LINEAR");
    model
}

#[test]
fn a_node_that_flattens_at_rest_places_neither_the_mesh_nor_its_frames() {
    for scale in [json!([1.0, 1.0, 0.0]), json!([0.0, 0.0, 0.0])] {
        let mut model = lifted();
        model.document["nodes"][0]["scale"] = scale;
        let file = model.open();
        assert!(file.warnings[0].0.contains("node 0 flattens its mesh"), "{:?}", file.warnings);
        assert_eq!(file.positions[5], DVec3::new(2.0, 0.0, 1.0));
        let tips: Vec<DVec3> = own_poses(&file, frames(2)).0.iter().map(|pose| pose.points[5]).collect();
        assert_eq!(tips, [[2.0, 1.0, 1.0], [2.0, 0.5, 1.0], [2.0, 1.0, 1.0]].map(DVec3::from_array));
    }
}

#[test]
fn frames_in_which_a_mesh_is_hidden_by_its_scale_are_passed_over_with_one_note() {
    let mut model = lifted();
    let times = model.floats("SCALAR", &[0.0, 0.5, 1.0]);
    let scales = model.floats("VEC3", &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    model.channel("Lift", 0, "scale", [times, scales], "STEP");
    // Below a node that turns: the product of both is flat but for rounding.
    let turns = model.floats("VEC4", &[0.1, 0.2, 0.3, 0.9].repeat(3));
    let flat = model.floats("VEC3", &[1.0, 1.0, 0.0].repeat(3));
    model.channel("Flat", 1, "scale", [times, flat], "STEP");
    model.channel("Flat", 0, "rotation", [times, turns], "STEP");
    model.document["nodes"] = json!([{"mesh": 0}, {"children": [0]}]);
    let file = model.open();
    let mut stream = crate::poses::Poses::of_reference(&file, frames(5)).expect("poses");
    let found: Vec<_> = stream.by_ref().map(|found| found.expect("no fault")).collect();
    // The target, and the last frame, which shows the mesh again.
    assert_eq!(found.len(), 2, "{found:?}");
    let said: Vec<String> = stream.warnings().iter().map(ToString::to_string).collect();
    assert_eq!(said, ["9 frames in which a node flattens what it carries (first: node 0): passed over"]);
}

#[test]
fn poses_are_counted_as_they_are_then_found() {
    let mut model = lifted();
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let places = model.floats("VEC3", &[0.0, 0.0, 0.0, 9.0, 8.0, 7.0]);
    model.channel("Camera", 1, "translation", [times, places], "LINEAR");
    model.document["nodes"] = json!([{"mesh": 0}, {"camera": 0}]);
    let file = model.open();
    for n in [1, 7, 24] {
        let stream = crate::poses::Poses::of_reference(&file, frames(n)).expect("poses");
        assert_eq!(crate::poses::Poses::count_of_reference(&file, n), stream.n_left());
        assert_eq!(stream.n_left(), 1 + n, "a target and one animation");
    }
    let count = crate::poses::Poses::count_of_reference;
    assert_eq!(
        (
            count(&Model::strip(2).open(), 24),
            count(&super::super::support::obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), 24)
        ),
        (0, 0)
    );
}

#[test]
fn by_default_a_clip_is_seen_in_two_dozen_frames() {
    let file = stretched(&[0.0, 1.0], &[2.0, 4.0], "LINEAR").open();
    let stream = crate::poses::Poses::of_reference(&file, Default::default()).expect("poses");
    assert_eq!(stream.n_left(), 24);
    assert_eq!(super::model::collect(stream).0.len(), 24);
}

#[test]
fn clips_that_move_no_mesh_are_none() {
    let mut model = Model::strip(2);
    model.document["nodes"] = json!([{"mesh": 0}, {"camera": 0}]);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let places = model.floats("VEC3", &[0.0, 0.0, 0.0, 9.0, 8.0, 7.0]);
    model.channel("Camera", 1, "translation", [times, places], "LINEAR");
    let error = crate::poses::Poses::of_reference(&model.open(), frames(2)).expect_err("a camera").to_string();
    assert_eq!(error, "the mesh: holds no morph targets and no animation that moves its mesh: name files with poses");
}

#[test]
fn animated_weights_mix_the_targets() {
    let mut model = Model::strip(2);
    let up: Vec<f32> = (0..6).flat_map(|v| [0.0, if v > 3 { 1.0 } else { 0.0 }, 0.0]).collect();
    let out: Vec<f32> = (0..6).flat_map(|v| [if v > 3 { 2.0 } else { 0.0 }, 0.0, 0.0]).collect();
    let targets = [model.floats("VEC3", &up), model.floats("VEC3", &out)];
    model.document["meshes"][0]["primitives"][0]["targets"] = json!(targets.map(|t| json!({"POSITION": t})));
    // Shown where nothing is animated; the mesh is opened without.
    model.document["meshes"][0]["weights"] = json!([0.0, 0.5]);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let weights = model.floats("SCALAR", &[0.25, 1.0, 0.75, 0.0]);
    model.channel("Mix", 0, "weights", [times, weights], "LINEAR");
    let scales = model.floats("VEC3", &[1.0, 1.0, 1.0, 1.0, 1.0, 2.0]);
    model.channel("Widen", 0, "scale", [times, scales], "LINEAR");
    let file = model.open();
    assert_eq!(file.positions[4], DVec3::new(2.0, 0.0, 0.0));
    let (poses, _) = own_poses(&file, frames(3));
    let tips: Vec<DVec3> = poses.iter().map(|pose| pose.points[4]).collect();
    let expected = [
        // The targets, then three frames of each animation.
        [2.0, 1.0, 0.0],
        [4.0, 0.0, 0.0],
        [4.0, 0.25, 0.0],
        [3.0, 0.5, 0.0],
        [2.0, 0.75, 0.0],
        [3.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
    ];
    assert_near(&tips, &expected.map(DVec3::from_array), 1e-14);
    let widths: Vec<f64> = poses[5..].iter().map(|pose| pose.points[5].z).collect();
    assert_eq!(widths, [1.0, 1.5, 2.0]);
}
