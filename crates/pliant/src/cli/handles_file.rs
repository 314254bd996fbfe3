//! The handles file: which file vertices are held, and where they go.
//!
//! ```json
//! { "fixed":  [0, 1, 2],
//!   "moved":  [ {"vertex": 17, "to": [0.1, 2.0, 0.0]} ],
//!   "groups": [ {"vertices": [40, 41], "matrix": [16 numbers]} ] }
//! ```
//!
//! Vertices are file vertices; what is held are the surface points they stand for. Naming a point more than once is
//! fine as long as it is sent to one place. Everything wrong is refused with its place in the file.

use std::collections::BTreeMap;
use std::fmt;
use std::io::Read;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use glam::{DMat4, DVec3};
use pliant_meshfile::MeshFile;
use pliant_solver::{LARGEST_COORDINATE, VertexId};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::document::bounds_of;

/// No honest handles file is larger; the same limit as for the JSON part of a glTF file.
const MAX_BYTES: u64 = 256 << 20;

/// Two targets of one point that differ by less than this part of the mesh's diagonal are one target: decimal copies
/// of coordinates differ in their last digits, wishes differ by more.
const SAME_TARGET: f64 = 1e-9;

/// Held surface points in ascending order, each once, with their targets in world space.
#[derive(Clone, Debug)]
pub(super) struct Handles {
    pub(super) held: Vec<VertexId>,
    pub(super) targets: Vec<DVec3>,
}

/// One thing that names vertices in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Fixed(usize),
    Moved(usize),
    Group(usize, usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Fixed(index) => write!(f, "fixed[{index}]"),
            Place::Moved(index) => write!(f, "moved[{index}].vertex"),
            Place::Group(group, index) => write!(f, "groups[{group}].vertices[{index}]"),
        }
    }
}

#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub(super) struct HandlesError {
    path: PathBuf,
    problem: Problem,
}

#[derive(Debug, thiserror::Error)]
enum Problem {
    #[error("cannot read: {0}")]
    Unreadable(std::io::Error),
    #[error("larger than {} MiB, which no handles file needs to be", MAX_BYTES >> 20)]
    TooLarge,
    #[error("not a handles file: {0}")]
    Malformed(serde_json::Error),
    #[error("no handles at all; name at least one vertex under \"fixed\", \"moved\" or \"groups\"")]
    NoHandles,
    #[error("{place} is {vertex}, but the mesh has {n_vertices} vertices (0 to {last})", last = n_vertices - 1)]
    OutOfRange { place: Place, vertex: u64, n_vertices: usize },
    #[error("groups[{group}].matrix has {got} numbers instead of 16")]
    MatrixLength { group: usize, got: usize },
    #[error("groups[{group}].matrix has the last row {row:?} instead of 0, 0, 0, 1; write it column by column")]
    MatrixRow { group: usize, row: [f64; 4] },
    #[error("{place} is {vertex}, whose target has a coordinate that is not a number up to {LARGEST_COORDINATE:e}")]
    TooFar { place: Place, vertex: u64 },
    #[error(
        "{second} (vertex {second_vertex}) and {first} (vertex {first_vertex}) are one point of the surface but go to two places; give it one target"
    )]
    Conflict { first: Place, first_vertex: u64, second: Place, second_vertex: u64 },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileContent {
    #[serde(default)]
    fixed: Vec<u64>,
    #[serde(default)]
    moved: Vec<Object<Moved>>,
    #[serde(default)]
    groups: Vec<Object<Group>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Moved {
    vertex: u64,
    to: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Group {
    vertices: Vec<u64>,
    matrix: Vec<f64>,
}

/// A value that must be written with its keys: derived code would also take `[17, [0, 0, 0]]` for a moved vertex.
struct Object<T>(T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Object<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Keys<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Keys<T> {
            type Value = Object<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object with keys")
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Object<T>, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(Object)
            }
        }
        deserializer.deserialize_map(Keys(PhantomData))
    }
}

/// Reads and checks the handles of `mesh` from the file at `path`.
pub(super) fn read(path: &Path, mesh: &MeshFile) -> Result<Handles, HandlesError> {
    let parse_all = || {
        let bytes = read_bytes(path)?;
        parse(&bytes, mesh)
    };
    parse_all().map_err(|problem| HandlesError { path: path.to_owned(), problem })
}

