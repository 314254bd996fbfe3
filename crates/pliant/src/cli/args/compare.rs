//! The options of `compare`.

use std::path::PathBuf;

use clap::Args;
use pliant_meshfile::Welding;

use super::{Entry, SolvingOptions};

const COMPARE_HELP: &str = "\
Examples:
  pliant compare bar.obj --handles bend.json --entry arap --entry rring:2 --entry rring:6 -o bar.html
  pliant compare creature.glb --handles bend.json --entry rring:painted.json --entry rring:3 \\
         --entry sr-arap:alpha=0.05 --entry embedded:nodes=300,node-neighbors=6 -o creature.html

Entries are shown in the order in which they are named:
  rring:6           rigid neighborhoods of 6 rings everywhere
  rring:FILE        of as many rings as FILE says for each vertex; see --rigidity of deform
  rring             as MESH carries it, else 1
  arap              rigid neighborhoods of one ring
  sr-arap           with alpha=0.02, unless it says otherwise after a colon
  embedded          with nodes=500,node-neighbors=4, unless it says otherwise after a colon

REPORT.html needs no other file and no network. Everything else is as in deform: the same entry gives the same result.
An entry that cannot be solved is reported as such, and the others go on. Pictures need a graphics adapter, if only
one that draws in software.";

#[derive(Debug, Args)]
#[command(after_help = COMPARE_HELP)]
pub(in crate::cli) struct CompareOptions {
    /// The mesh at rest (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "MESH")]
    pub(in crate::cli) mesh: PathBuf,

    /// Which vertices are held, and where
    #[arg(long, value_name = "HANDLES")]
    pub(in crate::cli) handles: PathBuf,

    /// A method to compare, with its rigidity or parameters; once for each
    #[arg(long = "entry", value_name = "METHOD[:R|:FILE|:PARAMETERS]", required = true)]
    pub(in crate::cli) entries: Vec<Entry>,

    /// The report, one HTML file
    #[arg(short, long, value_name = "REPORT.html")]
    pub(in crate::cli) output: PathBuf,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(in crate::cli) weld: Welding,

    #[command(flatten)]
    pub(in crate::cli) solving: SolvingOptions,

    /// Print the figures of the report as one JSON object instead of text
    #[arg(long)]
    pub(in crate::cli) json: bool,
}
