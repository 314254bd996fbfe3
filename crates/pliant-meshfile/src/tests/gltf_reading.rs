//! What glTF documents mean, where readers get it wrong.

use super::support::{glb, seam};
use crate::{Format, MeshFile, OpenError, from_bytes};
use glam::DVec3;
use serde_json::{Value, json};

fn opened(document: &Value, binary: &[u8]) -> Result<MeshFile, OpenError> {
    from_bytes(&glb(document, binary), Format::Glb, "test.glb")
}

/// Appends an accessor of numbers to a document.
fn append(document: &mut Value, binary: &mut Vec<u8>, bytes: &[u8], mut accessor: Value) -> usize {
    binary.resize(binary.len().next_multiple_of(4), 0);
    let views = document["bufferViews"].as_array_mut().expect("a list");
    views.push(json!({"buffer": 0, "byteOffset": binary.len(), "byteLength": bytes.len()}));
    accessor["bufferView"] = (views.len() - 1).into();
    binary.extend(bytes);
    document["buffers"][0]["byteLength"] = binary.len().into();
    let accessors = document["accessors"].as_array_mut().expect("a list");
    accessors.push(accessor);
    accessors.len() - 1
}

#[test]
fn the_normalized_flag_leaves_floating_point_positions_alone() {
    let (mut document, mut binary) = seam();
    binary[12..16].copy_from_slice(&(-5f32).to_le_bytes());
    document["nodes"] = json!([{"mesh": 0}]);
    document["scenes"] = json!([{"nodes": [0]}]);
    document["accessors"][0]["normalized"] = true.into();
    assert_eq!(opened(&document, &binary).expect("a mesh").positions[1], DVec3::new(-5.0, 0.0, 0.0));
}

#[test]
fn matrices_that_project_are_refused_and_rounding_is_not() {
    let (mut document, binary) = seam();
    let mut matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0, 0.0, 0.0, 1.0];
    for (at, value, fits) in [(15, 0.99999994, true), (15, 2.0, false), (3, 0.5, false), (11, 1e-7, true)] {
        let kept = std::mem::replace(&mut matrix[at], value);
        document["nodes"] = json!([{"mesh": 0, "matrix": matrix}]);
        document["scenes"] = json!([{"nodes": [0]}]);
        match opened(&document, &binary) {
            Ok(file) => {
                assert!(fits, "{value} at {at} was taken");
                assert_eq!(file.positions[0], DVec3::new(3.0, 0.0, 0.0));
            }
            Err(error) => {
                assert!(!fits, "{value} at {at}: {error}");
                assert!(error.to_string().contains("node 0: the last row of its matrix is"), "{error}");
            }
        }
        matrix[at] = kept;
    }
}

#[test]
fn rigidity_counts_whichever_primitive_brings_it() {
    let (mut document, mut binary) = seam();
    let r = append(
        &mut document,
        &mut binary,
        &[5, 6, 7, 8, 9, 10],
        json!({"componentType": 5121, "count": 6, "type": "SCALAR"}),
    );
    // A copy of the positions is a second set of vertices.
    let copy = document["accessors"][0].clone();
    document["accessors"].as_array_mut().expect("a list").push(copy);
    let second = r + 1;
    document["meshes"][0]["primitives"] = json!([
        {"attributes": {"POSITION": 0}},
        {"attributes": {"POSITION": second, "_RIGIDITY": r}},
        {"attributes": {"POSITION": 0, "_RIGIDITY": r}},
    ]);
    let file = opened(&document, &binary).expect("a mesh");
    assert_eq!(file.rigidity.as_deref(), Some(&[5, 6, 7, 8, 9, 10, 5, 6, 7, 8, 9, 10][..]));
    document["meshes"][0]["primitives"].as_array_mut().expect("a list").pop();
    let file = opened(&document, &binary).expect("a mesh");
    assert_eq!(file.rigidity.as_deref(), Some(&[1, 1, 1, 1, 1, 1, 5, 6, 7, 8, 9, 10][..]));
}

#[test]
fn a_wrong_rigidity_is_named_by_accessor_and_vertex() {
    let (mut document, mut binary) = seam();
    let accessor = json!({"componentType": 5121, "count": 6, "type": "SCALAR"});
    let r = append(&mut document, &mut binary, &[5, 6, 0, 8, 9, 10], accessor);
    document["meshes"][0]["primitives"][0]["attributes"]["_RIGIDITY"] = r.into();
    let error = opened(&document, &binary).expect_err("zero").to_string();
    assert_eq!(error, "test.glb: accessor 3, vertex 2: _RIGIDITY is 0: a rigidity is a whole number from 1 to 1000");
}

#[test]
fn numbers_for_display_are_always_finite() {
    let (mut document, mut binary) = seam();
    let odd = [f32::NAN, f32::INFINITY, 0.5, -0.0, f32::NEG_INFINITY, 1.0, 0.0, 0.25, 0.5, 0.5, 0.5, 0.5];
    let bytes: Vec<u8> = odd.iter().flat_map(|x| x.to_le_bytes()).collect();
    let uv = json!({"componentType": 5126, "count": 6, "type": "VEC2"});
    let uv = append(&mut document, &mut binary, &bytes, uv);
    let bytes: Vec<u8> = odd.iter().chain(&odd).flat_map(|x| x.to_le_bytes()).collect();
    let color = json!({"componentType": 5126, "count": 6, "type": "VEC4"});
    let color = append(&mut document, &mut binary, &bytes, color);
    document["meshes"][0]["primitives"][0]["attributes"] = json!({"POSITION": 0, "TEXCOORD_0": uv, "COLOR_0": color});
    let file = opened(&document, &binary).expect("a mesh");
    assert!(file.uvs.expect("coordinates").iter().all(|uv| uv.is_finite()));
    assert!(file.colors.expect("colors").iter().flatten().all(|x| x.is_finite()));
}

#[test]
fn indices_without_data_are_refused() {
    let (mut document, binary) = seam();
    document["accessors"][2].as_object_mut().expect("an object").remove("bufferView");
    let error = opened(&document, &binary).expect_err("no indices").to_string();
    assert!(error.contains("accessor 2: indices are in no bufferView"), "{error}");
    document["accessors"][0].as_object_mut().expect("an object").remove("bufferView");
    document["accessors"][0]["count"] = 20_000_001.into();
    let error = opened(&document, &binary).expect_err("zeros").to_string();
    assert!(error.contains("20000001 elements in an accessor without data are more than"), "{error}");
}

#[test]
fn one_long_name_does_not_fill_the_memory() {
    let (mut document, binary) = seam();
    document["meshes"][0]["name"] = "é".repeat(1 << 20).into();
    let primitive = document["meshes"][0]["primitives"][0].clone();
    document["meshes"][0]["primitives"] = vec![primitive; 1000].into();
    let file = opened(&document, &binary).expect("a mesh");
    assert_eq!(file.parts.len(), 1000);
    assert!(file.parts.iter().all(|part| part.name.len() < 1100), "names are cut");
}
