//! The paper's figures, redrawn on the project's own shapes and checked by numbers: `cargo xtask gallery` runs this.
//!
//! Each figure is a file in `figures/`: it bends shapes ([`bending`]), measures them ([`measures`]), has them drawn
//! ([`shots`], [`chart`]) and says what holds ([`page`]). A claim that does not hold is a result; only what could not be
//! computed is an error. [`checking`] tells whether the page that is kept is whole.

mod bending;
mod chart;
mod checking;
mod failure;
mod figures;
mod measures;
mod models;
mod page;
mod shots;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;

/// Draws the paper's figures into docs/gallery.
#[derive(Parser)]
struct Arguments {
    /// Only look whether the page that is there is whole
    #[arg(long)]
    check: bool,
    /// Another folder
    #[arg(long, value_name = "FOLDER")]
    to: Option<PathBuf>,
    /// Only the figure with this number (3, 4-5, 6 …), without the page
    #[arg(long, value_name = "NUMBER")]
    only: Option<String>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let folder = arguments.to.unwrap_or_else(|| workspace().join("docs/gallery"));
    let done = if arguments.check { checking::run(&folder) } else { figures::draw(folder, arguments.only.as_deref()) };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}

/// The folder of the workspace.
fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("this crate lies in crates/")
}
