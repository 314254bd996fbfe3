//! OFF in, the same OFF out.

use super::bad_files::refused;
use super::mutation::{survives, survives_saving};
use super::support::saved;
use crate::{Format, MeshFile, from_bytes};
use glam::{DVec3, Vec2};

/// A quad and a triangle, with comments, blank lines, normals, colors of vertices and of a face.
const TEXT: &str = "CNOFF # a comment\n\n# 9 9 9\n5 3 0\n0 0 0 0 0 1 255 0 0\n 1.50\t0.10 0  0 0 1  0 255 0 51 # keep\n\
1 1.25 0 0 0 1 0 0 255\n\n0 1 0 0 0 1 0 0 0\n.5 2 0e0 0 0 1 1 2 3\n4 0 1 2 3\n3 3 2 4  0.5 0.5 0.5\n2 0 1\n";

fn off(text: &str) -> MeshFile {
    from_bytes(text.as_bytes(), Format::Off, "test.off").unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_kinds_of_off_are_read() {
    let file = off(TEXT);
    let expected = [[0.0, 0.0, 0.0], [1.5, 0.1, 0.0], [1.0, 1.25, 0.0], [0.0, 1.0, 0.0], [0.5, 2.0, 0.0]];
    assert_eq!(file.positions, expected.map(DVec3::from_array));
    assert_eq!(file.triangles, [[0, 1, 2], [0, 2, 3], [3, 2, 4]]);
    let colors = file.colors.expect("colors");
    assert_eq!(colors[..2], [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.2]]);
    assert_eq!(file.warnings.len(), 1, "the face of two corners: {:?}", file.warnings);
    for (kind, vertex, color, uv) in [
        ("OFF", "", None, None),
        ("COFF", " 0.5 0.25 1.", Some([0.5, 0.25, 1.0, 1.0]), None),
        ("COFF", " 1 0 1 0", Some([1.0, 0.0, 1.0, 0.0]), None),
        ("COFF", " 255 0 51", Some([1.0, 0.0, 0.2, 1.0]), None),
        ("COFF", "", Some([1.0; 4]), None),
        ("STOFF", " 0.25 0.75", None, Some(Vec2::new(0.25, 0.75))),
        ("NOFF", " 0 0 1", None, None),
        ("STCNOFF", " 0 0 1 51 0 255 0.5 1", Some([0.2, 0.0, 1.0, 1.0]), Some(Vec2::new(0.5, 1.0))),
    ] {
        for head in [format!("{kind} 3 1 0\n"), format!("{kind}\r\n\r\n3 1\r\n"), format!("#\n{kind}\n3 1 3 # edges\n")]
        {
            let text = format!("{head}0 0 0{vertex}\n1 0 0{vertex}\n0 1 0{vertex}\n3 2 0 1\n");
            let file = off(&text);
            assert_eq!(file.positions, [DVec3::ZERO, DVec3::X, DVec3::Y], "{text}");
            assert_eq!(file.triangles, [[2, 0, 1]], "{text}");
            assert_eq!(file.colors.map(|colors| colors[0]), color, "{text}");
            assert_eq!(file.uvs.map(|uvs| uvs[2]), uv, "{text}");
        }
    }
}

#[test]
fn numbers_may_stand_on_whatever_lines() {
    for text in [
        "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 2 0 1",
        "OFF\n3\n1\n0\n0 0 0 1 0 0\n0 1 0 3 2\n0 1\n",
        "STNOFF 3 1 0 0 0 0 0 0 1 7 8 1 0 0 0 0 1 7 8 0 1 0 0 0 1 7 8 3 2 0 1",
    ] {
        let file = off(text);
        assert_eq!(file.positions, [DVec3::ZERO, DVec3::X, DVec3::Y], "{text}");
        assert_eq!(file.triangles, [[2, 0, 1]], "{text}");
        let mut points = file.points();
        points[2].y = 2.5;
        let (out, again) = saved(&file, "free.off", &points, None);
        assert_eq!(again.points(), points, "{text}");
        let [new, old] = [&String::from_utf8_lossy(&out), text]
            .map(|text| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>());
        let changed: Vec<_> = new.iter().zip(&old).filter(|(new, old)| new != old).collect();
        assert_eq!((new.len(), changed), (old.len(), vec![(&"2.5".to_owned(), &"1".to_owned())]), "{text}");
    }
}

#[test]
fn saving_an_untouched_file_gives_the_same_bytes() {
    for end in ["\n", "\r\n", "\r"] {
        let text = TEXT.replace('\n', end) + "what follows";
        let file = off(&text);
        assert_eq!(String::from_utf8_lossy(&saved(&file, "same.off", &file.points(), None).0), text);
    }
}

