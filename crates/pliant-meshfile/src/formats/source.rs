//! The words between a format and the rest of the crate.

use crate::folder::Folder;
use crate::saving::Unfinished;
use crate::shape::{Part, Shape};
use crate::textures::Textures;
use crate::watch::Stage;
use crate::{Fault, Format, SaveError, Warning, Weld};
use glam::{DVec3, Vec2};
use std::fmt::Debug;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a reader gets.
pub(crate) struct Input<'a> {
    pub(crate) bytes: Vec<u8>,
    /// Where references may be followed; nowhere for files from memory.
    pub(crate) folder: Option<&'a Folder>,
    /// Files beside the model that an interrupted saving left under other names.
    pub(crate) unfinished: Option<&'a Unfinished>,
    /// Name of the model, for parts that have none.
    pub(crate) name: &'a str,
    /// To be told how far reading is, every few milliseconds of work, and asked whether to go on.
    pub(crate) stage: Stage<'a>,
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

    /// Triangles that polygons of more than three corners were cut into, ascending; none in formats of triangles.
    ///
    /// Where a polygon is cut depends on its shape, so that two poses of one mesh can differ there.
    fn polygons(&self) -> &[Range<u32>] {
        &[]
    }

    /// The pictures on the surface; none in formats without.
    fn textures(&self, _mesh: Before<'_>) -> Textures {
        Textures::default()
    }

    /// What keeps vertices apart that are at one place; none in formats without skins.
    fn bindings(&self) -> Option<Box<dyn Bindings + '_>> {
        None
    }

    /// What the file refers to and was not read on opening: paths relative to its folder.
    fn references(&self) -> Vec<String> {
        Vec::new()
    }

    /// Files by the references to them that a file saved as `to` needs beside it, where this source has them in a pack.
    fn unpacked(&self, _to: &Path) -> Vec<(String, Vec<u8>)> {
        Vec::new()
    }

    /// How many poses [`Source::motion`] gives at most, told without reading them.
    fn n_poses(&self, _frames: usize) -> usize {
        0
    }

    /// The poses that the file holds besides its shape, with so many frames of each animation; none in formats that
    /// hold one shape.
    fn motion(self: Arc<Self>, _frames: usize) -> Result<Option<Box<dyn Motion>>, Fault> {
        Ok(None)
    }
}

/// What carries the vertices when the file's own skeleton moves.
pub(crate) trait Bindings {
    /// Whether two file vertices at one place stay together whatever the skeleton does.
    fn alike(&self, a: usize, b: usize) -> bool;
}

/// Poses that a file holds besides its shape: morph targets, frames of animations.
pub(crate) trait Motion: Debug + Send {
    /// How many there are.
    fn n_poses(&self) -> usize;
    /// Whether pose `index` is a frame of an animation, which neighbors resemble.
    fn is_frame(&self, index: usize) -> bool;
    /// What the file calls pose `index`, from 0.
    fn name(&self, index: usize) -> String;
    /// World position of every file vertex in pose `index`. Finite. None for a pose that is passed over: it shows nothing,
    /// which the warnings say, or what is wrong with it was said of a pose before.
    fn pose(&mut self, index: usize) -> Result<Option<Vec<DVec3>>, Broken>;
    /// What was passed over or changed so far, each said once.
    fn warnings(&mut self) -> Vec<Warning>;
}

/// A pose, or an animation with all its poses, that is broken.
#[derive(Debug)]
pub(crate) struct Broken {
    /// What the file calls it.
    pub(crate) what: String,
    pub(crate) fault: Fault,
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
    /// The file vertex that each vertex of the new file was, where they are not the same.
    pub(crate) origin: Option<Vec<u32>>,
}
