//! `pliant learn`: what it takes for poses, what it writes, and what it refuses.

use std::ops::RangeInclusive;

use pliant::cli::{Console, main_with};
use pliant_tests::program::{Folder, Outcome, pliant, read_json, read_positions};
use pliant_tests::shapes::{Shape, Vector, bar};
use serde_json::{Value, json};

/// Where the bar has its hinge, and how long an edge is at most.
const HINGE: f64 = 4.0;
const EDGE: f64 = 0.375;

/// A bar of two stiff halves.
fn hinged_bar() -> Shape {
    bar([32, 3, 3], [8.0, 0.75, 0.75])
}

/// The shape with everything beyond the hinge turned about it.
fn turned(shape: &Shape, degrees: f64) -> Shape {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let turn = |[x, y, z]: Vector| match x > HINGE {
        true => [HINGE + (x - HINGE) * cos - y * sin, (x - HINGE) * sin + y * cos, z],
        false => [x, y, z],
    };
    Shape { positions: shape.positions.iter().map(|&p| turn(p)).collect(), triangles: shape.triangles.clone() }
}

/// A folder with the bar at rest and in three poses.
struct Bench {
    folder: Folder,
    shape: Shape,
    reference: String,
    poses: [String; 3],
}

impl Bench {
    fn new() -> Self {
        let (folder, shape) = (Folder::new(), hinged_bar());
        let reference = folder.write("bar.obj", shape.obj());
        let pose = |degrees: i32| folder.write(&format!("bar{degrees}.obj"), turned(&shape, f64::from(degrees)).obj());
        let poses = [-40, 30, 55].map(pose);
        Bench { folder, shape, reference, poses }
    }

    fn run(&self, out: &str, more: &[&str]) -> Outcome {
        let mut arguments = vec!["learn", &self.reference];
        arguments.extend(self.poses.iter().map(String::as_str));
        arguments.extend(["-o", out]);
        arguments.extend(more);
        pliant(arguments)
    }

    /// Runs with a report, and reads it and the array of r.
    #[track_caller]
    fn learn(&self, more: &[&str]) -> (Value, Vec<u16>) {
        let (out, report) = (self.folder.path("r.json"), self.folder.path("report.json"));
        self.run(&out, &[&["--report", &report], more].concat()).expect_done();
        (read_json(&report), array(&out))
    }
}

fn array(path: &str) -> Vec<u16> {
    serde_json::from_value(read_json(path)).expect("an array of whole numbers")
}

/// Rows of a table: vertex, r, confidence, energies.
fn table(path: &str) -> (String, Vec<Vec<String>>) {
    let text = std::fs::read_to_string(path).expect("a table");
    let mut lines = text.lines();
    let header = lines.next().expect("a header").to_owned();
    (header, lines.map(|line| line.split(',').map(str::to_owned).collect()).collect())
}

/// Mean over the vertices at these distances from the hinge.
fn mean(shape: &Shape, r: &[u16], distances: RangeInclusive<f64>) -> f64 {
    let at = shape.vertices(|[x, ..]| distances.contains(&(x - HINGE).abs()));
    at.iter().map(|&vertex| f64::from(r[vertex])).sum::<f64>() / at.len() as f64
}

#[test]
fn a_hinge_comes_out_soft_and_what_it_joins_stiff() {
    let bench = Bench::new();
    let (report, r) = bench.learn(&["--omega", "0.01"]);
    assert_eq!(r.len(), bench.shape.positions.len());
    // Beyond six rings the hinge is in no neighborhood: only ω counts there.
    let deep = mean(&bench.shape, &r, 6.0 * EDGE..=8.0);
    let joint = mean(&bench.shape, &r, 0.0..=EDGE);
    assert_eq!(deep, 6.0);
    assert!(joint < 3.0, "mean r at the hinge {joint}");
    let keys: Vec<&String> = report.as_object().expect("an object").keys().collect();
    let expected = [
        "vertices",
        "poses",
        "r_min",
        "r_max",
        "omega",
        "omega_mode",
        "histogram",
        "mean_energy",
        "times_ms",
        "peak_memory_bytes",
        "warnings",
    ];
    assert_eq!(keys, expected);
    assert_eq!([&report["vertices"], &report["poses"]], [&json!(r.len()), &json!(3)]);
    assert_eq!([&report["r_min"], &report["r_max"], &report["omega"]], [&json!(1), &json!(6), &json!(0.01)]);
    assert_eq!([&report["omega_mode"], &report["warnings"]], [&json!("absolute"), &json!([])]);
    let count = |size: u16| r.iter().filter(|&&r| r == size).count();
    assert_eq!(report["histogram"], json!((1..=6).map(count).collect::<Vec<_>>()));
    let times: Vec<&String> = report["times_ms"].as_object().expect("an object").keys().collect();
    assert_eq!(times, ["load", "neighborhoods", "energies", "total"]);
    assert!(report["times_ms"].as_object().expect("an object").values().all(|ms| ms.as_f64() > Some(0.0)));
}

