//! The options of `learn`.

use std::path::PathBuf;

use clap::Args;
use pliant_meshfile::Welding;

use super::WeightsChoice;

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
pub(in crate::cli) struct LearnOptions {
    /// The mesh at rest (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "REFERENCE")]
    pub(in crate::cli) reference: PathBuf,

    /// Files with poses of it; without any, what REFERENCE itself holds
    #[arg(value_name = "POSE")]
    pub(in crate::cli) poses: Vec<PathBuf>,

    /// The learned rigidity: an array (.json), or the reference mesh that carries it
    #[arg(short, long, value_name = "OUT")]
    pub(in crate::cli) output: PathBuf,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(in crate::cli) weld: Welding,

    /// The smallest r a vertex may get
    #[arg(long, value_name = "R", default_value_t = 1, allow_negative_numbers = true)]
    pub(in crate::cli) r_min: i64,

    /// The largest r a vertex may get
    #[arg(long, value_name = "R", default_value_t = 6, allow_negative_numbers = true)]
    pub(in crate::cli) r_max: i64,

    /// What one ring is worth: auto finds it in the poses, a number is the paper's (which has 0.3)
    #[arg(long, value_name = "auto|X", default_value = "auto", value_parser = parse_omega, allow_negative_numbers = true)]
    pub(in crate::cli) omega: OmegaChoice,

    /// Weights of the edges; with cotangent, which is not refused here, energies may be negative
    #[arg(long, value_enum, default_value_t)]
    pub(in crate::cli) weights: WeightsChoice,

    /// Divide out the unit of length of each file, found by the lengths of edges; said in the warnings
    #[arg(long)]
    pub(in crate::cli) match_scale: bool,

    /// Take files with as many vertices but other faces for the same vertices in the same order
    #[arg(long)]
    pub(in crate::cli) reference_faces: bool,

    /// Frames of each animation, evenly from its first key to its last
    #[arg(long, value_name = "COUNT", default_value_t = 24, allow_negative_numbers = true)]
    pub(in crate::cli) frames: i64,

    /// Go on without files and poses that are broken or of another mesh; each is said in the warnings
    #[arg(long)]
    pub(in crate::cli) skip_broken: bool,

    /// Threads to use [default: all cores]
    #[arg(long, value_name = "N")]
    pub(in crate::cli) threads: Option<usize>,

    /// Write the energies of every vertex for every r
    #[arg(long, value_name = "TABLE.csv")]
    pub(in crate::cli) table: Option<PathBuf>,

    /// Write facts and times as JSON
    #[arg(long, value_name = "R.json")]
    pub(in crate::cli) report: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::cli) enum OmegaChoice {
    /// Found in the energies.
    Auto,
    /// As in the paper.
    Absolute(f64),
}

impl OmegaChoice {
    pub(in crate::cli) fn name(self) -> &'static str {
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

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;
    use crate::cli::args::{Arguments, Command};

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
}
