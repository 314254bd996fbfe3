//! Redraws the paper's figures in `docs/gallery`. The program that does it is the crate `pliant-gallery`: it takes the
//! renderer, without which the other commands are built sooner.

use crate::failure::Failure;
use crate::{program, vulkan};

/// Draws, or with `check` only looks whether the page is whole.
pub(crate) fn run(check: bool) -> Result<(), Failure> {
    if check {
        return program::run("--package pliant-gallery", ["--quiet", "--package", "pliant-gallery", "--", "--check"]);
    }
    vulkan::ensure()?;
    program::run("--package pliant-gallery", ["--release", "--package", "pliant-gallery"])
}
