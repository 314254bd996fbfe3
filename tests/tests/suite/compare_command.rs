//! `pliant compare`: its figures are those of `deform`, its report is one whole file, and what it refuses.

use pliant_tests::program::{Folder, Outcome, handles_json, pliant, read_json};
use pliant_tests::shapes::{Shape, Vector, arc_end, bar, irregular_sheet};
use serde_json::{Value, json};

const LENGTH: f64 = 5.0;

/// A bar bent along an arc, in a folder of its own.
struct Bench {
    folder: Folder,
    mesh: String,
    handles: String,
    out: String,
}

impl Bench {
    fn new() -> Self {
        Bench::of(&bar([20, 3, 3], [LENGTH, 1.0, 1.0]))
    }

    fn of(shape: &Shape) -> Self {
        let held = shape.vertices(|[x, ..]| x == 0.0 || x == LENGTH);
        let target = |at: Vector| if at[0] == 0.0 { at } else { arc_end(at, LENGTH, 120.0) };
        let moved: Vec<_> = held.into_iter().map(|vertex| (vertex, target(shape.positions[vertex]))).collect();
        Bench::with(&shape.obj(), &handles_json(&moved))
    }

    fn with(mesh: &str, handles: &str) -> Self {
        let folder = Folder::new();
        let (mesh, handles) = (folder.write("bar.obj", mesh), folder.write("bend & twist.json", handles));
        let out = folder.path("report.html");
        Bench { folder, mesh, handles, out }
    }

    fn run(&self, entries: &[&str], more: &[&str]) -> Outcome {
        let mut arguments = vec!["compare", &self.mesh, "--handles", &self.handles, "-o", &self.out];
        entries.iter().for_each(|entry| arguments.extend(["--entry", entry]));
        arguments.extend(more);
        pliant(arguments)
    }

    /// Runs with `--json`; the figures, and the page.
    #[track_caller]
    fn compare(&self, entries: &[&str], more: &[&str]) -> (Value, String) {
        let outcome = self.run(entries, &[&["--json"], more].concat()).expect_done();
        let figures = serde_json::from_str(&outcome.out).expect("JSON");
        (figures, std::fs::read_to_string(&self.out).expect("a page"))
    }

    /// Runs `deform` and returns its report.
    #[track_caller]
    fn deform(&self, more: &[&str]) -> Value {
        let (out, report) = (self.folder.path("out.obj"), self.folder.path("r.json"));
        let mut arguments = vec!["deform", &self.mesh, "--handles", &self.handles, "-o", &out, "--report", &report];
        arguments.extend(["--check-intersections"].iter().chain(more));
        pliant(arguments).expect_done();
        read_json(&report)
    }
}

#[test]
fn every_entry_comes_to_the_same_as_deform() {
    let bench = Bench::new();
    let sizes: String = (0..260).map(|vertex| format!("{} ", 1 + vertex % 4)).collect();
    let file = bench.folder.write("r.txt", sizes);
    let from_file = format!("rring:{file}");
    let ways: [(&str, &[&str]); 5] = [
        ("rring:3", &["--rigidity", "3"]),
        (&from_file, &["--rigidity", &file]),
        ("arap", &["--method", "arap"]),
        ("sr-arap:alpha=0.1", &["--method", "sr-arap", "--alpha", "0.1"]),
        ("embedded:nodes=40", &["--method", "embedded", "--nodes", "40"]),
    ];
    let common = ["--weights", "uniform", "--tolerance", "1e-5"];
    let (figures, page) = bench.compare(&ways.map(|(entry, _)| entry), &common);
    for (k, (entry, options)) in ways.iter().enumerate() {
        let (got, alone) = (&figures["entries"][k], bench.deform(&[*options, &common].concat()));
        let result = &got["result"];
        assert_eq!(
            [&got["entry"], &got["method"], &got["solver"]],
            [&json!(entry), &alone["method"], &alone["solver"]]
        );
        for key in ["energies", "converged", "iterations", "max_handle_error", "self_intersections"] {
            assert_eq!(result[key], alone[key], "{entry}: {key}");
        }
        let own = alone["energies"].as_array().and_then(|all| all.last()?.as_f64()).expect("energies");
        let expected = format!("data-value=\"{own:e}\"");
        let row = row(&page, "own_energy");
        assert!(row.contains(&expected), "{entry}: the page does not have {expected} in {row}");
    }
    let arap = &figures["entries"][2]["result"];
    let [own, common] = [arap["energies"].as_array().and_then(|all| all.last()).expect("some"), &arap["common_energy"]]
        .map(|number| number.as_f64().expect("a number"));
    assert!((own - common).abs() < 1e-9 * own, "what is common to all is ARAP's own: {common}, expected {own}");
}

