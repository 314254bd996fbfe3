//! What can go wrong, in one line each.

use std::path::PathBuf;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error("{path}: {source}")]
    File { path: PathBuf, source: std::io::Error },
    #[error("{program} could not be started: {source}")]
    Start { program: String, source: std::io::Error },
    #[error("{program} stopped with an error")]
    Stopped { program: String },
    #[error("the solver refused what is to be measured: {0}")]
    Solve(#[from] pliant_solver::SolveError),
    #[error("the poses to learn from were refused: {0}")]
    Learn(#[from] pliant_solver::LearnError),
    #[error("sample {name} could not be written: {source}")]
    Sample { name: &'static str, source: pliant_meshfile::SaveError },
    #[error("{n} of the files in assets/ are not what `cargo xtask assets` makes (first: {first}); run it and commit what changed", n = .0.len(), first = .0[0])]
    Stale(Vec<String>),
    #[error(
        "no Vulkan driver found: the image tests need one, a software one will do; install \
         `vulkan-loader mesa-vulkan-drivers` (Fedora) or `vulkan-icd-loader vulkan-swrast` (Arch), then run this again"
    )]
    NoVulkan,
    #[error(
        "no Vulkan driver found, and one could not be installed: the image tests need one, a software one will do; \
         as root run `apt-get install {0}`, then this again"
    )]
    NotInstalled(String),
    #[error("{variable} names Vulkan drivers that are not there: {files}; unset or correct it")]
    NoNamedDriver { variable: &'static str, files: String },
    #[error("{0} files were not treated as promised")]
    Corpus(usize),
    #[error("{0}")]
    Open(pliant_meshfile::OpenError),
    #[error("{0}")]
    Save(pliant_meshfile::SaveError),
    #[error("{}: saved untouched, or read again, it is not what it was", .0.display())]
    Changed(PathBuf),
    #[error(
        "{program} could not be started ({source}): the validator needs node and npm; install `nodejs npm`, then run this again"
    )]
    NoNode { program: &'static str, source: std::io::Error },
    #[error(
        "npm could not install {0}: see what it said above; the validator comes from the npm registry, which must be within reach once"
    )]
    NoValidator(&'static str),
    #[error("the validator found {0} new errors in what was saved, see above")]
    Invalid(usize),
    #[error("some tests failed")]
    TestsFailed,
}
