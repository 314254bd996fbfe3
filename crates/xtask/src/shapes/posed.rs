//! Sets of poses with their truth: what moves with which bone, and how far everything is from the next joint.
//!
//! | key of NAME.truth.json | what |
//! |---|---|
//! | `bones` | names |
//! | `joints` | for every joint the names of its two bones and by how many degrees each pose turns it |
//! | `poses` | names, in the order of the morph targets |
//! | `bone` | for every vertex the number of its bone, −1 inside a joint |
//! | `rings` | for every vertex the number of edges to the nearest vertex inside a joint |
//! | `joint` | for every vertex the number of that vertex's joint |

use glam::DVec3;
use serde_json::json;

use super::Shape;
use super::handles::{Handles, turn_and_shift};
use super::skeleton::{Joint, Place, Turn, bent};

/// Handles are on vertices at least so many edges from the nearest joint.
const HELD_FROM: u32 = 4;
/// How far the last bone is turned by its handle: about as far as in the poses.
const HELD_DEGREES: f64 = 40.0;

/// How to make a set of poses.
pub(crate) struct PoseSet {
    /// File name without ending.
    pub(crate) name: &'static str,
    pub(crate) make: fn() -> Posed,
}

/// A pose by its turns.
pub(crate) struct Pose {
    pub(crate) name: &'static str,
    /// One turn per joint.
    pub(crate) turns: Vec<Turn>,
    /// What the whole does besides: a turn about the origin, then a shift.
    pub(crate) root: (Turn, DVec3),
}

/// A shape at rest and in its poses.
pub(crate) struct Posed {
    pub(crate) rest: Shape,
    pub(crate) bones: Vec<&'static str>,
    pub(crate) joints: Vec<Joint>,
    pub(crate) places: Vec<Place>,
    pub(crate) poses: Vec<Pose>,
}

/// What the file NAME.truth.json says of every vertex.
pub(crate) struct Truth {
    /// The bone it moves with, or −1 inside a joint.
    pub(crate) bone: Vec<i32>,
    /// Edges to the nearest vertex inside a joint.
    pub(crate) rings: Vec<u32>,
    /// The joint of that vertex; the first of several that are equally near.
    pub(crate) joint: Vec<u32>,
}

/// Where a point lies in a chain of joints, each carried by the bone of the one before; `None` before the first.
pub(crate) fn walk(joints: &[Joint], chain: &[usize], p: DVec3) -> Option<Place> {
    let mut place = None;
    for &j in chain {
        let s = joints[j].along(p);
        if s <= -joints[j].half {
            break;
        }
        if s < joints[j].half {
            return Some(Place::Joint(j));
        }
        place = Some(Place::Bone(j + 1));
    }
    place
}

impl Posed {
    /// Positions of all vertices in a pose, rounded to single precision.
    pub(crate) fn positions(&self, pose: &Pose) -> Vec<DVec3> {
        let bent = bent(&self.rest.positions, &self.places, &self.joints, &pose.turns, pose.root);
        bent.into_iter().map(|p| p.as_vec3().as_dvec3()).collect()
    }

    /// The truth, by a search from all joints at once.
    pub(crate) fn truth(&self) -> Truth {
        let n = self.places.len();
        let mut neighbors = vec![Vec::new(); n];
        self.rest.directed_edges().0.iter().for_each(|&((a, b), _)| neighbors[a as usize].push(b));
        let (mut rings, mut joint) = (vec![u32::MAX; n], vec![0; n]);
        let mut front = Vec::new();
        for (v, place) in self.places.iter().enumerate() {
            if let Place::Joint(j) = *place {
                (rings[v], joint[v]) = (0, j as u32);
                front.push(v);
            }
        }
        let mut at = 0;
        while let Some(&v) = front.get(at) {
            for &next in &neighbors[v] {
                if rings[next as usize] == u32::MAX {
                    (rings[next as usize], joint[next as usize]) = (rings[v] + 1, joint[v]);
                    front.push(next as usize);
                }
            }
            at += 1;
        }
        let bone = self.places.iter().map(|place| match *place {
            Place::Bone(bone) => bone as i32,
            Place::Joint(..) => -1,
        });
        Truth { bone: bone.collect(), rings, joint }
    }

