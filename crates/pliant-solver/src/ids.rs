//! Typed indices: raw integers appear only inside kernels and at file and GPU edges.

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
        pub struct $name(pub u32);

        impl $name {
            /// The same number as a slice index.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id! {
    /// Index of a vertex of a [`Mesh`](crate::Mesh) (a surface point), in the caller's numbering.
    VertexId
}
id! {
    /// Index of a triangle of a [`Mesh`](crate::Mesh), in the caller's numbering.
    FaceId
}
id! {
    /// Index of an undirected edge in [`Mesh::edges`](crate::Mesh::edges).
    EdgeId
}
id! {
    /// Number of a connected component, as in [`Mesh::components`](crate::Mesh::components).
    ComponentId
}
