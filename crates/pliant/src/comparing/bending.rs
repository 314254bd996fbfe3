//! How the angles between neighboring faces changed.
//!
//! A *hinge* is an edge with exactly two faces. Its angle is 0 where they lie in one plane and 180° where one is folded onto
//! the other; the sign tells to which side. Which of its sides a face calls outside does not matter.

use glam::DVec3;
use pliant_solver::Mesh;
use rayon::prelude::*;

/// Faces lie on each other when their normals are further apart than this (as in comparisons of ARAP and SR-ARAP).
pub const FOLDED_DEGREES: f64 = 150.0;

/// Hinges to a task: tens of microseconds of work, far above the cost of handing it out.
const PER_TASK: usize = 4096;
/// A face whose angle at the hinge is smaller (radians) has no direction that could be trusted: rounding of coordinates
/// moves its third corner by some 1e-16 of its distance, and by a thousand times that in a model far from the origin.
const SLIVER: f64 = 1e-10;

/// All hinges of a mesh, with their angles at rest.
#[derive(Debug)]
pub struct Hinges {
    /// The ends of the edge, then the corners across from it.
    corners: Vec<[u32; 4]>,
    /// Degrees; NaN where a face has no area at rest.
    at_rest: Vec<f64>,
}

/// What bending did to the hinges.
#[derive(Debug)]
pub struct Bending {
    /// Degrees, 0 to 180, of each hinge whose faces have area at rest and now.
    pub changes: Vec<f64>,
    /// Hinges that are folded and were not at rest, see [`FOLDED_DEGREES`].
    pub folds: usize,
}

impl Hinges {
    /// Finds them. O(n log n).
    pub fn new(mesh: &Mesh) -> Hinges {
        let corners = corners(mesh.triangles());
        let at_rest = angles(&corners, mesh.positions());
        Hinges { corners, at_rest }
    }

    /// How they changed.
    pub fn bending(&self, now: &[DVec3]) -> Bending {
        let pairs = || self.at_rest.iter().zip(angles(&self.corners, now));
        let known = pairs().filter(|(rest, now)| rest.is_finite() && now.is_finite());
        let turned = |(rest, now): (&f64, f64)| {
            let change = (now - rest).abs();
            change.min(360.0 - change)
        };
        let (mut changes, mut folds) = (Vec::with_capacity(self.corners.len()), 0);
        for pair in known {
            folds += usize::from(pair.1.abs() > FOLDED_DEGREES && pair.0.abs() <= FOLDED_DEGREES);
            changes.push(turned(pair));
        }
        Bending { changes, folds }
    }
}

/// A side of a triangle: its ends, the lower number first, and the corner across from it.
type Side = ([u32; 2], u32);

fn corners(triangles: &[[u32; 3]]) -> Vec<[u32; 4]> {
    let sides_of = |&[a, b, c]: &[u32; 3]| -> [Side; 3] {
        [(a, b, c), (b, c, a), (c, a, b)].map(|(a, b, c)| ([a.min(b), a.max(b)], c))
    };
    let is_whole = |t: &&[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    let mut sides: Vec<Side> = triangles.par_iter().filter(is_whole).flat_map_iter(sides_of).collect();
    sides.par_sort_unstable();
    let shared = sides.chunk_by(|x, y| x.0 == y.0);
    shared.filter_map(|sides| if let &[([a, b], c), (_, d)] = sides { Some([a, b, c, d]) } else { None }).collect()
}

fn angles(corners: &[[u32; 4]], positions: &[DVec3]) -> Vec<f64> {
    let angle = |hinge: &[u32; 4]| {
        let [a, b, c, d] = hinge.map(|v| positions[v as usize]);
        angle(b - a, c - a, d - a).unwrap_or(f64::NAN)
    };
    corners.par_iter().with_min_len(PER_TASK).map(angle).collect()
}

/// Degrees from the plane through `edge` and `c`, gone on beyond the edge, to `d`; none without area on either side.
fn angle(edge: DVec3, c: DVec3, d: DVec3) -> Option<f64> {
    let (edge, c, d) = (direction(edge)?, direction(c)?, direction(d)?);
    let (left, right) = (edge.cross(c), d.cross(edge));
    let has_area = left.length() > SLIVER && right.length() > SLIVER;
    has_area.then(|| edge.dot(left.cross(right)).atan2(left.dot(right)).to_degrees())
}

/// Unit vector, however long or short `v` is; none without a length.
fn direction(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    (largest > 0.0 && largest.is_finite()).then(|| (v / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles on either side of an edge along z, the second turned up by `degrees` from their common plane.
    fn book(degrees: f64, size: f64) -> Vec<DVec3> {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let points = [DVec3::ZERO, DVec3::Z, DVec3::new(-0.7, 0.0, 0.4), DVec3::new(cos, sin, 0.6)];
        points.map(|p| p * size + DVec3::splat(3.0 * size)).into()
    }

    fn hinges(rest: f64, size: f64, triangles: [[u32; 3]; 2]) -> Hinges {
        Hinges::new(&Mesh::new(book(rest, size), triangles.into()).expect("sound indices"))
    }

    #[test]
    fn a_book_that_is_opened_changes_by_the_angle_it_is_opened_by() {
        for size in [1e-90, 1.0, 1e90] {
            for triangles in [[[0, 1, 2], [1, 0, 3]], [[0, 1, 2], [0, 1, 3]]] {
                for (rest, now, expected) in [(0.0, 90.0, 90.0), (-30.0, 100.0, 130.0), (-170.0, 170.0, 20.0)] {
                    let got = hinges(rest, size, triangles).bending(&book(now, size)).changes;
                    // Coordinates of 4 against edges of 1, a few roundings, in degrees.
                    assert!(got.len() == 1 && (got[0] - expected).abs() < 1e-12, "{rest} to {now}: {got:?}");
                }
            }
        }
    }

    #[test]
    fn folds_are_counted_unless_they_were_there_at_rest() {
        let triangles = [[0, 1, 2], [1, 0, 3]];
        for (rest, now, expected) in [(0.0, 149.0, 0), (0.0, -151.0, 1), (151.0, 170.0, 0), (151.0, 10.0, 0)] {
            assert_eq!(hinges(rest, 1.0, triangles).bending(&book(now, 1.0)).folds, expected, "{rest} to {now}");
        }
    }

    #[test]
    fn faces_without_area_and_edges_of_three_faces_are_no_hinges() {
        let triangles = [[0, 1, 2], [1, 0, 3]];
        let mut flat = book(40.0, 1.0);
        flat[3] = flat[1];
        let bending = hinges(0.0, 1.0, triangles).bending(&flat);
        assert_eq!((bending.changes.len(), bending.folds), (0, 0));
        let three = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [2, 2, 3]];
        let mesh = Mesh::new([book(40.0, 1.0), vec![DVec3::Y]].concat(), three.into()).expect("sound indices");
        assert_eq!(Hinges::new(&mesh).bending(mesh.positions()).changes.len(), 0);
    }
}
