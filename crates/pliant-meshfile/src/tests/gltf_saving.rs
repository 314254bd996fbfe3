//! glTF in, the same glTF out.

use super::support::{assert_near, bent, document, glb, saved, seam, seam_glb};
use crate::{Format, MeshFile, from_bytes};
use glam::DVec3;

fn opened(bytes: &[u8]) -> MeshFile {
    from_bytes(bytes, Format::Glb, "test.glb").unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn saving_an_untouched_glb_gives_the_same_bytes() {
    let bytes = seam_glb();
    let file = opened(&bytes);
    let (same, _) = saved(&file, "same.glb", &file.points(), None);
    assert_eq!(same, bytes);
}

#[test]
fn coordinates_are_world_space_through_the_first_node() {
    let file = opened(&seam_glb());
    assert_eq!(file.weld.n_points(), 4);
    assert_eq!(file.positions[1], DVec3::new(8.0, 0.0, 0.0));
    assert_eq!(file.triangles[0], [0, 2, 1], "a mirrored node turns triangles around");
    assert_eq!(file.parts[0].base_color, [1.0, 0.25, 0.0, 1.0]);
}

#[test]
fn a_bent_glb_returns_its_shape_and_seams_and_keeps_the_rest() {
    let bytes = seam_glb();
    let file = opened(&bytes);
    let points = bent(&file.points());
    let (out, again) = saved(&file, "bent.glb", &points, Some(&[1, 7, 3, 4]));
    // Single precision at coordinates up to 10, through a scale of 2 to 4.
    assert_near(&again.points(), &points, 10.0 * f64::from(f32::EPSILON));
    assert_eq!(again.triangles, file.triangles);
    assert_eq!(again.weld, file.weld);
    assert_eq!(again.rigidity.as_deref(), Some(&[1, 7, 3, 1, 3, 4][..]));
    let (mut new, old) = (document(&out), document(&bytes));
    let attributes = new["meshes"][0]["primitives"][0]["attributes"].clone();
    assert_eq!(attributes.as_object().map(|a| a.len()), Some(3), "{attributes}");
    new["meshes"][0]["primitives"][0]["attributes"] = old["meshes"][0]["primitives"][0]["attributes"].clone();
    for (key, n) in [("accessors", 3), ("bufferViews", 2)] {
        new[key].as_array_mut().expect("a list").truncate(n);
    }
    new["buffers"][0]["byteLength"] = old["buffers"][0]["byteLength"].clone();
    assert_eq!(new.to_string(), old.to_string(), "order, digits and unknown members stay");
}

#[test]
fn normals_turn_with_their_faces() {
    let file = opened(&seam_glb());
    // A quarter turn of everything about x, in the world.
    let turned: Vec<DVec3> = file.points().iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
    let (out, _) = saved(&file, "n.glb", &turned, None);
    let theirs = ::gltf::Gltf::from_slice(&out).expect("the gltf crate reads it");
    let blob = theirs.blob.clone().expect("a chunk");
    let primitive = theirs.meshes().next().and_then(|mesh| mesh.primitives().next()).expect("a primitive");
    let reader = primitive.reader(|_| Some(&blob));
    for (i, normal) in reader.read_normals().expect("normals").enumerate() {
        let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
        assert!((length - 1.0).abs() < 1e-6, "normal {i} has length {length}");
        assert!(normal[2].abs() < 1e-5 && normal[1] < -0.99999, "normal {i}: got {normal:?}, expected -y");
    }
}

#[test]
fn the_gltf_crate_reads_what_is_written() {
    let file = opened(&seam_glb());
    let points = bent(&file.points());
    let (out, _) = saved(&file, "oracle.glb", &points, Some(&[1, 2, 3, 4]));
    let theirs = ::gltf::Gltf::from_slice(&out).expect("valid for the gltf crate");
    let blob = theirs.blob.clone().expect("a chunk");
    let primitive = theirs.meshes().next().and_then(|mesh| mesh.primitives().next()).expect("a primitive");
    let node = theirs.nodes().next().expect("a node");
    let world = glam::Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
    let local: Vec<[f32; 3]> = primitive.reader(|_| Some(&blob)).read_positions().expect("positions").collect();
    let got: Vec<DVec3> =
        local.iter().map(|p| world.transform_point3(DVec3::new(p[0].into(), p[1].into(), p[2].into()))).collect();
    let expected: Vec<DVec3> = file.weld.point_of_vertex.iter().map(|&p| points[p as usize]).collect();
    assert_near(&got, &expected, 10.0 * f64::from(f32::EPSILON));
}

#[test]
fn glb_and_gltf_turn_into_each_other() {
    let file = opened(&seam_glb());
    let points = bent(&file.points());
    let (_, text) = saved(&file, "a.gltf", &points, Some(&[5, 6, 7, 8]));
    assert_eq!(text.format, Format::Gltf);
    let (_, binary) = saved(&text, "b.glb", &text.points(), None);
    assert_eq!(binary.positions, text.positions);
    assert_eq!(binary.rigidity, text.rigidity);
    assert_eq!(binary.parts, text.parts);
}

#[test]
fn strips_fans_and_unindexed_triangles_are_read() {
    for (mode, expected) in [(4, vec![[0, 2, 1], [3, 5, 4]]), (5, vec![[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]])] {
        let (mut document, binary) = seam();
        let primitive = document["meshes"][0]["primitives"][0].as_object_mut().expect("an object");
        primitive.remove("indices");
        primitive.insert("mode".into(), mode.into());
        assert_eq!(opened(&glb(&document, &binary)).triangles, expected, "mode {mode}");
    }
}

#[test]
fn sparse_and_normalized_positions_are_read_and_written() {
    let (mut document, mut binary) = seam();
    binary.extend([1u8, 0, 0, 0]);
    binary.extend([0.5f32, 0.5, 0.5].iter().flat_map(|x| x.to_le_bytes()));
    document["buffers"][0]["byteLength"] = binary.len().into();
    let views = document["bufferViews"].as_array_mut().expect("a list");
    views.push(serde_json::json!({"buffer": 0, "byteOffset": 156, "byteLength": 1}));
    views.push(serde_json::json!({"buffer": 0, "byteOffset": 160, "byteLength": 12}));
    document["accessors"][0]["sparse"] = serde_json::json!({
        "count": 1,
        "indices": {"bufferView": 2, "componentType": 5121},
        "values": {"bufferView": 3},
    });
    let file = opened(&glb(&document, &binary));
    assert_eq!(file.positions[1], DVec3::new(9.0, 1.0, 2.0));
    let points = bent(&file.points());
    let (_, again) = saved(&file, "s.glb", &points, None);
    assert_near(&again.points(), &points, 10.0 * f64::from(f32::EPSILON));
}