#[test]
fn by_default_omega_comes_from_the_poses() {
    let bench = Bench::new();
    let (report, r) = bench.learn(&[]);
    assert_eq!(report["omega_mode"], json!("auto"));
    assert!(report["omega"].as_f64().is_some_and(|omega| omega > 0.0 && omega.is_finite()), "{report}");
    let (deep, joint) = (mean(&bench.shape, &r, 6.0 * EDGE..=8.0), mean(&bench.shape, &r, 0.0..=EDGE));
    assert!(deep == 6.0 && joint < 4.0, "mean r deep {deep}, at the hinge {joint}");
}

#[test]
fn the_table_has_the_energies_that_r_follows_from() {
    let bench = Bench::new();
    let path = bench.folder.path("table.csv");
    let (report, r) = bench.learn(&["--table", &path, "--r-min", "2", "--r-max", "5", "--omega", "0.02"]);
    let (header, rows) = table(&path);
    assert_eq!(header, "vertex,r,confidence,energy_2,energy_3,energy_4,energy_5");
    assert_eq!(rows.len(), r.len());
    let mut sums = [0.0; 4];
    for (vertex, row) in rows.iter().enumerate() {
        assert_eq!((row.len(), &row[0], &row[1]), (7, &vertex.to_string(), &r[vertex].to_string()));
        let confidence: f64 = row[2].parse().expect("a number");
        assert!((0.0..=1.0).contains(&confidence), "{row:?}");
        let energies: Vec<f64> = row[3..].iter().map(|text| text.parse().expect("a number")).collect();
        for (text, energy) in row[3..].iter().zip(&energies) {
            assert_eq!(text.split(['e', '.']).take(2).map(str::len).sum::<usize>(), 17, "digits of {text}");
            assert_eq!(format!("{energy:.16e}"), *text);
        }
        let cost = |r: usize| energies[r - 2] + 0.02 * (5 - r) as f64;
        let best = (2..=5).map(cost).fold(f64::INFINITY, f64::min);
        assert_eq!(cost(usize::from(r[vertex])), best, "vertex {vertex}");
        sums.iter_mut().zip(&energies).for_each(|(sum, energy)| *sum += energy);
    }
    for (column, sum) in sums.iter().enumerate() {
        let (got, expected) = (report["mean_energy"][column].as_f64().expect("a number"), sum / rows.len() as f64);
        // The order of the sum may be another.
        assert!((got - expected).abs() <= 1e-12 * expected, "mean {column}: got {got}, expected {expected}");
    }
}

#[test]
fn a_mesh_as_output_is_the_reference_with_its_rigidity() {
    let bench = Bench::new();
    let (_, r) = bench.learn(&["--omega", "0.02"]);
    for name in ["out.glb", "out.gltf", "out.obj"] {
        let out = bench.folder.path(name);
        bench.run(&out, &["--omega", "0.02"]).expect_done();
        let file = pliant_meshfile::open(out.as_ref()).expect("an output written before");
        assert_eq!(file.rigidity.as_deref(), Some(&r[..]), "{name}");
        assert_eq!(read_positions(&out), bench.shape.positions, "{name}");
    }
    let sidecar = bench.folder.path("bar.rigidity.json");
    bench.run(&sidecar, &["--omega", "0.02"]).expect_done();
    let file = pliant_meshfile::open(bench.reference.as_ref()).expect("the reference");
    assert_eq!(file.rigidity.as_deref(), Some(&r[..]), "the array is what a sidecar is");
}

