//! The corners of OBJ that files in the wild have, each opened, bent and saved.

use super::support::{obj, saved};
use crate::MeshFile;
use glam::DVec3;

/// Lifts everything by 1 and gives the text that is then saved.
fn lifted(file: &MeshFile) -> String {
    let points: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::Z).collect();
    String::from_utf8(saved(file, "lifted.obj", &points, None).0).expect("text")
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const LIFTED: &str = "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";

#[test]
fn everything_behind_the_vertices_is_kept_to_the_byte() {
    for rest in [
        "f 1 2 3 4\n",
        "vt 0 0\nvt 1 1 0.5\nf 1/1 2/2 3/1 4/2\n",
        "g a b  c\ns 1\nusemtl  two words \nf 1 2 3\ns off\no\nf 1 3 4\n",
        "f 1 2 3\nl 1 2 3\np 1 2\nl 1/1 2\n",
        "f 1 2 3\n\n   \t\n# tail\\\n#\n\u{1a}",
        "mg 1 0.5\nlod 2\nusemap x\nshadow_obj y\ntrace_obj z\nf 1 2 3\ncall a.obj 1\n",
        "f\t1  2\t\t3 \t\n",
        "f 1 2 3 4 # a square",
        "vp 0 0\ncstype bezier\ndeg 1\ncurv 0 1 1 2\nparm u 0 1\nend\nf 1 2 3\n",
    ] {
        let file = obj(&format!("{SQUARE}{rest}"));
        assert_eq!(lifted(&file), format!("{LIFTED}{rest}"), "{rest:?}");
    }
}

#[test]
fn what_follows_the_coordinates_of_a_vertex_stays_on_its_line() {
    let text = "v 0 0 0 1.0\nv  1\t0 0 0.5 # w\nv 1 1 0 0.1 0.2 0.3\nv 0 1 0 1 0 0 0.5 junk\nf 1 2 3 4\n";
    let file = obj(text);
    let colors = file.colors.as_ref().expect("colors");
    assert_eq!(colors[2], [0.1, 0.2, 0.3, 1.0]);
    assert_eq!(colors[..2], [[1.0; 4]; 2], "a weight is no color");
    assert_eq!(file.positions[1], DVec3::X, "nor does it divide");
    let expected = "v 0 0 1 1.0\nv  1\t0 1 0.5 # w\nv 1 1 1 0.1 0.2 0.3\nv 0 1 1 1 0 0 0.5 junk\nf 1 2 3 4\n";
    assert_eq!(lifted(&file), expected);
}

#[test]
fn corners_of_one_face_may_be_written_in_different_ways() {
    let text = format!("{SQUARE}vt 0.5 0.25\nvn 0 0 1\nf 1 2/1 3//1 -1/-1/-1\n");
    let file = obj(&text);
    assert_eq!(file.triangles, [[0, 1, 2], [0, 2, 3]]);
    let uvs = file.uvs.as_ref().expect("coordinates");
    assert_eq!(uvs.iter().map(|uv| uv.to_array()).collect::<Vec<_>>(), [[0., 0.], [0.5, 0.25], [0., 0.], [0.5, 0.25]]);
}

#[test]
fn curves_and_surfaces_are_told_and_kept() {
    let file = obj(&format!("{SQUARE}f 1 2 3\ncurv 0 1 1 2\ncurv2 1 2\nsurf 0 1 0 1 1 2 3 4\n"));
    let said: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(said, ["3 free-form curves and surfaces are not shown; the file keeps them as they are"]);
}

#[test]
fn what_another_format_cannot_hold_is_told() {
    let file = obj(&format!("{SQUARE}f 1 2 3 4\nl 1 2\ncurv 0 1 1 2\n"));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let warnings = file.save(&folder.path().join("a.glb"), &file.points(), None).expect("saved");
    let said = warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    for words in ["polygons of more than three corners", "lines and points", "curves and surfaces"] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn concave_polygons_are_cut_without_a_flip_and_stay_polygons() {
    // A star of five points, whose every other corner is concave.
    let corner = |i: i32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::PI / 5.0).sin_cos();
        let r = if i % 2 == 0 { 1.0 } else { 0.3 };
        format!("v {} {} 0\n", r * cos, r * sin)
    };
    let outline: String = (0..10).map(corner).collect();
    let file = obj(&format!("{outline}f 1 2 3 4 5 6 7 8 9 10\n"));
    assert_eq!(file.triangles.len(), 8);
    for (t, triangle) in file.triangles.iter().enumerate() {
        let [a, b, c] = triangle.map(|v| file.positions[v as usize]);
        let area = (b - a).cross(c - a).z;
        assert!(area > 0.0, "triangle {t} has area {area}");
    }
    assert!(lifted(&file).ends_with("\nf 1 2 3 4 5 6 7 8 9 10\n"));
}

