//! From one format to another, and files made from nothing.

use super::support::{OBJ, assert_near, bent, glb, obj, saved, seam, seam_glb};
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
    for name in ["t.glb", "t.gltf", "t.obj", "t.ply", "t.off"] {
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
    assert_eq!(n, 2, "the file and its backup, no temporary");
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

/// A concave pentagon, a quad and a triangle around a corner, with colors.
const POLYGONS: &str = "v 0 0 0 1 0 0\nv 2 0 0 0 1 0\nv 1 0.5 0 0 0 1\nv 2 2 0 1 1 0\nv 0 2 0.1 0 1 1\nv 0 0 3 1 1 1\n\
v 0.1 2 3 0 0 0\no Thing\nf 1 2 3 4 5\nf 1 5 7 6\nf 2 1 6\n";

fn names() -> [&'static str; 6] {
    ["out.obj", "out.gltf", "out.glb", "out.ply", "out.stl", "out.off"]
}

#[test]
fn every_format_becomes_every_other_with_its_places_triangles_and_rigidity() {
    let start = obj(POLYGONS);
    let r: Vec<u16> = (1..=7).collect();
    for first in names() {
        let (_, from) = saved(&start, first, &start.points(), Some(&r));
        for second in names() {
            let (_, to) = saved(&from, second, &bent(&from.points()), None);
            let places = |file: &MeshFile| {
                file.triangles.iter().flatten().map(|&v| file.positions[v as usize]).collect::<Vec<_>>()
            };
            let expected = bent(&from.points());
            let expected: Vec<DVec3> = from.point_triangles().iter().flatten().map(|&p| expected[p as usize]).collect();
            assert_near(&places(&to), &expected, 4.0 * f64::from(f32::EPSILON));
            let of_corners = |file: &MeshFile| {
                let (r, disagree) = file.point_rigidity().expect("rigidity");
                assert!(!disagree, "{first} to {second}");
                file.point_triangles().iter().flatten().map(|&p| r[p as usize]).collect::<Vec<_>>()
            };
            assert_eq!(of_corners(&to), of_corners(&from), "{first} to {second}");
            let expected: Vec<u16> = start.triangles.iter().flatten().map(|&v| r[v as usize]).collect();
            assert_eq!(of_corners(&from), expected, "{first}");
        }
    }
}

#[test]
fn polygons_and_colors_go_from_format_to_format_where_both_hold_them() {
    let start = obj(POLYGONS);
    let holders = ["out.obj", "out.ply", "out.off"];
    for first in holders {
        let (_, from) = saved(&start, first, &start.points(), None);
        for second in holders {
            let (_, to) = saved(&from, second, &from.points(), None);
            assert_eq!(to.polygons(), [0..3, 3..5], "{first} to {second}");
            assert_eq!(to.triangles, start.triangles, "{first} to {second}");
            assert_eq!(to.positions.len(), 7, "{first} to {second}");
            let (got, expected) = (to.colors.expect("colors"), start.colors.as_ref().expect("colors"));
            assert_eq!(&got, expected, "{first} to {second}");
        }
    }
}

#[test]
fn seams_and_hard_edges_survive_formats_whose_corners_have_nothing_of_their_own() {
    let start = obj(OBJ);
    for name in ["out.ply", "out.off", "out.glb"] {
        let (_, to) = saved(&start, name, &start.points(), Some(&[1, 2, 3, 4, 5]));
        assert_eq!(to.positions[..5], start.positions[..], "{name}: the old vertices come first");
        // Vertices 0 and 1 have two normals each.
        assert_eq!(to.positions.len(), 7, "{name}");
        assert_eq!(to.point_triangles(), start.point_triangles(), "{name}");
        assert_eq!(to.point_rigidity(), Some((vec![1, 2, 3, 4, 5], false)), "{name}");
        assert_eq!(to.uvs.map(|uvs| uvs[2]), Some(glam::Vec2::ONE), "{name}");
    }
}

#[test]
fn what_a_format_cannot_hold_is_told() {
    let said = |file: &MeshFile, name: &str| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let warnings = file.save(&folder.path().join(name), &file.points(), None).expect("saved");
        warnings.iter().map(|w| w.0.split(": ").last().unwrap_or_default().to_owned()).collect::<Vec<_>>().join("; ")
    };
    let numbering = "the numbering of vertices, of which every triangle gets its own";
    let polygons = obj(POLYGONS);
    assert_eq!(said(&polygons, "out.ply"), "");
    assert_eq!(said(&polygons, "out.off"), "");
    assert_eq!(said(&polygons, "out.glb"), "polygons of more than three corners");
    let expected = format!("polygons of more than three corners, colors of vertices, {numbering}");
    assert_eq!(said(&polygons, "out.stl"), expected);
    let rich = obj(OBJ);
    let expected =
        "textures and material settings beyond the base color, lines and points, names and borders of parts, materials";
    assert_eq!(said(&rich, "out.ply"), expected);
    let expected = format!(
        "textures and material settings beyond the base color, lines and points, polygons of more than three corners, \
         names and borders of parts, materials, texture coordinates, normals of vertices, {numbering}"
    );
    assert_eq!(said(&rich, "out.stl"), expected);
}

#[test]
fn a_mesh_far_from_the_origin_keeps_its_details_or_says_so() {
    let far = DVec3::new(4.5e6, 5.4e6, 0.0);
    let file = obj(POLYGONS);
    let points: Vec<DVec3> = file.points().iter().map(|p| *p + far).collect();
    let (_, to) = saved(&file, "out.ply", &points, None);
    assert_eq!(to.points(), points, "in double precision");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let warnings = file.save(&folder.path().join("out.stl"), &points, None).expect("saved");
    assert!(warnings.iter().any(|w| w.0.contains("rounds its details")), "{warnings:?}");
}
