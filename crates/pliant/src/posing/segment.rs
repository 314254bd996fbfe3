//! The way of all handles from one kept pose to the next.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use pliant_solver::VertexId;

use super::motion::between;
use crate::document::{Group, KeptPose, held_by, rotation_of};

/// Two kept poses and what is held on the way between them: whatever one of them holds.
pub struct Segment {
    from: KeptPose,
    parts: Vec<Part>,
}

/// A group on its way.
struct Part {
    /// As it leaves the first pose.
    group: Group,
    way: Way,
}

enum Way {
    /// The same vertices of the same base: to another motion.
    Motion { to: DAffine3, center: DVec3 },
    /// Each vertex to another place: all together as a rigid body, and what is left over on the way.
    Points { from: Vec<DVec3>, to: Vec<DVec3>, motion: DAffine3, center: DVec3 },
}

impl Segment {
    /// The way from one pose to another of the same surface.
    pub fn new(from: &KeptPose, to: &KeptPose) -> Segment {
        let places = |kept: &KeptPose| -> HashMap<VertexId, DVec3> {
            let (vertices, targets) = held_by(&kept.groups);
            vertices.into_iter().zip(targets).collect()
        };
        let (held, wanted) = (places(from), places(to));
        let mut parts = Vec::new();
        for group in from.groups.iter() {
            let same = to
                .groups
                .iter()
                .find(|other| other.id == group.id && other.vertices == group.vertices && other.base == group.base);
            let way = match same {
                Some(other) => Way::Motion { to: other.motion, center: group.base_center() },
                None => {
                    let place = |v: &VertexId| wanted.get(v).copied().unwrap_or(to.positions[v.index()]);
                    points(group.targets().collect(), group.vertices.iter().map(place).collect())
                }
            };
            parts.push(Part { group: group.clone(), way });
        }
        for group in to.groups.iter() {
            let new: Vec<(VertexId, DVec3)> =
                group.vertices.iter().copied().zip(group.targets()).filter(|(v, _)| !held.contains_key(v)).collect();
            if new.is_empty() {
                continue;
            }
            let vertices: Arc<[VertexId]> = new.iter().map(|&(v, _)| v).collect();
            let begin = vertices.iter().map(|v| from.positions[v.index()]).collect();
            let way = points(begin, new.into_iter().map(|(_, target)| target).collect());
            parts.push(Part { group: Group { vertices, ..group.clone() }, way });
        }
        Segment { from: from.clone(), parts }
    }

    /// The pose it begins at.
    pub fn from(&self) -> &KeptPose {
        &self.from
    }

    /// What is held at `t` from 0 to 1, and where.
    pub fn groups(&self, t: f64) -> Arc<[Group]> {
        self.parts.iter().map(|part| part.at(t)).collect()
    }
}

impl Part {
    fn at(&self, t: f64) -> Group {
        match &self.way {
            Way::Motion { to, center } => {
                Group { motion: between(&self.group.motion, to, *center, t), ..self.group.clone() }
            }
            Way::Points { from, to, motion, center } => {
                let carried = between(&DAffine3::IDENTITY, motion, *center, t);
                let place =
                    |(&a, &b): (&DVec3, &DVec3)| carried.transform_point3(a) + (b - motion.transform_point3(a)) * t;
                let base = from.iter().zip(to).map(place).collect();
                Group { base, motion: DAffine3::IDENTITY, ..self.group.clone() }
            }
        }
    }
}

/// From places to others with the rigid motion that fits best; straight where they leave its rotation open.
fn points(from: Vec<DVec3>, to: Vec<DVec3>) -> Way {
    let n = from.len().max(1) as f64;
    let (center, arrives) = (from.iter().sum::<DVec3>() / n, to.iter().sum::<DVec3>() / n);
    let outer = |a: DVec3, b: DVec3| DMat3::from_cols(a * b.x, a * b.y, a * b.z);
    let covariance = from.iter().zip(&to).fold(DMat3::ZERO, |sum, (&a, &b)| sum + outer(b - arrives, a - center));
    // The rotation next to the covariance R S is that of the best fit. Its cofactors R cof(S) say the same rotation, and
    // fill in the third direction for points in a plane.
    let size = covariance.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let unit = covariance * (1.0 / size);
    let [x, y, z] = [unit.x_axis, unit.y_axis, unit.z_axis];
    let rotation = rotation_of(unit + DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)));
    let rotation = rotation.unwrap_or(DMat3::IDENTITY);
    let motion = DAffine3 { matrix3: rotation, translation: arrives - rotation * center };
    Way::Points { from, to, motion, center }
}
