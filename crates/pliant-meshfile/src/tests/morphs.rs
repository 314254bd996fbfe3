//! Several shapes in one glTF file: as morph targets, with an animation that goes through them.

use super::support::{bent, document, glb, obj, seam, seam_glb};
use crate::{Format, MeshFile, MorphShape, Morphs, SaveError, from_bytes};
use glam::DVec3;
use serde_json::{Value, json};
use std::ops::ControlFlow;

const KEYS: [(f32, Option<usize>); 3] = [(0.0, Some(0)), (0.5, Some(1)), (1.25, None)];

fn opened(bytes: &[u8]) -> MeshFile {
    from_bytes(bytes, Format::Glb, "test.glb").unwrap_or_else(|error| panic!("{error}"))
}

/// A bend, and a lift of everything.
fn shapes(file: &MeshFile) -> [Vec<DVec3>; 2] {
    let points = file.points();
    [bent(&points), points.iter().map(|p| *p + DVec3::new(0.0, 0.0, 2.0)).collect()]
}

fn save(file: &MeshFile, name: &str, shapes: &[Vec<DVec3>]) -> Result<Vec<u8>, SaveError> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    let named: Vec<MorphShape<'_>> =
        shapes.iter().zip(["Bent", "Lifted"]).map(|(points, name)| MorphShape { name, points }).collect();
    let morphs = Morphs { shapes: &named, animation: "Poses", keys: &KEYS, stepped: false };
    file.save_morphs(&path, None, &morphs, &mut |_| ControlFlow::Continue(()))?.expect("not canceled");
    Ok(std::fs::read(&path).expect("the saved file"))
}

/// World positions of every file vertex at rest with one target, as the `gltf` crate reads them. `scale` and `way` of the
/// node.
fn with_target(bytes: &[u8], target: usize, (scale, way): (DVec3, DVec3)) -> Vec<DVec3> {
    let theirs = ::gltf::Gltf::from_slice(bytes).expect("the gltf crate reads it");
    let blob = theirs.blob.clone().unwrap_or_default();
    let primitive = theirs.meshes().next().and_then(|mesh| mesh.primitives().next()).expect("a primitive");
    let reader = primitive.reader(|_| Some(&blob));
    let (moved, _, _) = reader.read_morph_targets().nth(target).expect("a target");
    let base = reader.read_positions().expect("positions");
    let place = |([x, y, z], [a, b, c]): ([f32; 3], [f32; 3])| {
        scale * DVec3::new(f64::from(x) + f64::from(a), f64::from(y) + f64::from(b), f64::from(z) + f64::from(c)) + way
    };
    base.zip(moved.expect("displacements")).map(place).collect()
}

