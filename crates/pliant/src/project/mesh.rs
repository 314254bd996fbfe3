//! The mesh of a project: packed into it, or linked to where it lies.
//!
//! A link is a path from the project's folder, with the length and a checksum of the file. It is followed when it is such a
//! path (not absolute, not to another drive or machine) and leads to a regular file of that length; a file with another
//! checksum is not used unless a person says so. The full path it had is only shown, so that it can be found again.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use pliant_meshfile::{MeshFile, OpenOptions, Pack, Welding};
use serde::{Deserialize, Serialize};

use super::ProjectError;
use super::container::{Block, Reader, Writer};
use super::error::Flaw;
use super::record;
use crate::document::{Model, ModelError};

/// How a mesh goes into a project.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mesh {
    /// Its file, with all that refers to, inside the project.
    #[default]
    Packed,
    /// By its place on the disk.
    Linked,
}

/// Which mesh a linked project is opened with.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum MeshChoice {
    /// The one it names, if that is still the same.
    #[default]
    Named,
    /// This one, whatever has become of it.
    Chosen(PathBuf),
}

/// Told the fraction that is done; answers whether to go on.
pub(super) type Progress<'a> = dyn FnMut(f64) -> ControlFlow<()> + Send + 'a;

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct MeshRecord {
    #[serde(default)]
    welding: WeldingRecord,
    /// Surface points.
    points: u64,
    source: SourceRecord,
}

#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum SourceRecord {
    Packed {
        name: String,
        bytes: Block,
        beside: Vec<(String, Block)>,
    },
    Linked {
        /// From the project's folder, with forward slashes.
        path: String,
        /// Where that was, for people.
        was: String,
        length: u64,
        checksum: u32,
    },
    /// A mesh that no file held.
    Lists {
        positions: Block,
        triangles: Block,
    },
}

#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum WeldingRecord {
    #[default]
    Exact,
    Within(f64),
    Never,
}

impl From<Welding> for WeldingRecord {
    fn from(welding: Welding) -> WeldingRecord {
        match welding {
            Welding::Exact => WeldingRecord::Exact,
            Welding::Within(distance) => WeldingRecord::Within(distance),
            Welding::Never => WeldingRecord::Never,
        }
    }
}

impl WeldingRecord {
    fn welding(self) -> Result<Welding, Flaw> {
        match self {
            WeldingRecord::Exact => Ok(Welding::Exact),
            WeldingRecord::Never => Ok(Welding::Never),
            WeldingRecord::Within(distance) if distance.is_finite() && distance >= 0.0 => Ok(Welding::Within(distance)),
            WeldingRecord::Within(_) => Err(Flaw::new("its welding distance is no length")),
        }
    }
}

impl MeshRecord {
    /// Puts the mesh of `model` into the project that is saved as `project`. What could not be done as wished is said.
    pub(super) fn put(
        writer: &mut Writer,
        model: &Model,
        wish: Mesh,
        project: &Path,
        warnings: &mut Vec<String>,
    ) -> MeshRecord {
        let file = &model.file;
        let linked = match wish {
            Mesh::Packed => None,
            Mesh::Linked => match link(file, project) {
                Ok(source) => Some(source),
                Err(why) => {
                    warnings.push(format!("the mesh was packed into the project: {why}"));
                    None
                }
            },
        };
        let source = linked.unwrap_or_else(|| pack(writer, file, warnings));
        MeshRecord { welding: file.welding.into(), points: model.mesh.n_vertices() as u64, source }
    }

    /// Whether it lies in the project.
    pub(super) fn kind(&self) -> Mesh {
        match self.source {
            SourceRecord::Linked { .. } => Mesh::Linked,
            SourceRecord::Packed { .. } | SourceRecord::Lists { .. } => Mesh::Packed,
        }
    }

    /// Opens the mesh. `name` is for one that no file held.
    pub(super) fn open(
        &self,
        reader: &Reader,
        project: &Path,
        (name, choice): (&str, &MeshChoice),
        progress: &mut Progress<'_>,
    ) -> Result<Model, ProjectError> {
        let broken = |flaw: Flaw| flaw.in_project(project);
        let unusable = |source: ModelError| ProjectError::Mesh { path: project.to_owned(), source };
        let options = OpenOptions { welding: self.welding.welding().map_err(broken)?, keep: true };
        let mut of = None;
        let file = match (&self.source, choice) {
            (SourceRecord::Packed { name, bytes, beside }, _) => {
                let pack = unpacked(reader, name, *bytes, beside).map_err(broken)?;
                options.open_pack(&pack, progress).map_err(|error| unusable(error.into()))?
            }
            (SourceRecord::Lists { positions, triangles }, _) => {
                lists(reader, name, *positions, *triangles).map_err(broken)?
            }
            (SourceRecord::Linked { .. }, MeshChoice::Chosen(mesh)) => {
                of = Some(mesh.clone());
                options.open_with_progress(mesh, progress).map_err(|error| unusable(error.into()))?
            }
            (SourceRecord::Linked { path, was, length, checksum }, MeshChoice::Named) => {
                let mesh = followed(project, path, was, *length)?;
                let file = options.open_with_progress(&mesh, progress).map_err(|error| unusable(error.into()))?;
                if file.original_bytes().is_none_or(|bytes| crc32fast::hash(bytes) != *checksum) {
                    return Err(ProjectError::MeshChanged { path: project.to_owned(), mesh });
                }
                of = Some(mesh);
                file
            }
        };
        let model = Model::from_file(file).map_err(unusable)?;
        let (found, expected) = (model.mesh.n_vertices(), self.points as usize);
        match of {
            _ if found == expected => Ok(model),
            Some(mesh) => Err(ProjectError::OtherMesh { mesh, found, expected }),
            None => Err(broken(Flaw(format!("its mesh has {found} vertices, {expected} are stated")))),
        }
    }
}

