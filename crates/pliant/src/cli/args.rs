//! What may be typed: every option of every command, with its default and its help.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use pliant_meshfile::Welding;
use pliant_solver::Weights;

mod compare;
mod entry;
mod solving;

pub(super) use compare::CompareOptions;
pub(super) use entry::{Entry, Way};
pub(super) use solving::SolvingOptions;

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
    /// Files to open in the editor (OBJ, glTF, GLB, PLY, STL, OFF, or a .pliant project); a sample when none is given
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
    /// Find out from poses how stiff each part of a mesh is
    Learn(LearnOptions),
    /// Bend a mesh by several methods and write a report that puts them side by side
    Compare(CompareOptions),
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
    /// The mesh at rest (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "MESH")]
    pub(super) mesh: PathBuf,

    /// Which vertices are held, and where
    #[arg(long, value_name = "HANDLES")]
    pub(super) handles: PathBuf,

    /// The bent mesh, format by extension
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,

    /// Rings each vertex keeps rigid: a number for all, or a file with one number a vertex (text, JSON array, or a
    /// mesh that carries its own); without it what MESH carries, else 1
    #[arg(long, value_name = "N|FILE", allow_negative_numbers = true)]
    pub(super) rigidity: Option<String>,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(super) weld: Welding,

    /// What to minimize
    #[arg(long, value_enum, default_value_t)]
    pub(super) method: Method,

    /// sr-arap: how much neighbors should turn alike [default: 0.02]
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    pub(super) alpha: Option<f64>,

    /// embedded: nodes that carry the surface, at most 20000 [default: 500]
    #[arg(long, value_name = "N")]
    pub(super) nodes: Option<usize>,

    /// embedded: nodes that carry each vertex, from 2 to 16 [default: 4]
    #[arg(long, value_name = "K")]
    pub(super) node_neighbors: Option<usize>,

    #[command(flatten)]
    pub(super) solving: SolvingOptions,

    /// Count the pairs of triangles of the result that cross, for the report
    #[arg(long)]
    pub(super) check_intersections: bool,

    /// Write facts and times as JSON
    #[arg(long, value_name = "R.json")]
    pub(super) report: Option<PathBuf>,
}

const LEARN_HELP: &str = "\
Examples:
  pliant learn horse.obj horse-*.obj -o horse.glb       one file a pose
  pliant learn creature.glb -o learned.glb              its own morph targets and animations
  pliant learn body.obj walk.glb run.glb --frames 40 -o r.json --report report.json

A POSE is a file of any format that has the vertices and faces of REFERENCE, or its corners in the
same order. A glTF that holds morph targets or animations gives all of them: its shape if that is
not REFERENCE's, each target at weight 1, and --frames of each animation, skins and all. Without
any POSE, those of REFERENCE itself are taken. Frames that show a shape seen before are passed
over. Poses may lie anywhere and be turned in any way.

Of each vertex the r is taken that makes the mean energy of its neighborhood plus OMEGA (R_MAX - r)
least: the larger OMEGA, the stiffer. OUT with the extension .json is an array of one r a vertex,
which --rigidity reads; any other is REFERENCE with its rigidity. TABLE.csv has a row a vertex,
numbered from 0 as in REFERENCE: its r, how clearly that r won (from 0 to 1), and the mean energies
for every r.";

#[derive(Debug, Args)]
#[command(after_help = LEARN_HELP)]
pub(super) struct LearnOptions {
    /// The mesh at rest (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "REFERENCE")]
    pub(super) reference: PathBuf,

    /// Files with poses of it; without any, what REFERENCE itself holds
    #[arg(value_name = "POSE")]
    pub(super) poses: Vec<PathBuf>,

    /// The learned rigidity: an array (.json), or the reference mesh that carries it
    #[arg(short, long, value_name = "OUT")]
    pub(super) output: PathBuf,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(super) weld: Welding,

    /// The smallest r a vertex may get
    #[arg(long, value_name = "R", default_value_t = 1, allow_negative_numbers = true)]
    pub(super) r_min: i64,

    /// The largest r a vertex may get
    #[arg(long, value_name = "R", default_value_t = 6, allow_negative_numbers = true)]
    pub(super) r_max: i64,

    /// What one ring is worth: auto finds it in the poses, a number is the paper's (which has 0.3)
    #[arg(long, value_name = "auto|X", default_value = "auto", value_parser = parse_omega, allow_negative_numbers = true)]
    pub(super) omega: OmegaChoice,

    /// Weights of the edges; with cotangent, which is not refused here, energies may be negative
    #[arg(long, value_enum, default_value_t)]
    pub(super) weights: WeightsChoice,

    /// Divide out the unit of length of each file, found by the lengths of edges; said in the warnings
    #[arg(long)]
    pub(super) match_scale: bool,

    /// Take files with as many vertices but other faces for the same vertices in the same order
    #[arg(long)]
    pub(super) reference_faces: bool,

    /// Frames of each animation, evenly from its first key to its last
    #[arg(long, value_name = "COUNT", default_value_t = 24, allow_negative_numbers = true)]
    pub(super) frames: i64,

    /// Go on without files and poses that are broken or of another mesh; each is said in the warnings
    #[arg(long)]
    pub(super) skip_broken: bool,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,

    /// Write the energies of every vertex for every r
    #[arg(long, value_name = "TABLE.csv")]
    pub(super) table: Option<PathBuf>,

