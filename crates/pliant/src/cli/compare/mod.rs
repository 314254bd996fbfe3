//! `pliant compare`: the same handles solved by several methods, and a report that puts them side by side.
//!
//! ```text
//! entries ── bench: solve and measure, one after another ──▶ facts (numbers, also as JSON)
//!                    │                                          │
//!                    └─ placed surfaces ── drawing ──▶ pictures ─┴─ page ──▶ one HTML file
//! ```
//!
//! Surfaces are reduced to what is drawn and counted as soon as they are solved, so that many entries on a large mesh
//! take little more memory than one. The file is written in one step at the end.

mod bench;
mod drawing;
mod facts;
mod names;
mod page;

use std::time::Instant;

use super::args::CompareOptions;
use super::console::Console;
use super::failure::Failure;
use super::report::{peak_memory_bytes, to_json};
use super::solve::milliseconds;
use super::staged::{Staged, check_side_files, check_target, same_file};
use super::threads::on_threads;
use crate::viewport::Headless;
use bench::Bench;
use facts::Facts;
use names::Names;

pub(super) fn run(options: &CompareOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    check_options(options)?;
    on_threads(options.solving.threads, || run_in_pool(options, console))
}

/// Refuses what can be refused without reading a file.
fn check_options(options: &CompareOptions) -> Result<(), Failure> {
    options.solving.check()?;
    options.entries.iter().try_for_each(|entry| entry.check())?;
    let output = &options.output;
    let is_html = |extension: &std::ffi::OsStr| ["html", "htm"].iter().any(|name| extension.eq_ignore_ascii_case(name));
    if !output.extension().is_some_and(is_html) {
        return Err(Failure::NotHtml { path: output.clone() });
    }
    check_target(output)?;
    let named = [(options.mesh.as_path(), "MESH"), (options.handles.as_path(), "the handles")];
    let files = options.entries.iter().filter_map(|entry| Some((entry.file()?.as_ref(), "the rigidity")));
    if let Some((_, other)) = named.into_iter().chain(files).find(|(path, _)| same_file(output, path)) {
        return Err(Failure::SamePath { path: output.clone(), what: "the report", other });
    }
    check_side_files(&[(&options.mesh, "a file that belongs to MESH")], &[(Some(output), "the report")])
}

fn run_in_pool(options: &CompareOptions, console: &mut Console<'_>) -> Result<(), Failure> {
    let clock = Instant::now();
    let mut bench = Bench::load(options, console)?;
    // What would only be found out after minutes: that nothing can be drawn, or written.
    let headless = Headless::new()?;
    drop(Staged::create(&options.output)?);

    let results = bench.solve_all(options, console)?;
    console.stage("drawing");
    let mut facts = Facts::new(options, &bench, &results);
    let pictures = drawing::draw(&headless, &bench, &results, console)?;
    drop((results, headless));
    facts.times_ms.total = milliseconds(clock);
    facts.peak_memory_bytes = peak_memory_bytes();
    let page = page::write(&facts, &Names::new(options), &pictures);
    let mut staged = Staged::create(&options.output)?;
    staged.write(page.as_bytes())?;
    staged.commit()?;

    for warning in &facts.warnings {
        console.warn(warning);
    }
    if options.json {
        console.clear_progress();
        console.print(&String::from_utf8_lossy(&to_json(&facts)));
    } else {
        facts.lines().iter().for_each(|line| console.summarize(line));
        console.summarize(&format!("{}: {:.1} s", options.output.display(), milliseconds(clock) / 1e3));
    }
    Ok(())
}