#[test]
fn poses_in_another_unit_are_learned_from_when_their_scale_is_divided_out() {
    let mut bench = Bench::new();
    let (plain, r) = bench.learn(&["--omega", "0.02"]);
    bench.poses = [-40, 30, 55].map(|degrees| {
        let mut pose = turned(&bench.shape, f64::from(degrees));
        pose.positions.iter_mut().flatten().for_each(|x| *x *= 1000.0);
        bench.folder.write(&format!("large{degrees}.obj"), pose.obj())
    });
    let (report, scaled) = bench.learn(&["--omega", "0.02", "--match-scale"]);
    assert_eq!(scaled, r);
    let energies = |report: &Value| report["mean_energy"][5].as_f64().expect("a number");
    assert!((energies(&report) / energies(&plain) - 1.0).abs() < 1e-9, "{report}");
    let warnings = report["warnings"].to_string();
    assert!(
        warnings.contains("large-40.obj and 2 more files: is 1000 times") && warnings.contains("divided out"),
        "{warnings}"
    );
    let (report, _) = bench.learn(&["--omega", "0.02"]);
    assert!(energies(&report) > 1000.0 * energies(&plain), "scale is left alone unless asked");
}

/// The bar as glTF: its geometry, two morph targets, and an animation that mixes them.
fn moving_bar(folder: &Folder, shape: &Shape) -> String {
    let bytes =
        |list: &[Vector]| -> Vec<u8> { list.iter().flatten().flat_map(|&x| (x as f32).to_le_bytes()).collect() };
    let offsets = |degrees: f64| -> Vec<Vector> {
        let pairs = turned(shape, degrees).positions.into_iter().zip(&shape.positions);
        pairs.map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]).collect()
    };
    let indices: Vec<u8> = shape.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
    let keys: Vec<u8> = [0f32, 1.0, 2.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let pieces = [bytes(&shape.positions), bytes(&offsets(35.0)), bytes(&offsets(-45.0)), indices, keys];
    let mut at = 0;
    let views: Vec<Value> = pieces
        .iter()
        .map(|piece| {
            let view = json!({"buffer": 0, "byteOffset": at, "byteLength": piece.len()});
            at += piece.len();
            view
        })
        .collect();
    folder.write("moving.bin", pieces.concat());
    let n = shape.positions.len();
    let vectors = |view: u32| json!({"bufferView": view, "componentType": 5126, "count": n, "type": "VEC3"});
    let mut positions = vectors(0);
    (positions["min"], positions["max"]) = (json!([0, 0, 0]), json!([8, 1, 1]));
    let document = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{
            "primitives": [{"attributes": {"POSITION": 0}, "indices": 3, "targets": [{"POSITION": 1}, {"POSITION": 2}]}],
            "extras": {"targetNames": ["up", "down"]},
        }],
        "animations": [{
            "name": "wave", "samplers": [{"input": 4, "output": 5}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
        }],
        "accessors": [
            positions, vectors(1), vectors(2),
            {"bufferView": 3, "componentType": 5125, "count": 3 * shape.triangles.len(), "type": "SCALAR"},
            {"bufferView": 4, "componentType": 5126, "count": 3, "type": "SCALAR"},
            {"bufferView": 4, "byteOffset": 12, "componentType": 5126, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": views, "buffers": [{"uri": "moving.bin", "byteLength": at}],
    });
    folder.write("moving.gltf", document.to_string())
}

#[test]
fn targets_and_animations_of_a_file_are_poses_of_itself_and_of_others() {
    let mut bench = Bench::new();
    let moving = moving_bar(&bench.folder, &bench.shape);
    let (out, report) = (bench.folder.path("r.json"), bench.folder.path("report.json"));
    let learn = |reference: &str, poses: &[&str], frames: &str| {
        let arguments = [&["learn", reference], poses, &["-o", &out, "--report", &report, "--frames", frames]].concat();
        pliant(arguments).expect_done();
        read_json(&report)
    };
    // Two targets, and of five frames all but the first, which is at rest. The third and the last show the targets
    // again, but a target is taken whatever the frames show.
    let own = learn(&moving, &[], "5");
    assert_eq!(own["poses"], json!(6));
    assert!(own["warnings"].to_string().contains("1 pose of a shape that was known"), "{own}");
    assert_eq!(learn(&moving, &[&moving], "5")["mean_energy"], own["mean_energy"], "the file as a pose of itself");
    let of_obj = learn(&bench.reference, &[&moving], "5");
    assert_eq!(of_obj["poses"], json!(6));
    let [got, expected] = [&of_obj, &own].map(|report| report["mean_energy"][5].as_f64().expect("a number"));
    assert!((got / expected - 1.0).abs() < 1e-5, "single precision apart: {got}, {expected}");
    bench.poses[0] = moving;
    assert_eq!(bench.learn(&["--frames", "2"]).0["poses"], json!(2 + 2 + 1));
}

