//! The options of `deform`.

use std::path::PathBuf;

use clap::Args;
use pliant_meshfile::Welding;

use super::{Method, SolvingOptions};

const DEFORM_HELP: &str = r#"Examples:
  pliant deform bar.obj --handles bend.json -o bent.obj --rigidity 6
  pliant deform bar.obj --handles bend.json -o bent.obj --weights cotangent --solver local-global \
         --start rest --report bent.json      the paper to the letter

HANDLES is a JSON file. Every key is optional, but at least one vertex must be held. Vertices are numbered
from 0 as in MESH; coordinates are in its units and axes:
  { "fixed":  [0, 1, 2],
    "moved":  [ {"vertex": 17, "to": [0.1, 2.0, 0.0]} ],
    "groups": [ {"vertices": [40, 41], "matrix": [16 numbers, column-major, applied to rest positions]} ] }

OUT keeps everything else that MESH held, as far as its format allows; what it cannot hold is said.
Not converged within the iterations is not a failure: see "converged" in the report."#;

#[derive(Debug, Args)]
#[command(after_help = DEFORM_HELP)]
pub(in crate::cli) struct DeformOptions {
    /// The mesh at rest (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "MESH")]
    pub(in crate::cli) mesh: PathBuf,

    /// Which vertices are held, and where
    #[arg(long, value_name = "HANDLES")]
    pub(in crate::cli) handles: PathBuf,

    /// The bent mesh, format by extension
    #[arg(short, long, value_name = "OUT")]
    pub(in crate::cli) output: PathBuf,

    /// Rings each vertex keeps rigid: a number for all, or a file with one number a vertex (text, JSON array, or a
    /// mesh that carries its own); without it what MESH carries, else 1
    #[arg(long, value_name = "N|FILE", allow_negative_numbers = true)]
    pub(in crate::cli) rigidity: Option<String>,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(in crate::cli) weld: Welding,

    /// What to minimize
    #[arg(long, value_enum, default_value_t)]
    pub(in crate::cli) method: Method,

    /// sr-arap: how much neighbors should turn alike [default: 0.02]
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    pub(in crate::cli) alpha: Option<f64>,

    /// embedded: nodes that carry the surface, at most 20000 [default: 500]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) nodes: Option<usize>,

    /// embedded: nodes that carry each vertex, from 2 to 16 [default: 4]
    #[arg(long, value_name = "K")]
    pub(in crate::cli) node_neighbors: Option<usize>,

    #[command(flatten)]
    pub(in crate::cli) solving: SolvingOptions,

    /// Count the pairs of triangles of the result that cross, for the report
    #[arg(long)]
    pub(in crate::cli) check_intersections: bool,

    /// Write facts and times as JSON
    #[arg(long, value_name = "R.json")]
    pub(in crate::cli) report: Option<PathBuf>,
}
