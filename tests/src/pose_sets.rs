//! The sets of poses that come with the program, what is known about them, and noise to spoil them with.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use pliant_solver::Mesh;
use serde_json::Value;

/// A set of poses with its truth.
#[derive(Clone, Debug)]
pub struct PoseSet {
    /// The shape at rest.
    pub mesh: Arc<Mesh>,
    /// Every vertex in every pose.
    pub poses: Vec<Vec<DVec3>>,
    /// For every vertex the bone it moves with, or −1 inside a joint.
    pub bone: Vec<i64>,
    /// For every vertex the number of edges to the nearest vertex inside a joint.
    pub rings: Vec<i64>,
    /// For every joint its turn in every pose, in degrees.
    pub degrees: Vec<Vec<f64>>,
}

impl PoseSet {
    /// Reads `assets/NAME.glb`, whose morph targets are the poses, and `assets/NAME.truth.json`.
    pub fn open(name: &str) -> PoseSet {
        let read =
            |ending| std::fs::read(assets().join(format!("{name}.{ending}"))).expect("it comes with the program");
        let glb = read("glb");
        let json_length = word(&glb, 12) as usize;
        let document: Value = serde_json::from_slice(&glb[20..20 + json_length]).expect("valid JSON");
        let data = &glb[28 + json_length..];
        let primitive = &document["meshes"][0]["primitives"][0];
        let vectors = |accessor: &Value| -> Vec<DVec3> {
            let number = |i: usize| f64::from(f32::from_bits(word(view(&document, data, accessor), 4 * i)));
            let n = document["accessors"][index(accessor)]["count"].as_u64().expect("a count") as usize;
            (0..n).map(|v| DVec3::new(number(3 * v), number(3 * v + 1), number(3 * v + 2))).collect()
        };
        let rest = vectors(&primitive["attributes"]["POSITION"]);
        let targets = primitive["targets"].as_array().expect("morph targets");
        let moved = |target: &Value| vectors(&target["POSITION"]).iter().zip(&rest).map(|(d, p)| p + d).collect();
        let poses = targets.iter().map(moved).collect();
        let corners: Vec<u32> = view(&document, data, &primitive["indices"])
            .chunks_exact(2)
            .map(|bytes| u32::from(u16::from_le_bytes([bytes[0], bytes[1]])))
            .collect();
        let triangles = corners.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
        let truth: Value = serde_json::from_slice(&read("truth.json")).expect("valid JSON");
        let numbers = |value: &Value| -> Vec<f64> {
            value.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
        };
        let whole = |key: &str| numbers(&truth[key]).iter().map(|&x| x as i64).collect();
        PoseSet {
            mesh: Arc::new(Mesh::new(rest, triangles).expect("a valid mesh")),
            poses,
            bone: whole("bone"),
            rings: whole("rings"),
            degrees: truth["joints"].as_array().expect("joints").iter().map(|j| numbers(&j["degrees"])).collect(),
        }
    }

    /// The first `n` poses, in the order of their numbers, that together bend every joint by `degrees` or more.
    pub fn poses_that_bend_every_joint(&self, n: usize, degrees: f64) -> Vec<usize> {
        let bends = |chosen: &[usize]| self.degrees.iter().all(|turns| chosen.iter().any(|&p| turns[p] >= degrees));
        let mut chosen: Vec<usize> = (0..n).collect();
        while !bends(&chosen) {
            // The next combination.
            let last = (0..n).rev().find(|&i| chosen[i] < self.poses.len() - n + i);
            let last = last.unwrap_or_else(|| panic!("no {n} poses bend every joint by {degrees}°"));
            chosen[last] += 1;
            (last + 1..n).for_each(|i| chosen[i] = chosen[i - 1] + 1);
        }
        chosen
    }

    /// Every position, at rest too where `rest_too`, moved at random by `share` mean edge lengths along each axis (root
    /// mean square), then everything scaled.
    pub fn spoiled(&self, share: f64, rest_too: bool, scale: f64) -> PoseSet {
        let positions = self.mesh.positions();
        let edges = self.mesh.edges().iter().map(|e| positions[e[0] as usize].distance(positions[e[1] as usize]));
        let amount = share * edges.sum::<f64>() / self.mesh.n_edges() as f64;
        let mut noise = Noise(1);
        let mut spoil = |positions: &[DVec3], amount: f64| -> Vec<DVec3> {
            positions.iter().map(|&p| (p + noise.vector() * amount) * scale).collect()
        };
        let rest = spoil(positions, if rest_too { amount } else { 0.0 });
        PoseSet {
            mesh: Arc::new(Mesh::new(rest, self.mesh.triangles().to_vec()).expect("a valid mesh")),
            poses: self.poses.iter().map(|pose| spoil(pose, amount)).collect(),
            ..self.clone()
        }
    }
}

fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ lies in the workspace").join("assets")
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

fn index(value: &Value) -> usize {
    value.as_u64().expect("an index") as usize
}

/// The bytes of an accessor's view.
fn view<'a>(document: &Value, data: &'a [u8], accessor: &Value) -> &'a [u8] {
    let view = &document["bufferViews"][index(&document["accessors"][index(accessor)]["bufferView"])];
    &data[index(&view["byteOffset"])..][..index(&view["byteLength"])]
}

/// Numbers that look random and are the same in every run (SplitMix64; Steele, Lea, Flood 2014).
struct Noise(u64);

impl Noise {
    /// A number with mean 0 and root mean square 1: the sum of three evenly spread ones, bell-shaped enough.
    fn number(&mut self) -> f64 {
        let mut even = || {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        // One of them, between −1 and 1, has a mean square of a third.
        even() + even() + even()
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }
}
