//! `cargo xtask bench`: measures the solver and writes `docs/performance.md`.
//!
//! | file | what |
//! |---|---|
//! | `machine` | the processor's name, and how fast it reads memory |
//! | `scene` | meshes with handles |
//! | `stages` | every stage of the solver by size and r |
//! | `kernels` | the parts of an iteration beside the memory's floor |
//! | `memory` | what the solver keeps, by processes of its own |
//! | `learning` | rigidity from poses |
//! | `methods` | embedded deformation and SR-ARAP |
//! | `opening` | files, beside other readers |
//! | `outside` | an iteration as anyone can time it, by the command line |
//! | `descent` | how fast the energy falls, from rest and in a drag |
//! | `peers` | libigl and Open3D beside it, by `tools/peers.py` |
//!
//! Times are medians of several repetitions on whatever else the machine does meanwhile: compare ratios.

mod clock;
mod descent;
mod kernels;
mod learning;
mod machine;
mod memory;
mod methods;
mod opening;
mod outside;
mod peers;
mod scene;
mod stages;
mod table;

use crate::assets;
use crate::failure::Failure;
use clap::ValueEnum;
use machine::Machine;
pub(crate) use memory::{Probe, probe};
use pliant_solver::Rigidity;
use scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What to measure.
#[derive(clap::Args, Clone, Debug, Default)]
pub(crate) struct Options {
    /// Only the smallest mesh: a few seconds, to see that everything runs
    #[arg(long)]
    quick: bool,
    /// Leave out meshes of more vertices than this
    #[arg(long, value_name = "VERTICES")]
    largest: Option<usize>,
    /// Also run libigl and Open3D beside the command line (needs Python with `pip install libigl open3d numpy`)
    #[arg(long)]
    peers: bool,
    /// Where to write, instead of docs/performance.md
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Measure this part alone and put it in its place on the page that is there
    #[arg(long, value_enum, value_name = "PART")]
    only: Option<Part>,
    /// A line to put under the machine's name, for instance a date
    #[arg(long, value_name = "TEXT")]
    note: Option<String>,
}

/// A table, which can be measured by itself.
#[derive(ValueEnum, Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// Every stage of the solver by size and r
    Stages,
    /// The parts of an iteration beside the memory's floor
    Kernels,
    /// Memory that the solver takes
    Memory,
    /// An iteration timed by the command line
    Outside,
    /// How fast the energy falls after a jump
    Rest,
    /// How fast the energy falls in a drag
    Drag,
    /// Rigidity from poses
    Learning,
    /// Embedded deformation and SR-ARAP
    Methods,
    /// How fast files are opened
    Opening,
    /// libigl and Open3D beside it
    Peers,
}

impl Part {
    fn title(self) -> &'static str {
        match self {
            Part::Stages => "Stages",
            Part::Kernels => "Kernels",
            Part::Memory => "Memory",
            Part::Outside => "An iteration from outside",
            Part::Rest => "From rest",
            Part::Drag => "A drag",
            Part::Learning => "Learning",
            Part::Methods => "Other methods",
            Part::Opening => "Opening",
            Part::Peers => "Beside others",
        }
    }
}

/// Sizes of the body: 1, 12, 50, 100, 250 and 1000 thousand vertices.
const CUTS: [u32; 6] = [10, 35, 71, 100, 158, 316];
/// Sizes of the bar: 12 and 100 thousand vertices.
const CELLS: [u32; 2] = [20, 58];
const SIZES: [u16; 6] = [1, 2, 3, 6, 10, 20];
/// Iterations by which the lowest energy is found.
const MOST_ITERATIONS: usize = 2000;

