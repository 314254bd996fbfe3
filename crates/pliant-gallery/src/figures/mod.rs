//! One file for each figure of the paper, in the paper's order.

mod contest;
mod convergence;
mod folding;
mod large;
mod learned;
mod limbs;
mod stiffening;
mod stripes;

use std::fs;
use std::path::PathBuf;
use std::time::Instant;

use crate::failure::Failure;
use crate::page::{Figure, Folder, page};

type Draw = fn(&mut Folder) -> Result<Figure, Failure>;

/// All of them with the number that the paper gives.
const ALL: [(&str, Draw); 11] = [
    ("3", folding::figure),
    ("4-5", convergence::figure),
    ("6", stiffening::figure),
    ("7", large::figure),
    ("8", stripes::figure),
    ("9", limbs::arm),
    ("10", limbs::legs),
    ("11", limbs::pieces),
    ("12", learned::shapes),
    ("13", learned::numbers),
    ("14", learned::uniform),
];

/// How many sections the page has.
pub(crate) const COUNT: usize = ALL.len();

/// Draws them all and writes the page, or only the one with this number.
pub(crate) fn draw(folder: PathBuf, only: Option<&str>) -> Result<(), Failure> {
    let begun = Instant::now();
    let mut into = Folder::new(folder)?;
    let mut figures = Vec::new();
    for (number, draw) in ALL.iter().filter(|(number, _)| only.is_none_or(|only| *number == only)) {
        let clock = Instant::now();
        let figure = draw(&mut into)?;
        eprintln!("{number}: {} ({:.0} s)", figure.title, clock.elapsed().as_secs_f64());
        figure.checks.iter().for_each(|check| eprintln!("  {}", check.line()));
        figures.push(figure);
    }
    if only.is_none() {
        let seconds = begun.elapsed().as_secs_f64();
        into.write("README.md".to_owned(), page(&figures, &foot(seconds)).into_bytes())?;
        into.remove_stale()?;
    }
    Ok(())
}

/// How the page is made.
fn foot(seconds: f64) -> String {
    let cpu = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        line.split_once(':').map(|(_, name)| name.trim().to_owned())
    });
    let cpu = cpu.unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let n_threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "Made by `cargo xtask gallery` in {seconds:.0} seconds on {cpu}, {n_threads} threads. But for the times in table 1, and the last \
         bits of pictures drawn by another graphics driver, it makes the same page every time; `cargo xtask gallery --check` looks \
         whether the page is whole."
    )
}
