//! The shapes of the figures: the samples in `assets/`, and handles for them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_meshfile::poses::{Found, PoseOptions, Poses};
use pliant_solver::{Mesh, VertexId};
use serde_json::Value;

use crate::failure::Failure;

/// What of a bone is held: from this part of the way to the vertex that is farthest from its joints (by eye).
const DEEP: f64 = 0.75;

/// A shape with what is held of it and where.
#[derive(Clone)]
pub(crate) struct Posing {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) held: Vec<VertexId>,
    pub(crate) targets: Vec<DVec3>,
}

impl Posing {
    /// Holds the vertices for which there is a target.
    pub(crate) fn new(mesh: Arc<Mesh>, target: impl Fn(usize, DVec3) -> Option<DVec3>) -> Posing {
        let at = |(v, &p): (usize, &DVec3)| target(v, p).map(|to| (VertexId(v as u32), to));
        let (held, targets) = mesh.positions().iter().enumerate().filter_map(at).unzip();
        Posing { mesh, held, targets }
    }
}

/// A bar of the samples with its length along x; its section is the unit square.
pub(crate) struct Bar {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) length: f64,
}

impl Bar {
    pub(crate) fn open(name: &str) -> Result<Bar, Failure> {
        let mesh = open(name)?;
        let length = mesh.positions().iter().map(|p| p.x).fold(0.0, f64::max);
        Ok(Bar { mesh, length })
    }

    /// One end held, the other carried along an arc in the x-y plane on which the middle line keeps its length.
    pub(crate) fn arc(&self, degrees: f64) -> Posing {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let radius = self.length / degrees.to_radians();
        Posing::new(self.mesh.clone(), |_, p| {
            let arm = radius - (p.y - 0.5);
            match p.x {
                0.0 => Some(p),
                x if x == self.length => Some(DVec3::new(arm * sin, 0.5 + radius - arm * cos, p.z)),
                _ => None,
            }
        })
    }
}

impl Bar {
    /// How far the middle line between two places along the bar, given as parts of its length, is from straight: the distance
    /// of its middle from the chord over the length at rest.
    pub(crate) fn bow(&self, posed: &[DVec3], [from, to]: [f64; 2]) -> f64 {
        let [a, middle, b] = [from, 0.5 * (from + to), to].map(|part| self.center(posed, part * self.length));
        let along = (b - a).normalize_or_zero();
        let off = middle - a;
        (off - along * off.dot(along)).length() / ((to - from) * self.length)
    }

    /// The middle of the section next to x.
    fn center(&self, posed: &[DVec3], x: f64) -> DVec3 {
        let off = |p: &DVec3| (p.x - x).abs();
        let nearest = self.mesh.positions().iter().map(off).fold(f64::INFINITY, f64::min);
        // Sections are a hundredth of the length apart or more.
        let of_section = |p: &DVec3| off(p) <= nearest + 1e-4 * self.length;
        let here = self.mesh.positions().iter().zip(posed).filter(|(p, _)| of_section(p));
        let (sum, n) = here.fold((DVec3::ZERO, 0.0), |(sum, n), (_, p)| (sum + *p, n + 1.0));
        sum / n
    }
}

/// A set of poses with what is known about it.
pub(crate) struct PoseSet {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) names: Vec<String>,
    pub(crate) poses: Vec<Vec<DVec3>>,
    /// For every vertex the bone it moves with; none inside a joint.
    pub(crate) bone: Vec<Option<usize>>,
    /// For every vertex the number of edges to the nearest vertex inside a joint.
    pub(crate) rings: Vec<u16>,
    /// For every vertex the number of that vertex's joint.
    joint: Vec<usize>,
    bones: Vec<String>,
    /// For every joint the names of its two bones.
    joints: Vec<[String; 2]>,
}

impl PoseSet {
    pub(crate) fn open(name: &str) -> Result<PoseSet, Failure> {
        let path = asset(&format!("{name}.glb"));
        let file = pliant_meshfile::open(&path)?;
        let mut set = PoseSet {
            mesh: Arc::new(Mesh::new(file.points(), file.point_triangles())?),
            names: Vec::new(),
            poses: Vec::new(),
            bone: Vec::new(),
            rings: Vec::new(),
            joint: Vec::new(),
            bones: Vec::new(),
            joints: Vec::new(),
        };
        for found in Poses::of_reference(&file, PoseOptions::default())? {
            if let Found::Pose(pose) = found? {
                set.poses.push(pose.points);
            }
        }
        let truth = Json::read(&format!("{name}.truth.json"))?;
        set.names = truth.list("poses", |name| name.as_str().map(str::to_owned))?;
        set.bones = truth.list("bones", |name| name.as_str().map(str::to_owned))?;
        set.bone = truth.list("bone", |bone| bone.as_i64().map(|bone| usize::try_from(bone).ok()))?;
        set.rings = truth.list("rings", |rings| rings.as_u64().map(|rings| rings.min(1000) as u16))?;
        set.joint = truth.list("joint", |joint| joint.as_u64().and_then(|joint| usize::try_from(joint).ok()))?;
        set.joints = truth.list("joints", |joint| serde_json::from_value(joint["between"].clone()).ok())?;
        let n = set.mesh.n_vertices();
        if set.poses.len() != set.names.len() || [set.bone.len(), set.rings.len(), set.joint.len()] != [n; 3] {
            return Err(truth.fault("it does not fit the mesh"));
        }
        Ok(set)
    }

