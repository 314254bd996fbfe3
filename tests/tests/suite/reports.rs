//! What `deform` says about its work, and what it writes.

use pliant_tests::program::{Folder, handles_json, pliant, read_json, read_positions};
use pliant_tests::shapes::{Shape, Vector, bar, bumpy_ball, distance, irregular_sheet};
use serde_json::{Value, json};

fn small_bar() -> Shape {
    bar([10, 2, 2], [5.0, 1.0, 1.0])
}

/// One end held, the other lifted.
fn lift(shape: &Shape) -> Vec<(usize, Vector)> {
    let held = shape.vertices(|position| position[0] == 0.0 || position[0] == 5.0);
    let target = |[x, y, z]: Vector| if x == 0.0 { [x, y, z] } else { [x, y + 1.5, z] };
    held.into_iter().map(|vertex| (vertex, target(shape.positions[vertex]))).collect()
}

/// Deforms and returns the report.
#[track_caller]
fn deform(folder: &Folder, mesh: &str, handles: &str, out: &str, more: &[&str]) -> Value {
    let handles = folder.write("handles.json", handles);
    let report = folder.path("report.json");
    let mut arguments = vec!["deform", mesh, "--handles", &handles, "-o", out, "--report", &report];
    arguments.extend(more);
    pliant(arguments).expect_done();
    read_json(&report)
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

#[test]
fn a_report_has_the_documented_keys_in_order() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let more = ["--rigidity", "2", "--threads", "1", "--check-intersections"];
    let report = deform(&folder, &mesh, &handles_json(&lift(&shape)), &folder.path("out.obj"), &more);
    let expected = [
        "mesh",
        "method",
        "solver",
        "weights",
        "threads",
        "rigidity",
        "converged",
        "iterations",
        "energies",
        "max_handle_error",
        "self_intersections",
        "times_ms",
        "peak_memory_bytes",
        "warnings",
    ];
    assert_eq!(keys(&report), expected);
    let times = [
        "load",
        "neighborhoods",
        "order",
        "factorize",
        "iterate",
        "iteration_median",
        "local_median",
        "global_median",
        "save",
        "total",
    ];
    assert_eq!(keys(&report["times_ms"]), times);
    // 10 × 2 × 2 cells: 8 vertices around each of 11 sections, and one inside each end.
    let mesh = json!({"vertices": 90, "surface_points": 90, "faces": 176, "edges": 264, "components": 1});
    assert_eq!(report["mesh"], mesh);
    assert_eq!(report["rigidity"], json!({"min": 2, "max": 2, "mean": 2.0}));
    assert_eq!([&report["method"], &report["solver"], &report["weights"]], ["rring", "lbfgs", "clamped"]);
    assert_eq!([&report["threads"], &report["self_intersections"]], [&json!(1), &json!(0)]);
    assert_eq!(report["max_handle_error"], json!(0.0));
    assert_eq!(report["warnings"], json!([]));
    assert_eq!(report["iterations"], json!(report["energies"].as_array().expect("a list").len()));
    for (stage, time) in report["times_ms"].as_object().expect("an object") {
        assert!(time.as_f64().is_some_and(|ms| ms >= 0.0), "{stage}: {time}");
    }
}

#[test]
#[cfg(unix)]
fn a_report_behind_a_link_is_written_through_it() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let kept = folder.write("kept.json", "old");
    std::os::unix::fs::symlink(&kept, folder.path("report.json")).expect("a new link");
    let report = deform(&folder, &mesh, &handles_json(&lift(&shape)), &folder.path("out.obj"), &[]);
    assert_eq!(read_json(&kept), report);
    assert!(std::fs::symlink_metadata(folder.path("report.json")).expect("the link").is_symlink());
}

#[test]
fn intersections_are_counted_only_when_asked_for() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let report = deform(&folder, &mesh, &handles_json(&lift(&shape)), &folder.path("out.obj"), &[]);
    assert_eq!(report["self_intersections"], Value::Null);
}

#[test]
fn both_solvers_say_their_name_and_find_the_same_minimum() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let solve = |name: &str, start: &str| {
        let more = ["--solver", name, "--start", start, "--tolerance", "1e-10", "--method", "arap"];
        let report = deform(&folder, &mesh, &handles_json(&lift(&shape)), &folder.path("out.obj"), &more);
        assert_eq!([&report["solver"], &report["converged"]], [&json!(name), &json!(true)], "from {start}");
        let energies: Vec<f64> =
            report["energies"].as_array().expect("a list").iter().map(|e| e.as_f64().expect("a number")).collect();
        assert!(energies.is_sorted_by(|before, after| after <= before), "{name} from {start}: {energies:?}");
        (energies.len(), *energies.last().expect("an iteration"))
    };
    for start in ["rest", "auto"] {
        let (plain_count, plain) = solve("local-global", start);
        let (count, energy) = solve("lbfgs", start);
        // Plain iteration ends where it is slow, not where it has arrived.
        assert!((energy - plain).abs() < 1e-6 * plain, "from {start}: {energy} instead of {plain}");
        assert!(2 * count < plain_count, "from {start}: {count} iterations instead of {plain_count}");
    }
}