#[test]
fn the_two_sides_of_a_hard_edge_turn_by_themselves() {
    // Two squares that meet at x = 1 at a right angle, each with its own normal there.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 -1\nv 1 1 -1\nvn 0 0 1\nvn 1 0 0\n\
                f 1//1 2//1 3//1 4//1\nf 2//2 5//2 6//2 3//2\n";
    let file = obj(text);
    let mut points = file.points();
    // The second side swings out until both lie in one plane.
    (points[4], points[5]) = (DVec3::new(2.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 0.0));
    let (bytes, _) = saved(&file, "flat.obj", &points, None);
    let text = String::from_utf8(bytes).expect("text");
    let normals: Vec<Vec<f64>> = text
        .lines()
        .filter_map(|line| line.strip_prefix("vn "))
        .map(|line| line.split(' ').map(|x| x.parse().expect("a number")).collect())
        .collect();
    assert!(text.contains("\nvn 0 0 1\n"), "the side that did not move keeps its digits: {normals:?}");
    // Single precision.
    let turned = DVec3::from_slice(&normals[1]).distance(DVec3::Z);
    assert!(turned < 1e-6, "got {:?}, expected +z", normals[1]);
}

#[test]
fn both_sides_of_a_texture_seam_turn_alike_and_files_without_normals_get_none() {
    // The squares share one normal at the edge and are cut apart there by their texture coordinates alone.
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n\
                f 1/1/1 2/1/2 3/1/2 4/1/1\nf 2/2/2 5/2/3 6/2/3 3/2/2\n";
    let file = obj(text);
    let mut points = file.points();
    for point in [4, 5] {
        points[point].z = 1.0;
    }
    let (bytes, _) = saved(&file, "roof.obj", &points, None);
    let text = String::from_utf8(bytes).expect("text");
    let shared: Vec<f64> = text.lines().filter(|line| line.starts_with("vn ")).nth(1).expect("a normal")[3..]
        .split(' ')
        .map(|x| x.parse().expect("a number"))
        .collect();
    // Area-weighted: (0, 0, 1) of one side and (-1, 0, 1) of the other.
    let expected = DVec3::new(-1.0, 0.0, 2.0).normalize();
    assert!(DVec3::from_slice(&shared).distance(expected) < 1e-6, "got {shared:?}, expected {expected}");
    let bare = obj(&format!("{SQUARE}f 1 2 3 4\n"));
    assert!(!lifted(&bare).contains("vn"));
}

#[test]
fn comments_and_names_of_any_bytes_are_kept() {
    let mut text = b"# \xe9\xff \xc3\x28\n".to_vec();
    text.extend(SQUARE.as_bytes());
    text.extend(b"g \xe9t\xe9\nusemtl \x80\nf 1 2 3 # \xfe\n");
    let file = crate::from_bytes(&text, crate::Format::Obj, "bytes.obj").expect("a mesh");
    let points: Vec<DVec3> = file.points().iter().map(|p| *p + DVec3::Z).collect();
    let (bytes, _) = saved(&file, "bytes.obj", &points, None);
    let mut expected = b"# \xe9\xff \xc3\x28\n".to_vec();
    expected.extend(LIFTED.as_bytes());
    expected.extend(b"g \xe9t\xe9\nusemtl \x80\nf 1 2 3 # \xfe\n");
    assert_eq!(bytes, expected);
}

#[test]
fn text_in_utf_16_is_named_as_such() {
    let text: Vec<u8> = "\u{feff}v 0 0 0\n".encode_utf16().flat_map(u16::to_be_bytes).collect();
    let error = crate::from_bytes(&text, crate::Format::Obj, "wide.obj").expect_err("not UTF-8").to_string();
    assert_eq!(error, "wide.obj: is text in UTF-16: save it as UTF-8 in a text editor and open that");
}