#[test]
fn the_same_poses_give_the_same_bits_on_one_and_on_two_threads() {
    let bench = Bench::new();
    let tables = ["1", "2", "2"].map(|threads| {
        let path = bench.folder.path("table.csv");
        bench.learn(&["--table", &path, "--threads", threads]);
        std::fs::read(&path).expect("a table")
    });
    assert!(tables[0] == tables[1], "one and two threads differ");
    assert!(tables[1] == tables[2], "two runs differ");
}

/// Runs with something precious in place of every output: none may be touched, one line has to say these words.
#[track_caller]
fn refuses(bench: &Bench, more: &[&str], words: &[&str]) {
    let outputs = ["out.glb", "table.csv", "report.json"].map(|name| bench.folder.write(name, "precious"));
    let [out, table, report] = &outputs;
    let names = bench.folder.names();
    let outcome = bench.run(out, &[&["--table", table, "--report", report], more].concat());
    assert_eq!(outcome.code, 1, "{}", outcome.err);
    assert_eq!(outcome.out, "");
    let lines: Vec<&str> = outcome.err.lines().collect();
    let [line] = lines[..] else { panic!("not one line but {lines:?}") };
    assert!(line.starts_with("pliant: "), "{line}");
    words.iter().for_each(|word| assert!(line.contains(word), "{line}\ndoes not say {word:?}"));
    assert_eq!(bench.folder.names(), names, "files appeared or vanished");
    for path in &outputs {
        assert_eq!(std::fs::read_to_string(path).expect("still there"), "precious", "{path}");
    }
}

#[test]
fn poses_that_cannot_be_used_are_named_with_what_to_do() {
    let mut bench = Bench::new();
    bench.poses[2] = bench.folder.path("nowhere.obj");
    refuses(&bench, &[], &["nowhere.obj: cannot be read"]);
    bench.poses[2] = bench.folder.write("text.obj", "v 0 0 zero\n");
    refuses(&bench, &[], &["text.obj: line 1, vertex 0: zero is not a number; leave it out, or use --skip-broken"]);
    bench.poses[2] = bench.folder.write("other.obj", bar([3, 3, 3], [1.0; 3]).obj());
    let n = bench.shape.positions.len();
    let words =
        format!("other.obj: is no pose of the reference: it has 56 vertices and 108 triangles instead of {n} and");
    refuses(&bench, &[], &[&words, "use --skip-broken"]);
    let mut flipped = turned(&bench.shape, 20.0);
    flipped.triangles[17].swap(0, 1);
    bench.poses[2] = bench.folder.write("flipped.obj", flipped.obj());
    refuses(&bench, &[], &["flipped.obj: is no pose of the reference: triangle 17 has vertices", "--reference-faces"]);
    assert_eq!(bench.learn(&["--reference-faces"]).0["poses"], json!(3));
    flipped.positions[5] = [1e200, 0.0, 0.0];
    flipped.triangles[17].swap(0, 1);
    bench.poses[2] = bench.folder.write("far.obj", flipped.obj());
    refuses(&bench, &[], &["far.obj: its shape: vertex 5: position is too large"]);
}

#[test]
fn on_request_the_rest_goes_on_without_broken_poses() {
    let mut bench = Bench::new();
    let first = bench.poses[0].clone();
    bench.poses[1] = bench.folder.path("nowhere.obj");
    bench.poses[2] = bench.folder.write("other.obj", bar([3, 3, 3], [1.0; 3]).obj());
    let (report, r) = bench.learn(&["--skip-broken"]);
    assert_eq!(report["poses"], json!(1));
    let warnings = report["warnings"].as_array().expect("a list");
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    for (warning, name) in warnings.iter().zip(["nowhere.obj", "other.obj"]) {
        let text = warning.as_str().expect("text");
        assert!(text.starts_with("skipped: ") && text.contains(name), "{text}");
    }
    let out = bench.folder.path("alone.json");
    pliant(["learn", &bench.reference, &first, "-o", &out]).expect_done();
    assert_eq!(array(&out), r, "what was skipped leaves no trace");
    bench.poses[0] = bench.folder.path("nowhere-either.obj");
    let words = "bar.obj: nothing is left to learn from: 3 poses were skipped, the first: ";
    refuses(&bench, &["--skip-broken"], &[words, "nowhere-either.obj: cannot be read"]);
}

