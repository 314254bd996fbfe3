//! A list of vertices with one value of each attribute, for formats whose corners have none of their own.

use crate::shape::{Corner, NONE, Shape};
use std::collections::HashMap;

/// Vertices of a new file: the shape's own first and in their order, so that numbers given for them still hold, then
/// the copies that corners with other attributes need.
pub(super) struct Split {
    /// Old vertex, texture coordinate and normal of each new vertex.
    pub(super) corners: Vec<Corner>,
    /// Triangles over the new vertices.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Split {
    pub(super) fn of(shape: &Shape) -> Split {
        let unused = |vertex| Corner { vertex, uv: NONE, normal: NONE };
        let mut corners: Vec<Corner> = (0..shape.positions.len() as u32).map(unused).collect();
        let mut taken = vec![false; corners.len()];
        let mut copies: HashMap<Corner, u32> = HashMap::new();
        let mut index_of = |corner: Corner| -> u32 {
            let first = corner.vertex as usize;
            if !std::mem::replace(&mut taken[first], true) {
                corners[first] = corner;
            }
            if corners[first] == corner {
                return corner.vertex;
            }
            *copies.entry(corner).or_insert_with(|| {
                corners.push(corner);
                corners.len() as u32 - 1
            })
        };
        let triangles = shape.triangles.iter().map(|t| t.map(&mut index_of)).collect();
        Split { corners, triangles }
    }

    /// The old vertex of each new one; `None` when they are the same.
    pub(super) fn origin(&self, shape: &Shape) -> Option<Vec<u32>> {
        (self.corners.len() > shape.positions.len()).then(|| self.corners.iter().map(|corner| corner.vertex).collect())
    }
}
