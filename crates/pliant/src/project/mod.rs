//! The project file (`.pliant`): everything needed to go on where one left off.
//!
//! ```text
//! mark · version · number of blocks · checksum
//! block 0: the header, JSON: names, small values, and the numbers of the blocks that hold the long lists
//! block 1…: lists of numbers, and the mesh file with all it refers to
//! ```
//!
//! Every block carries its length and a checksum over both (`container.rs`), so that a file that was cut or damaged anywhere
//! is told from a whole one. Numbers are little endian, positions in double precision: a project opens to the last bit as it
//! was left.
//!
//! **The mesh** is packed as the bytes that were opened, or linked by a relative path with length and checksum (`mesh.rs`). A
//! link that leads to another file, or to none, is an error that says so; the caller may then name the mesh.
//!
//! **Growing.** What a project holds further is an optional field of a record here: older files open without it, and older
//! programs skip it. Only what older programs would get wrong raises the version.
//!
//! **Trust.** A project is a file like any other: it may be broken or hostile. Lengths are compared with what is there before
//! memory is reserved, every index and number is checked (`scene.rs`), and of the disk only a file inside the project's reach
//! is read that has the length and checksum the project states.

mod container;
mod error;
mod file;
mod mesh;
mod poses;
mod record;
mod scene;
#[cfg(test)]
mod tests;

pub use error::ProjectError;
pub use file::{Contents, Loaded, Summary, is_project, open, save, summary};
pub use mesh::{Mesh, MeshChoice};

/// The ending of projects' names, without the dot.
pub const EXTENSION: &str = "pliant";
