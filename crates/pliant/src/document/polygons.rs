//! Which edges of the triangles are the file's own, and which only cut its polygons.

use std::ops::Range;
use std::sync::Arc;

/// Three bits a triangle: bit k is set where the edge across from corner k has another triangle of the same polygon behind it.
/// `polygons` are ranges of triangles; `None` when there are none, and with them no such edges.
pub(super) fn cuts(triangles: &[[u32; 3]], polygons: &[Range<u32>]) -> Option<Arc<[u8]>> {
    if polygons.is_empty() {
        return None;
    }
    let mut bits = vec![0; triangles.len()];
    // Both ends of an edge, lower first, then triangle and corner across.
    let mut edges: Vec<([u32; 2], usize, usize)> = Vec::new();
    for polygon in polygons {
        let polygon = polygon.start as usize..(polygon.end as usize).min(triangles.len());
        edges.clear();
        edges.extend(polygon.flat_map(|t| {
            (0..3).map(move |k| {
                let (a, b) = (triangles[t][(k + 1) % 3], triangles[t][(k + 2) % 3]);
                ([a.min(b), a.max(b)], t, k)
            })
        }));
        edges.sort_unstable();
        for same in edges.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
            same.iter().for_each(|&(_, t, k)| bits[t] |= 1 << k);
        }
    }
    Some(bits.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_cuts_of_polygons_are_marked() {
        // A quad, a triangle beside it, a pentagon as a fan.
        let triangles = [[0, 1, 2], [0, 2, 3], [1, 4, 2], [5, 6, 7], [5, 7, 8], [5, 8, 9]];
        let bits = cuts(&triangles, &[0..2, 3..6]).expect("there are polygons");
        assert_eq!(*bits, [0b010, 0b100, 0, 0b010, 0b110, 0b100]);
        assert_eq!(cuts(&triangles, &[]), None);
    }

    #[test]
    fn polygons_past_the_end_are_cut_short() {
        assert_eq!(*cuts(&[[0, 1, 2]], &[0..7, 9..12]).expect("polygons"), [0]);
    }
}
