//! What can go wrong with a project, each as one line.

use std::path::PathBuf;

use pliant_meshfile::SaveError;

use crate::document::ModelError;

/// Why a project was not opened or saved.
#[derive(Debug, thiserror::Error)]
pub enum ProjectError {
    /// The file system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The project.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is something else.
    #[error("{}: is not a Pliant project", path.display())]
    NotAProject {
        /// The file.
        path: PathBuf,
    },
    /// A later program wrote it.
    #[error(
        "{}: was saved by a newer Pliant (project version {found}, this one reads up to {known}): update to open it",
        path.display()
    )]
    Newer {
        /// The project.
        path: PathBuf,
        /// Its version.
        found: u32,
        /// The newest that can be read.
        known: u32,
    },
    /// Its bytes are not those that were written.
    #[error("{}: is damaged: {problem}; open a copy from before", path.display())]
    Damaged {
        /// The project.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// The linked mesh is not where it was.
    #[error("{}: its mesh {} was not found: choose where it is now", path.display(), mesh.display())]
    MeshMissing {
        /// The project.
        path: PathBuf,
        /// Where the mesh was.
        mesh: PathBuf,
    },
    /// The linked mesh is another one by now.
    #[error(
        "{}: its mesh {} has changed since the project was saved: use it as it is now, or choose another",
        path.display(), mesh.display()
    )]
    MeshChanged {
        /// The project.
        path: PathBuf,
        /// The changed mesh.
        mesh: PathBuf,
    },
    /// A mesh with other vertices was named.
    #[error("{}: has {found} vertices on its surface, the project was made with {expected}: choose the mesh it was made with", mesh.display())]
    OtherMesh {
        /// The mesh.
        mesh: PathBuf,
        /// Its surface points.
        found: usize,
        /// Those of the project.
        expected: usize,
    },
    /// Its mesh cannot be used.
    #[error("{}: its mesh cannot be opened: {source}", path.display())]
    Mesh {
        /// The project.
        path: PathBuf,
        /// Why.
        #[source]
        source: ModelError,
    },
    /// It could not be written.
    #[error(transparent)]
    Save(#[from] SaveError),
    /// The header is larger than one that would be read.
    #[error("{}: not saved: {what} are more than a project can hold", path.display())]
    TooLarge {
        /// The project.
        path: PathBuf,
        /// What there is too much of.
        what: &'static str,
    },
}

/// What is wrong with the content of a project, before it is said which.
#[derive(Debug, PartialEq)]
pub(super) struct Flaw(pub(super) String);

impl Flaw {
    pub(super) fn new(problem: impl Into<String>) -> Flaw {
        Flaw(problem.into())
    }

    pub(super) fn in_project(self, path: impl Into<PathBuf>) -> ProjectError {
        ProjectError::Damaged { path: path.into(), problem: self.0 }
    }
}
