//! Why a file gives no poses, each as one line.

use crate::{Fault, OpenError};
use std::path::PathBuf;

/// Why a file, or one pose in it, cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum PoseError {
    /// The file cannot be opened.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The file is sound but holds nothing that can be used.
    #[error("{}: {fault}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why not.
        fault: PoseFault,
    },
    /// A pose in the file is broken; the others may be sound.
    #[error("{}: {pose}: {fault}", path.display())]
    Pose {
        /// The file.
        path: PathBuf,
        /// What the file calls the pose.
        pose: String,
        /// What is wrong with it.
        fault: Fault,
    },
}

impl PoseError {
    /// Whether the file has as many vertices as the reference and only other faces: it could be used with the
    /// reference's.
    pub fn only_faces_differ(&self) -> bool {
        let PoseError::File { fault, .. } = self else { return false };
        match fault {
            PoseFault::Counts { vertices, .. } => vertices[0] == vertices[1],
            PoseFault::Face { .. } => true,
            _ => false,
        }
    }
}

/// What is wrong with a file that can be opened.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PoseFault {
    /// Other numbers of vertices or triangles.
    #[error(
        "is no pose of the reference: it has {} vertices and {} triangles instead of {} and {}",
        vertices[0], triangles[0], vertices[1], triangles[1]
    )]
    Counts {
        /// Of the file, then of the reference.
        vertices: [usize; 2],
        /// Of the file, then of the reference.
        triangles: [usize; 2],
    },
    /// As many vertices and triangles, but a triangle joins other vertices.
    #[error(
        "is no pose of the reference: triangle {face} has vertices {}, {}, {} instead of {}, {}, {}",
        found[0], found[1], found[2], expected[0], expected[1], expected[2]
    )]
    Face {
        /// The first triangle that differs, from 0.
        face: usize,
        /// Its vertices in the file.
        found: [u32; 3],
        /// Its vertices in the reference.
        expected: [u32; 3],
    },
    /// Corners of one surface point are apart in a file without shared vertices.
    #[error(
        "is no pose of the reference: triangles {} and {} meet at vertex {vertex} of the reference and not in this file",
        faces[0], faces[1]
    )]
    Apart {
        /// A file vertex of the reference.
        vertex: u32,
        /// Two triangles that share it.
        faces: [usize; 2],
    },
    /// There are neither morph targets nor animations.
    #[error("holds no morph targets and no animation that moves its mesh: name files with poses")]
    Nothing,
    /// The mesh or the reference has no extent.
    #[error("has no extent that its scale could be found by")]
    NoScale,
}
