//! Pictures that a file lays on its surface, for display: found, still encoded, and never written back from here.
//!
//! A picture is read only where it may be: inside the file, or in the model's own folder. One that cannot be had is
//! named with the reason, and the triangles it belongs to keep their base color.

use crate::budget;
use crate::folder::Folder;
use glam::Vec2;
use std::ops::Range;

/// What lies beyond the edge of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrapping {
    /// The picture again.
    Repeat,
    /// The picture mirrored.
    Mirror,
    /// Its edge.
    Clamp,
}

/// A picture as the file holds it: PNG, JPEG, WebP or whatever else it may be.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its file name, or its place in the file.
    pub name: String,
    /// Still encoded.
    pub bytes: Vec<u8>,
    /// Beyond left and right, beyond top and bottom.
    pub wrapping: [Wrapping; 2],
    /// Where its opacity, from 0 to 1, is less than this nothing is there; `None` where opacity means nothing.
    pub cutout: Option<f32>,
}

/// Triangles that show the same picture, or none.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// A range of [`crate::MeshFile::triangles`].
    pub triangles: Range<usize>,
    /// Index of the picture.
    pub picture: Option<usize>,
    /// What the picture is multiplied by: red, green, blue, alpha.
    pub tint: [f32; 4],
}

/// The pictures on a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Textures {
    /// Each once, at least one.
    pub pictures: Vec<Picture>,
    /// Ascending, together all triangles.
    pub runs: Vec<Run>,
    /// Texture coordinates of the corners of each triangle, origin at the lower left.
    pub uvs: Vec<[Vec2; 3]>,
    /// Pictures that cannot be shown, each with the reason.
    pub missing: Vec<String>,
}

/// Reads pictures within the budget of one model.
pub(crate) struct Gatherer {
    pub(crate) pictures: Vec<Picture>,
    pub(crate) missing: Vec<String>,
    left: u64,
}

impl Gatherer {
    /// None read yet.
    pub(crate) fn new() -> Gatherer {
        Gatherer { pictures: Vec::new(), missing: Vec::new(), left: budget::PICTURE_BYTES }
    }

    /// Takes a picture out of bytes that are there; its index.
    pub(crate) fn take(
        &mut self,
        name: String,
        bytes: Result<Vec<u8>, String>,
        (wrapping, cutout): ([Wrapping; 2], Option<f32>),
    ) -> Option<usize> {
        let bytes = match bytes {
            Ok(_) if self.pictures.len() >= budget::PICTURES => Err("there are too many pictures".to_owned()),
            Ok(bytes) if bytes.len() as u64 > self.left => Err("all pictures together are too large".to_owned()),
            bytes => bytes,
        };
        match bytes {
            Ok(bytes) => {
                self.left -= bytes.len() as u64;
                self.pictures.push(Picture { name, bytes, wrapping, cutout });
                Some(self.pictures.len() - 1)
            }
            Err(reason) => {
                self.missing.push(format!("{name} ({reason})"));
                None
            }
        }
    }

    /// Bytes of a file that a model in `folder` names.
    pub(crate) fn read(&self, folder: Option<&Folder>, reference: &str) -> Result<Vec<u8>, String> {
        folder.ok_or("no folder to look in")?.read(reference, self.left)
    }

    /// The pictures on triangles that these runs of materials cover in order, where there is any.
    pub(crate) fn on(self, mut runs: Vec<Run>, n_triangles: usize, uvs: impl FnOnce() -> Vec<[Vec2; 3]>) -> Textures {
        if self.pictures.is_empty() {
            return Textures { missing: self.missing, ..Textures::default() };
        }
        runs.retain(|run| !run.triangles.is_empty());
        // What no run covers has no picture.
        let plain = |triangles| Run { triangles, picture: None, tint: crate::shape::NO_MATERIAL };
        let mut all: Vec<Run> = Vec::new();
        let mut end = 0;
        for run in runs {
            if run.triangles.start > end {
                all.push(plain(end..run.triangles.start));
            }
            end = run.triangles.end;
            match all.last_mut().filter(|last| (last.picture, last.tint) == (run.picture, run.tint)) {
                Some(last) => last.triangles.end = end,
                None => all.push(run),
            }
        }
        if end < n_triangles {
            all.push(plain(end..n_triangles));
        }
        Textures { pictures: self.pictures, runs: all, uvs: uvs(), missing: self.missing }
    }
}
