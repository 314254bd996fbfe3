//! Bad input: exit code 1, one line that names the place, and nothing written or touched.

use pliant_tests::program::{Folder, pliant};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const HANDLES: &str = r#"{"fixed": [0, 1], "moved": [{"vertex": 2, "to": [1, 1, 0.5]}]}"#;

/// A folder with good input, for one thing at a time to be wrong.
struct Bench {
    folder: Folder,
    mesh: String,
    handles: String,
    out: String,
}

impl Bench {
    fn new() -> Self {
        let folder = Folder::new();
        let mesh = folder.write("square.obj", SQUARE);
        let handles = folder.write("handles.json", HANDLES);
        let out = folder.path("out.obj");
        Bench { folder, mesh, handles, out }
    }

    /// Deforms with these further options.
    #[track_caller]
    fn refuses(self, more: &[&str], words: &[&str]) {
        let mut arguments = vec!["deform", &self.mesh, "--handles", &self.handles, "-o", &self.out];
        arguments.extend(more);
        self.refuses_all(&arguments, words);
    }

    /// Runs twice: with nothing at the place of the output, and with something precious there.
    #[track_caller]
    fn refuses_all(&self, arguments: &[&str], words: &[&str]) {
        for precious in [None, Some("precious")] {
            let may_write = !std::path::Path::new(&self.out).is_dir() && !self.out.contains("missing");
            if let Some(content) = precious.filter(|_| may_write) {
                std::fs::write(&self.out, content).expect("an output that existed before");
            }
            let before = self.contents();
            let outcome = pliant(arguments);
            assert_eq!(outcome.code, 1, "exit code of {arguments:?}: {}", outcome.err);
            assert_eq!(outcome.out, "", "standard output of {arguments:?}");
            let lines: Vec<&str> = outcome.err.lines().collect();
            let [line] = lines[..] else { panic!("not one line but {lines:?}") };
            assert!(line.starts_with("pliant: "), "{line}");
            for word in words {
                assert!(line.contains(word), "{line}\ndoes not say {word:?}");
            }
            assert_eq!(self.contents(), before, "files after {arguments:?}");
        }
    }

    fn contents(&self) -> Vec<(String, Option<Vec<u8>>)> {
        let read = |name: String| {
            let bytes = std::fs::read(self.folder.path(&name)).ok();
            (name, bytes)
        };
        self.folder.names().into_iter().map(read).collect()
    }
}

#[track_caller]
fn bad_mesh(name: &str, content: impl AsRef<[u8]>, words: &[&str]) {
    let mut bench = Bench::new();
    bench.mesh = bench.folder.write(name, content);
    let words: Vec<&str> = [name].iter().chain(words).copied().collect();
    bench.refuses(&[], &words);
}

#[track_caller]
fn bad_handles(content: &str, words: &[&str]) {
    let mut bench = Bench::new();
    bench.handles = bench.folder.write("bad.json", content);
    let words: Vec<&str> = ["bad.json"].iter().chain(words).copied().collect();
    bench.refuses(&[], &words);
}

#[track_caller]
fn bad_rigidity(content: &str, words: &[&str]) {
    let bench = Bench::new();
    let file = bench.folder.write("r.json", content);
    let words: Vec<&str> = ["r.json"].iter().chain(words).copied().collect();
    bench.refuses(&["--rigidity", &file], &words);
}

#[test]
fn a_missing_mesh_is_named() {
    let mut bench = Bench::new();
    bench.mesh = bench.folder.path("nowhere.obj");
    bench.refuses(&[], &["nowhere.obj"]);
}

#[test]
fn a_folder_in_place_of_a_mesh_is_refused() {
    let mut bench = Bench::new();
    bench.mesh = bench.folder.path("folder.obj");
    std::fs::create_dir(&bench.mesh).expect("a new folder");
    bench.refuses(&[], &["folder.obj"]);
}

#[test]
fn empty_meshes_are_refused() {
    bad_mesh("empty.obj", "", &[]);
    bad_mesh("points.obj", "v 0 0 0\nv 1 0 0\n", &[]);
    bad_mesh("empty.glb", "", &[]);
    bad_mesh("empty.gltf", "{}", &[]);
}