    /// The first bone held, the last one turned against the one before: a pose that is none of the set.
    pub(crate) fn handles(&self) -> Handles {
        let truth = self.truth();
        let of_bone = |bone: usize| {
            let is_deep = |&v: &usize| truth.bone[v] == bone as i32 && truth.rings[v] >= HELD_FROM;
            (0..truth.bone.len()).filter(is_deep).map(|v| v as u32).collect()
        };
        let joint = &self.joints[self.joints.len() - 1];
        let across = if joint.axis.x.abs() < 0.7 { DVec3::X } else { DVec3::Y };
        let axis = (across - joint.axis * joint.axis.dot(across)).normalize();
        let turned = turn_and_shift(joint.pivot, axis, HELD_DEGREES, DVec3::ZERO);
        let groups = vec![(of_bone(self.joints.len()), turned)];
        Handles { fixed: of_bone(0), moved: Vec::new(), groups }
    }

    /// The truth as a file: a key a line.
    pub(crate) fn truth_json(&self) -> String {
        let truth = self.truth();
        let joint = |(j, joint): (usize, &Joint)| {
            let degrees: Vec<f64> = self.poses.iter().map(|p| (p.turns[j].degrees * 10.0).round() / 10.0).collect();
            let between = [self.bones[joint.parent], self.bones[j + 1]];
            format!("    {}", json!({ "between": between, "degrees": degrees }))
        };
        let joints: Vec<String> = self.joints.iter().enumerate().map(joint).collect();
        let poses: Vec<&str> = self.poses.iter().map(|pose| pose.name).collect();
        let lines = [
            format!("  \"bones\": {}", json!(self.bones)),
            format!("  \"joints\": [\n{}\n  ]", joints.join(",\n")),
            format!("  \"poses\": {}", json!(poses)),
            format!("  \"bone\": {}", json!(truth.bone)),
            format!("  \"rings\": {}", json!(truth.rings)),
            format!("  \"joint\": {}", json!(truth.joint)),
        ];
        format!("{{\n{}\n}}\n", lines.join(",\n"))
    }

    /// A GLB file: the shape at rest, every pose a morph target with its name. Normals are left to who reads it: those of
    /// the poses would double the file, and those at rest would be wrong in every pose.
    pub(crate) fn glb(&self, name: &str) -> Vec<u8> {
        let mut data = Vec::new();
        let (mut views, mut accessors) = (Vec::new(), Vec::new());
        let mut vectors = |data: &mut Vec<u8>, vectors: &[DVec3]| {
            let low = vectors.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::ZERO);
            let high = vectors.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::ZERO);
            views.push(json!({
                "buffer": 0, "byteOffset": data.len(), "byteLength": 12 * vectors.len(), "target": 34962,
            }));
            data.extend(vectors.iter().flat_map(|v| v.as_vec3().to_array()).flat_map(f32::to_le_bytes));
            let bounds = |v: DVec3| v.as_vec3().to_array().map(f64::from);
            accessors.push(json!({
                "bufferView": views.len() - 1, "componentType": 5126, "count": vectors.len(), "type": "VEC3",
                "min": bounds(low), "max": bounds(high),
            }));
            accessors.len() - 1
        };
        let rest = vectors(&mut data, &self.rest.positions);
        let mut targets = Vec::new();
        for pose in &self.poses {
            let away = |(p, q): (DVec3, &DVec3)| p - *q;
            let deltas: Vec<DVec3> = self.positions(pose).into_iter().zip(&self.rest.positions).map(away).collect();
            targets.push(json!({ "POSITION": vectors(&mut data, &deltas) }));
        }
        // All samples have fewer than 65,535 vertices (tested).
        let indices: Vec<u8> = self.rest.triangles.iter().flatten().flat_map(|&v| (v as u16).to_le_bytes()).collect();
        views.push(json!({
            "buffer": 0, "byteOffset": data.len(), "byteLength": indices.len(), "target": 34963,
        }));
        accessors.push(json!({
            "bufferView": views.len() - 1, "componentType": 5123, "count": indices.len() / 2, "type": "SCALAR",
        }));
        data.extend(indices);
        let names: Vec<&str> = self.poses.iter().map(|pose| pose.name).collect();
        let document = json!({
            "asset": { "version": "2.0", "generator": "Pliant" },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0, "name": name }],
            "meshes": [{
                "name": name,
                "primitives": [{
                    "attributes": { "POSITION": rest }, "indices": accessors.len() - 1, "targets": targets,
                }],
                "weights": vec![0.0; names.len()],
                "extras": { "targetNames": names },
            }],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{ "byteLength": data.len() }],
        });
        container(document.to_string().into_bytes(), data)
    }
}

