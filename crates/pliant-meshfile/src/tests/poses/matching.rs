//! Files as poses: which are taken, and what is said of the others.

use super::super::support::{assert_near, obj};
use super::model::{Model, collect, frames};
use crate::poses::{Found, Parted, PoseError, PoseOptions, Poses};
use crate::{MeshFile, open};
use glam::DVec3;
use serde_json::json;
use std::path::PathBuf;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// A file in a folder of its own, which is removed with it.
fn written(name: &str, content: impl AsRef<[u8]>) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join(name);
    std::fs::write(&path, content).expect("a new file");
    (folder, path)
}

fn refusal(text: &str, reference: &MeshFile) -> PoseError {
    let file = written("pose.obj", text);
    Poses::open(&file.1, reference, PoseOptions::default()).map(|_| ()).expect_err("another mesh")
}

#[test]
fn a_file_with_the_same_faces_is_a_pose() {
    let reference = obj(SQUARE);
    let file = written("pose.obj", SQUARE.replace("v 0 1 0", "v 0 1 5"));
    let (poses, _) = collect(Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose"));
    assert_eq!(poses.len(), 1);
    assert_eq!(poses[0].name, file.1.display().to_string());
    assert_eq!(poses[0].points[3], DVec3::new(0.0, 1.0, 5.0));
}

#[test]
fn other_meshes_are_refused_with_the_first_difference() {
    let reference = obj(SQUARE);
    let said = |text: &str| {
        let error = refusal(text, &reference);
        let faces = error.only_faces_differ();
        (error.to_string().split_once(".obj: ").expect("a file").1.to_owned(), faces)
    };
    let counts = "is no pose of the reference: it has 5 vertices and 3 triangles instead of 4 and 2";
    assert_eq!(said(&format!("v 9 9 9\n{SQUARE}f 1 2 5\n")), (counts.to_owned(), false));
    let counts = "is no pose of the reference: it has 4 vertices and 1 triangles instead of 4 and 2";
    assert_eq!(said(&SQUARE.replace("f 1 3 4\n", "")), (counts.to_owned(), true));
    let face = "is no pose of the reference: triangle 1 has vertices 1, 2, 3 instead of 0, 2, 3";
    assert_eq!(said(&SQUARE.replace("f 1 3 4", "f 2 3 4")), (face.to_owned(), true));
    let apart = "is no pose of the reference: triangles 0 and 1 meet at vertex 2 of the reference and not in this file";
    let six = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 3 3 3\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    assert_eq!(said(six), (apart.to_owned(), false));
    let error = Poses::open("nowhere.obj".as_ref(), &reference, PoseOptions::default()).expect_err("no file");
    assert!(error.to_string().starts_with("nowhere.obj: cannot be read"), "{error}");
}

#[test]
fn on_request_the_faces_are_taken_from_the_reference() {
    let reference = obj(SQUARE);
    let flipped = SQUARE.replace("f 1 2 3\nf 1 3 4", "f 1 2 4\nf 2 3 4").replace("v 1 1 0", "v 1 1 1");
    let options = PoseOptions { reference_faces: true, ..PoseOptions::default() };
    let file = written("pose.obj", &flipped);
    let (poses, _) = collect(Poses::open(&file.1, &reference, options).expect("a pose"));
    assert_eq!(poses[0].points[2], DVec3::ONE);
    let file = written("pose.obj", format!("v 0 0 0\n{flipped}"));
    assert!(Poses::open(&file.1, &reference, options).is_err(), "another number of vertices is another mesh");
}

#[test]
fn a_polygon_is_the_same_wherever_it_was_cut() {
    // A pentagon that is convex at rest, and dented so that it has to be cut elsewhere.
    let text = |y: f64| format!("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 {y} 0\nv 0 2 0\nf 1 2 3 4 5\nf 1 2 4\n");
    let (reference, dented) = (obj(&text(3.0)), obj(&text(0.5)));
    assert_ne!(reference.triangles[..3], dented.triangles[..3]);
    let file = written("pose.obj", text(0.5));
    let (poses, _) = collect(Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose"));
    assert_eq!(poses[0].points[3], DVec3::new(1.0, 0.5, 0.0));
    let other = text(0.5).replace("f 1 2 3 4 5", "f 1 2 3 5 4");
    assert!(refusal(&other, &reference).only_faces_differ());
}

#[test]
fn files_that_list_a_place_once_for_every_corner_are_compared_through_welding() {
    let reference = obj(&format!("v 7 7 7\n{}", SQUARE.replace("f 1 2 3\nf 1 3 4", "f 2 3 4\nf 2 4 5")));
    let soup = "v 0 0 0\nv 1 0 0\nv 1 1 2\nv 0 0 0\nv 1 1 2\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    let file = written("pose.obj", soup);
    let (poses, _) = collect(Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose"));
    // Vertex 0 of the reference is used by no triangle and stays.
    let expected = [[7.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 2.0], [0.0, 1.0, 0.0]].map(DVec3::from_array);
    assert_eq!(poses[0].points, expected);
    // The other way round: the reference is the soup.
    let reference = obj(soup);
    let file = written("pose.obj", SQUARE.replace("v 1 0 0", "v 1 0 4"));
    let (poses, _) = collect(Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose"));
    let expected = [[0.0; 3], [1.0, 0.0, 4.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(DVec3::from_array);
    assert_eq!(poses[0].points, expected);
}

#[test]
fn vertices_of_one_point_that_part_are_put_in_their_middle() {
    let soup = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
    let reference = obj(soup);
    let torn = soup.replacen("v 1 1 0", "v 1 1 1", 1);
    let file = written("pose.obj", torn);
    let (poses, _) = collect(Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose"));
    assert_eq!(poses[0].points[2], DVec3::new(1.0, 1.0, 0.5));
    assert_eq!(poses[0].parted, Some(Parted { points: 1, widest: 0.5 }));
}

/// The strip `0..n` of unit squares without any shared vertex, its triangles in this order, lifted along it by `lift`.
fn soup(order: impl Iterator<Item = usize>, lift: impl Fn(f64) -> f64) -> String {
    let (mut text, mut n) = (String::new(), 0);
    for triangle in order {
        // Odd corners lie at z = 1.
        for corner in if triangle % 2 == 0 { [0, 1, 2] } else { [2, 1, 3] } {
            let (x, z) = ((corner / 2 + triangle / 2) as f64, corner % 2);
            text += &format!("v {x} {} {z}\n", lift(x));
        }
        n += 1;
    }
    (0..n).for_each(|t| text += &format!("f {} {} {}\n", 3 * t + 1, 3 * t + 2, 3 * t + 3));
    text
}

#[test]
fn soups_of_triangles_are_compared_by_what_meets_in_them() {
    let n = 40;
    let reference = obj(&soup(0..n, |_| 0.0));
    assert_eq!(reference.weld.n_points(), n + 2);
    let bent = written("bent.obj", soup(0..n, |x| 0.1 * x * x));
    let (poses, _) = collect(Poses::open(&bent.1, &reference, PoseOptions::default()).expect("a pose"));
    assert_eq!(poses[0].parted, None);
    // The faces of all these are 0, 1, 2 and so on: their order alone tells that they are others.
    for other in
        [soup((0..n).rev(), |_| 0.0), soup((0..n).map(|t| t * 7 % n), |_| 0.0), soup((0..n).map(|t| t ^ 1), |_| 0.0)]
    {
        let error = refusal(&other, &reference).to_string();
        assert!(
            error.contains("is no pose of the reference: triangles 0 and ") && error.contains("meet at"),
            "{error}"
        );
        let options = PoseOptions { reference_faces: true, ..PoseOptions::default() };
        let file = written("pose.obj", &other);
        assert!(Poses::open(&file.1, &reference, options).is_ok(), "taken when a person vouches for it");
    }
}

#[test]
fn another_unit_is_divided_out_on_request_only() {
    let reference = obj(SQUARE);
    let file = written("pose.obj", "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 60 80\nf 1 2 3\nf 1 3 4\n");
    let options = PoseOptions { match_scale: true, ..PoseOptions::default() };
    let stream = Poses::open(&file.1, &reference, options).expect("a pose");
    assert_eq!(stream.scale(), 100.0);
    assert_near(&collect(stream).0[0].points[3..], &[DVec3::new(0.0, 0.6, 0.8)], 1e-15);
    let stream = Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose");
    assert_eq!(stream.scale(), 1.0);
    assert_eq!(collect(stream).0[0].points[3], DVec3::new(0.0, 60.0, 80.0));
    let file = written("pose.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\nf 1 3 4\n");
    let error = Poses::open(&file.1, &reference, options).expect_err("a point").to_string();
    assert!(error.ends_with("pose.obj: has no extent that its scale could be found by"), "{error}");
}

#[test]
fn a_moved_copy_of_the_reference_is_passed_over() {
    let reference = obj(SQUARE);
    let file = written("pose.obj", "v 5 0 0\nv 5 1 0\nv 4 1 0\nv 4 0 0\nf 1 2 3\nf 1 3 4\n");
    let found: Vec<_> = Poses::open(&file.1, &reference, PoseOptions::default()).expect("a pose").collect();
    assert!(matches!(&found[..], [Ok(Found::Alike { .. })]), "{found:?}");
}

#[test]
fn another_file_gives_its_shape_its_targets_and_its_frames() {
    // The reference lists each place once; the other file is the same strip as glTF, lifted at one end.
    let mut model = Model::strip(2);
    let strip: String = (0..6).map(|v| format!("v {} 0 {}\n", v / 2, v % 2)).collect();
    let reference = obj(&format!("{strip}f 1 2 3\nf 3 2 4\nf 3 4 5\nf 5 4 6\n"));
    let lift: Vec<f32> = (0..6).flat_map(|v| [0.0, if v > 3 { 1.0 } else { 0.0 }, 0.0]).collect();
    let target = model.floats("VEC3", &lift);
    model.document["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": target}]);
    let times = model.floats("SCALAR", &[0.0, 1.0]);
    let scales = model.floats("VEC3", &[1.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
    model.channel("Stretch", 0, "scale", [times, scales], "LINEAR");
    let tips = |model: &Model| -> Vec<DVec3> {
        let file = written("moving.glb", model.bytes());
        let (poses, _) = collect(Poses::open(&file.1, &reference, frames(2)).expect("poses"));
        poses.iter().map(|pose| pose.points[4]).collect()
    };
    let expected = [[2.0, 1.0, 0.0], [6.0, 0.0, 0.0]].map(DVec3::from_array);
    assert_eq!(tips(&model), expected, "the shape is the reference's and none of the poses");
    model.binary[12 * 4 + 4..12 * 4 + 8].copy_from_slice(&(-1f32).to_le_bytes());
    let expected = [[2.0, -1.0, 0.0], [2.0, 0.0, 0.0], [2.0, -1.0, 0.0], [6.0, -1.0, 0.0]].map(DVec3::from_array);
    assert_eq!(tips(&model), expected);
    assert!(open("nowhere.glb".as_ref()).is_err());
}
