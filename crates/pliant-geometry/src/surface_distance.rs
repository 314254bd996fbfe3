//! How far is it along the surface: fast marching with circular waves.
//!
//! A front leaves the source and reaches vertices in the order of their distance. Across a triangle A B C whose edge AB it
//! has reached, the source is unfolded into the triangle's plane: the point S beyond AB with |SA| = d(A) and |SB| = d(B).
//! If the straight line from S to C passes through AB,
//!
//! d(C) = |SC|,   else   d(C) = min(d(A) + |AC|, d(B) + |BC|).
//!
//! Kimmel and Sethian's update assumes a straight front within the triangle, which is wrong by several percent near the
//! source; the unfolded source is exact on a plane, so that brushes are round on any triangulation. At an obtuse corner
//! C can be reached before B; it is then corrected when B is reached, a few times at most.

use crate::bounds::corners;
use crate::incidence::Incidence;
use front::Front;
use glam::{DVec3, Vec3};
use std::sync::Arc;

pub use growth::{Crossing, Growth};

/// Corrections of one vertex: on a plane one or two are needed; the limit only ends ping-pong on crumpled surfaces.
const MAX_VISITS: u8 = 6;
/// A correction below this part of the distance is not worth passing on; rounding is far smaller, and no brush shows it.
const WORTHWHILE: f64 = 1e-5;

/// Distances along the surface (rest or posed). Keeps which triangles meet at a vertex and scratch space that need not be
/// cleared between questions.
#[derive(Clone, Debug)]
pub struct SurfaceDistance {
    incidence: Arc<Incidence>,
    question: Question,
}

/// A question under way: what the front has reached.
#[derive(Clone, Debug)]
struct Question {
    marks: Vec<Mark>,
    /// Number of the current question: marks with another number are blank.
    epoch: u32,
    front: Front,
    touched: Vec<u32>,
    /// Vertices past the radius that the front has visited all the same.
    beyond: Vec<u32>,
    /// Square of the longest edge that was met: neighbors differ by no more than the edge.
    longest_squared: f64,
}

/// What is known of a vertex in the question `epoch`.
#[derive(Clone, Copy, Debug, Default)]
struct Mark {
    epoch: u32,
    /// How often the front has passed it; 0 while its distance is only a bound.
    visits: u8,
    distance: f64,
}

impl SurfaceDistance {
    /// O(n): adjacency. Keeps no positions.
    pub fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> SurfaceDistance {
        SurfaceDistance {
            incidence: Arc::new(Incidence::new(n_vertices, triangles)),
            question: Question::new(n_vertices),
        }
    }

    /// Vertices within `radius` of a point inside triangle `triangle` (its position given), with their distance, in
    /// no order. Reaches only what hangs together with the triangle. `positions` and `triangles` have the lengths given to
    /// [`new`](Self::new); a triangle that is absent gives nothing. The cost grows with the number of vertices
    /// returned, not with the mesh.
    pub fn within(
        &mut self,
        positions: &[Vec3],
        triangles: &[[u32; 3]],
        triangle: u32,
        point: Vec3,
        radius: f32,
    ) -> Vec<(u32, f32)> {
        let surface = Posed { incidence: &self.incidence, positions, triangles };
        if !self.question.start(&surface, triangle, point) {
            return Vec::new();
        }
        self.question.march(&surface, f64::from(radius), usize::MAX);
        self.question.answer(radius)
    }

    /// A front that leaves a point and can be sent on as far as needed, for a radius that grows under the hand. `None` for
    /// a triangle that is absent. O(n) once; the adjacency is shared.
    pub fn growth(&self, positions: &[Vec3], triangles: &[[u32; 3]], triangle: u32, point: Vec3) -> Option<Growth> {
        let surface = Posed { incidence: &self.incidence, positions, triangles };
        let mut question = Question::new(self.question.marks.len());
        let radius = f64::NEG_INFINITY;
        question.start(&surface, triangle, point).then(|| Growth {
            incidence: self.incidence.clone(),
            question,
            radius,
        })
    }
}

/// A surface at one moment.
struct Posed<'a> {
    incidence: &'a Incidence,
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
}

impl Question {
    fn new(n_vertices: usize) -> Question {
        Question {
            marks: vec![Mark::default(); n_vertices],
            epoch: 0,
            front: Front::default(),
            touched: Vec::new(),
            beyond: Vec::new(),
            longest_squared: 0.0,
        }
    }

