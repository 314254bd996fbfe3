//! Every crafted file becomes what it must, and thousands of damaged ones do no harm.

use pliant_hostile::crafted;
use pliant_hostile::run::{Batch, Report, run};
use std::collections::HashSet;
use std::path::Path;

/// Damaged files tried; the long run goes on from there for as long as one likes.
const N_DAMAGED: u64 = 10_000;

fn tried(batch: Batch, n: u64) -> Report {
    let report = run(Path::new(env!("CARGO_BIN_EXE_pliant-hostile")), batch, n, None).expect("workers can be started");
    let troubles: Vec<String> =
        report.troubles.iter().map(|t| format!("file {} ({}): {}", t.index, t.name, t.what)).collect();
    assert!(troubles.is_empty(), "{} files in trouble:\n{}", troubles.len(), troubles.join("\n"));
    assert_eq!(report.opened + report.refused, n, "files with an outcome");
    report
}

#[test]
fn crafted_files_become_what_they_must_within_limits() {
    let cases = crafted::all();
    assert!(cases.len() >= 500, "{} crafted files", cases.len());
    let mut names = HashSet::new();
    let twice: Vec<&str> = cases.iter().map(|case| case.name.as_str()).filter(|name| !names.insert(*name)).collect();
    assert!(twice.is_empty(), "files of one name: {twice:?}");
    tried(Batch::Crafted, cases.len() as u64);
}

#[test]
fn damaged_files_open_or_are_refused_within_limits() {
    let report = tried(Batch::Damaged(1), N_DAMAGED);
    // Damage that nothing survives, or everything, would test little.
    let share = report.opened as f64 / N_DAMAGED as f64;
    assert!((0.1..0.9).contains(&share), "{share} of the damaged files opened");
}

#[test]
#[cfg(target_os = "linux")]
fn nothing_outside_the_folder_of_a_file_is_read() {
    let n = pliant_hostile::references::Traps::new().expect("a folder with traps").n();
    assert!(n >= 60, "{n} references");
    tried(Batch::References, n as u64);
}
