//! Which file vertices are one place of the surface.
//!
//! Formats repeat a vertex wherever texture coordinates or normals differ on its two sides. A solver that took those
//! copies for different vertices would tear the surface there, so copies at exactly the same place are one point.

use glam::DVec3;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// File vertices at the same place share one surface point.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Weld {
    /// Surface point of each file vertex.
    pub point_of_vertex: Vec<u32>,
    /// First file vertex of each surface point, ascending.
    pub vertex_of_point: Vec<u32>,
}

impl Weld {
    /// Number of surface points.
    pub fn n_points(&self) -> usize {
        self.vertex_of_point.len()
    }

    /// Triangles over file vertices as triangles over surface points, in the same order.
    pub(crate) fn triangles(&self, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
        triangles.iter().map(|t| t.map(|vertex| self.point_of_vertex[vertex as usize])).collect()
    }

    /// The largest of `per_vertex` at each surface point, and whether vertices of one point disagree.
    ///
    /// Takes one value per file vertex, and gives one per surface point.
    pub fn largest(&self, per_vertex: &[u16]) -> (Vec<u16>, bool) {
        let mut per_point = vec![0; self.n_points()];
        for (&point, &value) in self.point_of_vertex.iter().zip(per_vertex) {
            let largest: &mut u16 = &mut per_point[point as usize];
            *largest = value.max(*largest);
        }
        let disagree = self.point_of_vertex.iter().zip(per_vertex).any(|(&point, &v)| per_point[point as usize] != v);
        (per_point, disagree)
    }

    /// Welds finite positions that are equal as numbers (so -0.0 and 0.0 are one place).
    pub(crate) fn exact(positions: &[DVec3]) -> Weld {
        let mut weld = Weld { point_of_vertex: Vec::with_capacity(positions.len()), vertex_of_point: Vec::new() };
        let mut point_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
        for (vertex, position) in positions.iter().enumerate() {
            let next = weld.vertex_of_point.len() as u32;
            // Adding 0.0 turns -0.0 into 0.0 and changes nothing else.
            let key = position.to_array().map(|x| (x + 0.0).to_bits());
            let point = match point_at.entry(key) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    weld.vertex_of_point.push(vertex as u32);
                    *new.insert(next)
                }
            };
            weld.point_of_vertex.push(point);
        }
        weld
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_places_share_a_point_and_negative_zero_is_zero() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::new(-0.0, 0.0, -0.0), DVec3::X, DVec3::Y];
        let weld = Weld::exact(&positions);
        assert_eq!(weld.point_of_vertex, [0, 1, 0, 1, 2]);
        assert_eq!(weld.vertex_of_point, [0, 1, 4]);
    }

    #[test]
    fn of_vertices_that_disagree_the_largest_counts() {
        let weld = Weld::exact(&[DVec3::ZERO, DVec3::X, DVec3::ZERO]);
        assert_eq!(weld.largest(&[1, 2, 3]), (vec![3, 2], true));
        assert_eq!(weld.largest(&[3, 2, 3]), (vec![3, 2], false));
    }
}
