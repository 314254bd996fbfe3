//! What saving a PLY file changes, and what it does not.

use super::model::{ENCODINGS, Table, opened, ply, table, tables};
use crate::tests::support::{assert_near, bent, saved};
use glam::DVec3;

#[test]
fn saving_an_untouched_file_gives_the_same_bytes() {
    for encoding in ENCODINGS {
        for end in ["\n", "\r\n", "\r"] {
            let mut bytes = ply(encoding, end, &tables());
            bytes.extend(b"\x00 what follows \xff");
            let file = opened(&bytes);
            let (out, _) = saved(&file, "same.ply", &file.points(), None);
            assert_eq!(out, bytes, "{encoding} {end:?}");
        }
    }
}

#[test]
fn a_bend_changes_positions_and_normals_and_no_other_number() {
    for encoding in ENCODINGS {
        let before = tables();
        let file = opened(&ply(encoding, "\r\n", &before));
        let points = bent(&file.points());
        let (out, again) = saved(&file, "bent.ply", &points, None);
        // The same tables, with what is expected to change taken from the reader.
        let mut after: Vec<Table> = tables();
        for (vertex, row) in after[2].rows.iter_mut().enumerate() {
            let behind_tags = 4 + row[3] as usize;
            let position = again.positions[vertex];
            (row[1], row[2], row[behind_tags]) = (position.y, position.x, position.z);
        }
        let expected = ply(encoding, "\r\n", &after);
        assert_eq!(out.len(), if encoding == "ascii" { out.len() } else { expected.len() }, "{encoding}");
        // y is double and stays exact; x and z are float.
        assert_near(&again.positions, &points, 1e-6);
        for (vertex, (got, wanted)) in again.positions.iter().zip(&points).enumerate() {
            assert_eq!(got.y, wanted.y, "{encoding}, vertex {vertex}");
            assert_eq!(got.z, f64::from(wanted.z as f32), "{encoding}, vertex {vertex}");
        }
        assert_eq!(again.triangles, file.triangles, "{encoding}");
        if encoding == "ascii" {
            only_geometry_differs(&out, &ply(encoding, "\r\n", &before));
        } else {
            // Normals are the last twelve bytes of a vertex; all other bytes are as expected.
            let start = expected.len() - 8;
            assert_eq!(out[start..], expected[start..], "{encoding}: the edges behind the vertices");
            let differing = out.iter().zip(&expected).filter(|(a, b)| a != b).count();
            assert!(differing <= 5 * 12, "{encoding}: {differing} bytes differ");
        }
    }
}

/// Of the words of two texts only those of moved vertices may differ.
fn only_geometry_differs(out: &[u8], before: &[u8]) {
    let [out, before] = [out, before].map(|bytes| String::from_utf8(bytes.to_vec()).expect("text"));
    let lines: Vec<(&str, &str)> = out.split("\r\n").zip(before.split("\r\n")).collect();
    assert_eq!(lines.len(), before.split("\r\n").count(), "number of lines");
    let vertices = before.split("\r\n").position(|line| line.starts_with("7  ")).expect("the first vertex");
    for (i, (new, old)) in lines.iter().enumerate() {
        // The first vertex does not move, but its normal turns with the faces around it.
        if !(vertices..vertices + 5).contains(&i) {
            assert_eq!(new, old, "line {}", i + 1);
            continue;
        }
        let words = |line: &str| line.split("  ").map(str::to_owned).collect::<Vec<_>>();
        let (new, old) = (words(new), words(old));
        assert_eq!(new.len(), old.len(), "line {}", i + 1);
        assert_eq!(new[0], old[0], "line {}: kind", i + 1);
        assert_eq!(new[3..old.len() - 4], old[3..old.len() - 4], "line {}: tags", i + 1);
    }
    assert!(lines[vertices].0.starts_with("7  0  0  0  0  "), "the unmoved vertex: {}", lines[vertices].0);
}

#[test]
fn numbers_that_did_not_change_keep_their_text() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty double z\n\
                property uchar red\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n\
                0.000 -0 0e0 001\n 1.50\t0.10 0 002 \n0 1 0 003\n3 0 1 2\n";
    let file = opened(text.as_bytes());
    let mut points = file.points();
    points[1].y = 0.3;
    points[2].z = 0.1 + 0.2;
    let (out, again) = saved(&file, "text.ply", &points, None);
    let expected =
        text.replace("1.50\t0.10 0 002", "1.50\t0.3 0 002").replace("0 1 0 003", "0 1 0.30000000000000004 003");
    assert_eq!(String::from_utf8(out).expect("text"), expected);
    assert_eq!(again.points(), points);
}