#[test]
fn a_bend_changes_the_numbers_that_moved_and_nothing_else() {
    let file = off(TEXT);
    let mut points = file.points();
    // Within the plane, so that no normal turns; a third of a number takes all its digits.
    points[1].y = 1.0 / 3.0;
    let (out, again) = saved(&file, "bent.off", &points, None);
    let text = String::from_utf8(out).expect("text");
    assert_eq!(again.points(), points, "OFF holds positions to the bit");
    let [turned, before] = [&text, TEXT].map(|text| text.lines().collect::<Vec<_>>());
    assert_eq!(turned.len(), before.len());
    for (line, (new, old)) in turned.iter().zip(&before).enumerate() {
        if line == 5 {
            assert!(new.starts_with(" 1.50\t0.3333333333333333 0  ") && new.ends_with("  0 255 0 51 # keep"), "{new}");
            continue;
        }
        // Normals in a plane that stays may be written again, as the same numbers.
        let numbers = |text: &str| text.split_whitespace().map(|word| word.parse::<f64>()).collect::<Vec<_>>();
        assert_eq!(numbers(new), numbers(old), "line {}", line + 1);
    }
    let stood: Vec<DVec3> = file.points().iter().map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
    let (out, _) = saved(&file, "stood.off", &stood, None);
    let text = String::from_utf8(out).expect("text");
    let normal: Vec<f64> =
        text.lines().nth(4).expect("a vertex").split(' ').skip(3).take(3).flat_map(str::parse).collect();
    assert!(normal.len() == 3 && (normal[1] + 1.0).abs() < 1e-6, "normals turn: {normal:?}");
}

#[test]
fn rigidity_lives_in_a_sidecar() {
    let file = off(TEXT);
    let (out, again) = saved(&file, "r.off", &file.points(), Some(&[1, 2, 3, 4, 1000]));
    assert_eq!(String::from_utf8_lossy(&out), TEXT);
    assert_eq!(again.rigidity.as_deref(), Some(&[1, 2, 3, 4, 1000][..]));
}

#[test]
fn numbers_that_were_not_declared_are_told_and_kept() {
    let text = "OFF\n3 1 0\n0 0 0 9\n1 0 0 9\n0 1 0 9\n3 0 1 2\n";
    let file = off(text);
    assert!(file.warnings[0].0.contains("more numbers than the first line declares"), "{:?}", file.warnings);
    assert_eq!(saved(&file, "more.off", &file.points(), None).0, text.as_bytes());
}

#[test]
fn bad_files_are_refused_by_place() {
    let vertices = "0 0 0\n1 0 0\n0 1 0\n";
    for (text, expected) in [
        ("".to_owned(), "is not an OFF file"),
        ("OFF BINARY\n\0\0\0\x03".to_owned(), "is a binary OFF file, which is not read: save it as text"),
        ("4OFF\n1 1 1\n".to_owned(), "of the kind 4OFF: only points of three dimensions"),
        (format!("OFF\n3 1 0\n{vertices}3 0 1 3\n"), "line 6, face 0: names vertex 3, the file has 3"),
        (format!("OFF\n3 1 0\n{vertices}3 0 1 -1\n"), "line 6, face 0: -1 is no number of a vertex"),
        (format!("OFF\n3 1 0\n{vertices}3 0 1   \n"), "face 0: the file breaks off"),
        (format!("OFF\n3 1 0\n{vertices}99 0 1\n"), "face 0: says it has 99 corners"),
        (format!("OFF\n3 2 0\n{vertices}3 0 1 2\n"), "face 1: the file breaks off"),
        (format!("OFF\n3 0 0\n{vertices}"), "holds 3 vertices and no faces"),
        ("OFF\n3 1 0\n0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n".to_owned(), "line 4, vertex 1: x is not a number"),
        ("OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n".to_owned(), "line 4, vertex 1: inf is not finite"),
        (format!("OFF\n3 1 0\n0 0 0 {}\n1 0 0\n0 1 0\n3 0 1 2\n", "1 ".repeat(10)), "more than the 12 numbers"),
        ("STOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_owned(), "vertex 0: has no texture coordinates"),
        ("OFF\n20000000 1 0\n0 0 0\n".to_owned(), "is cut off: it counts 20000000 vertices and 1 faces"),
        ("OFF\n1 30000000 0\n0 0 0\n".to_owned(), "is cut off: it counts 1 vertices and 30000000 faces"),
        ("OFF\n1 99999999999 0\n0 0 0\n".to_owned(), "99999999999 faces are more than the limit"),
        (format!("OFF\n3 1 0\n{vertices}65537 0\n"), "65537 corners of one polygon are more than the limit"),
        ("OFF\n99999999999 1 0\n0 0 0\n".to_owned(), "99999999999 vertices are more than the limit"),
    ] {
        refused(text.as_bytes(), Format::Off, expected);
    }
}

#[test]
fn damaged_files_are_opened_or_refused() {
    survives(TEXT.as_bytes(), Format::Off, 0x5eed_0300, 4000);
    survives_saving(TEXT.as_bytes(), Format::Off, 0x5eed_0301, [1000, 10]);
}
