//! Redraws the paper's figures in `docs/gallery`. The program that does it is the crate `pliant-gallery`: it takes the
//! renderer, without which the other commands are built sooner.

use crate::failure::Failure;
use crate::{program, vulkan};

/// How it is built and run.
const RUN: [&str; 4] = ["--release", "--package", "pliant-gallery", "--"];

/// Draws, or with `check` only looks whether the page is whole.
pub(crate) fn run(check: bool) -> Result<(), Failure> {
    if !check {
        vulkan::ensure()?;
    }
    program::run("--package pliant-gallery", RUN.into_iter().chain(check.then_some("--check")))
}