/// The row of the table with the figures of one measure.
#[track_caller]
fn row<'a>(page: &'a str, measure: &str) -> &'a str {
    let start = page.find(&format!("<tr data-measure=\"{measure}\"")).unwrap_or_else(|| panic!("no row {measure}"));
    let row = &page[start..];
    &row[..row.find("</tr>").expect("an end of the row")]
}

#[test]
fn the_report_is_well_formed_and_needs_nothing_but_itself() {
    let bench = Bench::new();
    let file = bench.folder.write("r<1>.json", format!("[{}]", vec!["2"; 259].join(",") + ",5"));
    let (_, page) = bench.compare(&[&format!("rring:{file}"), "arap", "embedded:nodes=30"], &[]);
    assert_eq!(bench.folder.names(), ["bar.obj", "bend & twist.json", "r<1>.json", "report.html"]);
    assert_well_formed(&page);
    for outside in ["http:", "https:", "<script", "<link", "@import", "url(", "file:"] {
        assert!(!page.contains(outside), "the page has {outside:?}");
    }
    let folder = bench.folder.path("");
    assert!(!page.contains(folder.trim_end_matches('/')), "the page tells the folder of the files");
    let sources = page.matches(" src=\"").count();
    assert_eq!(sources, page.matches(" src=\"data:image/png;base64,").count(), "all pictures are in the page");
    // The rest shape, the painted rigidity, and two of each entry.
    assert_eq!(sources, 1 + 1 + 2 * 3);
    let targets: Vec<&str> = page.split(" href=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    for target in &targets {
        let id = target.strip_prefix('#').unwrap_or_else(|| panic!("a link out of the page: {target}"));
        assert!(page.contains(&format!("id=\"{id}\"")), "nothing is called {id}");
    }
    let command = "pliant compare bar.obj --handles &#39;bend &amp; twist.json&#39;";
    let escaped = page.replace("'", "&#39;");
    assert!(escaped.contains(command), "the command that made it is told, with its names quoted");
    assert!(page.contains("Rigidity from r&lt;1&gt;.json"));
}

/// Every tag is closed in order, and every `&` begins a character's name.
#[track_caller]
fn assert_well_formed(page: &str) {
    let page = page.strip_prefix("<!DOCTYPE html>").expect("a type");
    let mut open = Vec::new();
    for (k, piece) in page.split('<').enumerate().skip(1) {
        let (tag, text) = piece.split_once('>').unwrap_or_else(|| panic!("tag {k} has no end: {piece}"));
        let name = tag.split_whitespace().next().unwrap_or_default();
        match name.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name), "before {text:?}"),
            None if ["meta", "img", "br"].contains(&name) => {}
            None => open.push(name),
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "quotes of <{tag}>");
        for entity in text.split('&').skip(1) {
            assert!(entity.find(';').is_some_and(|end| end < 8), "&{entity}");
        }
    }
    assert_eq!(open, [""; 0], "all is closed");
}

