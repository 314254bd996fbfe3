//! Polygons again, from the triangles they were cut into.
//!
//! Each edge inside a polygon is walked once forth and once back by the triangles on its two sides; what is left when
//! those cancel is the outline. Where a polygon touches itself its outline can be walked in several ways; its triangles
//! are written then.

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

/// Faces of a mesh: triangles, and polygons that were cut.
pub(super) struct Outlines<'a, C> {
    triangles: &'a [[C; 3]],
    /// Triangles of each polygon, and its range of `corners`.
    polygons: Vec<(Range<usize>, Range<usize>)>,
    corners: Vec<C>,
}

impl<'a, C: Copy + Eq + Hash> Outlines<'a, C> {
    pub(super) fn of(triangles: &'a [[C; 3]], polygons: &[Range<u32>]) -> Outlines<'a, C> {
        let mut out = Outlines { triangles, polygons: Vec::new(), corners: Vec::new() };
        let mut edges = Edges { count: HashMap::new(), next: HashMap::new() };
        for polygon in polygons {
            let range = polygon.start as usize..polygon.end as usize;
            let start = out.corners.len();
            if edges.outline(&triangles[range.clone()], &mut out.corners) {
                out.polygons.push((range, start..out.corners.len()));
            } else {
                out.corners.truncate(start);
            }
        }
        out
    }

    /// The faces that a range of triangles makes up.
    pub(super) fn of_range(&self, range: Range<usize>) -> impl Iterator<Item = &[C]> {
        let first = self.polygons.partition_point(|(triangles, _)| triangles.start < range.start);
        let mut polygons = self.polygons[first..].iter().peekable();
        let mut t = range.start;
        std::iter::from_fn(move || {
            if t >= range.end {
                return None;
            }
            if let Some((triangles, corners)) = polygons.next_if(|(triangles, _)| triangles.start == t) {
                t = triangles.end;
                return Some(&self.corners[corners.clone()]);
            }
            t += 1;
            Some(&self.triangles[t - 1][..])
        })
    }

    /// All faces.
    pub(super) fn all(&self) -> impl Iterator<Item = &[C]> {
        self.of_range(0..self.triangles.len())
    }
}

/// Room for the edges of one polygon.
struct Edges<C> {
    /// How often each is walked.
    count: HashMap<(C, C), i32>,
    /// The corner after each along the outline.
    next: HashMap<C, C>,
}

impl<C: Copy + Eq + Hash> Edges<C> {
    /// Appends the outline of a polygon's triangles; false where it is not a single loop through each corner once.
    fn outline(&mut self, triangles: &[[C; 3]], out: &mut Vec<C>) -> bool {
        let edges = || triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        self.count.clear();
        self.next.clear();
        for edge in edges() {
            *self.count.entry(edge).or_default() += 1;
        }
        for (a, b) in edges() {
            let left = self.count[&(a, b)] - self.count.get(&(b, a)).copied().unwrap_or(0);
            if left > 1 || (left == 1 && self.next.insert(a, b).is_some()) {
                return false;
            }
        }
        let n = triangles.len() + 2;
        let first = triangles[0][0];
        let mut corner = first;
        for step in 0..n {
            out.push(corner);
            let Some(&after) = self.next.get(&corner) else { return false };
            corner = after;
            // Back at the start after a step for each corner, not before.
            if (corner == first) != (step + 1 == n) {
                return false;
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cut_polygons_are_whole_again_and_keep_their_direction() {
        let triangles = [[9, 8, 7], [0, 1, 2], [2, 3, 4], [0, 2, 4], [5, 6, 7]];
        let outlines = Outlines::of(&triangles, std::slice::from_ref(&(1..4)));
        let faces: Vec<&[i32]> = outlines.all().collect();
        assert_eq!(faces, [&[9, 8, 7][..], &[0, 1, 2, 3, 4], &[5, 6, 7]]);
        let faces: Vec<&[i32]> = outlines.of_range(1..4).collect();
        assert_eq!(faces, [&[0, 1, 2, 3, 4][..]]);
    }

    #[test]
    fn a_polygon_that_touches_itself_stays_in_triangles() {
        // Corner 0 is passed twice.
        let triangles = [[0, 1, 2], [0, 3, 4], [0, 2, 3]];
        assert_eq!(Outlines::of(&triangles, std::slice::from_ref(&(0..3))).all().count(), 1);
        let bow = [[0, 1, 2], [0, 3, 4]];
        assert_eq!(Outlines::of(&bow, std::slice::from_ref(&(0..2))).all().count(), 2);
    }
}
