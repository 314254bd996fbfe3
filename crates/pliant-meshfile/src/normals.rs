//! Normals of a bent surface, from the normals it came with.
//!
//! **Idea.** The artist's normals say which edges are hard and how soft ones are weighted; recomputing them would lose
//! that. So each is *turned* by the shortest rotation that carries the area-weighted normal of its own faces at rest to
//! that of the same faces bent. Corners that share a normal form a *cluster*, and a cluster's faces are all faces at its
//! corners: both sides of a texture seam turn alike, the two sides of a hard edge each by their own faces. A cluster
//! whose faces did not change keeps its normal to the bit.

use glam::{DQuat, DVec3, Vec3};

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
    let mut sums = vec![(DVec3::ZERO, DVec3::ZERO); n_clusters];
    for (t, triangle) in triangles.iter().enumerate() {
        let area_before = area_vector(before, triangle);
        let area_after = area_vector(after, triangle);
        for k in 0..3 {
            if let Some(sum) = cluster_of(t, k).and_then(|cluster| sums.get_mut(cluster as usize)) {
                sum.0 += area_before;
                sum.1 += area_after;
            }
        }
    }
    sums.into_iter().map(|(before, after)| turn(before, after)).collect()
}

fn turn(before: DVec3, after: DVec3) -> Option<DQuat> {
    if before == after {
        return None;
    }
    Some(DQuat::from_rotation_arc(before.try_normalize()?, after.try_normalize()?))
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