#[test]
fn a_face_past_the_end_of_the_vertices_is_refused() {
    bad_mesh("past.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", &["4"]);
}

#[test]
fn coordinates_that_are_not_finite_are_refused() {
    bad_mesh("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", &[]);
    bad_mesh("infinite.obj", "v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", &[]);
}

#[test]
fn unknown_and_broken_formats_are_refused() {
    bad_mesh("mesh.xyz", SQUARE, &[]);
    bad_mesh("noise.glb", [7_u8; 300], &[]);
    bad_mesh("noise.gltf", "{\"asset\": ", &[]);
}

#[test]
fn handles_past_the_end_name_their_place() {
    bad_handles(
        r#"{"fixed": [0], "moved": [{"vertex": 9000, "to": [0, 0, 0]}]}"#,
        &["moved[0].vertex is 9000", "4 vertices (0 to 3)"],
    );
    bad_handles(r#"{"fixed": [0, 4]}"#, &["fixed[1] is 4"]);
}

#[test]
fn no_handles_at_all_are_refused() {
    bad_handles("{}", &["no handles at all"]);
    bad_handles(r#"{"fixed": [], "groups": []}"#, &["no handles at all"]);
}

#[test]
fn malformed_handles_are_refused_with_their_line() {
    bad_handles("", &["line 1"]);
    bad_handles("{\"fixed\": [0,\n 1,]}", &["line 2"]);
    bad_handles(r#"{"fixed": ["first"]}"#, &["line 1"]);
    bad_handles(r#"{"fixed": [-1]}"#, &["-1", "line 1"]);
    bad_handles(r#"{"fixed": [0], "pinned": [1]}"#, &["pinned"]);
    bad_handles(r#"{"moved": [{"vertex": 0, "to": [0, 0, NaN]}]}"#, &["line 1"]);
    bad_handles(r#"{"groups": [{"vertices": [0], "matrix": [1, 0, 0, 0]}]}"#, &["groups[0].matrix", "16"]);
}

#[test]
fn two_targets_for_one_vertex_are_refused() {
    bad_handles(r#"{"fixed": [0, 2], "moved": [{"vertex": 2, "to": [1, 1, 0.5]}]}"#, &["moved[0]", "fixed[1]"]);
}

#[test]
fn targets_too_far_away_name_their_place() {
    bad_handles(r#"{"fixed": [0], "moved": [{"vertex": 2, "to": [1e200, 0, 0]}]}"#, &["moved[0].vertex is 2", "1e100"]);
}

#[test]
fn a_missing_handles_file_is_named() {
    let mut bench = Bench::new();
    bench.handles = bench.folder.path("nowhere.json");
    bench.refuses(&[], &["nowhere.json"]);
}

#[test]
fn rigidity_out_of_range_is_refused() {
    Bench::new().refuses(&["--rigidity", "0"], &["--rigidity is 0"]);
    Bench::new().refuses(&["--rigidity", "-2"], &["--rigidity is -2"]);
    Bench::new().refuses(&["--rigidity", "100000"], &["--rigidity is 100000"]);
    bad_rigidity("[1, 0, 1, 1]", &["0"]);
    bad_rigidity("1 1 1 -4", &[]);
    bad_rigidity("[1, 2.5, 1, 1]", &[]);
}

#[test]
fn rigidity_files_of_another_length_are_refused() {
    bad_rigidity("[1, 2, 3]", &["3", "4"]);
    bad_rigidity("1 2 3 4 5", &["5", "4"]);
    bad_rigidity("", &[]);
}

#[test]
fn a_missing_rigidity_file_is_named() {
    Bench::new().refuses(&["--rigidity", "nowhere.txt"], &["nowhere.txt"]);
}

#[test]
fn numbers_out_of_range_are_refused() {
    Bench::new().refuses(&["--max-iterations", "0"], &["--max-iterations"]);
    Bench::new().refuses(&["--tolerance", "-1"], &["--tolerance"]);
    Bench::new().refuses(&["--tolerance", "nan"], &["--tolerance"]);
    Bench::new().refuses(&["--method", "sr-arap", "--alpha", "-1"], &["--alpha"]);
    Bench::new().refuses(&["--method", "embedded", "--nodes", "0"], &["--nodes"]);
    Bench::new().refuses(&["--method", "embedded", "--node-neighbors", "1"], &["--node-neighbors"]);
    Bench::new().refuses(&["--threads", "0"], &["--threads"]);
}

#[test]
fn raw_cotangents_without_a_minimum_name_the_option_that_helps() {
    let mut bench = Bench::new();
    // Two faces that are obtuse at vertices 2 and 3: the weight of their common edge is negative. Held spikes at both of
    // its ends, so slim that their own weights are small, count it with r = 2 twice as often as the other sides.
    let mut text = "v 0 0 0\nv 4 0 0\nv 2 0.3 0\nv 2 -0.3 0\nf 1 2 3\nf 2 1 4\n".to_owned();
    for spike in 0..20 {
        let (end, first) = (spike % 2, 2 * spike + 5);
        let (x, z) = (4 * end, spike + 1);
        text += &format!("v {x} 0.001 {z}\nv {x} -0.001 {z}\nf {} {first} {}\n", end + 1, first + 1);
    }
    bench.mesh = bench.folder.write("spikes.obj", text);
    let held: Vec<String> = (2..44).map(|vertex| vertex.to_string()).collect();
    bench.handles = bench.folder.write("spikes.json", format!("{{\"fixed\": [{}]}}", held.join(", ")));
    let words = ["spikes.obj", "--weights clamped"];
    bench.refuses(&["--weights", "cotangent", "--rigidity", "2"], &words);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_work() {
    let mut bench = Bench::new();
    bench.out = bench.folder.path("out.xyz");
    bench.refuses(&[], &["out.xyz", ".obj"]);

    let mut bench = Bench::new();
    bench.out = bench.folder.path("missing/out.obj");
    bench.refuses(&[], &["missing", "folder"]);

    let mut bench = Bench::new();
    bench.out = bench.folder.path("folder.obj");
    std::fs::create_dir(&bench.out).expect("a new folder");
    bench.refuses(&[], &["folder.obj", "folder"]);
}

#[test]
fn a_report_that_cannot_be_written_leaves_no_output() {
    let bench = Bench::new();
    let report = bench.folder.path("missing/report.json");
    bench.refuses(&["--report", &report], &["report.json"]);
}

/// A rename would put a plain file in the place of the device, or take the one behind the stream away.
#[test]
#[cfg(target_os = "linux")]
fn devices_and_streams_are_no_place_for_a_file() {
    for place in ["/dev/null", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        Bench::new().refuses(&["--report", place], &[place, "not a regular file"]);
    }
}

#[test]
fn a_report_never_replaces_an_input_or_the_output() {
    let bench = Bench::new();
    let out = bench.out.clone();
    bench.refuses(&["--report", &out], &["OUT"]);
    let bench = Bench::new();
    let handles = bench.handles.clone();
    bench.refuses(&["--report", &handles], &["handles"]);
}

#[test]
fn info_and_render_refuse_like_deform() {
    let bench = Bench::new();
    let missing = bench.folder.path("nowhere.obj");
    bench.refuses_all(&["info", &missing], &["nowhere.obj"]);
    bench.refuses_all(&["info", &missing, "--json"], &["nowhere.obj"]);
    let picture = bench.folder.path("picture.png");
    bench.refuses_all(&["render", &missing, "-o", &picture], &["nowhere.obj"]);
    bench.refuses_all(&["render", &bench.mesh, "-o", &bench.folder.path("picture.bmp")], &["picture.bmp", "PNG"]);
    bench.refuses_all(&["render", &bench.mesh, "-o", &picture, "--size", "0x10"], &["--size", "0x10"]);
    bench.refuses_all(&["render", &bench.mesh, "-o", &picture, "--rigidity", "0"], &["--rigidity is 0"]);
}
