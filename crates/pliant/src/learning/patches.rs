//! A few patches spread evenly over a surface, by which a pose can be held.

use glam::DVec3;
use pliant_solver::{Mesh, VertexId};

/// Up to `n` vertices, each as far from those before as can be, and with each of them its neighbors. Ascending, none
/// twice. Distances are straight ones: a surface of many small pieces, of which each would be far from the others along
/// edges, is held all over. The first is the vertex farthest from the middle.
pub(super) fn spread_patches(mesh: &Mesh, n: usize) -> Vec<VertexId> {
    let positions = mesh.positions();
    let middle = positions.iter().sum::<DVec3>() / positions.len() as f64;
    let mut distances: Vec<f64> = positions.iter().map(|p| p.distance(middle)).collect();
    let mut held = Vec::new();
    for round in 0..n {
        // Of equally far ones the first.
        let farthest = |a: &usize, b: &usize| distances[*a].total_cmp(&distances[*b]).then(b.cmp(a));
        let center = (0..positions.len()).max_by(farthest).unwrap_or(0);
        if round > 0 && distances[center] == 0.0 {
            break;
        }
        held.push(VertexId(center as u32));
        held.extend(mesh.neighbors(VertexId(center as u32)).iter().map(|&v| VertexId(v)));
        for (distance, p) in distances.iter_mut().zip(positions) {
            let to_center = p.distance(positions[center]);
            *distance = if round == 0 { to_center } else { distance.min(to_center) };
        }
    }
    held.sort_unstable_by_key(|v| v.0);
    held.dedup();
    held
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two strips of `n` points each along x, far apart.
    fn strips(n: usize) -> Mesh {
        let point = |i: usize| DVec3::new((i / 2) as f64, (i % 2) as f64, 0.0);
        let far = DVec3::new(0.0, 1000.0, 0.0);
        let points = (0..n).map(point).chain((0..n).map(|i| point(i) + far)).collect();
        let strip = |first: usize| (first..first + n - 2).map(move |i| [i as u32, i as u32 + 1, i as u32 + 2]);
        Mesh::new(points, strip(0).chain(strip(n)).collect()).expect("valid")
    }

    #[test]
    fn patches_lie_at_the_ends_first() {
        let held = spread_patches(&strips(40), 4);
        for end in [0, 39, 40, 79] {
            assert!(held.iter().any(|v| v.index().abs_diff(end) <= 1), "no patch near vertex {end}: {held:?}");
        }
        assert!(held.len() <= 4 * 5, "a vertex and its neighbors each: {held:?}");
    }

    #[test]
    fn more_patches_than_vertices_hold_everything_once() {
        let held = spread_patches(&strips(4), 100);
        assert_eq!(held.iter().map(|v| v.index()).collect::<Vec<_>>(), (0..8).collect::<Vec<_>>());
    }
}
