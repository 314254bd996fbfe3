//! A front that is sent on and on.

use super::{Posed, Question};
use crate::incidence::Incidence;
use glam::Vec3;
use std::sync::Arc;

/// Distances from one point, known as far as they were asked for. A larger radius goes on from where the last one ended.
#[derive(Clone, Debug)]
pub struct Growth {
    pub(super) incidence: Arc<Incidence>,
    pub(super) question: Question,
    /// The largest radius so far.
    pub(super) radius: f64,
}

/// Where a line crosses an edge: from its first vertex (0) to its second (1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Two vertices.
    pub edge: [u32; 2],
    /// In 0..=1.
    pub along: f32,
}

impl Growth {
    /// Sends the front on to `radius`, past `most` vertices at most; whether it has arrived. `positions` and `triangles`
    /// are those it began with.
    pub fn grow(&mut self, positions: &[Vec3], triangles: &[[u32; 3]], radius: f32, most: usize) -> bool {
        let radius = f64::from(radius);
        if radius > self.radius {
            self.radius = radius;
            // What lay beyond the old radius may spread now.
            let question = &mut self.question;
            for v in std::mem::take(&mut question.beyond) {
                let mark = &mut question.marks[v as usize];
                mark.visits = mark.visits.saturating_sub(1);
                question.front.push(mark.distance, v);
            }
        }
        let surface = Posed { incidence: &self.incidence, positions, triangles };
        self.question.march(&surface, self.radius, most)
    }

    /// The distance of a vertex, if the front has come to it.
    pub fn distance(&self, v: u32) -> Option<f32> {
        let mark = self.question.marks.get(v as usize)?;
        (mark.epoch == self.question.epoch).then_some(mark.distance as f32)
    }

    /// Vertices the front has come to, with their distances, in no order. Some lie beyond the radius.
    pub fn reached(&self) -> impl Iterator<Item = (u32, f32)> + '_ {
        self.question.touched.iter().map(|&v| (v, self.question.marks[v as usize].distance as f32))
    }

    /// The line around what lies within `radius`, as pieces across triangles, into `lines`. O(vertices reached).
    pub fn line(&self, positions: &[Vec3], triangles: &[[u32; 3]], radius: f32, lines: &mut Vec<[Crossing; 2]>) {
        lines.clear();
        let radius = f64::from(radius);
        let distance = |v: u32| {
            let mark = self.question.marks[v as usize];
            if mark.epoch == self.question.epoch { mark.distance } else { f64::INFINITY }
        };
        let longest = self.question.longest_squared.sqrt();
        for &v in &self.question.touched {
            let outside = distance(v);
            if outside <= radius || outside > radius + longest {
                continue;
            }
            for &face in self.incidence.around(v as usize) {
                let Some(&corners) = triangles.get(face as usize) else { continue };
                let known = corners.map(distance);
                let is_outside = known.map(|d| d > radius);
                // Each triangle once: by its first corner outside.
                let first = (0..3).find(|&k| is_outside[k]);
                if first.is_none_or(|k| corners[k] != v) || is_outside == [true; 3] {
                    continue;
                }
                let alone = (0..3)
                    .find(|&k| is_outside[k] != is_outside[(k + 1) % 3] && is_outside[k] != is_outside[(k + 2) % 3]);
                let Some(alone) = alone else { continue };
                let cut = |other: usize| Crossing {
                    edge: [corners[alone], corners[other]],
                    along: along(
                        [known[alone], known[other]],
                        radius,
                        edge_length(positions, [corners[alone], corners[other]]),
                    ),
                };
                lines.push([cut((alone + 1) % 3), cut((alone + 2) % 3)]);
            }
        }
    }
}

fn edge_length(positions: &[Vec3], [a, b]: [u32; 2]) -> f64 {
    match (positions.get(a as usize), positions.get(b as usize)) {
        (Some(a), Some(b)) => f64::from(a.distance(*b)),
        _ => 0.0,
    }
}

/// Where the radius lies between two vertices of these distances. A vertex not yet reached is as far as the edge is long.
fn along(distances: [f64; 2], radius: f64, length: f64) -> f32 {
    let [from, to] = match distances {
        [from, to] if from.is_infinite() => [to + length, to],
        [from, to] if to.is_infinite() => [from, from + length],
        both => both,
    };
    let along = (radius - from) / (to - from);
    if along.is_finite() { along.clamp(0.0, 1.0) as f32 } else { 0.5 }
}
