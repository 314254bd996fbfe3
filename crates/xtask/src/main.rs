//! Developer commands: `cargo xtask test` runs every test, `cargo xtask assets` makes the samples anew, `cargo xtask
//! guide` draws the pictures of the guide, `cargo xtask gallery` redraws the paper's figures, `cargo xtask validate` asks the
//! glTF validator, `cargo xtask bench` measures, `cargo xtask corpus` tries mesh files that people have.

mod assets;
mod bench;
mod corpus;
mod failure;
mod gallery;
mod guide;
mod program;
mod shapes;
mod testing;
mod validating;
mod vulkan;

use clap::{Parser, Subcommand};
use std::path::PathBuf;
use std::process::ExitCode;

/// Developer commands of Pliant.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Run all tests of the workspace; installs a software Vulkan driver first where none is found and it can
    Test {
        /// Passed on to the test runner, for instance a part of a test's name
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        filter: Vec<String>,
    },
    /// Make the samples in assets/ anew
    Assets {
        /// Only compare with what is there; fail if a byte differs
        #[arg(long)]
        check: bool,
    },
    /// Draw the pictures of docs/guide.md anew
    Guide,
    /// Redraw the paper's figures in docs/gallery, and say which of its claims hold
    Gallery {
        /// Only look whether the page that is there is whole
        #[arg(long)]
        check: bool,
    },
    /// Hold what is saved as glTF against the Khronos Group's validator (needs node and npm)
    Validate {
        /// Mesh files to save, instead of the samples and the test data
        files: Vec<PathBuf>,
    },
    /// Measure the solver and write docs/performance.md
    Bench(bench::Options),
    /// Tell how much memory a solver takes, in a process that does nothing else
    #[command(hide = true)]
    ProbeMemory(bench::Probe),
    /// Open, bend and save every mesh file of some folders, each in processes of its own with limits
    Corpus(corpus::Options),
}

fn main() -> ExitCode {
    let done = match Arguments::parse().task {
        Task::Test { filter } => testing::run(&filter),
        Task::Assets { check } => assets::run(check),
        Task::Guide => guide::run(),
        Task::Gallery { check } => gallery::run(check),
        Task::Validate { files } => validating::run(&files),
        Task::Bench(options) => bench::run(&options),
        Task::ProbeMemory(probe) => bench::probe(probe),
        Task::Corpus(options) => corpus::run(&options),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}
