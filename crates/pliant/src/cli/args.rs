//! What may be typed: every option of every command, with its default and its help.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

const EDITOR_EXAMPLES: &str = "\
Examples:
  pliant                       open the editor on a sample
  pliant creature.glb          open the editor on a file
  pliant info creature.glb     say what is in a file, without a window

Exit codes: 0 done, 1 refused or failed (one line says why; nothing is written), 2 wrong usage,
3 no graphics adapter or no display.";

/// Bend any mesh, and say where it is stiff.
///
/// Without a command the editor opens.
#[derive(Debug, Parser)]
#[command(name = "pliant", bin_name = "pliant", version, after_help = EDITOR_EXAMPLES)]
#[command(override_usage = "pliant [--quiet] [FILE]...\n       pliant [--quiet] <COMMAND> ...")]
pub(super) struct Arguments {
    /// Files to open in the editor (OBJ, glTF, GLB); a sample when none is given
    #[arg(value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,

    /// No progress, no summary and no warnings: only failures are said
    #[arg(long, global = true)]
    pub(super) quiet: bool,

    #[command(subcommand)]
    pub(super) command: Option<Command>,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Bend a mesh: hold some vertices, move some, and let the rest follow
    Deform(DeformOptions),
    /// Say what is in a mesh file: counts, bounds, defects, parts, rigidity
    Info(InfoOptions),
    /// Draw a picture of a mesh without a window
    Render(RenderOptions),
}

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
pub(super) struct DeformOptions {
    /// The mesh at rest (OBJ, glTF, GLB)
    #[arg(value_name = "MESH")]
    pub(super) mesh: PathBuf,

    /// Which vertices are held, and where
    #[arg(long, value_name = "HANDLES")]
    pub(super) handles: PathBuf,

    /// The bent mesh, format by extension
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,

    /// Rings each vertex keeps rigid: a number for all, or a file with one number a vertex (text, JSON array, or a
    /// mesh that carries _RIGIDITY); without it what MESH carries, else 1
    #[arg(long, value_name = "N|FILE", allow_negative_numbers = true)]
    pub(super) rigidity: Option<String>,

    /// What to minimize
    #[arg(long, value_enum, default_value_t)]
    pub(super) method: Method,

    /// How to minimize it
    #[arg(long, value_enum, default_value_t)]
    pub(super) solver: SolverChoice,

    /// Weights of the edges
    #[arg(long, value_enum, default_value_t)]
    pub(super) weights: WeightsChoice,

    /// Where the iteration begins
    #[arg(long, value_enum, default_value_t)]
    pub(super) start: StartChoice,

    /// Iterations at most
    #[arg(long, value_name = "COUNT", default_value_t = 1000)]
    pub(super) max_iterations: u64,

    /// Stop when the energy falls by less than this fraction in one iteration (lbfgs: in three); 0 runs all iterations
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-3, allow_negative_numbers = true)]
    pub(super) tolerance: f64,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,

    /// Count the pairs of triangles of the result that cross, for the report
    #[arg(long)]
    pub(super) check_intersections: bool,

    /// Write facts and times as JSON
    #[arg(long, value_name = "R.json")]
    pub(super) report: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    /// Rigid neighborhoods of r rings a vertex
    #[default]
    Rring,
    /// As rigid as possible: r = 1 everywhere
    Arap,
}

impl Method {
    /// The name in options and reports.
    pub(super) fn name(self) -> &'static str {
        match self {
            Method::Rring => "rring",
            Method::Arap => "arap",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum SolverChoice {
    /// Learns from its last steps where the surface gives way: the same minimum in fewer iterations
    #[default]
    Lbfgs,
    /// Best positions for the rotations, best rotations for the positions, in turn (the paper's way)
    LocalGlobal,
}

impl SolverChoice {
    pub(super) fn name(self) -> &'static str {
        match self {
            SolverChoice::Lbfgs => "lbfgs",
            SolverChoice::LocalGlobal => "local-global",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum WeightsChoice {
    /// Cotangents, with slivers and negative weights tamed
    #[default]
    Clamped,
    /// Raw cotangents (eq. 2); refused where they admit no minimum
    Cotangent,
    /// 1 for every edge
    Uniform,
}

impl WeightsChoice {
    pub(super) fn name(self) -> &'static str {
        match self {
            WeightsChoice::Clamped => "clamped",
            WeightsChoice::Cotangent => "cotangent",
            WeightsChoice::Uniform => "uniform",
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum StartChoice {
    /// The best of several starts
    #[default]
    Auto,
    /// Every rotation the identity, as in the paper
    Rest,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  pliant info creature.glb\n  pliant info creature.glb --json")]
pub(super) struct InfoOptions {
    /// The mesh file (OBJ, glTF, GLB)
    #[arg(value_name = "MESH")]
    pub(super) mesh: PathBuf,

    /// Print one JSON object instead of text
    #[arg(long)]
    pub(super) json: bool,
}

const RENDER_HELP: &str = "\
Example:
  pliant render creature.glb -o creature.png --color rigidity --size 1280x800

--color energy shows each vertex's share of the energy between the file's rest pose and its present pose. A file
that holds one pose is its own rest pose, so its energy is zero everywhere and the picture shows the color of zero.";

#[derive(Debug, Args)]
#[command(after_help = RENDER_HELP)]
pub(super) struct RenderOptions {
    /// The mesh file (OBJ, glTF, GLB)
    #[arg(value_name = "MESH")]
    pub(super) mesh: PathBuf,

    /// The picture, a PNG
    #[arg(short, long, value_name = "PICTURE.png")]
    pub(super) output: PathBuf,

    /// What colors the surface
    #[arg(long, value_enum, default_value_t)]
    pub(super) color: ColorChoice,

    /// Rigidity to show: a number for all, or a file with one number a vertex; without it what MESH carries, else 1
    #[arg(long, value_name = "N|FILE", allow_negative_numbers = true)]
    pub(super) rigidity: Option<String>,

    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = parse_size)]
    pub(super) size: [u32; 2],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum ColorChoice {
    /// The file's own colors
    #[default]
    None,
    /// Rigidity r, blue for 1 to red for stiff
    Rigidity,
    /// Energy of each vertex
    Energy,
}

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let parsed = text.split_once('x').and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    parsed.ok_or_else(|| "expected WIDTHxHEIGHT in pixels, such as 1280x800".to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn every_option_is_declared_consistently() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_command_shows_an_example_in_its_help() {
        for command in Arguments::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            assert!(help.contains("pliant "), "{}: {help:?}", command.get_name());
        }
    }

    #[test]
    fn the_first_choice_named_is_the_default() {
        let parsed = Arguments::try_parse_from(["pliant", "deform", "a.obj", "--handles", "h.json", "-o", "b.obj"])
            .expect("the shortest legal command");
        let Some(Command::Deform(options)) = parsed.command else { panic!("not deform: {:?}", parsed.command) };
        assert_eq!(options.method, Method::Rring);
        assert_eq!(options.solver, SolverChoice::Lbfgs);
        assert_eq!(options.weights, WeightsChoice::Clamped);
        assert_eq!(options.start, StartChoice::Auto);
        assert_eq!(options.max_iterations, 1000);
        assert_eq!(options.tolerance, 1e-3);
    }

    #[test]
    fn a_size_is_two_numbers_and_an_x() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        for wrong in ["", "640", "640x", "x480", "640x480x2", "-1x5", "640,480"] {
            assert!(parse_size(wrong).is_err(), "{wrong:?}");
        }
    }
}
