//! What may be typed: every option of every command, with its default and its help. Commands with many have files of
//! their own.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};
use pliant_meshfile::Welding;

mod choices;
mod compare;
mod deform;
mod entry;
mod learn;
mod render;
mod solving;

pub(super) use choices::{Method, SolverChoice, StartChoice, WeightsChoice};
pub(super) use compare::CompareOptions;
pub(super) use deform::DeformOptions;
pub(super) use entry::{Entry, Way};
pub(super) use learn::{LearnOptions, OmegaChoice};
pub(super) use render::{ColorChoice, RenderOptions};
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
}