/// A GLB file of JSON and data.
fn container(mut json: Vec<u8>, mut data: Vec<u8>) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let mut bytes = b"glTF".to_vec();
    bytes.extend([word(2), word(28 + json.len() + data.len())].concat());
    for (kind, content) in [(b"JSON", json), (b"BIN\0", data)] {
        bytes.extend(word(content.len()));
        bytes.extend(kind);
        bytes.extend(content);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::POSED;
    use std::sync::LazyLock;

    /// Made once: it takes seconds.
    static SETS: LazyLock<Vec<(&str, Posed)>> = LazyLock::new(|| POSED.map(|set| (set.name, (set.make)())).into());

    #[test]
    fn sets_are_closed_surfaces_of_well_shaped_triangles_that_fit_short_indices() {
        for (name, set) in SETS.iter() {
            let shape = &set.rest;
            assert_eq!(shape.flaws(false), Vec::<String>::new(), "{name}");
            assert_eq!(shape.triangles.len(), 2 * shape.positions.len() - 4, "{name}: a sphere by Euler's formula");
            assert!(shape.volume() > 0.0, "{name} is inside out");
            assert!(shape.smallest_angle() > 20.0, "{name}: an angle of {}°", shape.smallest_angle());
            assert!((3000..=6500).contains(&shape.positions.len()), "{name}: {} vertices", shape.positions.len());
        }
    }

    #[test]
    fn neither_rest_nor_any_pose_crosses_itself() {
        let mut found = Vec::new();
        for (name, set) in SETS.iter() {
            let poses = set.poses.iter().map(|pose| (pose.name, set.positions(pose)));
            for (pose, positions) in poses.chain([("rest", set.rest.positions.clone())]) {
                let pairs = pliant_geometry::crossings(&positions, &set.rest.triangles);
                found.extend(pairs.into_iter().map(|pair| (*name, pose, pair)));
            }
        }
        assert_eq!(found, Vec::new());
    }

    #[test]
    fn bones_move_rigidly() {
        for (name, set) in SETS.iter() {
            let bone = |v: u32| match set.places[v as usize] {
                Place::Bone(bone) => Some(bone),
                Place::Joint(_) => None,
            };
            // Four coordinates of up to 4, each rounded to single precision.
            let tolerance = 4.0 * 4.0 * f64::from(f32::EPSILON);
            for pose in &set.poses {
                let positions = set.positions(pose);
                for &((a, b), _) in &set.rest.directed_edges().0 {
                    let length = |p: &[DVec3]| p[a as usize].distance(p[b as usize]);
                    let (got, expected) = (length(&positions), length(&set.rest.positions));
                    let stretched = (got - expected).abs() > tolerance;
                    let rigid = bone(a).is_some() && bone(a) == bone(b);
                    assert!(!rigid || !stretched, "{name}, {}: edge {a}-{b} is {got} for {expected}", pose.name);
                }
            }
        }
    }

    #[test]
    fn neighboring_bones_are_joined_by_joints_only() {
        for (name, set) in SETS.iter() {
            for &((a, b), _) in &set.rest.directed_edges().0 {
                if let (Place::Bone(first), Place::Bone(second)) = (set.places[a as usize], set.places[b as usize]) {
                    assert_eq!(first, second, "{name}: edge {a}-{b}");
                }
            }
        }
    }

    #[test]
    fn twelve_poses_bend_every_joint_by_thirty_degrees_or_more() {
        for (name, set) in SETS.iter() {
            assert!(set.poses.len() >= 12, "{name}");
            for j in 0..set.joints.len() {
                let most = set.poses.iter().map(|pose| pose.turns[j].degrees).fold(0.0, f64::max);
                assert!(most >= 30.0, "{name}: joint {j} bends by {most}°");
            }
        }
    }

    #[test]
    fn every_bone_has_vertices_more_than_six_edges_from_all_joints() {
        for (name, set) in SETS.iter() {
            let truth = set.truth();
            for (bone, bone_name) in set.bones.iter().enumerate() {
                let deep = truth.bone.iter().zip(&truth.rings).filter(|(b, rings)| **b == bone as i32 && **rings > 6);
                // A ring of the thinnest limb.
                assert!(deep.count() >= 10, "{name}: {bone_name}");
            }
        }
    }

    #[test]
    fn files_hold_rest_and_poses() {
        for (name, set) in SETS.iter() {
            let glb = set.glb(name);
            assert!(glb.len() < 1_050_000, "{name}: {} bytes", glb.len());
            let mesh = pliant_meshfile::from_bytes(&glb, pliant_meshfile::Format::Glb, name).expect("it opens");
            assert_eq!((&mesh.positions, &mesh.triangles), (&set.rest.positions, &set.rest.triangles), "{name}");
        }
    }
}
