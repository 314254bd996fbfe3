//! From one format to another, and files made from nothing.

use super::support::{OBJ, glb, obj, saved, seam, seam_glb};
use crate::{Format, MeshFile, from_bytes};
use glam::DVec3;
use serde_json::json;

#[test]
fn an_obj_becomes_a_glb_with_its_vertices_first_and_in_order() {
    let file = obj(OBJ);
    let r = [1, 2, 3, 4, 5];
    let (bytes, again) = saved(&file, "out.glb", &file.points(), Some(&r));
    assert_eq!(again.positions[..5], file.positions[..]);
    assert_eq!(again.weld.n_points(), 5);
    assert_eq!(again.point_triangles(), file.point_triangles());
    assert_eq!(again.point_rigidity(), Some((r.to_vec(), false)));
    assert!(again.uvs.is_some(), "texture coordinates are carried over");
    ::gltf::Gltf::from_slice(&bytes).expect("valid for the gltf crate");
}

#[test]
fn a_glb_becomes_an_obj_with_seams_normals_and_materials() {
    let file = from_bytes(&seam_glb(), Format::Glb, "seam.glb").expect("a mesh");
    let (bytes, again) = saved(&file, "out.obj", &file.points(), Some(&[4, 3, 2, 1]));
    assert_eq!(again.positions, file.positions);
    assert_eq!(again.triangles, file.triangles);
    assert_eq!(again.point_rigidity(), Some((vec![4, 3, 2, 1], false)));
    assert_eq!(again.parts[0].base_color, file.parts[0].base_color);
    assert!(String::from_utf8_lossy(&bytes).contains("vn "));
}

#[test]
fn generated_meshes_are_saved_alike_every_time() {
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    for name in ["t.glb", "t.gltf", "t.obj"] {
        let file = MeshFile::from_triangles("tetrahedron", positions.clone(), triangles.clone());
        let (first, again) = saved(&file, name, &file.points(), Some(&[1, 1, 1, 9]));
        let (second, _) = saved(&file, name, &file.points(), Some(&[1, 1, 1, 9]));
        assert_eq!(first, second, "{name}");
        assert_eq!(again.positions, positions, "{name}");
        assert_eq!(again.triangles, triangles, "{name}");
        assert_eq!(again.rigidity.as_deref(), Some(&[1, 1, 1, 9][..]), "{name}");
    }
}

#[test]
fn a_file_can_be_saved_over_itself() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("self.obj");
    std::fs::write(&path, OBJ).expect("a file");
    let file = crate::open(&path).expect("a mesh");
    let points: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::Z).collect();
    file.save(&path, &points, None).expect("saved");
    assert_eq!(crate::open(&path).expect("a mesh").points(), points);
    let n = std::fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(n, 1, "no temporary stays");
}

#[test]
fn a_refused_save_touches_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("kept.obj");
    std::fs::write(&path, "old").expect("a file");
    let file = obj(OBJ);
    let mut points = file.points();
    for (r, what) in [(vec![0; 5], "rigidity 0"), (vec![1; 4], "4 rigidities"), (vec![1; 5], "vertex 3")] {
        points[3].x = f64::NAN;
        let points = if what.starts_with("vertex") { points.clone() } else { file.points() };
        let error = file.save(&path, &points, Some(&r)).expect_err(what).to_string();
        assert!(error.contains(what), "got {error}, expected {what}");
        assert_eq!(std::fs::read(&path).expect("the old file"), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).expect("the folder").count(), 1);
    }
}

#[test]
fn a_library_of_another_model_is_not_overwritten() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let library = |name: &str| folder.path().join(name);
    std::fs::write(library("out.mtl"), "newmtl oak\n").expect("a file");
    let file = from_bytes(&seam_glb(), Format::Glb, "seam.glb").expect("a mesh");
    // Saved twice: the second time over the first, into the same library.
    for name in ["out.obj", "out.obj", "out-2.obj"] {
        file.save(&library(name), &file.points(), None).expect("saved");
        let again = crate::open(&library(name)).expect("a mesh");
        assert_eq!(again.parts[0].base_color, file.parts[0].base_color, "{name}");
    }
    assert_eq!(std::fs::read(library("out.mtl")).expect("the old library"), b"newmtl oak\n");
    let mut names: Vec<_> = std::fs::read_dir(folder.path()).expect("the folder").flatten().collect();
    names.sort_by_key(|entry| entry.file_name());
    let names: Vec<_> = names.iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    assert_eq!(names, ["out-2-2.mtl", "out-2.mtl", "out-2.obj", "out.mtl", "out.obj"]);
}

#[test]
fn materials_of_one_name_stay_apart_in_an_obj() {
    let (mut document, binary) = seam();
    let material =
        |name: &str, red: f32| json!({"name": name, "pbrMetallicRoughness": {"baseColorFactor": [red, 0, 0, 1]}});
    document["materials"] = json!([material("M", 0.0), material("M", 0.25), material("M.2", 0.5), material("M", 1.0)]);
    let primitive = |m: usize| json!({"attributes": {"POSITION": 0}, "indices": 2, "material": m});
    document["meshes"][0]["primitives"] = (0..4).map(primitive).collect();
    let file = from_bytes(&glb(&document, &binary), Format::Glb, "m.glb").expect("a mesh");
    let (_, again) = saved(&file, "out.obj", &file.points(), None);
    let red: Vec<f32> = again.parts.iter().map(|part| part.base_color[0]).collect();
    assert_eq!(red, [0.0, 0.25, 0.5, 1.0]);
}

#[test]
fn an_obj_of_a_glb_names_what_is_lost_and_only_that() {
    let warning = |document: &serde_json::Value, binary: &[u8]| {
        let file = from_bytes(&glb(document, binary), Format::Glb, "m.glb").expect("a mesh");
        let folder = tempfile::tempdir().expect("a temporary folder");
        let warnings = file.save(&folder.path().join("out.obj"), &file.points(), None).expect("saved");
        warnings.iter().map(|w| w.0.split(": ").last().unwrap_or_default().to_owned()).collect::<Vec<_>>().join("; ")
    };
    let (mut document, binary) = seam();
    assert_eq!(warning(&document, &binary), "instances of a mesh beyond its first");
    document["nodes"][1].as_object_mut().expect("an object").remove("mesh");
    assert_eq!(warning(&document, &binary), "");
    let attributes = json!({"POSITION": 0, "TANGENT": 0, "TEXCOORD_0": 0, "TEXCOORD_1": 0});
    let primitive = &mut document["meshes"][0]["primitives"][0];
    primitive["attributes"] = attributes;
    primitive["targets"] = json!([{"POSITION": 0}]);
    let lines = json!({"attributes": {"POSITION": 0}, "mode": 1});
    document["meshes"][0]["primitives"].as_array_mut().expect("a list").push(lines);
    document["animations"] = json!([{}]);
    let expected = "tangents, further texture coordinates, lines and points, morph targets, animations";
    assert_eq!(warning(&document, &binary), expected);
}
