//! Which file vertices are one place of the surface.
//!
//! **Idea.** Formats repeat a vertex wherever texture coordinates or normals differ on its two sides. A solver that took
//! those copies for different vertices would tear the surface there, so copies at the same place are one point. Two
//! things keep them apart all the same: a person who wants so ([`Welding::Never`]), and a skeleton that would tear them
//! apart (the file's skins): vertices of one place are one point only if the same skin carries them, with the same joints
//! and weights, or none does.
//!
//! A *point* is where its first vertex is, in the order of the file, and the other vertices are compared with that one
//! alone. So nothing is chained: however dense the vertices lie, none is farther from its point than the distance that
//! was asked for, and two vertices of one point are at most twice that distance apart.

mod near;

use crate::Fault;
use crate::formats::Bindings;
use crate::watch::Stage;
use foldhash::quality::RandomState;
use glam::DVec3;
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use std::hash::BuildHasher;

/// Which file vertices become one surface point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Welding {
    /// Those at exactly the same place (-0.0 is 0.0).
    #[default]
    Exact,
    /// Those at most so far apart, in the file's units, and those at exactly the same place.
    ///
    /// Places are taken in the order of the file: one joins the nearest point (the earlier of two as near) that is no
    /// farther than this, or becomes a point. The file keeps its vertices where they are; a deformation takes each along
    /// with its point, at its own offset. A distance of 0, or below what double precision tells apart at the size of the
    /// mesh, welds exactly.
    Within(f64),
    /// None: every file vertex is a point of its own, and surfaces come apart at their seams.
    Never,
}

impl std::str::FromStr for Welding {
    type Err = String;

    /// `exact`, `never`, or a distance.
    fn from_str(text: &str) -> Result<Welding, String> {
        match text {
            "exact" => Ok(Welding::Exact),
            "never" => Ok(Welding::Never),
            _ => match text.parse() {
                Ok(distance) if f64::is_finite(distance) && distance >= 0.0 => Ok(Welding::Within(distance)),
                _ => Err("expected exact, never or a distance in the file's units, such as 0.001".into()),
            },
        }
    }
}

impl std::fmt::Display for Welding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Welding::Exact => f.write_str("exact"),
            Welding::Never => f.write_str("never"),
            Welding::Within(distance) => write!(f, "{distance}"),
        }
    }
}

