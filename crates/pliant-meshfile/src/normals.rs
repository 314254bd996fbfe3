//! Normals of a bent surface, from the normals it came with.
//!
//! **Idea.** The artist's normals say which edges are hard and how soft ones are weighted; recomputing them would lose
//! that. So each is *turned* as its own faces turned: by the rotation that carries their area-weighted normal and, in the
//! plane across it, one of their edges from rest to bent. It is exact for rigid motions and takes tangents along. Corners that share a normal form a *cluster*, and a cluster's faces are all faces at its
//! corners: both sides of a texture seam turn alike, the two sides of a hard edge each by their own faces. A cluster
//! whose faces did not change keeps its normal to the bit.

use glam::{DMat3, DQuat, DVec3, Vec3};

/// The rotation of each of `n_clusters` clusters from `before` to `after`, `None` where nothing changed.
///
/// `triangles` index `before` and `after`; `cluster_of(t, k)` is the cluster of corner `k` of triangle `t`, if any.
pub(crate) fn turns(
    triangles: &[[u32; 3]],
    n_clusters: usize,
    cluster_of: impl Fn(usize, usize) -> Option<u32>,
    before: &[DVec3],
    after: &[DVec3],
) -> Vec<Option<DQuat>> {
    let mut clusters = vec![Cluster::default(); n_clusters];
    for (t, triangle) in triangles.iter().enumerate() {
        let area = [area_vector(before, triangle), area_vector(after, triangle)];
        for k in 0..3 {
            let Some(cluster) = cluster_of(t, k).and_then(|c| clusters.get_mut(c as usize)) else { continue };
            cluster.area = [cluster.area[0] + area[0], cluster.area[1] + area[1]];
            if cluster.edge[0] == DVec3::ZERO {
                let [a, b] = [triangle[k], triangle[(k + 1) % 3]].map(|v| v as usize);
                cluster.edge = [before[b] - before[a], after[b] - after[a]];
            }
        }
    }
    clusters.into_iter().map(Cluster::turn).collect()
}

/// Faces of a cluster before and after: sum of their area vectors, and an edge of the first that has one.
#[derive(Clone, Copy, Default)]
struct Cluster {
    area: [DVec3; 2],
    edge: [DVec3; 2],
}

impl Cluster {
    fn turn(self) -> Option<DQuat> {
        if self.area[0] == self.area[1] && self.edge[0] == self.edge[1] {
            return None;
        }
        let [before, after] = [self.area[0].try_normalize()?, self.area[1].try_normalize()?];
        let frame = |normal: DVec3, edge: DVec3| {
            let along = edge.reject_from_normalized(normal).try_normalize()?;
            Some(DMat3::from_cols(normal, along, normal.cross(along)))
        };
        match (frame(before, self.edge[0]), frame(after, self.edge[1])) {
            (Some(from), Some(to)) => Some(DQuat::from_mat3(&(to * from.transpose())).normalize()),
            // An edge along the normal says nothing about the plane.
            _ => Some(DQuat::from_rotation_arc(before, after)),
        }
    }
}

/// Twice the area of a triangle times its normal.
fn area_vector(positions: &[DVec3], triangle: &[u32; 3]) -> DVec3 {
    let [a, b, c] = triangle.map(|v| positions[v as usize]);
    (b - a).cross(c - a)
}

/// `normal` turned, of unit length, or as it was where the turn makes no sense of it.
pub(crate) fn turned(normal: Vec3, turn: DQuat) -> Vec3 {
    match (turn * normal.as_dvec3()).try_normalize() {
        Some(new) => new.as_vec3(),
        None => normal,
    }
}

/// Area-weighted vertex normals of unit length; +Z where a vertex has no face.
pub(crate) fn smooth(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in triangles {
        let area = area_vector(positions, triangle);
        for &vertex in triangle {
            sums[vertex as usize] += area;
        }
    }
    sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(DVec3::Z).as_vec3()).collect()
}
