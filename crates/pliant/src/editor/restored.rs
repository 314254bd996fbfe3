//! A project that was read, on its way to the screen.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::SystemTime;

use serde_json::Value;

use super::Leftover;
use crate::document::{Model, Snapshot};
use crate::project::{Loaded, Mesh};
use crate::viewport::Camera;

/// The project on the disk that a document belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProjectFile {
    /// Where it is.
    pub path: PathBuf,
    /// How it holds its mesh.
    pub mesh: Mesh,
    /// Length and time of the file when this window last read or wrote it.
    stamp: Option<(u64, SystemTime)>,
}

impl ProjectFile {
    /// The project in a file, as it is now.
    pub fn new(path: PathBuf, mesh: Mesh) -> ProjectFile {
        ProjectFile { stamp: stamp(&path), path, mesh }
    }

    /// Whether another program, or another window, has written the file since.
    pub fn is_foreign(&self) -> bool {
        stamp(&self.path).is_some_and(|now| self.stamp != Some(now))
    }
}

fn stamp(path: &Path) -> Option<(u64, SystemTime)> {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

/// Where a restored document comes from.
#[derive(Clone, Debug)]
pub enum Origin {
    /// A project, saved by the user.
    Project(ProjectFile),
    /// An autosave of a window that stopped.
    Leftover(Arc<Leftover>),
}

/// What a project holds besides its mesh.
pub struct Restored {
    /// Scene and pose; they fit the mesh.
    pub(super) snapshot: Snapshot,
    pub(super) next_group: u32,
    pub(super) camera: Option<Camera>,
    pub(super) settings: Value,
    pub(super) origin: Origin,
}

impl Restored {
    /// Takes a project apart: its mesh, and the rest.
    pub(super) fn of(loaded: Loaded, origin: impl FnOnce(Mesh) -> Origin) -> (Model, Restored) {
        let Loaded { model, scene, pose, next_group, camera, settings, mesh } = loaded;
        let snapshot = Snapshot { scene, pose };
        (model, Restored { snapshot, next_group, camera, settings, origin: origin(mesh) })
    }
}
