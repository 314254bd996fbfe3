//! The options of `render`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use pliant_meshfile::Welding;

const RENDER_HELP: &str = "\
Example:
  pliant render creature.glb -o creature.png --color rigidity --size 1280x800

--color energy shows each vertex's share of the energy between the file's rest pose and its present pose. A file
that holds one pose is its own rest pose, so its energy is zero everywhere and the picture shows the color of zero.";

#[derive(Debug, Args)]
#[command(after_help = RENDER_HELP)]
pub(in crate::cli) struct RenderOptions {
    /// The mesh file (OBJ, glTF, GLB, PLY, STL, OFF)
    #[arg(value_name = "MESH")]
    pub(in crate::cli) mesh: PathBuf,

    /// The picture, a PNG
    #[arg(short, long, value_name = "PICTURE.png")]
    pub(in crate::cli) output: PathBuf,

    /// Which vertices are one point of the surface: those at exactly the same place, those at most so far apart (in the
    /// file's units), or none
    #[arg(long, value_name = "exact|never|DISTANCE", default_value = "exact", allow_negative_numbers = true)]
    pub(in crate::cli) weld: Welding,

    /// What colors the surface
    #[arg(long, value_enum, default_value_t)]
    pub(in crate::cli) color: ColorChoice,

    /// Rigidity to show: a number for all, or a file with one number a vertex; without it what MESH carries, else 1
    #[arg(long, value_name = "N|FILE", allow_negative_numbers = true)]
    pub(in crate::cli) rigidity: Option<String>,

    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = parse_size)]
    pub(in crate::cli) size: [u32; 2],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum ColorChoice {
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
    use super::*;

    #[test]
    fn a_size_is_two_numbers_and_an_x() {
        assert_eq!(parse_size("640x480"), Ok([640, 480]));
        for wrong in ["", "640", "640x", "x480", "640x480x2", "-1x5", "640,480"] {
            assert!(parse_size(wrong).is_err(), "{wrong:?}");
        }
    }
}
