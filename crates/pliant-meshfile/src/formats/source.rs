//! The words between a format and the rest of the crate.

use crate::shape::{Part, Shape};
use crate::{Format, SaveError, Warning, Weld};
use glam::{DVec3, Vec2};
use std::fmt::Debug;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a reader gets.
pub(crate) struct Input<'a> {
    pub(crate) bytes: Vec<u8>,
    /// Where references may be followed; nowhere for files from memory.
    pub(crate) folder: Option<&'a Path>,
    /// Name of the model, for parts that have none.
    pub(crate) name: &'a str,
}

/// What a reader gives.
pub(crate) struct Opened {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) rigidity: Option<Vec<u16>>,
    pub(crate) uvs: Option<Vec<Vec2>>,
    pub(crate) colors: Option<Vec<[f32; 4]>>,
    pub(crate) parts: Vec<Part>,
    pub(crate) warnings: Vec<Warning>,
    pub(crate) source: Arc<dyn Source>,
}

/// A file as it came, able to be written again with another shape.
pub(crate) trait Source: Debug + Send + Sync {
    /// The same file with the edit, touching nothing else; `None` when `format` is not of the source's kind.
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>>;
    /// The edited mesh without its file, for other formats.
    fn shape(&self, edit: &Edit<'_>) -> Shape;
}

/// A mesh as it was opened.
#[derive(Clone, Copy)]
pub(crate) struct Before<'a> {
    pub(crate) positions: &'a [DVec3],
    pub(crate) triangles: &'a [[u32; 3]],
    pub(crate) weld: &'a Weld,
    pub(crate) rigidity: &'a Option<Vec<u16>>,
    pub(crate) uvs: &'a Option<Vec<Vec2>>,
    pub(crate) colors: &'a Option<Vec<[f32; 4]>>,
    pub(crate) parts: &'a [Part],
}

/// The new state of a mesh.
pub(crate) struct Edit<'a> {
    pub(crate) mesh: Before<'a>,
    /// World position of each file vertex; equal to the opened one to the bit where nothing moved.
    pub(crate) positions: Vec<DVec3>,
    /// r of each file vertex, when it is to be written.
    pub(crate) rigidity: Option<Vec<u16>>,
}

impl Edit<'_> {
    /// Whether a file vertex is not where it was opened.
    pub(crate) fn moved(&self, vertex: usize) -> bool {
        self.positions[vertex] != self.mesh.positions[vertex]
    }
}

/// Finished files, not yet on the disk.
#[derive(Debug)]
pub(crate) struct Output {
    pub(crate) bytes: Vec<u8>,
    /// Further files that belong to it.
    pub(crate) beside: Vec<(PathBuf, Vec<u8>)>,
    pub(crate) warnings: Vec<Warning>,
}
