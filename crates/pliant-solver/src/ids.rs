//! Typed indices: raw integers appear only inside kernels and at file and GPU edges.

/// Index of a vertex of a [`Mesh`](crate::Mesh) (a surface point), in the caller's numbering.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct VertexId(pub u32);

impl VertexId {
    /// The same number as a slice index.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}