#[test]
fn the_best_of_a_row_is_marked_and_volume_only_where_there_is_one() {
    let bench = Bench::new();
    let (figures, page) = bench.compare(&["rring:6", "arap"], &[]);
    let common = row(&page, "common_energy");
    assert!(common.find("class=\"best\"") > common.find("data-value"), "ARAP, the second, is best: {common}");
    let ratio = figures["entries"][1]["result"]["volume_ratio"].as_f64().expect("closed");
    assert!((0.5..1.1).contains(&ratio), "{ratio}");

    let sheet = irregular_sheet(9, 7, 0.2, 3);
    let open = Bench::with(&sheet.obj(), r#"{"fixed": [0, 1, 2], "moved": [{"vertex": 79, "to": [8, 6, 5]}]}"#);
    let (figures, page) = open.compare(&["rring:2", "arap"], &[]);
    assert_eq!(figures["entries"][0]["result"]["volume_ratio"], Value::Null);
    let why = "the surface is open (32 edges have a face on one side only)";
    assert_eq!(figures["rest"]["no_volume"], json!(why));
    assert!(row(&page, "volume_ratio").contains(why), "{}", row(&page, "volume_ratio"));
}

#[test]
fn figures_do_not_depend_on_threads_and_histograms_are_of_all_edges() {
    let bench = Bench::new();
    let figures = |threads: &str| {
        let (mut figures, _) = bench.compare(&["rring:2", "sr-arap"], &["--threads", threads]);
        let fields = figures.as_object_mut().expect("an object");
        for key in ["times_ms", "peak_memory_bytes", "threads"] {
            fields.remove(key).expect(key);
        }
        for entry in fields["entries"].as_array_mut().expect("a list") {
            entry["result"].as_object_mut().expect("an object").remove("times_ms");
        }
        figures
    };
    let one = figures("1");
    assert_eq!(one, figures("2"));
    let result = &one["entries"][0]["result"];
    // Closed: three edges for two of the 516 faces, and all of them have two faces.
    assert_eq!([&result["stretch"]["count"], &result["bending"]["count"]], [&json!(774), &json!(774)]);
    for measure in ["stretch", "bending"] {
        let shares = result[measure]["histogram"].as_array().expect("a list").iter();
        let sum: f64 = shares.map(|share| share.as_f64().expect("a number")).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{measure}: {sum}");
    }
}

#[test]
fn an_entry_that_fails_says_why_and_the_others_go_on() {
    // Two faces that are obtuse across from their common edge, whose weight is so negative that no minimum is left when slim
    // spikes at its ends count it twice: with r = 2.
    let mut text = "v 0 0 0\nv 4 0 0\nv 2 0.3 0\nv 2 -0.3 0\nf 1 2 3\nf 2 1 4\n".to_owned();
    for spike in 0..20 {
        let (end, first) = (spike % 2, 2 * spike + 5);
        let (x, z) = (4 * end, spike + 1);
        text += &format!("v {x} 0.001 {z}\nv {x} -0.001 {z}\nf {} {first} {}\n", end + 1, first + 1);
    }
    let held = json!({"fixed": (2..44).collect::<Vec<_>>()});
    let bench = Bench::with(&text, &held.to_string());
    let raw = ["--weights", "cotangent"];
    let (figures, page) = bench.compare(&["rring:2", "embedded:nodes=10"], &raw);
    assert!(figures["entries"][0]["failed"].as_str().is_some_and(|why| why.contains("--weights clamped")), "{figures}");
    assert_eq!([&figures["entries"][0]["result"], &figures["entries"][1]["failed"]], [&Value::Null; 2]);
    assert!(page.contains("has no result: bar.obj: its raw cotangents admit no minimum"), "said in the page, too");
    assert_well_formed(&page);

    std::fs::remove_file(&bench.out).expect("written before");
    let outcome = bench.run(&["rring:2"], &raw);
    assert_eq!(outcome.code, 1, "{}", outcome.err);
    assert!(outcome.err.contains("no entry could be solved") && outcome.err.lines().count() == 1, "{}", outcome.err);
    assert!(!bench.folder.names().contains(&"report.html".to_owned()));
}

#[test]
fn parts_without_handles_and_faces_without_area_are_compared_too() {
    let mut text = irregular_sheet(4, 3, 0.2, 1).obj();
    text += "v 100 0 0\nv 101 0 0\nv 100 1 0\nv 50 50 50\nf 21 22 23\nf 1 1 2\n";
    let bench = Bench::with(&text, r#"{"fixed": [0, 1, 2], "moved": [{"vertex": 18, "to": [4, 3, 2]}]}"#);
    let (figures, page) = bench.compare(&["rring:2", "arap", "sr-arap", "embedded:nodes=12"], &[]);
    for entry in figures["entries"].as_array().expect("a list") {
        assert_eq!(entry["failed"], Value::Null);
        assert!(entry["result"]["common_energy"].as_f64().is_some_and(f64::is_finite), "{entry}");
    }
    let said = figures["warnings"].to_string();
    assert!(said.contains("component of 3 vertices has no handle and stays at rest"), "{said}");
    assert_eq!(said.matches("component of 3").count(), 1, "once for all entries: {said}");
    assert_well_formed(&page);
}

#[test]
fn bad_input_is_refused_in_one_line_and_nothing_is_written() {
    let bench = Bench::new();
    let short = bench.folder.write("short.txt", "1 2 3");
    let points = bench.folder.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    let refused = |mesh: &str, out: &str, entry: &str, words: &str| {
        let before = bench.folder.names();
        let outcome =
            pliant(["compare", mesh, "--handles", &bench.handles, "-o", out, "--entry", "arap", "--entry", entry]);
        assert_eq!(outcome.code, 1, "{entry}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
        assert!(outcome.err.starts_with("pliant: ") && outcome.err.contains(words), "{}", outcome.err);
        assert_eq!(bench.folder.names(), before);
    };
    let (mesh, out) = (&bench.mesh, &bench.out);
    refused(mesh, out, "rring:0", "r of --entry is 0, but must be between 1 and 1000");
    refused(mesh, out, "rring:nowhere.json", "nowhere.json");
    refused(mesh, out, &format!("rring:{short}"), "short.txt");
    refused(mesh, out, "sr-arap:alpha=-1", "alpha of --entry is -1");
    refused(mesh, out, "embedded:nodes=0", "nodes of --entry is 0, but must be from 1 to 20000");
    refused(&points, out, "rring", "no faces");
    refused(&bench.folder.path("nothing.obj"), out, "rring", "nothing.obj");
    refused(mesh, &bench.folder.path("report.pdf"), "rring", "use the extension .html");
    refused(mesh, &bench.folder.path("missing/report.html"), "rring", "there is no folder");
    let handles = bench.folder.write("handles.html", "{}");
    let outcome = pliant(["compare", mesh, "--handles", &handles, "-o", &handles, "--entry", "arap"]);
    assert!(outcome.code == 1 && outcome.err.contains("the report would overwrite the handles"), "{}", outcome.err);
}

#[test]
fn wrong_usage_ends_with_2() {
    let wrong = [vec![], vec!["--entry", "magic"], vec!["--entry", "arap:2"], vec!["--entry", "sr-arap:beta=1"]];
    for entries in wrong {
        let arguments = ["compare", "a.obj", "--handles", "h.json", "-o", "b.html"].iter().chain(&entries);
        let outcome = pliant(arguments);
        assert_eq!(outcome.code, 2, "{entries:?}: {}", outcome.err);
        assert!(outcome.err.starts_with("error: "), "{}", outcome.err);
    }
}

#[test]
fn without_json_a_line_is_said_for_each_entry() {
    let bench = Bench::new();
    let said = bench.run(&["rring:2", "arap"], &[]).expect_done().out;
    let lines: Vec<&str> = said.lines().map(str::trim_start).collect();
    assert!(lines.len() == 3 && lines[0].starts_with("rring:2: ") && lines[1].starts_with("arap: "), "{said}");
    assert!(lines[2].contains("report.html"), "{said}");
    assert_eq!(bench.run(&["arap"], &["--quiet"]).expect_done().out, "");
}