/// File vertices that are one place of the surface share one surface point.
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

    /// Welds as is wished; `bindings` are asked for only where there is something to keep apart.
    pub(crate) fn new<'b>(
        positions: &[DVec3],
        welding: Welding,
        bindings: impl FnOnce() -> Option<Box<dyn Bindings + 'b>>,
        stage: Stage<'_>,
    ) -> Result<Weld, Fault> {
        let n = positions.len();
        if welding == Welding::Never {
            let each: Vec<u32> = (0..n as u32).collect();
            return Ok(Weld { point_of_vertex: each.clone(), vertex_of_point: each });
        }
        let exact = Weld::places(positions, stage.part(0.0, 0.5))?;
        let distance = match welding {
            Welding::Within(distance) if distance > near::resolution(positions) => Some(distance),
            _ => None,
        };
        if distance.is_none() && exact.n_points() == n {
            return Ok(exact);
        }
        let bindings = bindings();
        let bindings = bindings.as_deref();
        let exact = match bindings {
            Some(bindings) => exact.parted(bindings, stage.part(0.5, 0.6))?,
            None => exact,
        };
        match distance {
            Some(distance) => near::weld(positions, exact, distance, bindings, stage.part(0.6, 1.0)),
            None => Ok(exact),
        }
    }

    /// Welds finite positions that are equal as numbers (so -0.0 and 0.0 are one place), whatever carries them.
    pub(crate) fn exact(positions: &[DVec3]) -> Weld {
        Weld::places(positions, Stage::unwatched()).expect("nothing cancels it")
    }

    fn places(positions: &[DVec3], stage: Stage<'_>) -> Result<Weld, Fault> {
        let mut weld = Weld { point_of_vertex: Vec::with_capacity(positions.len()), vertex_of_point: Vec::new() };
        // Keyed differently in every run, so that no file can be made to collide; what is found does not depend on it.
        let hasher = RandomState::default();
        // Adding 0.0 turns -0.0 into 0.0 and changes nothing else.
        let hash = |vertex: u32| hasher.hash_one(positions[vertex as usize].to_array().map(|x| (x + 0.0).to_bits()));
        // Numbers of points alone, which stay in the cache better than places do.
        let mut known: HashTable<u32> = HashTable::with_capacity(positions.len());
        for (vertex, position) in positions.iter().enumerate() {
            if vertex % PIECE == 0 {
                stage.tell(vertex, positions.len())?;
            }
            let first = &mut weld.vertex_of_point;
            let found = known.entry(
                hash(vertex as u32),
                |&point| positions[first[point as usize] as usize] == *position,
                |&point| hash(first[point as usize]),
            );
            let point = match found {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(new) => {
                    let point = first.len() as u32;
                    new.insert(point);
                    first.push(vertex as u32);
                    point
                }
            };
            weld.point_of_vertex.push(point);
        }
        Ok(weld)
    }

    /// The same without points whose vertices a skeleton would tear apart.
    fn parted(self, bindings: &dyn Bindings, stage: Stage<'_>) -> Result<Weld, Fault> {
        let mut weld = Weld { point_of_vertex: Vec::with_capacity(self.point_of_vertex.len()), ..Weld::default() };
        // The points of each place, as a list through `next`.
        let (mut first, mut next) = (vec![NONE; self.n_points()], Vec::new());
        for (vertex, &place) in self.point_of_vertex.iter().enumerate() {
            if vertex % PIECE == 0 {
                stage.tell(vertex, self.point_of_vertex.len())?;
            }
            let (mut point, mut last, mut n_seen) = (first[place as usize], NONE, 0);
            while point != NONE && !bindings.alike(weld.vertex_of_point[point as usize] as usize, vertex) {
                n_seen += 1;
                last = point;
                point = if n_seen < MOST_BOUND { next[point as usize] } else { NONE };
            }
            if point == NONE {
                point = weld.vertex_of_point.len() as u32;
                weld.vertex_of_point.push(vertex as u32);
                next.push(NONE);
                let link = if last == NONE { &mut first[place as usize] } else { &mut next[last as usize] };
                // Behind the last that is looked at nothing is listed.
                if *link == NONE {
                    *link = point;
                }
            }
            weld.point_of_vertex.push(point);
        }
        Ok(weld)
    }
}

/// Vertices between two looks at whether they are still wanted: welding so many takes a few milliseconds.
const PIECE: usize = 1 << 14;

/// Points at one place that are told apart by what carries them. Characters have two or three where clothes touch; a
/// file could have any number, which is not to cost their square: vertices that are like none of these stay alone.
const MOST_BOUND: usize = 16;

