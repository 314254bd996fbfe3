//! STL in, the same STL out.

use super::bad_files::refused;
use super::mutation::{survives, survives_saving};
use super::support::{bent, saved};
use crate::{Format, MeshFile, from_bytes, open};
use glam::DVec3;

/// A tetrahedron in two solids, with what else a text may hold. The second facet has no normal, the third zeros.
const TEXT: &str = "SOLID two words \n\
  facet normal 0 0 -1\n    outer loop\n      vertex 0 0 0\n      vertex 0 1.50 0\n      vertex 1e0 0 0\n    endloop\n  \
  endfacet\n\nFacet Normal\nOuter Loop vertex 0 0 0 Vertex 1 0 0\n VERTEX 0 0 1 EndLoop EndFacet\nendsolid two words\n\
solid\n facet normal 0 0 0\n outer loop\n vertex 0 0 0\n vertex 0 0 1\n vertex 0 1.5 0\n endloop\n endfacet\n\
 facet normal nan nan nan\n outer loop\n vertex 1 0 0\n vertex 0 1.5 0\n vertex 0 0 1\n endloop\n endfacet\nendsolid\n";

/// The triangles of the text, by corners.
const CORNERS: [[f32; 3]; 12] = {
    let (o, x, y, z) = ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 1.0]);
    [o, y, x, o, x, z, o, z, y, x, y, z]
};

