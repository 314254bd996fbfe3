//! Which way the surface faces at each vertex.

use crate::bounds::corners;
use crate::incidence::Incidence;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Vertices or triangles per task: small meshes are not worth waking other threads.
const PER_TASK: usize = 2048;

/// Area-weighted unit normals at the vertices. Keeps which triangles meet at a vertex, so that every vertex gathers its
/// own sum: parallel, and the same bits for any number of threads.
#[derive(Clone, Debug)]
pub struct VertexNormals {
    incidence: Incidence,
}

impl VertexNormals {
    /// O(n): which triangles meet at each vertex.
    pub fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> VertexNormals {
        VertexNormals { incidence: Incidence::new(n_vertices, triangles) }
    }

    /// Fills `out` with one unit vector a vertex. `triangles` as given to [`new`](Self::new). Where no triangle with an
    /// area meets, the normal is +y.
    pub fn compute(&self, positions: &[Vec3], triangles: &[[u32; 3]], out: &mut Vec<Vec3>) {
        out.resize(self.incidence.n_vertices(), Vec3::Y);
        // Each triangle once, and not again at each of its corners.
        let areas = triangles.par_iter().with_min_len(PER_TASK);
        let areas = areas.map(|&t| corners(positions, t).map_or(DVec3::ZERO, doubled_area)).collect::<Vec<_>>();
        out.par_iter_mut().with_min_len(PER_TASK).enumerate().for_each(|(v, normal)| {
            let sum: DVec3 = self.incidence.around(v).iter().filter_map(|&t| areas.get(t as usize)).sum();
            *normal = sum.try_normalize().map_or(Vec3::Y, |n| n.as_vec3());
        });
    }
}

/// Normal of a triangle with twice its area as length; in `f64`, where the area of a tiny triangle does not vanish.
fn doubled_area([a, b, c]: [Vec3; 3]) -> DVec3 {
    let a = a.as_dvec3();
    (b.as_dvec3() - a).cross(c.as_dvec3() - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::sphere;

    #[test]
    fn normals_of_a_sphere_point_outwards_at_any_scale() {
        for scale in [1.0_f32, 1e-12, 1e12] {
            let (unit, triangles) = sphere(32, 64);
            let positions: Vec<Vec3> = unit.iter().map(|p| p.as_vec3() * scale).collect();
            let mut normals = Vec::new();
            VertexNormals::new(positions.len(), &triangles).compute(&positions, &triangles, &mut normals);
            for (v, normal) in normals.iter().enumerate() {
                let expected = unit[v].as_vec3();
                // Cells of 5.6°: the area-weighted normal may lean by a small part of a cell.
                assert!(normal.angle_between(expected) < 0.03, "vertex {v}: {normal} for {expected}");
                assert!((normal.length() - 1.0).abs() < 1e-5, "vertex {v}: length {}", normal.length());
            }
        }
    }

    #[test]
    fn broken_and_lonely_vertices_get_some_unit_vector() {
        let positions = [Vec3::ZERO, Vec3::ZERO, Vec3::NAN, Vec3::X, Vec3::Z];
        let triangles = [[0, 1, 2], [0, 1, 1], [0, 1, 3], [3, 4, 77]];
        let mut normals = vec![Vec3::ZERO; 9];
        VertexNormals::new(5, &triangles).compute(&positions, &triangles, &mut normals);
        assert_eq!(normals.len(), 5);
        assert!(normals.iter().all(|n| n.is_normalized()), "{normals:?}");
    }
}