#[test]
fn running_out_of_iterations_is_said_and_not_a_failure() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let more = ["--start", "rest", "--max-iterations", "2", "--tolerance", "1e-9"];
    let report = deform(&folder, &mesh, &handles_json(&lift(&shape)), &folder.path("out.obj"), &more);
    assert_eq!([&report["converged"], &report["iterations"]], [&json!(false), &json!(2)]);
    let more = ["--start", "rest", "--max-iterations", "7", "--tolerance", "0"];
    let report = deform(&folder, &mesh, &handles_json(&lift(&shape)), &folder.path("out.obj"), &more);
    assert_eq!(report["iterations"], json!(7), "a tolerance of 0 runs all iterations");
}

#[test]
fn handles_at_rest_give_the_rest_pose() {
    let (folder, shape) = (Folder::new(), bumpy_ball(2, 0.2, 4));
    let mesh = folder.write("ball.obj", shape.obj());
    let out = folder.path("out.obj");
    for start in ["auto", "rest"] {
        let report =
            deform(&folder, &mesh, r#"{"fixed": [0, 5, 9, 70]}"#, &out, &["--start", start, "--rigidity", "3"]);
        assert_eq!(report["converged"], json!(true));
        for (vertex, (got, &expected)) in read_positions(&out).iter().zip(&shape.positions).enumerate() {
            assert!(distance(*got, expected) < 1e-7, "{start}: vertex {vertex}: {got:?}, expected {expected:?}");
        }
    }
}

#[test]
fn handles_moved_as_one_move_everything_with_them() {
    let (folder, shape) = (Folder::new(), bumpy_ball(2, 0.2, 4));
    let mesh = folder.write("ball.obj", shape.obj());
    let out = folder.path("out.obj");
    // A quarter turn about z, then (1, 2, 3); column by column.
    let handles = json!({"groups": [{
        "vertices": [0, 20, 60, 100, 150],
        "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1],
    }]});
    let report = deform(&folder, &mesh, &handles.to_string(), &out, &["--rigidity", "2"]);
    assert_eq!(report["converged"], json!(true));
    for (vertex, (got, &[x, y, z])) in read_positions(&out).iter().zip(&shape.positions).enumerate() {
        let expected = [1.0 - y, 2.0 + x, 3.0 + z];
        assert!(distance(*got, expected) < 1e-6, "vertex {vertex}: {got:?}, expected {expected:?}");
    }
}

#[test]
fn parts_without_a_handle_stay_and_are_named() {
    let folder = Folder::new();
    let near = irregular_sheet(4, 3, 0.2, 1);
    let mut text = near.obj();
    let first = near.positions.len();
    // A triangle of its own, and a vertex that nothing uses.
    text += "v 100 0 0\nv 101 0 0\nv 100 1 0\nv 50 50 50\n";
    text += &format!("f {} {} {}\n", first + 1, first + 2, first + 3);
    let mesh = folder.write("parts.obj", text);
    let handles = r#"{"fixed": [0, 1, 2], "moved": [{"vertex": 18, "to": [4, 3, 2]}]}"#;
    let out = folder.path("out.obj");
    let report = deform(&folder, &mesh, handles, &out, &[]);
    let warnings = report["warnings"].to_string();
    assert!(
        warnings.contains(&format!("component of 3 vertices has no handle and stays at rest (first: vertex {first})")),
        "{warnings}"
    );
    assert!(warnings.contains(&format!("(first: vertex {})", first + 3)), "{warnings}");
    let positions = read_positions(&out);
    assert_eq!(positions[first + 1], [101.0, 0.0, 0.0]);
    assert_eq!(positions[first + 3], [50.0, 50.0, 50.0]);
}

#[test]
fn rigidity_asked_for_is_in_the_output_and_is_used_when_it_is_opened_again() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let r: Vec<u16> = shape.positions.iter().map(|position| if position[0] > 2.0 { 4 } else { 1 }).collect();
    let file = folder.write("r.txt", r.iter().map(|r| format!("{r}\n")).collect::<String>());
    let handles = handles_json(&lift(&shape));
    for name in ["out.glb", "out.gltf", "out.obj"] {
        let out = folder.path(name);
        let first = deform(&folder, &mesh, &handles, &out, &["--rigidity", &file]);
        let reopened = pliant_meshfile::open(out.as_ref()).expect("an output written before");
        assert_eq!(reopened.rigidity.as_deref(), Some(&r[..]), "{name}");
        let again = deform(&folder, &out, r#"{"fixed": [0]}"#, &folder.path("again.obj"), &[]);
        assert_eq!(again["rigidity"], first["rigidity"], "{name}");
        let as_file = ["--rigidity", &out];
        let through_mesh = deform(&folder, &mesh, &handles, &folder.path("through.obj"), &as_file);
        assert_eq!(through_mesh["rigidity"], first["rigidity"], "{name}");
    }
}

#[test]
fn arap_is_rigidity_1_everywhere() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let handles = handles_json(&lift(&shape));
    let arap = deform(&folder, &mesh, &handles, &folder.path("arap.obj"), &["--method", "arap"]);
    let rring = deform(&folder, &mesh, &handles, &folder.path("rring.obj"), &["--rigidity", "1"]);
    assert_eq!(arap["method"], json!("arap"));
    assert_eq!(arap["energies"], rring["energies"]);
}

