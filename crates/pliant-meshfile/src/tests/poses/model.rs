//! glTF files made piece by piece, and streams of poses as lists.

use super::super::support::glb;
use crate::poses::{Found, Pose, PoseOptions, Poses};
use crate::{Format, MeshFile, from_bytes};
use serde_json::{Value, json};

/// A document with its binary chunk.
#[derive(Clone)]
pub(in super::super) struct Model {
    pub(in super::super) document: Value,
    pub(in super::super) binary: Vec<u8>,
}

impl Model {
    /// A strip of unit squares along x: vertex 2 i + k at (i, 0, k), `n` squares long, in one node.
    pub(in super::super) fn strip(n: usize) -> Model {
        let document = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [], "bufferViews": [], "buffers": [{"byteLength": 0}],
        });
        let mut model = Model { document, binary: Vec::new() };
        let positions: Vec<f32> = (0..2 * n + 2).flat_map(|v| [(v / 2) as f32, 0.0, (v % 2) as f32]).collect();
        model.floats("VEC3", &positions);
        model.document["accessors"][0]["min"] = json!([0, 0, 0]);
        model.document["accessors"][0]["max"] = json!([n, 0, 1]);
        let square = |i: u16| [2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 2, 2 * i + 1, 2 * i + 3];
        let indices: Vec<u16> = (0..n as u16).flat_map(square).collect();
        let bytes: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        model.accessor(&bytes, json!({"componentType": 5123, "count": indices.len(), "type": "SCALAR"}));
        model
    }

    /// Appends bytes behind a view of their own; gives its number.
    pub(in super::super) fn view(&mut self, bytes: &[u8]) -> usize {
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.binary.len(), "byteLength": bytes.len()});
        self.binary.extend(bytes);
        self.document["buffers"][0]["byteLength"] = self.binary.len().into();
        push(&mut self.document["bufferViews"], view)
    }

    pub(in super::super) fn accessor(&mut self, bytes: &[u8], mut accessor: Value) -> usize {
        accessor["bufferView"] = self.view(bytes).into();
        push(&mut self.document["accessors"], accessor)
    }

    /// Appends an accessor of single-precision numbers.
    pub(in super::super) fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, json!({"componentType": 5126, "count": numbers.len() / width, "type": kind}))
    }

    /// Appends an animation, or a channel to the one of this name.
    pub(in super::super) fn channel(
        &mut self,
        name: &str,
        node: usize,
        path: &str,
        keys: [usize; 2],
        interpolation: &str,
    ) {
        if self.document["animations"].is_null() {
            self.document["animations"] = json!([]);
        }
        let animations = &mut self.document["animations"];
        let known = animations.as_array().expect("a list").iter().position(|animation| animation["name"] == name);
        let at = known.unwrap_or_else(|| push(animations, json!({"name": name, "samplers": [], "channels": []})));
        let [input, output] = keys;
        let sampler = json!({"input": input, "output": output, "interpolation": interpolation});
        let sampler = push(&mut animations[at]["samplers"], sampler);
        let channel = json!({"sampler": sampler, "target": {"node": node, "path": path}});
        push(&mut animations[at]["channels"], channel);
    }

    pub(in super::super) fn open(&self) -> MeshFile {
        from_bytes(&self.bytes(), Format::Glb, "model.glb").unwrap_or_else(|error| panic!("{error}"))
    }

    pub(in super::super) fn bytes(&self) -> Vec<u8> {
        glb(&self.document, &self.binary)
    }
}

/// Appends to a list and gives the number of the item.
pub(in super::super) fn push(list: &mut Value, item: Value) -> usize {
    let list = list.as_array_mut().expect("a list");
    list.push(item);
    list.len() - 1
}

pub(in super::super) fn frames(frames: usize) -> PoseOptions {
    PoseOptions { frames, ..PoseOptions::default() }
}

/// All poses that a file holds of itself, and how many were passed over.
pub(in super::super) fn own_poses(file: &MeshFile, options: PoseOptions) -> (Vec<Pose>, usize) {
    collect(Poses::of_reference(file, options).unwrap_or_else(|error| panic!("{error}")))
}

pub(in super::super) fn collect(poses: Poses<'_>) -> (Vec<Pose>, usize) {
    let (mut taken, mut n_alike) = (Vec::new(), 0);
    for found in poses {
        match found.unwrap_or_else(|error| panic!("{error}")) {
            Found::Pose(pose) => taken.push(pose),
            Found::Alike { .. } => n_alike += 1,
        }
    }
    (taken, n_alike)
}