    /// Write facts and times as JSON
    #[arg(long, value_name = "R.json")]
    pub(super) report: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum OmegaChoice {
    /// Found in the energies.
    Auto,
    /// As in the paper.
    Absolute(f64),
}

impl OmegaChoice {
    pub(super) fn name(self) -> &'static str {
        match self {
            OmegaChoice::Auto => "auto",
            OmegaChoice::Absolute(_) => "absolute",
        }
    }
}

fn parse_omega(text: &str) -> Result<OmegaChoice, String> {
    if text == "auto" {
        return Ok(OmegaChoice::Auto);
    }
    text.parse().map(OmegaChoice::Absolute).map_err(|_| "expected auto or a number, such as 0.3".to_owned())
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    /// Rigid neighborhoods of r rings a vertex
    #[default]
    Rring,
    /// As rigid as possible: r = 1 everywhere
    Arap,
    /// ARAP whose neighbors turn alike, too (Levi and Gotsman 2015)
    SrArap,
    /// Some hundred nodes carry the surface (Sumner, Schmid and Pauly 2007); handles are soft
    Embedded,
}

impl Method {
    /// The name in options and reports.
    pub(super) fn name(self) -> &'static str {
        match self {
            Method::Rring => "rring",
            Method::Arap => "arap",
            Method::SrArap => "sr-arap",
            Method::Embedded => "embedded",
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

impl From<WeightsChoice> for Weights {
    fn from(choice: WeightsChoice) -> Weights {
        match choice {
            WeightsChoice::Clamped => Weights::Clamped,
            WeightsChoice::Cotangent => Weights::Cotangent,
            WeightsChoice::Uniform => Weights::Uniform,
        }
    }
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

impl StartChoice {
    pub(super) fn name(self) -> &'static str {
        match self {
            StartChoice::Auto => "auto",
            StartChoice::Rest => "rest",
        }
    }
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  pliant info creature.glb\n  pliant info creature.glb --json")]
pub(super) struct InfoOptions {
    /// The mesh file (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "MESH")]
    pub(super) mesh: PathBuf,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(super) weld: Welding,

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
    /// The mesh file (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "MESH")]
    pub(super) mesh: PathBuf,

    /// The picture, a PNG
    #[arg(short, long, value_name = "PICTURE.png")]
    pub(super) output: PathBuf,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(super) weld: Welding,

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
    fn the_options_of_learn_are_all_named_in_the_readme() {
        let readme = include_str!("../../../../README.md");
        let command = Arguments::command();
        let learn = command.find_subcommand("learn").expect("a command");
        for option in learn.get_arguments().filter_map(|argument| argument.get_long()) {
            let named = option == "output" || readme.contains(&format!("--{option}"));
            assert!(named, "--{option} is not in README.md");
        }
    }

    #[test]
    fn the_first_choice_named_is_the_default() {
        let parsed = Arguments::try_parse_from(["pliant", "deform", "a.obj", "--handles", "h.json", "-o", "b.obj"])
            .expect("the shortest legal command");
        let Some(Command::Deform(options)) = parsed.command else { panic!("not deform: {:?}", parsed.command) };
        assert_eq!(options.method, Method::Rring);
        assert_eq!(options.solving.solver, SolverChoice::Lbfgs);
        assert_eq!(options.solving.weights, WeightsChoice::Clamped);
        assert_eq!(options.solving.start, StartChoice::Auto);
        assert_eq!(options.solving.max_iterations, 1000);
        assert_eq!(options.solving.tolerance, 1e-3);
    }

    #[test]
    fn welding_is_exact_unless_it_is_named() {
        let welding = |more: &[&str]| {
            let words = ["pliant", "info", "a.obj"].iter().chain(more);
            let parsed = Arguments::try_parse_from(words).map_err(|error| error.kind())?;
            let Some(Command::Info(options)) = parsed.command else { panic!("not info: {:?}", parsed.command) };
            Ok(options.weld)
        };
        assert_eq!(welding(&[]), Ok(Welding::Exact));
        assert_eq!(welding(&["--weld", "exact"]), Ok(Welding::Exact));
        assert_eq!(welding(&["--weld", "never"]), Ok(Welding::Never));
        assert_eq!(welding(&["--weld", "1e-3"]), Ok(Welding::Within(1e-3)));
        for wrong in ["-1", "nan", "inf", "always"] {
            assert_eq!(welding(&["--weld", wrong]), Err(clap::error::ErrorKind::ValueValidation), "{wrong}");
        }
    }

    #[test]
    fn learning_has_the_defaults_of_the_paper_but_for_omega() {
        let parsed = Arguments::try_parse_from(["pliant", "learn", "a.obj", "b.obj", "-o", "r.json"]).expect("legal");
        let Some(Command::Learn(options)) = parsed.command else { panic!("not learn: {:?}", parsed.command) };
        assert_eq!((options.r_min, options.r_max), (1, 6));
        assert_eq!(options.omega, OmegaChoice::Auto);
        assert_eq!(parse_omega("0.3"), Ok(OmegaChoice::Absolute(0.3)));
        assert!(parse_omega("much").is_err());
        let frames = pliant_meshfile::poses::PoseOptions::default().frames;
        assert_eq!(options.frames, frames as i64);
    }

    #[test]
    fn a_size_is_two_numbers_and_an_x() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        for wrong in ["", "640", "640x", "x480", "640x480x2", "-1x5", "640,480"] {
            assert!(parse_size(wrong).is_err(), "{wrong:?}");
        }
    }
}
