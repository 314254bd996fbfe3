//! Welding within a distance.
//!
//! Points are kept in a grid of cells more than twice as wide as the distance, so that whatever is near enough to a place
//! lies in one of at most eight cells. Copies of one place were made one before: a place is taken once, and stays whole.

use super::{NONE, PIECE, Weld};
use crate::Fault;
use crate::formats::Bindings;
use crate::watch::Stage;
use foldhash::quality::RandomState;
use glam::DVec3;
use std::collections::HashMap;

/// Width of a cell in distances: more than two, so that what is near lies in two cells along each axis, not in three.
const WIDTH: f64 = 2.5;

/// Points looked at in one cell. Points that may be welded are farther apart than the distance: balls of half of it around
/// them do not meet and lie in a cube 3.5 distances wide, into which 81 fit by volume. Only points that are kept apart by
/// what carries them lie denser.
const MOST_IN_CELL: usize = 96;

/// How much farther is looked than the distance, for the sake of rounding.
const REACH: f64 = 1.0 + 1e-9;

/// What double precision tells apart at the size of a mesh: smaller distances are none.
pub(super) fn resolution(positions: &[DVec3]) -> f64 {
    positions.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max) * f64::EPSILON
}

/// Joins the points of `exact` that are no more than `distance` apart, by the rule of [`super::Welding::Within`].
pub(super) fn weld(
    positions: &[DVec3],
    exact: Weld,
    distance: f64,
    bindings: Option<&dyn Bindings>,
    stage: Stage<'_>,
) -> Result<Weld, Fault> {
    let n = exact.n_points();
    // Sums of places and distances stay within the numbers; what is farther apart is beyond any mesh.
    let distance = distance.min(f64::MAX / 4.0);
    let mut grid =
        Grid { positions, distance, bindings, first: HashMap::default(), next: Vec::new(), vertices: Vec::new() };
    let mut point_of_place = Vec::with_capacity(n);
    for (place, &vertex) in exact.vertex_of_point.iter().enumerate() {
        if place % PIECE == 0 {
            stage.tell(place, n)?;
        }
        let point = match grid.nearest(vertex as usize) {
            NONE => grid.add(vertex),
            near => near,
        };
        point_of_place.push(point);
    }
    let point_of_vertex = exact.point_of_vertex.iter().map(|&place| point_of_place[place as usize]).collect();
    Ok(Weld { point_of_vertex, vertex_of_point: grid.vertices })
}

struct Grid<'a> {
    positions: &'a [DVec3],
    distance: f64,
    bindings: Option<&'a dyn Bindings>,
    /// The first point of each cell, and of each point the next in its cell.
    first: HashMap<[u64; 3], u32, RandomState>,
    next: Vec<u32>,
    /// The first vertex of each point.
    vertices: Vec<u32>,
}

impl Grid<'_> {
    /// The cell of a place, as whole numbers in double precision: beyond 2^53 cells it is no finer than the numbers are,
    /// and a distance that small has been refused.
    fn cell(&self, place: DVec3) -> DVec3 {
        (place / self.distance / WIDTH).floor()
    }

    fn key(cell: DVec3) -> [u64; 3] {
        cell.to_array().map(|x| (x + 0.0).to_bits())
    }

    /// The nearest point that a vertex may join, the earlier of two as near, or [`NONE`].
    fn nearest(&self, vertex: usize) -> u32 {
        let place = self.positions[vertex];
        let reach = DVec3::splat(self.distance * REACH);
        let ends = [self.cell(place - reach), self.cell(place + reach)];
        let mut best = (f64::INFINITY, NONE);
        for corner in 0..8 {
            let side = [corner & 1, corner >> 1 & 1, corner >> 2];
            // A cell that both ends lie in is looked at once.
            if (0..3).any(|axis| side[axis] == 1 && ends[0][axis] == ends[1][axis]) {
                continue;
            }
            let cell = DVec3::new(ends[side[0]].x, ends[side[1]].y, ends[side[2]].z);
            self.nearest_in(cell, vertex, &mut best);
        }
        best.1
    }

    /// Puts a point of one cell in the place of `best`, its distance and number, when a vertex may rather join that.
    fn nearest_in(&self, cell: DVec3, vertex: usize, best: &mut (f64, u32)) {
        let mut point = self.first.get(&Self::key(cell)).copied().unwrap_or(NONE);
        for _ in 0..MOST_IN_CELL {
            if point == NONE {
                return;
            }
            let first = self.vertices[point as usize] as usize;
            let far = self.positions[first].distance(self.positions[vertex]);
            let near = far <= self.distance && (far, point) < *best;
            if near && self.bindings.is_none_or(|bindings| bindings.alike(first, vertex)) {
                *best = (far, point);
            }
            point = self.next[point as usize];
        }
    }

    /// Makes a vertex the first of a new point.
    fn add(&mut self, vertex: u32) -> u32 {
        let point = self.vertices.len() as u32;
        let key = Self::key(self.cell(self.positions[vertex as usize]));
        self.next.push(self.first.insert(key, point).unwrap_or(NONE));
        self.vertices.push(vertex);
        point
    }
}
