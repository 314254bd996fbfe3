//! What can go wrong, one line each: what, where, what to do.

use crate::LARGEST_COORDINATE;

/// Why a mesh was refused by [`Mesh::new`](crate::Mesh::new).
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// The list of positions is empty.
    #[error("the mesh has no vertices")]
    NoVertices,
    /// The list of triangles is empty.
    #[error("the mesh has no faces")]
    NoFaces,
    /// A coordinate is NaN, infinite or too large to be squared.
    #[error("vertex {vertex} has a coordinate that is not a number below {LARGEST_COORDINATE:e}")]
    NotFinite {
        /// The first such vertex.
        vertex: u32,
    },
    /// A triangle names a vertex that does not exist.
    #[error("face {face} names vertex {index}, but the mesh has only {n_vertices} vertices")]
    IndexOutOfRange {
        /// The first such triangle.
        face: usize,
        /// The vertex it names.
        index: u32,
        /// Number of vertices of the mesh.
        n_vertices: usize,
    },
    /// Vertices or faces do not fit 32-bit indices.
    #[error("the mesh has {n_vertices} vertices and {n_faces} faces; at most {max} of each can be handled")]
    TooLarge {
        /// Number of vertices given.
        n_vertices: usize,
        /// Number of triangles given.
        n_faces: usize,
        /// The limit for each.
        max: usize,
    },
}

/// Why rigidity values were refused by [`Rigidity::new`](crate::Rigidity::new).
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RigidityError {
    /// A value is zero or too large.
    #[error("vertex {vertex} has rigidity {r}; it must be from 1 to {max}")]
    OutOfRange {
        /// The first such vertex.
        vertex: usize,
        /// Its value.
        r: u16,
        /// The largest value allowed.
        max: u16,
    },
}

/// Why the solver refused a change. It is then as it was before.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SolveError {
    /// No vertex is held.
    #[error("no vertex is held; place at least one handle")]
    NoHandles,
    /// A held vertex does not exist.
    #[error("handle vertex {vertex} does not exist; the mesh has {n_vertices} vertices")]
    HeldOutOfRange {
        /// The vertex given.
        vertex: u32,
        /// Number of vertices of the mesh.
        n_vertices: usize,
    },
    /// A vertex is listed twice among the held ones.
    #[error("handle vertex {vertex} is listed twice")]
    HeldTwice {
        /// The vertex given.
        vertex: u32,
    },
    /// A list does not have one entry per vertex (or per held vertex).
    #[error("{what}: {got} given, {expected} expected")]
    WrongLength {
        /// What was given.
        what: &'static str,
        /// Length of the list.
        got: usize,
        /// Length it must have.
        expected: usize,
    },
    /// A target or a position is NaN, infinite or too large to be squared.
    #[error("the position given for vertex {vertex} is not a number below {LARGEST_COORDINATE:e}")]
    TargetNotFinite {
        /// The vertex it was given for.
        vertex: u32,
    },
    /// Raw cotangent weights do not give a positive definite system.
    #[error("the raw weights make the system indefinite at vertex {vertex}; use clamped weights")]
    Indefinite {
        /// The vertex whose pivot was not positive.
        vertex: u32,
    },
    /// The computation was stopped from outside.
    #[error("canceled")]
    Canceled,
    /// The neighborhoods or the factor need more memory or larger indices than there are.
    #[error("{what} is too large for this machine; use a smaller mesh or a smaller rigidity")]
    TooLarge {
        /// What did not fit.
        what: &'static str,
    },
}

/// Why rigidity could not be learned. Nothing has changed then.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LearnError {
    /// The range of r is empty or out of bounds.
    #[error("r from {first} to {last} cannot be learned; give a range within 1 to {max}")]
    BadRange {
        /// The first r given.
        first: u16,
        /// The last r given.
        last: u16,
        /// The largest r there is.
        max: u16,
    },
    /// The neighborhoods or the table need more memory than is reasonable.
    #[error(
        "r up to {last} on {n_vertices} vertices needs too much memory; learn with a smaller r or on a smaller mesh"
    )]
    TooLarge {
        /// The last r given.
        last: u16,
        /// Number of vertices of the mesh.
        n_vertices: usize,
    },
    /// A pose does not have one position per vertex.
    #[error("the pose has {got} vertices, but the reference has {expected}")]
    WrongLength {
        /// Number of positions given.
        got: usize,
        /// Number of vertices of the reference.
        expected: usize,
    },
    /// A position is NaN, infinite or too large to be squared.
    #[error("vertex {vertex} of the pose has a coordinate that is not a number below {LARGEST_COORDINATE:e}")]
    NotFinite {
        /// The first such vertex.
        vertex: u32,
    },
    /// No pose has been added.
    #[error("no pose to learn from; add at least one besides the reference")]
    NoPoses,
}