#[test]
fn without_another_shape_there_is_nothing_to_learn() {
    let mut bench = Bench::new();
    let mut moved = hinged_bar();
    moved.positions.iter_mut().for_each(|[x, y, z]| [*x, *y, *z] = [*y + 3.0, 1.0 - *x, *z]);
    bench.poses = ["a.obj", "b.obj", "c.obj"].map(|name| bench.folder.write(name, moved.obj()));
    refuses(&bench, &[], &["bar.obj: nothing to learn from: none of the poses shows another shape"]);
    let out = bench.folder.path("r.json");
    let outcome = pliant(["learn", &bench.reference, "-o", &out]);
    assert_eq!(outcome.code, 1);
    assert!(
        outcome
            .err
            .ends_with("bar.obj: holds no morph targets and no animation that moves its mesh: name files with poses\n"),
        "{}",
        outcome.err
    );
    assert!(!std::path::Path::new(&out).exists());
}

#[test]
fn options_out_of_range_and_outputs_over_inputs_are_refused() {
    let bench = Bench::new();
    for (more, words) in [
        (["--r-min", "0"], "--r-min is 0, but must be between 1 and 1000"),
        (["--r-max", "1001"], "--r-max is 1001, but must be between 1 and 1000"),
        (["--r-min", "7"], "--r-min is 7, but must be at most --r-max"),
        (["--omega", "-0.1"], "--omega is -0.1, but must be auto or a number of at least 0"),
        (["--omega", "nan"], "--omega is NaN"),
        (["--frames", "0"], "--frames is 0, but must be between 1 and 10000"),
        (["--threads", "0"], "--threads is 0, but must be at least 1"),
    ] {
        refuses(&bench, &more, &[words]);
    }
    let refused = |out: &str, more: &[&str], words: &str| {
        let before = std::fs::read(&bench.reference).expect("the reference");
        let outcome = bench.run(out, more);
        assert_eq!(outcome.code, 1, "{}", outcome.err);
        assert!(outcome.err.contains(words), "{}\ndoes not say {words:?}", outcome.err);
        assert_eq!(std::fs::read(&bench.reference).expect("the reference"), before);
    };
    let out = bench.folder.path("r.json");
    refused(&bench.poses[1], &[], "OUT would overwrite a pose");
    refused(&out, &["--table", &bench.reference], "the table would overwrite REFERENCE");
    refused(&out, &["--report", &out], "the report would overwrite OUT");
    let (mesh, beside) = (bench.folder.path("out.obj"), bench.folder.path("out.rigidity.json"));
    refused(&mesh, &["--report", &beside], "the report would overwrite a file that belongs to OUT");
    refused(&mesh, &["--table", &beside], "the table would overwrite a file that belongs to OUT");
    refused(&out, &["--table", &bench.folder.path("bar.rigidity.json")], "a file that belongs to REFERENCE");
    refused(&bench.folder.path("r.txt"), &[], "not a mesh file or array by its name; use .json");
    refused(&bench.folder.path("missing/r.json"), &[], "there is no folder");
    assert_eq!(bench.run(&out, &["--omega", "much"]).code, 2);
    assert_eq!(pliant(["learn", "-o", "r.json"]).code, 2);
    assert_eq!(pliant(["learn", &bench.reference, &bench.poses[0]]).code, 2);
}

#[test]
fn quiet_says_nothing_and_otherwise_one_line_sums_up() {
    let bench = Bench::new();
    let out = bench.folder.path("r.json");
    let said = bench.run(&out, &[]).expect_done();
    assert_eq!((said.out.lines().count(), said.err.as_str()), (1, ""), "{}", said.out);
    assert!(said.out.contains("from 3 poses, omega "), "{}", said.out);
    let said = bench.run(&out, &["--quiet"]).expect_done();
    assert_eq!((said.out.as_str(), said.err.as_str()), ("", ""));
}

#[test]
fn a_terminal_sees_progress_that_is_wiped_at_the_end() {
    let bench = Bench::new();
    let out = bench.folder.path("r.json");
    let arguments = ["pliant", "learn", &bench.reference, &bench.poses[0], "-o", &out];
    let (mut said, mut err) = (Vec::new(), Vec::new());
    assert_eq!(main_with(arguments, &mut Console::new(&mut said, &mut err, true)), 0);
    let err = String::from_utf8(err).expect("text");
    assert!(err.starts_with(&format!("reading {}", bench.reference)) && err.ends_with("\r\x1b[K"), "{err:?}");
}
