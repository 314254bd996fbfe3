//! `info`, `render`, help and usage.

use pliant_tests::program::{Folder, pliant};
use pliant_tests::shapes::bar;
use serde_json::{Value, json};

/// A square of two triangles, one of them twice, one without area, and a vertex that nothing uses.
const DEFECTS: &str = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 3 4\nf 1 3 4\nf 1 2 2\n";

#[test]
fn info_counts_parts_and_defects() {
    let folder = Folder::new();
    let mesh = folder.write("defects.obj", DEFECTS);
    let outcome = pliant(["info", &mesh, "--json"]).expect_done();
    let facts: Value = serde_json::from_str(&outcome.out).expect("JSON");
    assert_eq!([&facts["mesh"]["vertices"], &facts["mesh"]["surface_points"]], [5, 5]);
    assert_eq!(facts["mesh"]["components"], json!(2));
    assert_eq!(facts["bounds"], json!({"min": [0.0, 0.0, 0.0], "max": [9.0, 9.0, 9.0]}));
    for defect in ["duplicate_faces", "unreferenced_vertices"] {
        assert_eq!(facts["defects"][defect], json!(1), "{defect}: {}", facts["defects"]);
    }
    assert!(facts["defects"]["boundary_edges"].is_u64() && facts["defects"]["non_manifold_edges"].is_u64());
    let unused = &facts["findings"].as_array().expect("a list").last().expect("some")["vertices"];
    assert_eq!(unused, &json!([4]), "findings name the vertices of the file: {}", facts["findings"]);
    assert_eq!(facts["rigidity"], Value::Null);
    assert!(facts["parts"].is_array() && facts["warnings"].is_array());
    let text = pliant(["info", &mesh]).expect_done().out;
    for words in ["defects.obj", "vertices    5", "1 face that repeats an earlier one", "1 vertex in no face"] {
        assert!(text.contains(words), "{text}\ndoes not say {words:?}");
    }
}

#[test]
fn info_of_a_sound_closed_mesh_finds_no_defects() {
    let folder = Folder::new();
    let mesh = folder.write("bar.obj", bar([4, 2, 2], [2.0, 1.0, 1.0]).obj());
    let facts: Value = serde_json::from_str(&pliant(["info", &mesh, "--json"]).expect_done().out).expect("JSON");
    for (defect, count) in facts["defects"].as_object().expect("an object") {
        assert_eq!(count, &json!(0), "{defect}");
    }
    assert_eq!(facts["mesh"]["components"], json!(1));
}