    /// Patches of some bones where a pose has them: their vertices that are farthest from all joints.
    pub(crate) fn held_by(&self, bones: &[&str], pose: &[DVec3]) -> Posing {
        let mut deepest = vec![0; self.bones.len()];
        for (bone, &rings) in self.bone.iter().zip(&self.rings) {
            if let Some(bone) = *bone {
                deepest[bone] = rings.max(deepest[bone]);
            }
        }
        let is_held = |v: usize| {
            let bone = self.bone[v].filter(|_| self.is_in_bone(v, bones));
            bone.is_some_and(|bone| f64::from(self.rings[v]) >= DEEP * f64::from(deepest[bone]))
        };
        Posing::new(self.mesh.clone(), |v, _| is_held(v).then(|| pose[v]))
    }

    /// Whether a vertex is inside a joint that carries one of these bones.
    pub(crate) fn is_in_joint_of(&self, v: usize, bones: &[&str]) -> bool {
        let carried = self.joints.get(self.joint[v]).map(|[_, bone]| bone.as_str());
        self.bone[v].is_none() && carried.is_some_and(|bone| bones.contains(&bone))
    }

    /// Whether a vertex moves with one of these bones.
    pub(crate) fn is_in_bone(&self, v: usize, bones: &[&str]) -> bool {
        self.bone[v].is_some_and(|bone| bones.contains(&self.bones[bone].as_str()))
    }

    /// The pose of this name.
    pub(crate) fn pose(&self, name: &str) -> Result<&[DVec3], Failure> {
        let place = self.names.iter().position(|other| other == name);
        let missing = || Failure::Asset { path: asset("*.truth.json"), what: format!("there is no pose {name}") };
        place.map(|place| self.poses[place].as_slice()).ok_or_else(missing)
    }
}

/// A sample's shape.
pub(crate) fn open(name: &str) -> Result<Arc<Mesh>, Failure> {
    let file = pliant_meshfile::open(&asset(&format!("{name}.glb")))?;
    Ok(Arc::new(Mesh::new(file.points(), file.point_triangles())?))
}

/// r of every vertex of a sample that has a demonstration.
pub(crate) fn painted(name: &str) -> Result<Vec<u16>, Failure> {
    let json = Json::read(&format!("{name}.rigidity.json"))?;
    json.items(&json.value, "the list", |r| r.as_u64().and_then(|r| u16::try_from(r).ok()))
}

fn asset(file: &str) -> PathBuf {
    crate::workspace().join("assets").join(file)
}

/// A file of the samples with its content.
struct Json {
    path: PathBuf,
    value: Value,
}

impl Json {
    fn read(file: &str) -> Result<Json, Failure> {
        let path = asset(file);
        let text = read(&path)?;
        match serde_json::from_str(&text) {
            Ok(value) => Ok(Json { path, value }),
            Err(error) => Err(Failure::Asset { path, what: error.to_string() }),
        }
    }

    fn fault(&self, what: &str) -> Failure {
        Failure::Asset { path: self.path.clone(), what: what.to_owned() }
    }

    /// A list by its key, item by item.
    fn list<T>(&self, key: &str, read: impl FnMut(&Value) -> Option<T>) -> Result<Vec<T>, Failure> {
        self.items(&self.value[key], key, read)
    }

    fn items<T>(&self, list: &Value, what: &str, read: impl FnMut(&Value) -> Option<T>) -> Result<Vec<T>, Failure> {
        let items = list.as_array().map(|items| items.iter().map(read).collect::<Option<Vec<T>>>());
        items.flatten().ok_or_else(|| self.fault(what))
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|source| Failure::File { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bow_of_an_arc_is_its_sagitta() {
        let bar = Bar::open("thin-bar").expect("a sample");
        let (angle, radius) = (2.0_f64, bar.length / 2.0);
        let bent: Vec<DVec3> = bar
            .mesh
            .positions()
            .iter()
            .map(|p| {
                let (sin, cos) = (p.x / radius).sin_cos();
                DVec3::new((radius - p.y) * sin, radius - (radius - p.y) * cos, p.z)
            })
            .collect();
        let (got, expected) = (bar.bow(&bent, [0.0, 1.0]), (1.0 - (angle / 2.0).cos()) / angle);
        // The middle line is half a unit nearer to the center than the line that keeps its length.
        assert!((got - expected).abs() < 0.5 / radius, "{got}, expected {expected}");
        assert!(bar.bow(bar.mesh.positions(), [0.2, 0.8]) < 1e-6, "at rest");
    }

    #[test]
    fn pose_sets_say_what_moves_with_what() {
        let set = PoseSet::open("gecko").expect("a sample");
        let knees = (0..set.bone.len()).filter(|&v| set.is_in_joint_of(v, &["left shin"])).count();
        assert!(knees > 10, "{knees} vertices");
        let held = set.held_by(&["head"], set.pose("stand").expect("a pose")).held;
        assert!(held.iter().all(|v| set.is_in_bone(v.index(), &["head"])) && held.len() > 10);
        assert!(set.pose("handstand").is_err());
    }
}
