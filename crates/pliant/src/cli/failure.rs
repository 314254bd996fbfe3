//! Why a command stopped, in one line, and the exit code that belongs to it.

use std::path::PathBuf;

use pliant_meshfile::{Format, OpenError, SaveError};
use pliant_solver::{MeshError, SolveError};

use crate::viewport::GpuError;

use super::handles_file::HandlesError;

/// The end of a command without a result. [`Failure::exit_code`] tells which kind.
#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    /// Combinations of options that clap cannot rule out by itself.
    #[error("{0}")]
    Usage(clap::Error),
    #[error("{option} is {value}, but must be {allowed}")]
    OutOfRange { option: &'static str, value: String, allowed: &'static str },
    #[error("{}: unknown extension; use one of {}", path.display(), known_extensions())]
    UnknownExtension { path: PathBuf },
    #[error("{}: a picture is written as PNG; use the extension .png", path.display())]
    NotPng { path: PathBuf },
    #[error("{}: there is no folder {}; create it first", path.display(), folder.display())]
    NoFolder { path: PathBuf, folder: PathBuf },
    #[error("{}: is a folder; name a file", path.display())]
    IsFolder { path: PathBuf },
    #[error("{}: {what} would overwrite {other}; name another file", path.display())]
    SamePath { path: PathBuf, what: &'static str, other: &'static str },
    #[error("{}: cannot write: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("cannot draw or compress the picture: {0}")]
    Picture(#[from] image::ImageError),
    #[error("cannot start {threads} threads ({source}); use --threads with a smaller number")]
    Threads { threads: usize, source: rayon::ThreadPoolBuildError },
    #[error("{}: {source}", path.display())]
    Mesh { path: PathBuf, source: MeshError },
    #[error("{}: vertex {vertex} has r = {r}, but r must be between 1 and {max}", path.display())]
    Rigidity { path: PathBuf, vertex: usize, r: u16, max: u16 },
    #[error(
        "the result has coordinates that are not finite (first: vertex {vertex}); check that the handles are within reach of the mesh's size"
    )]
    NotFinite { vertex: usize },
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Handles(#[from] HandlesError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error(transparent)]
    Graphics(#[from] GpuError),
    #[error("{0}{hint}", hint = command_line_hint(.0))]
    NoWindow(String),
}

impl Failure {
    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Failure::Usage(_) => 2,
            Failure::Graphics(_) | Failure::NoWindow(_) => 3,
            _ => 1,
        }
    }
}

fn known_extensions() -> String {
    let known: Vec<String> = Format::EXTENSIONS.iter().map(|extension| format!(".{extension}")).collect();
    known.join(", ")
}

/// The editor's own message may already mention the way without a window.
fn command_line_hint(message: &str) -> &'static str {
    if message.contains("command line") { "" } else { "; the command line works without a window: see pliant --help" }
}
