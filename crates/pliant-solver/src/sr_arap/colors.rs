//! Vertices by color: no two of a color are joined by an edge, so that all of a color can be turned at the same time with
//! the result of turning one after the other.

use crate::analysis::Layout;

/// The order of turning, color after color; numbers in it are *places*.
pub(super) struct Colors {
    /// Color c has the places `begin[c]..begin[c + 1]`.
    pub(super) begin: Vec<usize>,
    /// Vertex at each place, ascending within a color, and back.
    pub(super) vertices: Vec<u32>,
    pub(super) place_of: Vec<u32>,
}

impl Colors {
    /// Greedily: every vertex takes the first color that none of its neighbors before it has.
    pub(super) fn new(layout: &Layout) -> Colors {
        const NONE: u32 = u32::MAX;
        let n = layout.n_vertices();
        let mut color = vec![NONE; n];
        // The vertex that last saw a color among its neighbors.
        let mut seen: Vec<u32> = Vec::new();
        for v in 0..n {
            for spoke in layout.spokes(v) {
                if let Some(seen) = seen.get_mut(color[spoke.vertex as usize] as usize) {
                    *seen = v as u32;
                }
            }
            let free = seen.iter().position(|&seen| seen != v as u32).unwrap_or(seen.len());
            if free == seen.len() {
                seen.push(NONE);
            }
            color[v] = free as u32;
        }
        let mut begin = vec![0; seen.len() + 1];
        color.iter().for_each(|&c| begin[c as usize + 1] += 1);
        (0..seen.len()).for_each(|c| begin[c + 1] += begin[c]);
        let mut next = begin.clone();
        let (mut vertices, mut place_of) = (vec![0; n], vec![0; n]);
        for (v, &c) in color.iter().enumerate() {
            let place = &mut next[c as usize];
            (vertices[*place], place_of[v]) = (v as u32, *place as u32);
            *place += 1;
        }
        Colors { begin, vertices, place_of }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::test_support::bumpy_sheet;
    use crate::{Analysis, Weights};

    #[test]
    fn no_edge_joins_two_vertices_of_a_color_and_every_vertex_has_a_place() {
        let analysis = Analysis::new(Arc::new(bumpy_sheet(20)), Weights::Clamped);
        let colors = Colors::new(&analysis.layout);
        let color = |v: u32| colors.begin.partition_point(|&begin| begin <= colors.place_of[v as usize] as usize);
        for &[i, j] in &analysis.layout.edges {
            assert_ne!(color(i), color(j), "edge {i} {j}");
        }
        let mut vertices = colors.vertices.clone();
        vertices.sort_unstable();
        assert!(vertices.iter().zip(0..).all(|(&v, expected)| v == expected));
    }
}