#[test]
fn targets_give_back_every_shape_and_the_animation_goes_through_them() {
    let file = opened(&seam_glb());
    let shapes = shapes(&file);
    let bytes = save(&file, "poses.glb", &shapes).expect("saved");
    let node = (DVec3::new(-2.0, 2.0, 4.0), DVec3::new(10.0, 0.0, 0.0));
    for (k, shape) in shapes.iter().enumerate() {
        for (v, got) in with_target(&bytes, k, node).into_iter().enumerate() {
            let expected = shape[file.weld.point_of_vertex[v] as usize];
            // Single precision twice, at coordinates up to 10.
            assert!(
                got.distance(expected) < 20.0 * f64::from(f32::EPSILON),
                "shape {k}, vertex {v}: {got}, not {expected}"
            );
        }
    }
    let theirs = ::gltf::Gltf::from_slice(&bytes).expect("the gltf crate reads it");
    let blob = theirs.blob.clone().expect("a chunk");
    let animation = theirs.animations().next().expect("an animation");
    assert_eq!(animation.name(), Some("Poses"));
    assert_eq!(animation.channels().count(), 2, "both nodes that show the mesh");
    for channel in animation.channels() {
        let reader = channel.reader(|_| Some(&blob));
        assert_eq!(reader.read_inputs().expect("times").collect::<Vec<f32>>(), [0.0, 0.5, 1.25]);
        let Some(::gltf::animation::util::ReadOutputs::MorphTargetWeights(weights)) = reader.read_outputs() else {
            panic!("weights are animated")
        };
        assert_eq!(weights.into_f32().collect::<Vec<f32>>(), [1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    }
    let (new, old) = (document(&bytes), document(&seam_glb()));
    assert_eq!(new["meshes"][0]["extras"]["targetNames"], json!(["Bent", "Lifted"]));
    assert_eq!(new["meshes"][0]["weights"], json!([0.0, 0.0]));
    for key in ["extras", "scenes", "nodes", "materials"] {
        assert_eq!(new[key], old[key], "{key} stays");
    }
    let targets = new["meshes"][0]["primitives"][0]["targets"].as_array().expect("targets");
    assert!(targets.iter().all(|target| target.get("NORMAL").is_some()), "normals turn along");
    // The file's own poses are its targets and the frames between.
    let again = opened(&bytes);
    assert_eq!(again.points(), file.points(), "the shape itself is the one at rest");
}

#[test]
fn targets_and_animations_of_the_file_stay_before_the_new_ones() {
    let (mut model, mut binary) = seam();
    // A target that moves the second vertex, and an animation of its weight.
    let start = binary.len();
    let target: Vec<f32> = (0..18).map(|k| if k == 4 { 1.0 } else { 0.0 }).collect();
    let numbers = target.iter().chain(&[0.0, 1.0]).chain(&[0.25, 0.75]);
    binary.extend(numbers.flat_map(|x| x.to_le_bytes()));
    let n = binary.len() - start;
    model["bufferViews"]
        .as_array_mut()
        .expect("views")
        .push(json!({"buffer": 0, "byteOffset": start, "byteLength": n}));
    let accessors = model["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"bufferView": 2, "componentType": 5126, "count": 6, "type": "VEC3",
        "min": [0.0, 0.0, 0.0], "max": [0.0, 1.0, 0.0]}));
    accessors.push(json!({"bufferView": 2, "byteOffset": 72, "componentType": 5126, "count": 2, "type": "SCALAR",
        "min": [0.0], "max": [1.0]}));
    accessors.push(json!({"bufferView": 2, "byteOffset": 80, "componentType": 5126, "count": 2, "type": "SCALAR"}));
    model["buffers"][0]["byteLength"] = binary.len().into();
    model["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 3}]);
    model["meshes"][0]["weights"] = json!([0.5]);
    model["animations"] = json!([{"channels": [{"sampler": 0, "target": {"node": 1, "path": "weights"}}],
        "samplers": [{"input": 4, "output": 5}]}]);
    let bytes = glb(&model, &binary);
    let file = opened(&bytes);
    let out = save(&file, "more.glb", &shapes(&file)).expect("saved");
    let new = document(&out);
    assert_eq!(new["meshes"][0]["weights"], json!([0.5, 0.0, 0.0]));
    assert_eq!(new["meshes"][0]["extras"]["targetNames"], json!(["target 0", "Bent", "Lifted"]));
    assert_eq!(new["meshes"][0]["primitives"][0]["targets"][0], json!({"POSITION": 3}));
    let theirs = ::gltf::Gltf::from_slice(&out).expect("the gltf crate reads it");
    let blob = theirs.blob.clone().expect("a chunk");
    let weights: Vec<Vec<f32>> = theirs
        .animations()
        .map(|animation| {
            let channel = animation.channels().next().expect("a channel");
            let Some(::gltf::animation::util::ReadOutputs::MorphTargetWeights(weights)) =
                channel.reader(|_| Some(&blob)).read_outputs()
            else {
                panic!("weights are animated")
            };
            weights.into_f32().collect()
        })
        .collect();
    assert_eq!(weights[0], [0.25, 0.0, 0.0, 0.75, 0.0, 0.0], "the old animation moves what it moved");
    assert_eq!(weights[1], [0.5, 1.0, 0.0, 0.5, 0.0, 1.0, 0.5, 0.0, 0.0]);
}

#[test]
fn meshes_of_other_formats_become_targets_with_the_copies_that_seams_need() {
    let file = obj(super::support::OBJ);
    let shapes = shapes(&file);
    for name in ["poses.glb", "poses.gltf"] {
        let bytes = save(&file, name, &shapes).expect("saved");
        let document: Value =
            if name.ends_with("glb") { document(&bytes) } else { serde_json::from_slice(&bytes).expect("JSON") };
        for primitive in document["meshes"][0]["primitives"].as_array().expect("primitives") {
            assert_eq!(primitive["targets"].as_array().map(Vec::len), Some(2), "{name}");
        }
        if name.ends_with("glb") {
            for (k, shape) in shapes.iter().enumerate() {
                let got = with_target(&bytes, k, (DVec3::ONE, DVec3::ZERO));
                // The mesh's own vertices come first.
                for (v, expected) in
                    (0..file.positions.len()).map(|v| (v, shape[file.weld.point_of_vertex[v] as usize]))
                {
                    assert!(got[v].distance(expected) < 1e-6, "shape {k}, vertex {v}: {}, not {expected}", got[v]);
                }
            }
        }
    }
}

#[test]
fn what_cannot_hold_shapes_is_refused_and_a_cancel_writes_nothing() {
    let file = opened(&seam_glb());
    let shapes = shapes(&file);
    let said = save(&file, "poses.obj", &shapes).expect_err("OBJ has no targets").to_string();
    assert!(said.contains("only glTF and GLB"), "{said}");
    let still = [file.points(), file.points()];
    let said = save(&file, "poses.glb", &still).expect_err("nothing moves").to_string();
    assert!(said.contains("no shape differs"), "{said}");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let named = [MorphShape { name: "Bent", points: &shapes[0] }, MorphShape { name: "Lifted", points: &shapes[1] }];
    let morphs = Morphs { shapes: &named, animation: "Poses", keys: &KEYS, stepped: true };
    let mut asked = 0;
    let mut stop_at_second = |_| {
        asked += 1;
        if asked == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let done = file.save_morphs(&folder.path().join("a.glb"), None, &morphs, &mut stop_at_second).expect("no error");
    assert_eq!((done, std::fs::read_dir(folder.path()).expect("the folder").count()), (None, 0));
}
