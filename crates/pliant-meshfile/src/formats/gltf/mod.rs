//! glTF 2.0, as JSON with buffers or as one GLB file.
//!
//! The JSON is kept as it is and read through checks of our own: every accessor, view, index, stride, type and node in
//! 64-bit arithmetic, before anything is reserved or followed. A typed document would lose members it does not know,
//! and the usual crate's reader panics on several broken files; it checks this reader in the tests instead. Saving
//! changes the text of the JSON where it must and copies the rest ([`patch`]); geometry that extensions compress is decoded
//! on opening ([`compressed`]).
//!
//! A mesh is opened once, where the first node of the default scene puts it, and all nodes that use it follow what is
//! bent. Meshes outside that scene are opened too, since vertices are numbered through the whole file.

mod access;
mod base64;
mod buffers;
mod builder;
mod compressed;
mod container;
mod export;
mod json;
mod leave_draco;
mod morphs;
mod motion;
mod nodes;
mod patch;
mod read;
mod relocate;
mod rewrite;
mod shape;
mod source;
mod textures;

pub(super) use export::write;
pub(crate) use morphs::with_morphs;
pub(super) use read::read;

use super::source::{Before, Bindings, Edit, Motion, Output, Source};
use crate::shape::Shape;
use crate::textures::Textures;
use crate::{Fault, Format, SaveError};
use source::GltfSource;
use std::path::Path;
use std::sync::Arc;

impl Source for GltfSource {
    fn rewrite(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Option<Result<Output, SaveError>> {
        matches!(format, Format::Gltf | Format::Glb).then(|| rewrite::rewrite(self, edit, to, format))
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        shape::shape(self, edit)
    }

    fn references(&self) -> Vec<String> {
        relocate::images_beside(&self.document).filter_map(crate::files::percent_decoded).collect()
    }

    fn textures(&self, mesh: Before<'_>) -> Textures {
        textures::textures(self, mesh)
    }

    fn bindings(&self) -> Option<Box<dyn Bindings + '_>> {
        motion::bindings(self)
    }

    fn n_poses(&self, frames: usize) -> usize {
        motion::n_poses(self, frames)
    }

    fn motion(self: Arc<Self>, frames: usize) -> Result<Option<Box<dyn Motion>>, Fault> {
        motion::of(self, frames)
    }
}