/// Builds the command line and itself with optimization, and measures.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if cfg!(debug_assertions) {
        return run_optimized();
    }
    // Built by `run_optimized` into the same folder as this program.
    let here = std::env::current_exe().map_err(|source| Failure::File { path: "xtask".into(), source })?;
    let program = here.with_file_name(format!("pliant{}", std::env::consts::EXE_SUFFIX));
    let page = assets::folder().with_file_name("docs").join("performance.md");
    let text = match options.only {
        None => measure(options, program.is_file().then_some(&*program))?,
        Some(part) => {
            let old = fs::read_to_string(&page).map_err(|source| Failure::File { path: page.clone(), source })?;
            let bench = Bench::new(options, program.is_file().then_some(&*program))?;
            match bench.text(part)? {
                Some(text) => with_section(&old, part.title(), &text),
                None => return Err(Failure::Stopped { program: program.display().to_string() }),
            }
        }
    };
    let output = options.output.clone().unwrap_or(page);
    fs::write(&output, text).map_err(|source| Failure::File { path: output.clone(), source })?;
    eprintln!("written to {}", output.display());
    Ok(())
}

/// The same command in a build whose times mean something.
fn run_optimized() -> Result<(), Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let own = std::env::args_os().skip(1).collect::<Vec<_>>();
    let build: [&[&str]; 2] =
        [&["build", "--release", "--package", "pliant"], &["run", "--release", "--package", "xtask", "--"]];
    for (arguments, more) in build.into_iter().zip([&[][..], &own]) {
        let status = Command::new(&cargo).args(arguments).args(more).status();
        let status = status.map_err(|source| Failure::Start { program: "cargo".into(), source })?;
        if !status.success() {
            return Err(Failure::Stopped { program: format!("cargo {}", arguments.join(" ")) });
        }
    }
    Ok(())
}

fn temporary_folder() -> Result<tempfile::TempDir, Failure> {
    tempfile::tempdir().map_err(|source| Failure::File { path: std::env::temp_dir(), source })
}

/// A page with another text under one title; where it has no such title, a section more at its end.
fn with_section(page: &str, title: &str, text: &str) -> String {
    let new = format!("## {title}\n\n{}\n", text.trim_end());
    let heading = format!("## {title}\n");
    let start = if page.starts_with(&heading) { Some(0) } else { page.find(&format!("\n{heading}")).map(|at| at + 1) };
    let Some(start) = start else { return format!("{}\n\n{new}", page.trim_end()) };
    match page[start + heading.len()..].find("\n## ") {
        Some(length) => format!("{}{new}{}", &page[..start], &page[start + heading.len() + length..]),
        None => format!("{}{new}", &page[..start]),
    }
}

/// The text of the page; without `program` what needs the command line is left out.
fn measure(options: &Options, program: Option<&Path>) -> Result<String, Failure> {
    let bench = Bench::new(options, program)?;
    let mut page = String::from(
        "# Performance\n\n\
         Made by `cargo xtask bench`. Times are medians of several repetitions, beside whatever else the machine \
         did: ratios say more than times.\n\n",
    );
    let mut about = bench.machine.description();
    for line in [&options.note, &Some(MESHES.to_owned())].into_iter().flatten() {
        about = format!("{about}\n\n{line}");
    }
    page.push_str(&format!("## What was measured\n\n{about}\n\n"));
    for &part in Part::value_variants() {
        if part != Part::Peers || options.peers {
            let text = bench.text(part)?;
            page.extend(text.map(|text| format!("## {}\n\n{text}", part.title())));
        }
    }
    page.truncate(page.trim_end().len());
    page.push('\n');
    Ok(page)
}

/// What all tables need.
struct Bench<'a> {
    options: &'a Options,
    program: Option<&'a Path>,
    machine: Machine,
    folder: tempfile::TempDir,
    scenes: Vec<(Scene, Vec<u16>)>,
}