#[test]
fn normals_turn_with_their_faces() {
    for scalar in ["float", "char"] {
        let leak = |text: String| -> &'static str { text.leak() };
        let names = ["nx", "ny", "nz"].map(|name| leak(format!("{scalar} {name}")));
        let properties = [&["float x", "float y", "float z"][..], &names].concat();
        // Of whole numbers a normal is as long as its type allows.
        let length = if scalar == "char" { 127.0 } else { 1.0 };
        let rows = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| vec![x, y, 0.0, 0.0, 0.0, length]);
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        let faces = table("face", &["list uchar int vertex_indices"], &[&[3.0, 0.0, 1.0, 2.0]]);
        let file = opened(&ply("ascii", "\n", &[table("vertex", &properties, &rows), faces]));
        let turned: Vec<DVec3> = file.points().iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
        let (out, _) = saved(&file, "turned.ply", &turned, None);
        let text = String::from_utf8(out).expect("text");
        let normals: Vec<Vec<f64>> = text
            .lines()
            .filter(|line| line.split_whitespace().count() == 6)
            .map(|line| line.split_whitespace().skip(3).map(|word| word.parse().expect("a number")).collect())
            .collect();
        assert_eq!(normals.len(), 3);
        for normal in normals {
            let [x, y, z] = [normal[0], normal[1], normal[2]];
            assert!(DVec3::new(x, y, z).distance(DVec3::NEG_Y * length) < 1e-6 * length, "{scalar}: {x} {y} {z}");
        }
    }
}

#[test]
fn whole_numbers_are_widened_when_a_bend_needs_more_and_only_then() {
    for encoding in ENCODINGS {
        for (scalar, wide) in [("short", "float"), ("int32", "double")] {
            let leak = |text: String| -> &'static str { text.leak() };
            let properties = ["x", "y", "z"].map(|axis| leak(format!("{scalar} {axis}")));
            let properties = [&properties[..], &["uchar kind"]].concat();
            let rows: &[&[f64]] = &[&[0.0, 0.0, 0.0, 1.0], &[10.0, 0.0, 0.0, 2.0], &[0.0, 10.0, 0.0, 3.0]];
            let tables = [
                table("vertex", &properties, rows),
                table("face", &["list uchar int vertex_indices"], &[&[3.0, 0.0, 1.0, 2.0]]),
            ];
            let bytes = ply(encoding, "\n", &tables);
            let file = opened(&bytes);
            let mut points = file.points();
            points[1].z = -3.0;
            let (out, again) = saved(&file, "whole.ply", &points, None);
            assert_eq!(again.points(), points, "{encoding} {scalar}");
            assert!(encoding == "ascii" || out.len() == bytes.len(), "{encoding} {scalar}: the type stays");
            points[1].z = 0.5;
            let folder = tempfile::tempdir().expect("a temporary folder");
            let path = folder.path().join("wide.ply");
            let warnings = file.save(&path, &points, None).expect("saved");
            assert_eq!(crate::open(&path).expect("a mesh").points(), points, "{encoding} {scalar}");
            assert_eq!(warnings.len(), 3, "{encoding} {scalar}: {warnings:?}");
            assert!(warnings[0].0.contains(&format!("became {wide}")), "{warnings:?}");
            let header = String::from_utf8_lossy(&std::fs::read(&path).expect("the file")).into_owned();
            assert!(
                header
                    .contains(&format!("property {wide} x\nproperty {wide} y\nproperty {wide} z\nproperty uchar kind"))
            );
        }
    }
}

#[test]
fn positions_beyond_the_range_of_the_file_are_refused() {
    let file = opened(&ply("binary_big_endian", "\n", &tables()));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut points = file.points();
    points[3].x = 1e39;
    let error = file.save(&folder.path().join("far.ply"), &points, None).expect_err("x is float").to_string();
    assert!(error.contains("the position of vertex 3 is not finite or too large"), "{error}");
    (points[3].x, points[3].y) = (0.0, 1e39);
    file.save(&folder.path().join("far.ply"), &points, None).expect("y is double");
}
