//! From one format to another, and files made from nothing.

use super::support::{OBJ, obj, saved, seam_glb};
use crate::{Format, MeshFile, from_bytes};
use glam::DVec3;

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
