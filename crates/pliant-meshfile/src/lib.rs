//! Mesh files in, and the same files out with nothing changed but their shape.
//!
//! **Idea.** A file is more than its triangles: materials, seams, names, comments, animation, members that only some
//! other program understands. Opening therefore keeps the file as it came (the JSON and binary chunks of glTF, the
//! lines of OBJ, the header and lists of PLY) beside the geometry read from it, and saving edits that original: it replaces positions, turns the
//! normals the file had, adds rigidity, and leaves every other byte alone.
//!
//! **Three numberings.** *File vertices* are what a file lists (`v` lines, the positions of glTF primitives in document
//! order) and keep their order through opening and saving. *Surface points* are the places they stand for: file
//! vertices at exactly the same place share one, which closes the seams that texture coordinates and hard edges cut.
//! *Corners* tie triangles to texture coordinates and normals, and matter only inside a format.
//!
//! **Trust.** No input panics, hangs, reserves memory it does not fill, or makes the crate open a file outside the
//! model's own folder. Sizes are compared with what is really there before anything is reserved.
//!
//! [`poses`] are further shapes of a mesh, from other files or from what a file holds besides its shape.
//!
//! A format is one variant of [`Format`], one folder under `formats` and one line in its table.

mod budget;
mod error;
mod files;
mod folder;
mod format;
mod formats;
mod generated;
mod mesh_file;
mod normals;
mod opening;
mod pack;
mod polygon;
pub mod poses;
mod rigidity;
mod saving;
mod shape;
#[cfg(test)]
mod tests;
mod textures;
mod watch;
mod weld;

pub use error::{Fault, OpenError, SaveError, Warning};
pub use format::Format;
pub use mesh_file::{MeshFile, MorphShape, Morphs, side_files};
pub use opening::{OpenOptions, from_bytes, open};
pub use pack::Pack;
pub use rigidity::read_rigidity;
pub use saving::{SaveOptions, replace_file};
pub use shape::Part;
pub use textures::{Picture, Run, Textures, Wrapping};
pub use weld::{Weld, Welding};