#[test]
fn vertices_are_welded_as_is_wished() {
    let folder = Folder::new();
    // Two triangles whose common edge is written twice, the second time 0.001 off at one end.
    let mesh = folder.write("gap.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0.001\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
    for (welding, points) in [("exact", 5), ("never", 6), ("0.0005", 5), ("0.01", 4)] {
        let told = pliant(["info", &mesh, "--json", "--weld", welding]).expect_done().out;
        let facts: Value = serde_json::from_str(&told).expect("JSON");
        assert_eq!(facts["mesh"]["surface_points"], points, "--weld {welding}");
        assert_eq!(facts["mesh"]["vertices"], 6, "--weld {welding}");
    }
    let handles = folder.write("h.json", r#"{"fixed": [0, 1, 5], "moved": [{"vertex": 2, "to": [1, 1, 0.5]}]}"#);
    let out = folder.path("out.obj");
    pliant(["deform", &mesh, "--handles", &handles, "-o", &out, "--weld", "0.01"]).expect_done();
    let saved = pliant_meshfile::open(out.as_ref()).expect("opens again").positions;
    assert_eq!(saved[2].to_array(), [1.0, 1.0, 0.5], "the point goes where it was sent");
    let offset = saved[4].distance(saved[2]);
    assert!((offset - 0.001).abs() < 1e-12, "the vertex welded to it keeps its distance, got {offset}");
}

#[test]
fn render_writes_a_picture_of_the_size_asked_for_with_the_surface_in_it() {
    let folder = Folder::new();
    let mesh = folder.write("bar.obj", bar([8, 2, 2], [4.0, 1.0, 1.0]).obj());
    let mut pictures = Vec::new();
    for (name, more) in [
        ("plain.png", vec![]),
        ("stiff.png", vec!["--color", "rigidity", "--rigidity", "6"]),
        ("soft.png", vec!["--color", "rigidity"]),
        ("energy.png", vec!["--color", "energy"]),
    ] {
        let picture = folder.path(name);
        let mut arguments = vec!["render", &mesh, "-o", &picture, "--size", "320x200"];
        arguments.extend(more);
        pliant(arguments).expect_done();
        let pixels = image::open(&picture).expect("a PNG").to_rgb8();
        assert_eq!(pixels.dimensions(), (320, 200), "{name}");
        assert!(stands_out(&pixels), "{name}: the middle looks like the corner");
        pictures.push(pixels);
    }
    let middle = |index: usize| pictures[index].get_pixel(160, 100).0.map(i32::from);
    let ([stiff_red, _, stiff_blue], [soft_red, _, soft_blue]) = (middle(1), middle(2));
    assert!(stiff_red > stiff_blue && soft_blue > soft_red, "stiff {:?}, soft {:?}", middle(1), middle(2));
}

/// Whether the pixel in the middle differs clearly from the one in the corner (the color of zero energy is dark, and
/// about 30 away from the background).
fn stands_out(pixels: &image::RgbImage) -> bool {
    let (width, height) = pixels.dimensions();
    let pair = pixels.get_pixel(width / 2, height / 2).0.into_iter().zip(pixels.get_pixel(1, 1).0);
    pair.map(|(a, b)| a.abs_diff(b)).max().is_some_and(|difference| difference > 20)
}

#[test]
fn wrong_usage_ends_with_2_and_explains_itself() {
    let full = ["deform", "a.obj", "--handles", "h.json", "-o", "b.obj"];
    let with = |more: &[&'static str]| full.iter().chain(more).copied().collect::<Vec<_>>();
    let wrong = [
        vec!["deform"],
        vec!["deform", "a.obj"],
        vec!["deform", "a.obj", "--handles", "h.json"],
        vec!["info"],
        vec!["info", "a.obj", "--yaml"],
        vec!["render", "a.obj"],
        vec!["render", "a.obj", "-o", "b.png", "--size", "large"],
        vec!["render", "a.obj", "-o", "b.png", "--color", "pink"],
        vec!["--unknown"],
        with(&["--method", "magic"]),
        with(&["--weights", "heavy"]),
        with(&["--start", "late"]),
        with(&["--max-iterations", "many"]),
        with(&["--tolerance", "low"]),
        with(&["--threads", "-1"]),
        with(&["--method", "arap", "--rigidity", "3"]),
        with(&["--method", "sr-arap", "--rigidity", "3"]),
        with(&["--method", "embedded", "--alpha", "0.1"]),
        with(&["--alpha", "0.1"]),
        with(&["--method", "sr-arap", "--nodes", "50"]),
        with(&["--node-neighbors", "3"]),
    ];
    for arguments in wrong {
        let outcome = pliant(&arguments);
        assert_eq!(outcome.code, 2, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.starts_with("error: "), "{arguments:?}: {}", outcome.err);
        assert_eq!(outcome.out, "", "{arguments:?}");
    }
}

#[test]
fn every_command_explains_itself_with_an_example() {
    for command in ["", "deform", "learn", "compare", "info", "render"] {
        let arguments: Vec<&str> = [command, "--help"].into_iter().filter(|word| !word.is_empty()).collect();
        let outcome = pliant(&arguments).expect_done();
        assert!(outcome.out.contains("Example"), "{arguments:?}: {}", outcome.out);
        assert_eq!(outcome.err, "", "{arguments:?}");
    }
    assert!(pliant(["--version"]).expect_done().out.starts_with("pliant "));
}

#[test]
fn quiet_is_understood_before_and_after_a_command() {
    let folder = Folder::new();
    let mesh = folder.write("bar.obj", bar([4, 2, 2], [2.0, 1.0, 1.0]).obj());
    let handles = folder.write("handles.json", r#"{"fixed": [0, 1]}"#);
    let out = folder.path("out.obj");
    let deform = ["deform", &mesh, "--handles", &handles, "-o", &out];
    assert_ne!(pliant(deform).expect_done().out, "");
    for arguments in [[&["--quiet"], &deform[..]].concat(), [&deform[..], &["--quiet"]].concat()] {
        let outcome = pliant(&arguments).expect_done();
        assert_eq!((outcome.out.as_str(), outcome.err.as_str()), ("", ""), "{arguments:?}");
    }
}

#[test]
fn quiet_says_nothing_when_all_is_well() {
    let folder = Folder::new();
    let mesh = folder.write("defects.obj", DEFECTS);
    let handles = folder.write("handles.json", r#"{"fixed": [0, 1]}"#);
    let out = folder.path("out.obj");
    let outcome = pliant(["deform", &mesh, "--handles", &handles, "-o", &out, "--quiet"]).expect_done();
    assert_eq!((outcome.out.as_str(), outcome.err.as_str()), ("", ""));
}