/// No point.
const NONE: u32 = u32::MAX;

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

    /// What carries each vertex.
    struct Carried(Vec<u32>);

    impl Bindings for Carried {
        fn alike(&self, a: usize, b: usize) -> bool {
            self.0[a] == self.0[b]
        }
    }

    fn welded(positions: &[DVec3], welding: Welding, carried: Option<&[u32]>) -> Vec<u32> {
        let bindings = || carried.map(|carried| Box::new(Carried(carried.to_vec())) as Box<dyn Bindings>);
        let weld = Weld::new(positions, welding, bindings, Stage::unwatched()).expect("nobody cancels");
        for (point, &vertex) in weld.vertex_of_point.iter().enumerate() {
            let first = weld.point_of_vertex.iter().position(|&p| p as usize == point);
            assert_eq!(first, Some(vertex as usize), "first vertex of point {point}");
        }
        assert!(weld.vertex_of_point.is_sorted());
        weld.point_of_vertex
    }

    fn along(places: &[f64]) -> Vec<DVec3> {
        places.iter().map(|&x| DVec3::X * x).collect()
    }

    #[test]
    fn without_welding_every_vertex_is_a_point() {
        assert_eq!(welded(&along(&[1.0, 1.0, 1.0]), Welding::Never, None), [0, 1, 2]);
    }

    #[test]
    fn vertices_of_one_place_stay_apart_when_other_joints_carry_them() {
        let positions = along(&[1.0, 1.0, 1.0, 2.0, 1.0]);
        assert_eq!(welded(&positions, Welding::Exact, Some(&[7, 8, 7, 8, 8])), [0, 1, 0, 2, 1]);
        assert_eq!(welded(&positions, Welding::Within(5.0), Some(&[7, 8, 7, 8, 8])), [0, 1, 0, 1, 1]);
    }

    #[test]
    fn places_carried_in_any_number_of_ways_stay_apart_and_cost_no_square() {
        let n = 1000;
        let carried: Vec<u32> = (0..n).collect();
        let points = welded(&vec![DVec3::ONE; n as usize], Welding::Exact, Some(&carried));
        assert_eq!(points, carried);
    }

    #[test]
    fn within_a_distance_each_joins_the_nearest_point_and_none_is_chained() {
        let close = Welding::Within(1.0);
        // 0.9 joins 0; 1.8 is too far from 0 although it is near 0.9; 1.2 is nearer to 1.8 than to 0.
        assert_eq!(welded(&along(&[0.0, 0.9, 1.8, 1.2, 0.9]), close, None), [0, 0, 1, 1, 0]);
        // Exactly the distance counts, and of two as near the earlier.
        assert_eq!(welded(&along(&[0.0, 2.0, 1.0]), close, None), [0, 1, 0]);
        // Cells of the search do not matter: neighbors on both sides of zero and far from it.
        assert_eq!(welded(&along(&[-0.4, 0.4, 1000.6, 999.8, -1.5]), close, None), [0, 0, 1, 1, 2]);
    }

    #[test]
    fn copies_of_a_place_stay_together_whatever_comes_between_them() {
        // 1.0 joins 0.3; the point at 1.5 comes later and is nearer to the copy of 1.0.
        assert_eq!(welded(&along(&[0.3, 1.0, 1.5, 1.0]), Welding::Within(1.0), None), [0, 0, 1, 0]);
    }

    #[test]
    fn distances_too_small_or_too_large_for_the_numbers_do_no_harm() {
        let positions = along(&[1.0, 1.0 + f64::EPSILON, 1e150, -1e150, 1.0]);
        for distance in [0.0, f64::MIN_POSITIVE, 1e-300, 1.0] {
            let expected: &[u32] = &[0, 1, 2, 3, 0];
            assert_eq!(welded(&positions, Welding::Within(distance), None), expected, "{distance}");
        }
        assert_eq!(welded(&positions, Welding::Within(f64::MAX), None), [0; 5]);
    }

    #[test]
    fn weldings_are_read_as_they_are_written() {
        for welding in [Welding::Exact, Welding::Never, Welding::Within(0.25)] {
            assert_eq!(welding.to_string().parse(), Ok(welding));
        }
        for wrong in ["", "NaN", "inf", "-1", "close", "Exact"] {
            assert!(wrong.parse::<Welding>().is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn of_vertices_that_disagree_the_largest_counts() {
        let weld = Weld::exact(&[DVec3::ZERO, DVec3::X, DVec3::ZERO]);
        assert_eq!(weld.largest(&[1, 2, 3]), (vec![3, 2], true));
        assert_eq!(weld.largest(&[3, 2, 3]), (vec![3, 2], false));
    }
}
