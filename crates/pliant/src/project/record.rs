//! Lists of numbers as blocks, and the small values of the header.

use glam::{DAffine3, DMat3, DVec3, Quat, Vec3};
use pliant_solver::{LooseComponents, VertexId, Weights};
use serde::{Deserialize, Serialize};

use super::container::{Block, Reader, Writer};
use super::error::Flaw;
use crate::document::{Method, MethodKind};
use crate::viewport::{Camera, Projection};

pub(super) fn put_points(writer: &mut Writer, points: impl Iterator<Item = DVec3>) -> Block {
    writer.put(points.flat_map(|p| p.to_array()).flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

pub(super) fn put_vertices(writer: &mut Writer, vertices: impl Iterator<Item = VertexId>) -> Block {
    writer.put(vertices.flat_map(|v| v.0.to_le_bytes()).collect::<Vec<u8>>())
}

pub(super) fn put_triangles(writer: &mut Writer, triangles: &[[u32; 3]]) -> Block {
    writer.put(triangles.iter().flatten().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>())
}

pub(super) fn put_rigidity(writer: &mut Writer, r: &[u16]) -> Block {
    writer.put(r.iter().flat_map(|r| r.to_le_bytes()).collect::<Vec<u8>>())
}

/// The numbers of a block, of `N` bytes each.
fn numbers<const N: usize>(reader: &Reader, block: Block, what: &str) -> Result<impl Iterator<Item = [u8; N]>, Flaw> {
    let (chunks, rest) = reader.bytes(block, what)?.as_chunks::<N>();
    if !rest.is_empty() {
        return Err(Flaw(format!("{what}: its length is not that of whole numbers")));
    }
    Ok(chunks.iter().copied())
}

/// Finite points.
pub(super) fn points(reader: &Reader, block: Block, what: &str) -> Result<Vec<DVec3>, Flaw> {
    let all = numbers::<24>(reader, block, what)?.map(|bytes| {
        let (x, _) = bytes.as_chunks::<8>();
        DVec3::new(f64::from_le_bytes(x[0]), f64::from_le_bytes(x[1]), f64::from_le_bytes(x[2]))
    });
    let all: Vec<DVec3> = all.collect();
    match all.iter().position(|p| !p.is_finite()) {
        Some(index) => Err(Flaw(format!("{what}: position {index} is not finite"))),
        None => Ok(all),
    }
}

/// Vertices below `n_points`.
pub(super) fn vertices(reader: &Reader, block: Block, n_points: usize, what: &str) -> Result<Vec<VertexId>, Flaw> {
    let all: Vec<_> = numbers::<4>(reader, block, what)?.map(|bytes| VertexId(u32::from_le_bytes(bytes))).collect();
    match all.iter().find(|v| v.index() >= n_points) {
        Some(v) => Err(Flaw(format!("{what}: vertex {} does not exist: the surface has {n_points}", v.0))),
        None => Ok(all),
    }
}

pub(super) fn triangles(reader: &Reader, block: Block) -> Result<Vec<[u32; 3]>, Flaw> {
    let all = numbers::<12>(reader, block, "triangles")?.map(|bytes| {
        let (v, _) = bytes.as_chunks::<4>();
        [u32::from_le_bytes(v[0]), u32::from_le_bytes(v[1]), u32::from_le_bytes(v[2])]
    });
    Ok(all.collect())
}

pub(super) fn rigidity(reader: &Reader, block: Block) -> Result<Vec<u16>, Flaw> {
    Ok(numbers::<2>(reader, block, "rigidity")?.map(u16::from_le_bytes).collect())
}

/// Columns of the matrix, then the translation.
pub(super) fn motion_numbers(motion: &DAffine3) -> [f64; 12] {
    let mut numbers = [0.0; 12];
    numbers[..9].copy_from_slice(&motion.matrix3.to_cols_array());
    numbers[9..].copy_from_slice(&motion.translation.to_array());
    numbers
}

pub(super) fn motion_of(numbers: &[f64; 12]) -> Option<DAffine3> {
    let (matrix, translation) = numbers.split_at(9);
    let motion = DAffine3 { matrix3: DMat3::from_cols_slice(matrix), translation: DVec3::from_slice(translation) };
    motion.is_finite().then_some(motion)
}

/// Edge weights by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum WeightsRecord {
    #[default]
    Clamped,
    Cotangent,
    Uniform,
}

impl From<Weights> for WeightsRecord {
    fn from(weights: Weights) -> WeightsRecord {
        match weights {
            Weights::Clamped => WeightsRecord::Clamped,
            Weights::Cotangent => WeightsRecord::Cotangent,
            Weights::Uniform => WeightsRecord::Uniform,
        }
    }
}

impl From<WeightsRecord> for Weights {
    fn from(record: WeightsRecord) -> Weights {
        match record {
            WeightsRecord::Clamped => Weights::Clamped,
            WeightsRecord::Cotangent => Weights::Cotangent,
            WeightsRecord::Uniform => Weights::Uniform,
        }
    }
}

/// What parts without handles do, by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum LooseRecord {
    Stay,
    #[default]
    Follow,
}