    /// Blank marks, and the corners of the triangle reached. Whether there is such a triangle.
    fn start(&mut self, surface: &Posed<'_>, triangle: u32, point: Vec3) -> bool {
        let start = surface.triangles.get(triangle as usize).copied();
        let Some((start, at)) = start.and_then(|t| Some((t, corners(surface.positions, t)?))) else {
            return false;
        };
        if !point.is_finite() || start.iter().any(|&v| v as usize >= self.marks.len()) {
            return false;
        }
        self.epoch = self.epoch.wrapping_add(1);
        if self.epoch == 0 {
            self.marks.fill(Mark::default());
            self.epoch = 1;
        }
        self.front.clear();
        self.touched.clear();
        self.beyond.clear();
        self.longest_squared = 0.0;
        for (v, p) in start.into_iter().zip(at) {
            self.offer(v, (p.as_dvec3() - point.as_dvec3()).length());
        }
        true
    }

    /// Vertices in order of distance, `most` at a time; whether the front has come to the radius. Those past it are
    /// still visited, without spreading further: they support their neighbors inside.
    fn march(&mut self, surface: &Posed<'_>, radius: f64, most: usize) -> bool {
        let mut n_visited = 0;
        while let Some((key, v)) = self.front.pop() {
            let mark = &mut self.marks[v as usize];
            if key > Front::key(mark.distance) || mark.visits >= MAX_VISITS {
                continue;
            }
            if n_visited == most {
                self.front.push(mark.distance, v);
                return false;
            }
            n_visited += 1;
            mark.visits += 1;
            let distance = mark.distance;
            if distance > radius {
                self.beyond.push(v);
            }
            self.spread(surface, radius, (v, distance));
        }
        true
    }

    /// Offers distances across the triangles around a vertex that the front has come to.
    fn spread(&mut self, surface: &Posed<'_>, radius: f64, (v, distance): (u32, f64)) {
        for &triangle in surface.incidence.around(v as usize) {
            let triangle = surface.triangles.get(triangle as usize);
            let Some((ids, at)) = triangle.and_then(|&t| Some((t, corners(surface.positions, t)?))) else {
                continue;
            };
            let corner = ids.iter().position(|&id| id == v).unwrap_or(0);
            let [a, b, c] = [corner, (corner + 1) % 3, (corner + 2) % 3].map(|k| (ids[k], at[k].as_dvec3()));
            let squared = |x: (u32, DVec3), y: (u32, DVec3)| x.1.distance_squared(y.1);
            let (to_b, to_c, between) = (squared(a, b), squared(a, c), squared(b, c));
            self.longest_squared = self.longest_squared.max(to_b).max(to_c);
            for (b, c, squares) in [(b, c, [to_b, to_c, between]), (c, b, [to_c, to_b, between])] {
                let through = self.visited(b.0).and_then(|known| across(squares, distance, known));
                let reached = through.unwrap_or_else(|| distance + squares[1].sqrt());
                if reached <= radius || distance <= radius {
                    self.offer(c.0, reached);
                }
            }
        }
    }

    /// The distance of a vertex that the front has passed.
    fn visited(&self, v: u32) -> Option<f64> {
        let mark = self.marks[v as usize];
        (mark.epoch == self.epoch && mark.visits > 0).then_some(mark.distance)
    }

    /// Takes a distance for a vertex if it is the smallest so far.
    fn offer(&mut self, v: u32, distance: f64) {
        let mark = &mut self.marks[v as usize];
        if mark.epoch != self.epoch {
            *mark = Mark { epoch: self.epoch, visits: 0, distance: f64::INFINITY };
            self.touched.push(v);
        }
        let worthwhile = if mark.visits > 0 { mark.distance * (1.0 - WORTHWHILE) } else { mark.distance };
        if distance < worthwhile {
            mark.distance = distance;
            self.front.push(distance, v);
        }
    }

    fn answer(&self, radius: f32) -> Vec<(u32, f32)> {
        let found = self.touched.iter().map(|&v| (v, self.marks[v as usize].distance as f32));
        found.filter(|&(_, d)| d <= radius).collect()
    }
}

/// d(C) through the inside of edge AB, from the squares |AB|², |AC|², |BC|² and the distances of A and B; `None` when the
/// straight line from the unfolded source does not pass there.
fn across([ab, ac, bc]: [f64; 3], from_a: f64, from_b: f64) -> Option<f64> {
    // A at the origin, B on the positive x axis, C above it, the source S below; all lengths times 2 |AB|, which leaves one
    // division.
    let (a2, b2) = (from_a * from_a, from_b * from_b);
    let (cx, sx) = (ac - bc + ab, a2 - b2 + ab);
    let cy = (4.0 * ab * ac - cx * cx).max(0.0).sqrt();
    let depth = (4.0 * ab * a2 - sx * sx).max(0.0).sqrt();
    let height = cy + depth;
    // Where the line from S to C meets AB, times the height. Without a height, as with |AB| = 0, there is no such line.
    let crossing = sx * height + (cx - sx) * depth;
    let passes = height > 0.0 && crossing >= 0.0 && crossing <= 2.0 * ab * height;
    passes.then(|| (((cx - sx).powi(2) + height * height) / (4.0 * ab)).sqrt())
}

mod front;
mod growth;
#[cfg(test)]
mod tests;