fn read_bytes(path: &Path) -> Result<Vec<u8>, Problem> {
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(Problem::Unreadable)?;
    let n_read = file.take(MAX_BYTES + 1).read_to_end(&mut bytes).map_err(Problem::Unreadable)?;
    if n_read as u64 > MAX_BYTES {
        return Err(Problem::TooLarge);
    }
    Ok(bytes)
}

fn parse(bytes: &[u8], mesh: &MeshFile) -> Result<Handles, Problem> {
    // Some editors on Windows put a byte order mark in front.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let Object::<FileContent>(content) = serde_json::from_slice(bytes).map_err(Problem::Malformed)?;
    let mut collected = Collected::new(mesh);
    for (index, &vertex) in content.fixed.iter().enumerate() {
        collected.hold(Place::Fixed(index), vertex, |rest| rest)?;
    }
    for (index, Object(moved)) in content.moved.iter().enumerate() {
        collected.hold(Place::Moved(index), moved.vertex, |_| DVec3::from_array(moved.to))?;
    }
    for (number, Object(group)) in content.groups.iter().enumerate() {
        let matrix = affine(number, &group.matrix)?;
        for (index, &vertex) in group.vertices.iter().enumerate() {
            collected.hold(Place::Group(number, index), vertex, |rest| matrix.transform_point3(rest))?;
        }
    }
    collected.finish()
}

/// 16 numbers, column by column, whose last row is that of an affine map.
fn affine(group: usize, numbers: &[f64]) -> Result<DMat4, Problem> {
    let columns: &[f64; 16] = numbers.try_into().map_err(|_| Problem::MatrixLength { group, got: numbers.len() })?;
    let matrix = DMat4::from_cols_array(columns);
    let row = matrix.row(3).to_array();
    if row == [0.0, 0.0, 0.0, 1.0] { Ok(matrix) } else { Err(Problem::MatrixRow { group, row }) }
}

/// Held points so far, each with the first thing that named it.
struct Collected<'a> {
    mesh: &'a MeshFile,
    tolerance: f64,
    points: BTreeMap<u32, (DVec3, Place, u64)>,
}

impl<'a> Collected<'a> {
    fn new(mesh: &'a MeshFile) -> Self {
        let (min, max) = bounds_of(&mesh.positions);
        Collected { mesh, tolerance: SAME_TARGET * (max - min).length(), points: BTreeMap::new() }
    }

    fn hold(&mut self, place: Place, vertex: u64, target: impl FnOnce(DVec3) -> DVec3) -> Result<(), Problem> {
        let n_vertices = self.mesh.positions.len();
        let index = usize::try_from(vertex).ok().filter(|&index| index < n_vertices);
        let index = index.ok_or(Problem::OutOfRange { place, vertex, n_vertices })?;
        let point = self.mesh.weld.point_of_vertex[index];
        // The rest position of the point, not of the vertex: welded vertices then agree to the last bit.
        let rest = self.mesh.positions[self.mesh.weld.vertex_of_point[point as usize] as usize];
        let target = target(rest);
        // Not (a coordinate > limit): one that is not a number is too far as well.
        if !target.to_array().iter().all(|coordinate| coordinate.abs() <= LARGEST_COORDINATE) {
            return Err(Problem::TooFar { place, vertex });
        }
        let &mut (present, first, first_vertex) = self.points.entry(point).or_insert((target, place, vertex));
        // Not (distance > tolerance): a distance that overflows is a conflict too.
        if present == target || present.distance(target) <= self.tolerance {
            Ok(())
        } else {
            Err(Problem::Conflict { first, first_vertex, second: place, second_vertex: vertex })
        }
    }

    fn finish(self) -> Result<Handles, Problem> {
        if self.points.is_empty() {
            return Err(Problem::NoHandles);
        }
        let held = self.points.keys().map(|&point| VertexId(point)).collect();
        let targets = self.points.values().map(|&(target, ..)| target).collect();
        Ok(Handles { held, targets })
    }
}

#[cfg(test)]
mod tests;
