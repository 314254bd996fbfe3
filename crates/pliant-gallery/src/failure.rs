//! Why the gallery could not be drawn, in one line each.

use std::path::PathBuf;

/// What stopped it. A claim of the paper that does not hold is none: the page says so.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error("{path}: {source}")]
    File { path: PathBuf, source: std::io::Error },
    #[error("{path} is not what `cargo xtask assets` makes: {what}; run it")]
    Asset { path: PathBuf, what: String },
    #[error(transparent)]
    Open(#[from] pliant_meshfile::OpenError),
    #[error(transparent)]
    Poses(#[from] pliant_meshfile::poses::PoseError),
    #[error(transparent)]
    Mesh(#[from] pliant_solver::MeshError),
    #[error("sizes of neighborhoods: {0}")]
    Rigidity(#[from] pliant_solver::RigidityError),
    #[error("the solver refused a figure: {0}")]
    Solve(#[from] pliant_solver::SolveError),
    #[error("the poses to learn from were refused: {0}")]
    Learn(#[from] pliant_solver::LearnError),
    #[error("{0}")]
    Gpu(#[from] pliant::viewport::GpuError),
    #[error("{file}: the picture could not be encoded: {source}")]
    Picture { file: String, source: image::ImageError },
    #[error("docs/gallery is not as promised:\n{}", .0.join("\n"))]
    Faults(Vec<String>),
}