impl From<LooseComponents> for LooseRecord {
    fn from(loose: LooseComponents) -> LooseRecord {
        match loose {
            LooseComponents::KeepAtRest => LooseRecord::Stay,
            LooseComponents::FollowNearest => LooseRecord::Follow,
        }
    }
}

impl From<LooseRecord> for LooseComponents {
    fn from(record: LooseRecord) -> LooseComponents {
        match record {
            LooseRecord::Stay => LooseComponents::KeepAtRest,
            LooseRecord::Follow => LooseComponents::FollowNearest,
        }
    }
}

/// The method that bends, with the parameters of all.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct MethodRecord {
    kind: KindRecord,
    alpha: f64,
    nodes: usize,
    neighbors: usize,
    #[serde(default)]
    agreement: Option<f64>,
    #[serde(default)]
    pull: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum KindRecord {
    Rring,
    Arap,
    SrArap,
    Embedded,
}

impl MethodRecord {
    pub(super) fn of(method: &Method) -> MethodRecord {
        let kind = match method.kind {
            MethodKind::RRing => KindRecord::Rring,
            MethodKind::Arap => KindRecord::Arap,
            MethodKind::SrArap => KindRecord::SrArap,
            MethodKind::Embedded => KindRecord::Embedded,
        };
        let Method { alpha, nodes, neighbors, agreement, pull, .. } = *method;
        MethodRecord { kind, alpha, nodes, neighbors, agreement: Some(agreement), pull: Some(pull) }
    }

    pub(super) fn method(self) -> Result<Method, Flaw> {
        let kind = match self.kind {
            KindRecord::Rring => MethodKind::RRing,
            KindRecord::Arap => MethodKind::Arap,
            KindRecord::SrArap => MethodKind::SrArap,
            KindRecord::Embedded => MethodKind::Embedded,
        };
        let MethodRecord { alpha, nodes, neighbors, .. } = self;
        let usual = Method::default();
        let (agreement, pull) = (self.agreement.unwrap_or(usual.agreement), self.pull.unwrap_or(usual.pull));
        let method = Method { kind, alpha, nodes, neighbors, agreement, pull };
        match method.fault() {
            Some((what, value, allowed)) => Err(Flaw(format!("{what} is {value}, and must be {allowed}"))),
            None => Ok(method),
        }
    }
}

/// The eye, in view space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct CameraRecord {
    target: [f32; 3],
    distance: f32,
    orientation: [f32; 4],
    orthographic: bool,
    field_of_view: f32,
}

impl CameraRecord {
    pub(super) fn of(camera: &Camera) -> CameraRecord {
        CameraRecord {
            target: camera.target.to_array(),
            distance: camera.distance,
            orientation: camera.orientation.to_array(),
            orthographic: camera.projection == Projection::Orthographic,
            field_of_view: camera.fov_y_radians,
        }
    }

    /// Nothing for a camera that could not look at anything: the surface is then seen whole.
    pub(super) fn camera(&self) -> Option<Camera> {
        let target = Vec3::from_array(self.target);
        let orientation = Quat::from_array(self.orientation);
        let is_sound = target.is_finite()
            && self.distance.is_finite()
            && self.distance > 0.0
            && orientation.is_finite()
            && (orientation.length_squared() - 1.0).abs() < 1e-3
            && (0.01..3.0).contains(&self.field_of_view);
        is_sound.then_some(Camera {
            target,
            distance: self.distance,
            orientation,
            projection: if self.orthographic { Projection::Orthographic } else { Projection::Perspective },
            fov_y_radians: self.field_of_view,
        })
    }
}
