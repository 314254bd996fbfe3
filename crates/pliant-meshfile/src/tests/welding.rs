//! Which vertices of a file are one point, and what a deformation does to those that are.

use super::poses::model::Model;
use super::support::{OBJ, assert_near, obj, saved};
use crate::{Format, MeshFile, OpenOptions, Welding};
use glam::{DQuat, DVec3};
use serde_json::json;
use std::ops::ControlFlow;

fn opened(text: &str, welding: Welding) -> MeshFile {
    let options = OpenOptions { welding, ..OpenOptions::default() };
    options.from_bytes(text.as_bytes(), Format::Obj, "test.obj").unwrap_or_else(|error| panic!("{error}"))
}

/// Two triangles whose common edge was written twice, 0.01 apart at one end and 0.003 at the other.
const GAP: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.01 0 0\nv 1 1 0.003\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";

/// A strip of one square cut along its diagonal, whose two triangles are carried by `carried`: skin, and the weight of
/// its first joint of two. A tuple of the same skin and weight twice is what a seam looks like.
fn carried(carried: [(Option<usize>, f32); 2]) -> MeshFile {
    let mut model = Model::strip(1);
    model.document["nodes"] = json!([{"name": "a"}, {"name": "b"}, {"name": "c"}]);
    model.document["skins"] = json!([{"joints": [0, 1]}, {"joints": [1, 2]}, {"joints": [0, 1]}]);
    let joints = model.accessor(&[0, 1, 0, 0].repeat(3), json!({"componentType": 5121, "count": 3, "type": "VEC4"}));
    let corners = [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]];
    let mut meshes = Vec::new();
    for (i, (skin, weight)) in carried.into_iter().enumerate() {
        let positions = model.floats("VEC3", &corners[i]);
        let weights = model.floats("VEC4", &[weight, 1.0 - weight, 0.0, 0.0].repeat(3));
        let mut attributes = json!({"POSITION": positions});
        let mut node = json!({"mesh": i});
        if let Some(skin) = skin {
            attributes["JOINTS_0"] = joints.into();
            attributes["WEIGHTS_0"] = weights.into();
            node["skin"] = skin.into();
        }
        meshes.push(json!({"primitives": [{"attributes": attributes}]}));
        model.document["nodes"].as_array_mut().expect("a list").push(node);
    }
    model.document["meshes"] = meshes.into();
    model.document["scenes"] = json!([{"nodes": [0, 1, 2, 3, 4]}]);
    model.open()
}

#[test]
fn the_seam_copies_of_one_skinned_mesh_are_one_point() {
    assert_eq!(carried([(Some(0), 0.25), (Some(0), 0.25)]).weld.point_of_vertex, [0, 1, 2, 0, 2, 3]);
    // What two short weights make of one number.
    assert_eq!(carried([(Some(0), 63.0 / 255.0), (Some(0), 65.0 / 255.0)]).weld.n_points(), 4);
    // A skin that is written twice is one skin.
    assert_eq!(carried([(Some(0), 0.25), (Some(2), 0.25)]).weld.n_points(), 4);
}

#[test]
fn meshes_that_touch_stay_apart_where_skins_or_weights_would_tear_them() {
    for other in [(Some(1), 0.25), (Some(0), 0.5), (Some(0), 0.27), (None, 0.25)] {
        let file = carried([(Some(0), 0.25), other]);
        assert_eq!(file.weld.n_points(), 6, "{other:?}");
        assert_eq!(file.points().len(), 6);
    }
    assert_eq!(carried([(None, 0.0), (None, 1.0)]).weld.n_points(), 4, "no skin carries either");
}

#[test]
fn a_distance_closes_gaps_and_says_what_it_did() {
    assert_eq!(opened(GAP, Welding::Exact).weld.n_points(), 6);
    assert_eq!(opened(GAP, Welding::Within(0.005)).weld.point_of_vertex, [0, 1, 2, 3, 2, 4]);
    let file = opened(GAP, Welding::Within(0.01));
    assert_eq!(file.weld.point_of_vertex, [0, 1, 2, 0, 2, 3]);
    let said: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(said, ["2 vertices were welded to others within 0.01 (farthest: 0.01)"]);
    let error = OpenOptions { welding: Welding::Within(3.0), ..OpenOptions::default() }.from_bytes(
        GAP.as_bytes(),
        Format::Obj,
        "gap.obj",
    );
    let error = error.expect_err("all is one point").to_string();
    assert!(error.starts_with("gap.obj: welding within 3 leaves no surface"), "{error}");
}

