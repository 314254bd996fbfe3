//! Every way of writing a PLY file is read.

use super::model::{ENCODINGS, opened, ply, table, tables};
use glam::{DVec3, Vec2};

#[test]
fn any_order_of_elements_and_properties_is_read_in_every_encoding() {
    for encoding in ENCODINGS {
        for end in ["\n", "\r\n", "\r"] {
            let file = opened(&ply(encoding, end, &tables()));
            let expected = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [1.0, 1.25, 0.0], [0.0, 1.0, 0.5], [0.5, 2.0, 0.0]];
            assert_eq!(file.positions, expected.map(DVec3::from_array), "{encoding} {end:?}");
            assert_eq!(file.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 4]], "{encoding} {end:?}");
            assert_eq!(file.warnings, [], "{encoding} {end:?}");
            assert_eq!((file.rigidity, file.colors, file.uvs), (None, None, None), "{encoding} {end:?}");
        }
    }
}

#[test]
fn every_type_holds_positions_counts_and_indices() {
    let types = [
        "char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8", "int16", "uint16",
        "int32", "uint32", "float32", "float64",
    ];
    for encoding in ENCODINGS {
        for scalar in types {
            let leak = |text: String| -> &'static str { text.leak() };
            let position = ["x", "y", "z"].map(|axis| leak(format!("{scalar} {axis}")));
            let rows: &[&[f64]] = &[&[0.0, 0.0, 0.0], &[120.0, 0.0, 0.0], &[0.0, 3.0, 100.0]];
            let count = if scalar.starts_with(['f', 'd']) { "uchar" } else { scalar };
            let list = leak(format!("list {count} {scalar} vertex_index"));
            let faces = table("face", &[list], &[&[3.0, 2.0, 0.0, 1.0]]);
            let file = opened(&ply(encoding, "\n", &[table("vertex", &position, rows), faces]));
            let expected = [DVec3::ZERO, DVec3::new(120.0, 0.0, 0.0), DVec3::new(0.0, 3.0, 100.0)];
            assert_eq!(file.positions, expected, "{encoding} {scalar}");
            assert_eq!(file.triangles, [[2, 0, 1]], "{encoding} {scalar}");
        }
    }
}

#[test]
fn colors_and_texture_coordinates_are_read_by_all_their_names() {
    let place: &[&str] = &["float x", "float y", "float z"];
    let rows = |more: &[f64]| [0.0, 1.0, 2.0].map(|x| [&[x, x * x, 0.0], more].concat());
    let file = |properties: &[&'static str], more: &[f64]| {
        let rows = rows(more);
        let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
        let vertex = table("vertex", &[place, properties].concat(), &rows);
        opened(&ply(
            "ascii",
            "\n",
            &[vertex, table("face", &["list uchar int vertex_indices"], &[&[3.0, 0.0, 1.0, 2.0]])],
        ))
    };
    let color = |properties: &[&'static str], more: &[f64]| file(properties, more).colors.expect("colors")[1];
    assert_eq!(color(&["uchar red", "uchar green", "uchar blue"], &[255.0, 0.0, 51.0]), [1.0, 0.0, 0.2, 1.0]);
    let with_alpha = &["uchar red", "uchar green", "uchar blue", "uchar alpha"];
    assert_eq!(color(with_alpha, &[0.0, 255.0, 0.0, 51.0]), [0.0, 1.0, 0.0, 0.2]);
    assert_eq!(color(&["float red", "float green", "float blue"], &[1.0, 0.25, 0.5]), [1.0, 0.25, 0.5, 1.0]);
    let diffuse = &["ushort diffuse_red", "ushort diffuse_green", "ushort diffuse_blue"];
    assert_eq!(color(diffuse, &[65535.0, 0.0, 13107.0]), [1.0, 0.0, 0.2, 1.0]);
    assert_eq!(file(&["uchar red", "uchar green"], &[1.0, 2.0]).colors, None, "two channels are no color");
    for names in [["float s", "float t"], ["float u", "float v"], ["double texture_u", "double texture_v"]] {
        assert_eq!(file(&names, &[0.25, 0.75]).uvs.expect("coordinates")[2], Vec2::new(0.25, 0.75), "{names:?}");
    }
}

#[test]
fn strips_become_triangles_that_face_one_way() {
    let rows: &[&[f64]] = &[&[0.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[1.0, 0.0, 0.0], &[1.0, 1.0, 0.0], &[2.0, 0.0, 0.0]];
    let vertex = table("vertex", &["float x", "float y", "float z"], rows);
    // Two strips; the doubled 3 only leads on.
    let strip: &[f64] = &[10.0, 0.0, 2.0, 1.0, 3.0, 3.0, -1.0, 2.0, 4.0, 3.0, 3.0];
    let strips = table("tristrips", &["list int int vertex_indices"], &[strip]);
    let file = opened(&ply("binary_little_endian", "\n", &[vertex, strips]));
    assert_eq!(file.triangles, [[0, 2, 1], [1, 2, 3], [2, 4, 3]]);
}

#[test]
fn numbers_of_a_vertex_may_stand_on_several_lines() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n\n0\n0 0\n+1 0 -0\n\n1e0 1.\t.5\n3 0\n1 2";
    let file = opened(text.as_bytes());
    assert_eq!(file.positions, [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.5)]);
    assert_eq!(file.triangles, [[0, 1, 2]]);
}

#[test]
fn oddities_are_told_and_do_not_stop_opening() {
    let text = "ply\nformat ascii 1.0\nCreated by someone\nelement vertex 3\nproperty float x\nproperty float y\n\
                property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n\
                0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n1 2 3\n";
    let warnings: Vec<String> = opened(text.as_bytes()).warnings.into_iter().map(|warning| warning.0).collect();
    let expected = [
        "line 3 of the header begins with Created and is passed over",
        "6 bytes after the last element are kept and not read",
        "1 faces have fewer than three corners and were skipped",
    ];
    assert_eq!(warnings, expected);
}