#[test]
fn other_methods_bend_the_same_handles_and_say_what_they_are() {
    let (folder, shape) = (Folder::new(), small_bar());
    let mesh = folder.write("bar.obj", shape.obj());
    let handles = handles_json(&lift(&shape));
    let run = |name: &str, more: &[&str]| {
        let options = [&["--method", name], more].concat();
        deform(&folder, &mesh, &handles, &folder.path(&format!("{name}.obj")), &options)
    };
    let smooth = run("sr-arap", &["--alpha", "0.1"]);
    let embedded = run("embedded", &["--nodes", "40", "--node-neighbors", "3"]);
    for (report, method, solver) in [(&smooth, "sr-arap", "lbfgs"), (&embedded, "embedded", "gauss-newton")] {
        assert_eq!([&report["method"], &report["solver"]], [method, solver]);
        assert_eq!(report["converged"], json!(true), "{method}");
        let energies: Vec<f64> =
            report["energies"].as_array().expect("a list").iter().filter_map(|energy| energy.as_f64()).collect();
        assert!(energies.is_sorted_by(|before, after| after <= before), "{method}: {energies:?}");
    }
    let error = |report: &serde_json::Value| report["max_handle_error"].as_f64().expect("a number");
    assert_eq!(error(&smooth), 0.0);
    assert!(error(&embedded) > 0.0, "handles are soft");
}

#[test]
fn an_obj_keeps_its_order_its_quads_and_everything_else() {
    let folder = Folder::new();
    let text = "# made by hand\nmtllib paint.mtl\no sheet\nv 0 0 0\nv 1 0 0\nvt 0 0\nv 1 1 0\nv 0 1 0\nvt 1 1\nv 2 0 0\n\
        v 2 1 0\nusemtl red\ns off\nf 1/1 2/2 3/1 4/2\nusemtl blue\nf 2 5 6 3\n";
    let mesh = folder.write("quads.obj", text);
    let out = folder.path("out.obj");
    let handles = r#"{"fixed": [0, 3], "moved": [{"vertex": 4, "to": [2, 0, 1]}]}"#;
    deform(&folder, &mesh, handles, &out, &[]);
    let saved = std::fs::read_to_string(&out).expect("the output");
    let others =
        |text: &str| text.lines().filter(|line| !line.starts_with("v ")).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(others(&saved), others(text));
    let positions = read_positions(&out);
    assert_eq!([positions[0], positions[3]], [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(positions[4], [2.0, 0.0, 1.0]);
}

#[test]
fn the_same_command_gives_the_same_bits_on_one_and_on_two_threads() {
    let (folder, shape) = (Folder::new(), bumpy_ball(3, 0.2, 9));
    let mesh = folder.write("ball.obj", shape.obj());
    let handles = r#"{"fixed": [0, 1, 2, 3], "moved": [{"vertex": 600, "to": [2, 1, 0]}]}"#;
    let mut results = Vec::new();
    for (name, threads) in [("a.obj", "1"), ("b.obj", "1"), ("c.obj", "2")] {
        let out = folder.path(name);
        let report = deform(&folder, &mesh, handles, &out, &["--threads", threads, "--rigidity", "4"]);
        results.push((report["energies"].to_string(), std::fs::read(&out).expect("the output")));
    }
    assert!(results[0] == results[1], "two runs on one thread differ");
    assert!(results[0] == results[2], "one and two threads differ");
}