impl<'a> Bench<'a> {
    fn new(options: &'a Options, program: Option<&'a Path>) -> Result<Bench<'a>, Failure> {
        let (machine, folder, scenes) = (Machine::measure(), temporary_folder()?, scenes(options));
        Ok(Bench { options, program, machine, folder, scenes })
    }

    /// The text of a part; none where it needs the command line and there is none.
    fn text(&self, part: Part) -> Result<Option<String>, Failure> {
        let (folder, quick) = (self.folder.path(), self.options.quick);
        let most = if quick { 50 } else { MOST_ITERATIONS };
        let both = || self.bodies(&[CUTS[1], CUTS[3]]);
        Ok(Some(match (part, self.program) {
            (Part::Stages, _) => stages::tables(&self.scenes)?,
            (Part::Kernels, _) => kernels::table(&self.scenes, self.machine.bandwidth[1])?,
            (Part::Memory, Some(_)) => memory::table(&self.bodies(&CUTS[1..5]))?,
            (Part::Outside, Some(program)) => outside::table(program, &self.bodies(&CUTS[1..4]), folder)?,
            (Part::Rest, _) => {
                let jumps: Vec<_> = both().into_iter().flat_map(|scene| [(scene, 1), (scene, 10)]).collect();
                descent::from_rest(&jumps, most)?
            }
            (Part::Drag, _) => dragged(quick)?,
            (Part::Learning, _) => learning::table(&self.bodies(&CUTS))?,
            (Part::Methods, _) => methods::table(&self.bodies(&CUTS[1..3]))?,
            (Part::Opening, _) => opening::table(quick, folder)?,
            (Part::Peers, Some(program)) => peers::tables(program, &both(), folder, most)?,
            (Part::Memory | Part::Outside | Part::Peers, None) => return Ok(None),
        }))
    }

    /// The bodies of some sizes.
    fn bodies(&self, cuts: &[u32]) -> Vec<&Scene> {
        let is_wanted = |scene: &&Scene| self.options.quick || cuts.iter().any(|&c| scene.is_body_of(c));
        self.scenes.iter().map(|(scene, _)| scene).filter(is_wanted).collect()
    }
}

const MESHES: &str = "*Body*: a bumpy ellipsoid, irregular and Delaunay, its ends held (an eighth of its vertices) and \
                      bent by 70°. *Bar*: the samples' bar, finer, bent by 70°.";

/// Meshes with the r to be timed on them.
fn scenes(options: &Options) -> Vec<(Scene, Vec<u16>)> {
    if options.quick {
        return vec![(Scene::body(CUTS[0]), vec![1, 10])];
    }
    let largest = options.largest.unwrap_or(usize::MAX);
    let is_wanted = |n: u32| n as usize <= largest;
    let bodies = CUTS.into_iter().filter(|&cuts| is_wanted(10 * cuts * cuts));
    let bars = CELLS.into_iter().filter(|&cells| is_wanted(30 * cells * cells));
    let body = |cuts| {
        eprintln!("making a body of {} vertices", 10 * cuts * cuts + 2);
        (Scene::body(cuts), SIZES.to_vec())
    };
    bodies.map(body).chain(bars.map(|cells| (Scene::bar(cells), vec![1, 10]))).collect()
}

/// The creature with its painted r; small and with a made-up r if quick, for its shape takes seconds to make.
fn dragged(quick: bool) -> Result<String, Failure> {
    let (scene, r) = if quick {
        let scene = Scene::body(CUTS[0]);
        let r = (0..scene.n_vertices()).map(|v| 1 + (v % 6) as u16).collect();
        (scene, r)
    } else {
        Scene::creature()
    };
    let rigidity = Rigidity::new(r).expect("1 to 6");
    Ok(descent::drag(&scene, &rigidity)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_section_is_put_in_its_place() {
        let page = "# Page\n\n## A drag\n\nold\n\n## Learning\n\nkept\n";
        let drag = with_section(page, "A drag", "new\n\n");
        assert_eq!(drag, "# Page\n\n## A drag\n\nnew\n\n## Learning\n\nkept\n");
        let learning = with_section(page, "Learning", "new\n\n");
        assert_eq!(learning, "# Page\n\n## A drag\n\nold\n\n## Learning\n\nnew\n");
        let more = with_section(page, "Opening", "new\n\n");
        assert_eq!(more, format!("{page}\n## Opening\n\nnew\n"));
    }

    #[test]
    fn the_quick_run_writes_every_table() {
        let page = measure(&Options { quick: true, ..Options::default() }, None).expect("measured");
        let titles =
            ["What was measured", "Stages", "Kernels", "From rest", "A drag", "Learning", "Other methods", "Opening"];
        for title in titles {
            let section = page.split("## ").find(|section| section.starts_with(title));
            let section = section.unwrap_or_else(|| panic!("no section {title} in\n{page}"));
            assert!(title == "What was measured" || section.contains("|\n| "), "no table in\n{section}");
        }
        assert!(!page.contains("NaN"), "{page}");
    }
}