#[test]
fn welded_vertices_keep_their_offsets_through_a_deformation() {
    let file = opened(GAP, Welding::Within(0.01));
    let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.0);
    let rigid = |p: DVec3| turn * p + DVec3::new(3.0, 4.0, 5.0);
    let moved: Vec<DVec3> = file.points().into_iter().map(rigid).collect();
    let (_, again) = saved(&file, "turned.obj", &moved, None);
    let expected: Vec<DVec3> = file.positions.iter().map(|&p| rigid(p)).collect();
    // Rounding of coordinates up to 7, some operations long.
    assert_near(&again.positions, &expected, 1e-13);
    // One point moves: its vertices by the same, all others stay to the bit.
    let mut points = file.points();
    points[2] += DVec3::new(0.0, 0.0, 0.5);
    let (bytes, again) = saved(&file, "pulled.obj", &points, None);
    let text = String::from_utf8(bytes).expect("text");
    let changed: Vec<usize> = (0..8).filter(|&i| text.lines().nth(i) != GAP.lines().nth(i)).collect();
    assert_eq!(changed, [2, 4], "lines that changed");
    assert_eq!(again.positions[2], DVec3::new(1.0, 1.0, 0.5));
    let offset = again.positions[4] - again.positions[2];
    assert!((offset.length() - 0.003).abs() < 1e-15, "offset {offset}");
}

#[test]
fn saving_an_untouched_file_gives_the_same_bytes_however_it_was_welded() {
    for welding in [Welding::Exact, Welding::Within(0.01), Welding::Never] {
        let file = opened(GAP, welding);
        let (bytes, _) = saved(&file, "same.obj", &file.points(), None);
        assert_eq!(String::from_utf8_lossy(&bytes), GAP, "{welding}");
    }
}

#[test]
fn unwelded_copies_are_saved_where_each_of_them_went() {
    let text = GAP.replace("0.01", "0").replace("0.003", "0");
    let file = opened(&text, Welding::Never);
    assert_eq!((file.weld.n_points(), opened(&text, Welding::Exact).weld.n_points()), (6, 4));
    let points: Vec<DVec3> = (0..6).map(|i| file.positions[i] + DVec3::Z * i as f64).collect();
    let (_, again) = saved(&file, "apart.obj", &points, None);
    assert_eq!(again.positions, points);
}

#[test]
fn order_and_attributes_are_those_of_the_file_however_it_is_welded() {
    let file = obj(OBJ);
    for welding in [Welding::Within(0.3), Welding::Never] {
        let other = opened(OBJ, welding);
        assert_eq!((&other.positions, &other.triangles), (&file.positions, &file.triangles), "{welding}");
        assert_eq!((&other.uvs, &other.parts), (&file.uvs, &file.parts), "{welding}");
    }
}

#[test]
fn progress_ascends_to_one_and_may_stop_the_opening() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("gap.obj");
    std::fs::write(&path, GAP).expect("a file");
    let mut told = Vec::new();
    let opened = OpenOptions::default().open_with_progress(&path, &mut |fraction| {
        told.push(fraction);
        ControlFlow::Continue(())
    });
    opened.expect("nobody stopped it");
    assert!(told.is_sorted() && told.last() == Some(&1.0), "{told:?}");
    for stop_at in 0..told.len() {
        let mut n_told = 0;
        let stopped = OpenOptions::default().open_with_progress(&path, &mut |_| {
            n_told += 1;
            if n_told > stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let error = stopped.expect_err("stopped");
        assert!(error.is_canceled() && n_told == stop_at + 1, "stop {stop_at}: {error}, told {n_told} times");
    }
}

#[test]
fn opening_any_text_or_table_tells_how_far_it_is_and_stops_when_asked() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let n = 30_000;
    let vertices: Vec<DVec3> = (0..n).map(|i| DVec3::new(f64::from(i), f64::from(i % 7), 0.0)).collect();
    let triangles = (0..n as u32 - 2).map(|i| [i, i + 1, i + 2]).collect();
    let start = MeshFile::from_triangles("strip", vertices, triangles);
    for name in ["strip.ply", "strip.stl", "strip.off"] {
        let path = folder.path().join(name);
        start.save(&path, &start.points(), None).expect("saved");
        let mut told = Vec::new();
        let opened = OpenOptions::default().open_with_progress(&path, &mut |fraction| {
            told.push(fraction);
            ControlFlow::Continue(())
        });
        opened.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(told.is_sorted() && told.last() == Some(&1.0), "{name}: {told:?}");
        // Reading the content is what lies between these.
        let inside = told.iter().filter(|fraction| (0.15..0.75).contains(*fraction)).count();
        assert!(inside >= 1, "{name}: {told:?}");
        let stop = |fraction: f64| if fraction > 0.15 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
        let error = OpenOptions::default().open_with_progress(&path, &mut { stop }).expect_err("stopped");
        assert!(error.is_canceled(), "{name}: {error}");
    }
}
