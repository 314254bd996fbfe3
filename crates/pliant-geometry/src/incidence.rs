//! Which triangles meet at a vertex.

/// For every vertex the triangles around it, as one list with offsets.
#[derive(Clone, Debug)]
pub(crate) struct Incidence {
    starts: Vec<u32>,
    triangles: Vec<u32>,
}

impl Incidence {
    /// O(n). A triangle that names a vertex past the end is left out; one that names a vertex twice is listed once there.
    pub(crate) fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> Incidence {
        let present = || triangles.iter().enumerate().filter(|(_, t)| t.iter().all(|&v| (v as usize) < n_vertices));
        let mut starts = vec![0_u32; n_vertices + 1];
        for (_, triangle) in present() {
            distinct(*triangle).for_each(|v| starts[v as usize + 1] += 1);
        }
        for v in 0..n_vertices {
            starts[v + 1] += starts[v];
        }
        let mut next = starts.clone();
        let mut around = vec![0_u32; starts[n_vertices] as usize];
        for (i, triangle) in present() {
            for v in distinct(*triangle) {
                around[next[v as usize] as usize] = i as u32;
                next[v as usize] += 1;
            }
        }
        Incidence { starts, triangles: around }
    }

    /// Number of vertices.
    pub(crate) fn n_vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// The triangles around vertex `v`, ascending.
    pub(crate) fn around(&self, v: usize) -> &[u32] {
        &self.triangles[self.starts[v] as usize..self.starts[v + 1] as usize]
    }
}

fn distinct(triangle: [u32; 3]) -> impl Iterator<Item = u32> {
    (0..3).filter(move |&i| !triangle[..i].contains(&triangle[i])).map(move |i| triangle[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_vertex_lists_its_triangles_once() {
        let incidence = Incidence::new(5, &[[0, 1, 2], [2, 2, 1], [0, 7, 1], [3, 1, 0]]);
        let got: Vec<&[u32]> = (0..5).map(|v| incidence.around(v)).collect();
        assert_eq!(got, [&[0, 3][..], &[0, 1, 3], &[0, 1], &[3], &[]]);
    }
}
