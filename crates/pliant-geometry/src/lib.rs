//! Questions about a triangle mesh in space: what does a ray meet, which triangles cross, how far is it along the
//! surface, which way does the surface face.
//!
//! Everything here takes plain slices: positions by vertex, triangles as three vertex numbers. What depends only on the
//! triangles is computed once and kept ([`Bvh`] the tree's shape, [`SurfaceDistance`] and [`VertexNormals`] which
//! triangles meet at a vertex); positions are passed to each question, since they change many times a second while a
//! handle is dragged.
//!
//! | object | built once | each question |
//! |---|---|---|
//! | [`Bvh`] | O(n log n) | [`refit`](Bvh::refit) O(n); a ray O(log n) |
//! | [`crossings()`], [`crossings_of_all`] | – | O(n log n) plus the pairs of boxes that overlap |
//! | [`FacePatches`] | O(n) | – |
//! | [`MirrorMap`] | O(n log n) | O(1) |
//! | [`edge_stretch`], [`largest_difference`] | – | O(n) |
//! | [`Occlusion`] | O(n), parallel, for one view | a point O(1) |
//! | [`SurfaceDistance`] | O(n) | O(k log k) for k vertices returned |
//! | [`VertexNormals`] | O(n) | O(n), parallel |
//!
//! **Broken input never panics.** A triangle that names a vertex past the end, or has a corner that is not finite,
//! counts as absent; a triangle without area is met by no ray and crosses nothing.

mod bounds;
mod bvh;
mod crossings;
mod face_neighbors;
mod face_patches;
mod incidence;
mod measures;
mod mirror_map;
mod occlusion;
mod ray;
mod surface_distance;
mod tree;
mod vertex_normals;

#[cfg(test)]
mod test_shapes;

pub use bvh::Bvh;
pub use crossings::{crossings, crossings_of_all};
pub use face_patches::FacePatches;
pub use measures::{edge_stretch, largest_difference};
pub use mirror_map::{MirrorMap, Plane, Seam, Uneven};
pub use occlusion::{Lens, Occlusion, Sight};
pub use ray::{Hit, Ray};
pub use surface_distance::{Crossing, Growth, SurfaceDistance};
pub use vertex_normals::VertexNormals;
