//! Why a command stopped, in one line, and the exit code that belongs to it.

use std::path::{Path, PathBuf};

use pliant_meshfile::poses::{PoseError, PoseFault};
use pliant_meshfile::{OpenError, SaveError};
use pliant_solver::{LearnError, MeshError, SolveError};

use crate::document::ModelError;
use crate::editor::EditorError;
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
    #[error("{}: a picture is written as PNG; use the extension .png", path.display())]
    NotPng { path: PathBuf },
    #[error("{}: the report is written as HTML; use the extension .html", path.display())]
    NotHtml { path: PathBuf },
    #[error("no entry could be solved; the first, {entry}: {source}")]
    NoneSolved { entry: String, source: Box<Failure> },
    #[error("{}: there is no folder {}; create it first", path.display(), folder.display())]
    NoFolder { path: PathBuf, folder: PathBuf },
    #[error("{}: is a folder; name a file", path.display())]
    IsFolder { path: PathBuf },
    #[error("{}: is not a regular file; name one", path.display())]
    NotRegular { path: PathBuf },
    #[error("{}: {what} would overwrite {other}; name another file", path.display())]
    SamePath { path: PathBuf, what: &'static str, other: &'static str },
    #[error("{}: cannot write: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    /// The one failure after which there is an output.
    #[error("{} is complete, but its {what} is missing: {source}", out.display())]
    Lost { what: &'static str, out: PathBuf, source: Box<Failure> },
    #[error("cannot draw or compress the picture: {0}")]
    Picture(#[from] image::ImageError),
    #[error(
        "--size is {}x{}, but the graphics device draws at most {}x{} of it; use a smaller one",
        asked[0], asked[1], drawn[0], drawn[1]
    )]
    PictureSize { asked: [u32; 2], drawn: [u32; 2] },
    #[error("cannot start {threads} threads ({source}); use --threads with a smaller number")]
    Threads { threads: usize, source: rayon::ThreadPoolBuildError },
    #[error("{}: {source}", path.display())]
    Mesh { path: PathBuf, source: MeshError },
    #[error(
        "{}: its raw cotangents admit no minimum (first seen at vertex {vertex}); use --weights clamped",
        path.display()
    )]
    Indefinite { path: PathBuf, vertex: usize },
    #[error("{}: {source}", path.display())]
    Solve { path: PathBuf, source: SolveError },
    #[error(
        "the result has coordinates that are not finite (first: vertex {vertex}); check that the handles are within reach of the mesh's size"
    )]
    NotFinite { vertex: usize },
    #[error("{}: {source}", path.display())]
    Learn { path: PathBuf, source: LearnError },
    /// `is_own`: of a pose in the reference's own file.
    #[error("{error}{}", pose_hint(error, *is_own))]
    Pose { error: PoseError, is_own: bool },
    #[error("{}: nothing to learn from: none of the poses shows another shape than this mesh", path.display())]
    NoPoses { path: PathBuf },
    #[error(
        "{}: nothing is left to learn from: {} skipped, the first: {first}",
        path.display(), if *count == 1 { "1 pose was".to_owned() } else { format!("{count} poses were") }
    )]
    AllSkipped { path: PathBuf, count: usize, first: Box<PoseError> },
    #[error("{}: not a mesh file or array by its name; use .json, .obj, .gltf, .glb, .ply, .stl or .off", path.display())]
    UnknownOutput { path: PathBuf },
    #[error(transparent)]
    Open(#[from] OpenError),
    #[error(transparent)]
    Save(#[from] SaveError),
    #[error(transparent)]
    Handles(#[from] HandlesError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Graphics(#[from] GpuError),
    #[error("{0}; the command line works without a window: see pliant --help")]
    Editor(EditorError),
}

/// What can be done about a pose that cannot be used.
fn pose_hint(error: &PoseError, is_own: bool) -> &'static str {
    match error {
        // Says what to do itself.
        PoseError::File { fault: PoseFault::Nothing, .. } => "",
        _ if error.only_faces_differ() => {
            "; if its vertices are those of the reference in the same order, use --reference-faces"
        }
        PoseError::Pose { .. } if is_own => "; use --skip-broken, or name files with poses",
        _ if is_own => "; name files with poses",
        _ => "; leave it out, or use --skip-broken",
    }
}

impl Failure {
    /// After OUT was written, `what` belongs to it and could not be.
    pub(super) fn lost(what: &'static str, out: &Path, source: Failure) -> Failure {
        Failure::Lost { what, out: out.to_owned(), source: Box::new(source) }
    }

    pub(super) fn exit_code(&self) -> u8 {
        match self {
            Failure::Usage(_) => 2,
            Failure::Graphics(GpuError::NoAdapter { .. }) => 3,
            Failure::Editor(EditorError::NoWindow(_) | EditorError::NoAdapter) => 3,
            _ => 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_that_cannot_be_used_come_with_what_can_be_done() {
        let said = |fault: PoseFault, is_own| {
            Failure::Pose { error: PoseError::File { path: "a.glb".into(), fault }, is_own }.to_string()
        };
        let nothing = "a.glb: holds no morph targets and no animation that moves its mesh: name files with poses";
        assert_eq!(said(PoseFault::Nothing, true), nothing);
        assert!(said(PoseFault::NoScale, false).ends_with("; leave it out, or use --skip-broken"));
        let error = || PoseError::File { path: "a.glb".into(), fault: PoseFault::NoScale };
        let skipped = |count| Failure::AllSkipped { path: "r.obj".into(), count, first: Box::new(error()) }.to_string();
        let first = error().to_string();
        assert_eq!(
            [skipped(1), skipped(3)],
            ["1 pose was", "3 poses were"]
                .map(|n| format!("r.obj: nothing is left to learn from: {n} skipped, the first: {first}"))
        );
    }

    #[test]
    fn exit_code_3_means_that_there_is_nothing_to_draw_on() {
        let graphics = |error: GpuError| Failure::Graphics(error).exit_code();
        assert_eq!(graphics(GpuError::NoAdapter { tried: "GL: none".to_owned() }), 3);
        assert_eq!(graphics(GpuError::Unreadable { reason: "lost".to_owned() }), 1);
        let editor = |error: EditorError| Failure::Editor(error).exit_code();
        assert_eq!(editor(EditorError::NoWindow("no display".to_owned())), 3);
        assert_eq!(editor(EditorError::NoAdapter), 3);
        assert_eq!(editor(EditorError::NoThread(std::io::ErrorKind::OutOfMemory.into())), 1);
    }
}