/// A binary file of the same tetrahedron, its header and the bytes behind triangles filled.
fn binary() -> Vec<u8> {
    let mut bytes = b"solid COLOR=\x80\x40\x20\xff made by hand".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(4u32.to_le_bytes());
    for (t, corners) in CORNERS.chunks(3).enumerate() {
        let normal = if t == 0 { [0.0, 0.0, -1.0] } else { [0.0; 3] };
        bytes.extend([normal, corners[0], corners[1], corners[2]].iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend((0x8000 | t as u16).to_le_bytes());
    }
    bytes
}

fn stl(bytes: &[u8]) -> MeshFile {
    from_bytes(bytes, Format::Stl, "test.stl").unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn text_and_bytes_are_told_apart_and_read_alike() {
    let marked = [b"\xef\xbb\xbf \n", TEXT.as_bytes()].concat();
    for bytes in [
        TEXT.as_bytes(),
        &TEXT.replace('\n', "\r\n").into_bytes(),
        &TEXT.replace('\n', "\r").into_bytes(),
        &marked,
        &binary(),
    ] {
        let file = stl(bytes);
        let expected: Vec<DVec3> = CORNERS.iter().map(|&corner| glam::Vec3::from(corner).into()).collect();
        assert_eq!(file.positions, expected);
        assert_eq!(file.triangles, [[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]]);
        assert_eq!(file.weld.n_points(), 4);
        assert_eq!(file.warnings, []);
    }
}

#[test]
fn every_solid_is_a_part() {
    let parts: Vec<(String, usize)> =
        stl(TEXT.as_bytes()).parts.into_iter().map(|p| (p.name, p.triangles.len())).collect();
    assert_eq!(parts, [("two words".to_owned(), 2), ("test.stl".to_owned(), 2)]);
    assert_eq!(stl(&binary()).parts.len(), 1);
}

#[test]
fn saving_an_untouched_file_gives_the_same_bytes() {
    let long = [&binary()[..], b"what follows"].concat();
    for bytes in [TEXT.as_bytes(), &TEXT.replace('\n', "\r\n").into_bytes(), &binary(), &long] {
        let file = stl(bytes);
        assert_eq!(saved(&file, "same.stl", &file.points(), None).0, bytes);
    }
    let expected = "12 bytes after the last triangle are kept and not read";
    assert_eq!(stl(&long).warnings.iter().map(|w| w.0.as_str()).collect::<Vec<_>>(), [expected]);
}

#[test]
fn a_bend_changes_the_numbers_that_moved_and_nothing_else_of_a_text() {
    let file = stl(TEXT.as_bytes());
    let mut points = file.points();
    let tip = points.iter().position(|p| *p == DVec3::Z).expect("the tip");
    points[tip] = DVec3::new(0.0, 0.1, 2.0);
    let (out, again) = saved(&file, "bent.stl", &points, None);
    let expected = TEXT.replace("VERTEX 0 0 1", "VERTEX 0 0.1 2").replace("vertex 0 0 1", "vertex 0 0.1 2");
    assert_eq!(String::from_utf8(out).expect("text"), expected, "zeros, words and unmoved corners stay");
    assert_eq!(again.points(), points);
}

#[test]
fn a_bend_changes_positions_and_normals_and_nothing_else_of_a_binary_file() {
    let bytes = binary();
    let file = stl(&bytes);
    let turned: Vec<DVec3> = file.points().iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
    let (out, again) = saved(&file, "bent.stl", &turned, None);
    assert_eq!(again.points(), turned);
    assert_eq!(out.len(), bytes.len());
    assert_eq!(out[..84], bytes[..84], "header and count");
    let number = |at: usize| f32::from_le_bytes(out[at..at + 4].try_into().expect("four bytes"));
    for (at, expected) in [(84, 0.0), (88, 1.0), (92, 0.0)] {
        assert!((number(at) - expected).abs() < 1e-6, "byte {at}: got {}, expected {expected}", number(at));
    }
    for t in 0..4 {
        let start = 84 + 50 * t;
        assert_eq!(out[start + 48..start + 50], bytes[start + 48..start + 50], "triangle {t}: color");
        assert!(t == 0 || out[start..start + 12] == [0; 12], "triangle {t}: a normal that was left open stays open");
    }
}

#[test]
fn colors_of_triangles_are_read_by_both_conventions() {
    // Five bits a channel: 31, 0 and 5 of 31.
    let (bits, color) = (31 | 5 << 10, [1.0, 0.0, 5.0 / 31.0, 1.0]);
    let swapped = [5.0 / 31.0, 0.0, 1.0, 1.0];
    let object = [128.0 / 255.0, 64.0 / 255.0, 32.0 / 255.0, 1.0];
    for (magics, attributes, expected) in [
        (true, [bits, 0x8000, 0x8000, 0x8000], Some([color, object])),
        (false, [0x8000 | bits, 0, 0, 0], Some([swapped, crate::shape::NO_MATERIAL])),
        (true, [0x8000, 0x8001, 0x8002, 0x8003], None),
        (true, [0; 4], None),
        (false, [bits, 0, 0, 0], None),
    ] {
        let mut bytes = binary();
        if !magics {
            bytes[..80].fill(0);
        }
        for (t, attribute) in attributes.iter().enumerate() {
            bytes[84 + 50 * t + 48..84 + 50 * t + 50].copy_from_slice(&(*attribute as u16).to_le_bytes());
        }
        let file = stl(&bytes);
        let got = file.colors.as_ref().map(|colors| [colors[2], colors[3]]);
        assert_eq!(got, expected, "{magics} {attributes:?}");
        assert_eq!(file.parts[0].base_color, if magics { object } else { crate::shape::NO_MATERIAL });
        assert_eq!(saved(&file, "colored.stl", &file.points(), None).0, bytes, "{magics} {attributes:?}");
        let (_, ply) = saved(&file, "colored.ply", &file.points(), None);
        let rounded = |color: [f32; 4]| color.map(|x| (x * 255.0).round() as u8);
        let got = ply.colors.map(|colors| [rounded(colors[2]), rounded(colors[3])]);
        assert_eq!(got, expected.map(|colors| colors.map(rounded)), "{magics} {attributes:?}");
    }
}

#[test]
fn rigidity_of_corners_lives_in_a_sidecar() {
    for bytes in [TEXT.as_bytes(), &binary()] {
        let file = stl(bytes);
        let (out, again) = saved(&file, "r.stl", &file.points(), Some(&[1, 2, 3, 4]));
        assert_eq!(out, bytes);
        assert_eq!(again.point_rigidity(), Some((vec![1, 2, 3, 4], false)));
        assert_eq!(again.rigidity.map(|r| r.len()), Some(12));
    }
}

#[test]
fn positions_beyond_single_precision_are_refused() {
    let file = stl(&binary());
    let mut points = file.points();
    points[3].y = 1e39;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let error = file.save(&folder.path().join("far.stl"), &points, None).expect_err("too large").to_string();
    assert!(error.contains("not finite or too large"), "{error}");
}

#[test]
fn bad_files_are_refused_by_place() {
    let facet = |inside: &str| format!("solid a\nfacet normal 0 0 1\n{inside}endfacet\nendsolid\n").into_bytes();
    let vertices = "vertex 0 0 0\nvertex 1 0 0\n";
    for (bytes, expected) in [
        (Vec::new(), "0 bytes are too few for a binary one"),
        (b"solid\nendsolid\n".to_vec(), "holds no faces"),
        (facet(&format!("outer loop\n{vertices}endloop\n")), "line 6: endloop stands where vertex is expected"),
        (facet(&format!("outer loop\n{vertices}{vertices}endloop\n")), "line 7: a facet has more than three corners"),
        (facet(&format!("outer loop\n{vertices}vertex 0 nan 0\nendloop\n")), "line 6, triangle 0: nan is not finite"),
        (facet(&format!("outer loop\n{vertices}vertex 0 z 0\nendloop\n")), "line 6, triangle 0: z is not a number"),
        (b"solid a\nfacet normal 0 0".to_vec(), "line 2: the file breaks off where a number is expected"),
        (b"solid a\nfacet normal 0 0 1\nouter".to_vec(), "line 3: the file breaks off where loop is expected"),
        (b"solid a\nface\n".to_vec(), "line 2: face stands where solid, facet or endsolid is expected"),
        (binary()[..283].to_vec(), "line 1: "),
        (
            [&[b'x'; 80][..], &binary()[80..283]].concat(),
            "it would have 284 bytes by its count of triangles, where 283 are",
        ),
        ([&[0; 80][..], &u32::MAX.to_le_bytes()].concat(), "it would have 214748364834 bytes"),
    ] {
        if expected == "line 1: " {
            assert!(from_bytes(&bytes, Format::Stl, "bad").is_err(), "a cut file that begins with solid");
            continue;
        }
        refused(&bytes, Format::Stl, expected);
    }
    let mut bytes = binary();
    bytes[84 + 50 + 24..84 + 50 + 28].copy_from_slice(&f32::NAN.to_le_bytes());
    refused(&bytes, Format::Stl, "byte 158, triangle 1, corner 1: its position");
}

#[test]
fn damaged_files_are_opened_or_refused() {
    survives(TEXT.as_bytes(), Format::Stl, 0x5eed_0200, 3000);
    survives(&binary(), Format::Stl, 0x5eed_0201, 3000);
    survives_saving(TEXT.as_bytes(), Format::Stl, 0x5eed_0202, [1000, 10]);
    survives_saving(&binary(), Format::Stl, 0x5eed_0203, [1000, 10]);
}

#[test]
fn a_text_of_a_binary_files_title_is_still_binary() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("title.stl");
    let mut bytes = binary();
    bytes[..80].copy_from_slice(format!("{:80}", "solid facet normal 0 0 0 outer loop").as_bytes());
    std::fs::write(&path, &bytes).expect("a file");
    assert_eq!(open(&path).expect("a mesh").triangles.len(), 4);
    let moved = bent(&open(&path).expect("a mesh").points());
    open(&path).expect("a mesh").save(&path, &moved, None).expect("saved");
    let n = std::fs::read(&path).expect("the file").len();
    assert_eq!(n, bytes.len(), "saved as it was");
}
