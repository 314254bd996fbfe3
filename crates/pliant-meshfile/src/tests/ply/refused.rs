//! PLY files that are refused, each with one line that says where and what.

use super::model::{Table, ply, table};
use crate::tests::bad_files::refused;
use crate::{
    Format,
    tests::mutation::{survives, survives_saving},
};

/// A text with these lines for the header's element lines and the body.
fn text(vertex: &str, face: &str, body: &str) -> Vec<u8> {
    let place = "property float x\nproperty float y\nproperty float z\n";
    let faces = "property list uchar int vertex_indices\n";
    format!("ply\nformat ascii 1.0\n{vertex}\n{place}{face}\n{faces}end_header\n{body}").into_bytes()
}

#[test]
fn bad_headers_are_refused_by_line() {
    for (header, expected) in [
        ("", "does not begin with the line ply"),
        ("plywood\n", "does not begin with the line ply"),
        ("ply\n", "there is no line end_header"),
        ("ply\nformat ascii 1.0\nend_header", "there is no line end_header"),
        ("ply\nend_header\n", "names no format"),
        ("ply\nformat utf8 1.0\nend_header\n", "line 2: the format is utf8"),
        ("ply\nformat ascii 2.0\nend_header\n", "line 2: is PLY version 2.0"),
        ("ply\nformat ascii 1.0\nproperty int x\nend_header\n", "line 3: a property comes before any element"),
        ("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "line 3: -1 is no count of elements"),
        ("ply\nformat ascii 1.0\nelement vertex\nend_header\n", "line 3: element vertex has no count"),
        ("ply\nformat ascii 1.0\nelement v 1\nelement v 1\nend_header\n", "line 4: element v is declared twice"),
        ("ply\nformat ascii 1.0\nelement v 1\nproperty int64 x\nend_header\n", "line 4: int64 is no type of PLY"),
        ("ply\nformat ascii 1.0\nelement v 1\nproperty list float int x\nend_header\n", "cannot be counted in float"),
        ("ply\nformat ascii 1.0\nelement v 1\nend_header\n", "declares no element vertex"),
        ("ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nend_header\n", "no numbers x, y and z"),
    ] {
        refused(header.as_bytes(), Format::Ply, expected);
    }
    let many = "property char a\n".repeat(10_001);
    let header = format!("ply\nformat ascii 1.0\nelement vertex 1\n{many}end_header\n");
    refused(header.as_bytes(), Format::Ply, "elements and properties in the header are more than the limit");
}

#[test]
fn bad_bodies_are_refused_by_place() {
    let (vertex, face) = ("element vertex 3", "element face 1");
    for (body, expected) in [
        ("0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 13, face 0: names vertex 3, the file has 3"),
        ("0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 13, face 0: -1 is no number of a vertex"),
        ("0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n", "line 13, face 0: 1.5 is no number of a vertex"),
        ("0 0 0\n1 0 0\n0 1 0\n99 0 1\n", "line 13, face 0: a list says it has 99 items"),
        ("0 0 0\n1 0 0\n0 1 0\n-3 0 1\n", "line 13, face 0: -3 is no count of a list"),
        ("0 0 0\n1 0 0\n0 1 0\n3 0 1   ", "line 13, face 0: the file breaks off"),
        ("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "line 11, vertex 1: its position [1, NaN, 0] is not finite"),
        ("0 0 0\n1 1e999 0\n0 1 0\n3 0 1 2\n", "line 11, vertex 1: its position [1, inf, 0] is not finite"),
        ("0 0 0\n1 y 0\n0 1 0\n3 0 1 2\n", "line 11, vertex 1: y: y is not a number"),
        ("0 0 0 7\n1 0 0\n0 1 0\n3 0 1 2\n", "vertex 1: begins on a line that holds more numbers than the header"),
        ("0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "line 14, face 0: the file breaks off"),
        ("0 0 0\n", "is cut off: the header counts 3 of element vertex"),
    ] {
        refused(&text(vertex, face, body), Format::Ply, expected);
    }
    refused(&text(vertex, "element face 0", "0 0 0\n1 0 0\n0 1 0\n"), Format::Ply, "holds 3 vertices and no faces");
    let edges: Vec<Table> = vec![
        table("vertex", &["float x", "float y", "float z"], &[&[0.0, 0.0, 0.0], &[1.0, 0.0, 0.0]]),
        table("edge", &["int vertex1", "int vertex2"], &[&[0.0, 1.0]]),
    ];
    let expected = "holds 2 vertices, 1 edges and no faces: there is no surface to deform";
    refused(&ply("binary_big_endian", "\n", &edges), Format::Ply, expected);
    let cloud = table("points", &["list uchar int vertex_indices"], &[&[1.0, 0.0]]);
    let no_list = [table("vertex", &["float x", "float y", "float z"], &[&[0.0; 3]]), cloud];
    refused(&ply("ascii", "\n", &no_list), Format::Ply, "holds 1 vertices and no faces");
}

#[test]
fn counts_beyond_the_file_are_refused_at_once() {
    let place = "property char x\nproperty char y\nproperty char z\n";
    let face = "element face 1\nproperty list uchar uchar vertex_indices\n";
    for (element, expected) in [
        ("element vertex 4294967295", "4294967295 vertices are more than the limit"),
        ("element vertex 99999999999999999999999", "more than the limit"),
        ("element vertex 20000000", "is cut off: the header counts 20000000 of element vertex, of 3 bytes or more"),
    ] {
        let header = format!("ply\nformat binary_little_endian 1.0\n{element}\n{place}{face}end_header\n\0\0\0");
        let is_count = !element.contains("999999999999999");
        refused(header.as_bytes(), Format::Ply, if is_count { expected } else { "is no count of elements" });
    }
    // An element without properties takes no bytes, however often; it must not be walked.
    let empty = "element nothing 9000000000000000\n";
    for encoding in ["ascii", "binary_big_endian"] {
        let tail =
            if encoding == "ascii" { "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" } else { "\0\0\0\x01\0\0\0\x01\0\x03\0\x01\x02" };
        let header = format!("ply\nformat {encoding} 1.0\n{empty}element vertex 3\n{place}{face}end_header\n{tail}");
        let file = super::model::opened(header.as_bytes());
        assert_eq!(file.triangles, [[0, 1, 2]], "{encoding}");
    }
    let many = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\n{place}element face 1\nproperty list uint uint vertex_index\n\
         end_header\n0 0 0\n1 0 0\n0 1 0\n65537{}\n",
        " 0".repeat(65_537)
    );
    refused(
        many.as_bytes(),
        Format::Ply,
        "line 13, face 0: 65537 corners of one polygon or strip are more than the limit",
    );
    let list = "element face 1\nproperty list uint uint vertex_indices\n";
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\n{place}{list}end_header\n\0\0\0\u{7f}\u{7f}\u{7f}\u{7f}"
    );
    refused(header.as_bytes(), Format::Ply, "face 0: a list says it has 2139062143 items, 0 bytes are left");
}

#[test]
fn damaged_files_are_opened_or_refused() {
    for (i, encoding) in super::model::ENCODINGS.iter().enumerate() {
        let bytes = ply(encoding, "\n", &super::model::tables());
        survives(&bytes, Format::Ply, 0x5eed_0100 + i as u64, 3000);
        survives_saving(&bytes, Format::Ply, 0x5eed_0110 + i as u64, [1000, 10]);
    }
}