fn pack(writer: &mut Writer, file: &MeshFile, warnings: &mut Vec<String>) -> SourceRecord {
    let Some((pack, missing)) = file.pack() else {
        return SourceRecord::Lists {
            positions: record::put_points(writer, file.positions.iter().copied()),
            triangles: record::put_triangles(writer, &file.triangles),
        };
    };
    warnings.extend(missing.iter().map(ToString::to_string));
    let bytes = writer.put(pack.bytes);
    let beside = pack.beside.into_iter().map(|(name, bytes)| (name, writer.put(bytes))).collect();
    SourceRecord::Packed { name: pack.name, bytes, beside }
}

fn unpacked(reader: &Reader, name: &str, bytes: Block, beside: &[(String, Block)]) -> Result<Pack, Flaw> {
    let mut files = BTreeMap::new();
    let mut taken = 0_usize;
    for (name, block) in beside {
        let bytes = reader.bytes(*block, name)?;
        // One block can be named any number of times.
        taken += bytes.len();
        if taken > reader.length() {
            return Err(Flaw::new("the files in it overlap"));
        }
        files.insert(name.clone(), Arc::new(bytes.to_vec()));
    }
    Ok(Pack { name: name.to_owned(), bytes: Arc::new(reader.bytes(bytes, "the mesh")?.to_vec()), beside: files })
}

fn lists(reader: &Reader, name: &str, positions: Block, triangles: Block) -> Result<MeshFile, Flaw> {
    let positions = record::points(reader, positions, "vertices of the mesh")?;
    let triangles = record::triangles(reader, triangles)?;
    if triangles.is_empty() {
        return Err(Flaw::new("its mesh has no faces"));
    }
    let n_vertices = positions.len();
    if triangles.iter().flatten().any(|&v| v as usize >= n_vertices) {
        return Err(Flaw::new("a face of its mesh names a vertex that does not exist"));
    }
    Ok(MeshFile::from_triangles(name, positions, triangles))
}

/// A link to the file of a mesh, or why there can be none.
fn link(file: &MeshFile, project: &Path) -> Result<SourceRecord, &'static str> {
    let path = file.path.as_deref().ok_or("no file holds it")?;
    let bytes = file.original_bytes().ok_or("it was not kept")?;
    let now = std::fs::metadata(path).ok().filter(|now| now.is_file() && now.len() == bytes.len() as u64);
    let is_same = now.is_some() && std::fs::read(path).is_ok_and(|now| now == bytes);
    if !is_same {
        return Err("its file is no longer what was opened");
    }
    let full = path.canonicalize().map_err(|_| "its file cannot be found")?;
    let folder = project.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().map_err(|_| "the project's folder cannot be found")?;
    let path = relative(&folder, &full).ok_or("no path leads from the project to it")?;
    let (length, checksum) = (bytes.len() as u64, crc32fast::hash(bytes));
    Ok(SourceRecord::Linked { path, was: full.to_string_lossy().into_owned(), length, checksum })
}

/// The way from a folder to a file, both in full, with forward slashes.
fn relative(folder: &Path, file: &Path) -> Option<String> {
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let mut steps = vec![".."; from.len() - shared];
    for component in &to[shared..] {
        match component {
            Component::Normal(name) => steps.push(name.to_str()?),
            _ => return None,
        }
    }
    let path = steps.join("/");
    steps_of(&path).map(|_| path)
}

/// The steps of a path that is followed: names and `..`, nothing that leads to another drive or machine.
fn steps_of(path: &str) -> Option<PathBuf> {
    let is_step = |step: &str| !step.is_empty() && step != "." && !step.contains(['\\', ':', '\0']);
    path.split('/').all(is_step).then(|| path.split('/').collect())
}

/// The file a link leads to, if it is there with the length it had.
fn followed(project: &Path, path: &str, was: &str, length: u64) -> Result<PathBuf, ProjectError> {
    let missing = |mesh: PathBuf| ProjectError::MeshMissing { path: project.to_owned(), mesh };
    let steps = steps_of(path).ok_or_else(|| missing(PathBuf::from(was)))?;
    let mesh = project.parent().unwrap_or(Path::new("")).join(steps);
    match std::fs::metadata(&mesh) {
        Ok(found) if found.is_file() && found.len() == length => Ok(mesh),
        Ok(found) if found.is_file() => Err(ProjectError::MeshChanged { path: project.to_owned(), mesh }),
        _ => Err(missing(mesh)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_is_a_path_from_the_project_and_never_leads_to_another_machine() {
        let at = |folder: &str, file: &str| relative(Path::new(folder), Path::new(file));
        assert_eq!(at("/a/b", "/a/b/m.obj").as_deref(), Some("m.obj"));
        assert_eq!(at("/a/b", "/a/c/m.obj").as_deref(), Some("../c/m.obj"));
        assert_eq!(at("/a", "/a/b/c/m.obj").as_deref(), Some("b/c/m.obj"));
        for bad in ["/etc/m.obj", "//host/m.obj", "\\\\host\\m.obj", "c:m.obj", "a//b.obj", "", "./m.obj", "a\0.obj"] {
            assert_eq!(steps_of(bad), None, "{bad:?} would be followed");
        }
    }
}
