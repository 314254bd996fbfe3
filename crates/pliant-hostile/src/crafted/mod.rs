//! Broken, odd and hostile files, each with what must become of it.
//!
//! **Idea.** What is wrong is known, because it was put in: one thing at a time into a small sound file. A file with
//! something odd that its format allows, or that harms nothing, must open with all its vertices; anything else must be
//! refused with a message that names the place.

mod glb;
mod gltf;
mod gltf_large;
mod gltf_moving;
mod gltf_places;
mod model;
mod obj;
mod obj_large;
mod off;
mod ply;
mod stl;

pub use model::{glb_of, gltf_of, sound_document};

use crate::exercise::Outcome;
use pliant_meshfile::Format;
use std::path::Path;

/// A file and what must become of it.
#[derive(Clone, Debug)]
pub struct Case {
    /// Says what is odd about it.
    pub name: String,
    /// Ending of its name, which chooses the reader.
    pub extension: &'static str,
    /// Its content.
    pub bytes: Vec<u8>,
    /// What must become of it.
    pub expected: Expected,
}

/// What must become of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expected {
    /// It opens with so many file vertices.
    Opens(usize),
    /// It is refused with a message that contains this.
    Refused(String),
}

impl Expected {
    /// Whether this is what happened.
    pub fn is(&self, outcome: &Outcome) -> bool {
        match (self, outcome) {
            (Expected::Opens(expected), Outcome::Opened(n)) => n == expected,
            (Expected::Refused(part), Outcome::Refused(message)) => message.contains(part),
            _ => false,
        }
    }
}

impl From<usize> for Expected {
    fn from(n_vertices: usize) -> Expected {
        Expected::Opens(n_vertices)
    }
}

impl From<&str> for Expected {
    fn from(part: &str) -> Expected {
        Expected::Refused(part.to_owned())
    }
}

impl From<String> for Expected {
    fn from(part: String) -> Expected {
        Expected::Refused(part)
    }
}

impl Case {
    fn new(
        name: impl Into<String>,
        extension: &'static str,
        bytes: impl Into<Vec<u8>>,
        expected: impl Into<Expected>,
    ) -> Case {
        Case { name: name.into(), extension, bytes: bytes.into(), expected: expected.into() }
    }

    /// The format of its name.
    pub fn format(&self) -> Format {
        Format::of(&Path::new("case").with_extension(self.extension)).expect("crafted files have known endings")
    }
}

/// Every crafted file, in an order that stays.
pub fn all() -> Vec<Case> {
    [small(), obj_large::cases(), gltf_large::cases()].concat()
}

fn small() -> Vec<Case> {
    [
        obj::cases(),
        gltf::cases(),
        gltf_places::cases(),
        gltf_moving::cases(),
        glb::cases(),
        ply::cases(),
        stl::cases(),
        off::cases(),
    ]
    .concat()
}

/// The sound ones that are small, from which damaged files are made.
pub fn seeds() -> Vec<Case> {
    let sound = |case: &Case| matches!(case.expected, Expected::Opens(_)) && case.bytes.len() < 8_000;
    small().into_iter().filter(sound).collect()
}
