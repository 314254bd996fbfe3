//! Regions for the flood fill.

use pliant_solver::{Mesh, Rigidity, VertexId};

/// The vertices that can be reached from `seed` along edges without leaving its value of r; sorted. O(region).
pub fn region_of_equal_rigidity(mesh: &Mesh, rigidity: &Rigidity, seed: VertexId) -> Vec<VertexId> {
    let r = rigidity.as_slice();
    let mut reached = vec![false; mesh.n_vertices()];
    let mut region = vec![seed];
    reached[seed.index()] = true;
    let mut next = 0;
    while next < region.len() {
        for &w in mesh.neighbors(region[next]) {
            if !reached[w as usize] && r[w as usize] == r[seed.index()] {
                reached[w as usize] = true;
                region.push(VertexId(w));
            }
        }
        next += 1;
    }
    region.sort_unstable();
    region
}
