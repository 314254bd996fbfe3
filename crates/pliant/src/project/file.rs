//! Projects to and from the disk.

use std::fs;
use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use super::container::{Block, Reader, Refusal, VERSION, Writer};
use super::error::Flaw;
use super::mesh::{Mesh, MeshChoice, MeshRecord, Progress};
use super::record::{self, CameraRecord};
use super::scene::{self, SceneRecord};
use super::{EXTENSION, ProjectError};
use crate::document::{Document, Model, Pose, Scene, Snapshot};
use crate::viewport::Camera;

/// Bytes of a project: twice the largest mesh that is opened.
const FILE_BYTES: u64 = 4 << 30;
/// Bytes of a header: a million groups.
const HEADER_BYTES: usize = 256 << 20;
/// Bytes of the settings, which are read before it is known what they are: hundreds of times what they take.
const SETTINGS_BYTES: usize = 1 << 20;
/// Share of reading the project in the work of opening it; the mesh takes the rest (by eye).
const READING: f64 = 0.15;

/// What is saved.
#[derive(Clone)]
pub struct Contents {
    /// The opened mesh.
    pub model: Arc<Model>,
    /// What the user made of it.
    pub snapshot: Snapshot,
    /// The number of the next group.
    pub next_group: u32,
    /// The eye.
    pub camera: Camera,
    /// Settings of tools and picture, as the editor writes them.
    pub settings: serde_json::Value,
    /// How the mesh goes into the project.
    pub mesh: Mesh,
    /// The project that an autosave belongs to.
    pub belongs_to: Option<PathBuf>,
}

impl Contents {
    /// What a document holds now, seen from `camera`.
    pub fn of(document: &Document, camera: Camera) -> Contents {
        Contents {
            model: document.model().clone(),
            snapshot: document.snapshot(),
            next_group: document.next_group().0,
            camera,
            settings: serde_json::Value::Null,
            mesh: Mesh::Packed,
            belongs_to: None,
        }
    }
}

/// What was read.
pub struct Loaded {
    /// The mesh.
    pub model: Model,
    /// What the user had made of it.
    pub scene: Scene,
    /// Where its surface was.
    pub pose: Pose,
    /// The number of the next group.
    pub next_group: u32,
    /// The eye, unless it was lost.
    pub camera: Option<Camera>,
    /// Settings of tools and picture.
    pub settings: serde_json::Value,
    /// How the mesh lies in the project.
    pub mesh: Mesh,
}

/// What an autosave is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Summary {
    /// Name of the mesh.
    pub name: String,
    /// When it was written.
    pub saved_at: SystemTime,
    /// The project it belongs to.
    pub belongs_to: Option<PathBuf>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Header {
    /// Who wrote it, for people.
    #[serde(default)]
    program: String,
    /// Seconds since 1970.
    #[serde(default)]
    saved_at: u64,
    name: String,
    #[serde(default)]
    belongs_to: Option<String>,
    mesh: MeshRecord,
    scene: SceneRecord,
    #[serde(default)]
    next_group: u32,
    pose: Block,
    #[serde(default)]
    camera: Option<CameraRecord>,
    #[serde(default)]
    settings: Option<Block>,
}

/// Whether a path is that of a project, by its ending.
pub fn is_project(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(EXTENSION))
}

/// Writes a project, whole or not at all. Returns what could not be done as wished.
pub fn save(contents: &Contents, to: &Path) -> Result<Vec<String>, ProjectError> {
    let mut writer = Writer::default();
    let mut warnings = Vec::new();
    let settings = serde_json::to_vec(&contents.settings).unwrap_or_default();
    let camera = CameraRecord::of(&contents.camera);
    let header = Header {
        program: format!("Pliant {}", env!("CARGO_PKG_VERSION")),
        saved_at: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
        name: contents.model.name.clone(),
        belongs_to: contents.belongs_to.as_deref().and_then(Path::to_str).map(str::to_owned),
        mesh: MeshRecord::put(&mut writer, &contents.model, contents.mesh, to, &mut warnings),
        scene: SceneRecord::put(&mut writer, &contents.snapshot.scene),
        next_group: contents.next_group,
        pose: record::put_points(&mut writer, contents.snapshot.pose.positions.iter().copied()),
        // What is not a number cannot be written as one.
        camera: camera.camera().is_some().then_some(camera),
        settings: (settings.len() <= SETTINGS_BYTES).then(|| writer.put(settings)),
    };
    let too_large = |what| ProjectError::TooLarge { path: to.to_owned(), what };
    let header = serde_json::to_vec(&header).map_err(|_| too_large("numbers that are not finite"))?;
    if header.len() > HEADER_BYTES {
        return Err(too_large("so many handles"));
    }
    if writer.length() + header.len() as u64 > FILE_BYTES {
        return Err(too_large("so large a mesh and its files: link the mesh instead of packing it; 4 GiB"));
    }
    pliant_meshfile::replace_file(to, |file| writer.write(&header, file))?;
    Ok(warnings)
}

/// Opens a project. `progress` is told the fraction that is done, and stops by a break; the error then does not matter.
pub fn open(path: &Path, choice: &MeshChoice, progress: &mut Progress<'_>) -> Result<Loaded, ProjectError> {
    let reader = read(path, &mut |fraction| progress(READING * fraction))?;
    let header = header(&reader, path)?;
    let broken = |flaw: Flaw| flaw.in_project(path);
    let mesh = header.mesh.kind();
    let named = (header.name.as_str(), choice);
    let mut model =
        header.mesh.open(&reader, path, named, &mut |fraction| progress(READING + (1.0 - READING) * fraction))?;
    model.name = header.name;
    let n_points = model.mesh.n_vertices();
    let scene = header.scene.scene(&reader, n_points, Scene::new(&model)).map_err(broken)?;
    let next_group = scene::next_group(&scene, header.next_group).map_err(broken)?;
    let pose = Pose { positions: scene::pose(&reader, header.pose, n_points).map_err(broken)?.into() };
    let settings = match header.settings {
        Some(block) => reader.bytes(block, "settings").map_err(broken)?,
        None => &[],
    };
    let settings = if settings.len() > SETTINGS_BYTES { &[] } else { settings };
    let settings = serde_json::from_slice(settings).unwrap_or_default();
    let camera = header.camera.and_then(|camera| camera.camera());
    Ok(Loaded { model, scene, pose, next_group, camera, settings, mesh })
}

/// What a project is about, if every byte of it is as it was written.
pub fn summary(path: &Path) -> Result<Summary, ProjectError> {
    let reader = read(path, &mut |_| ControlFlow::Continue(()))?;
    let header = header(&reader, path)?;
    let saved_at = UNIX_EPOCH + std::time::Duration::from_secs(header.saved_at.min(u64::from(u32::MAX) * 4));
    Ok(Summary { name: header.name, saved_at, belongs_to: header.belongs_to.map(PathBuf::from) })
}

fn header(reader: &Reader, path: &Path) -> Result<Header, ProjectError> {
    let bytes = reader.header().map_err(|flaw| flaw.in_project(path))?;
    if bytes.len() > HEADER_BYTES {
        return Err(Flaw::new("its header is too large").in_project(path));
    }
    let unreadable = |error: serde_json::Error| Flaw(format!("its header cannot be read: {error}")).in_project(path);
    serde_json::from_slice(bytes).map_err(unreadable)
}

/// Bytes read between two looks at whether they are still wanted.
const PIECE: u64 = 4 << 20;

fn read(path: &Path, progress: &mut Progress<'_>) -> Result<Reader, ProjectError> {
    let failed = |source| ProjectError::Read { path: path.to_owned(), source };
    let other = |text: &str| failed(std::io::Error::other(text.to_owned()));
    // Asked before opening: opening a pipe without a writer waits for ever.
    let metadata = fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        return Err(other("it is not a regular file"));
    }
    if metadata.len() > FILE_BYTES {
        return Err(other("it is larger than a project can be (4 GiB)"));
    }
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(metadata.len() as usize).map_err(|error| failed(std::io::Error::other(error)))?;
    let mut file = fs::File::open(path).map_err(failed)?.take(FILE_BYTES);
    while file.by_ref().take(PIECE).read_to_end(&mut bytes).map_err(failed)? > 0 {
        if progress(bytes.len() as f64 / metadata.len().max(1) as f64).is_break() {
            return Err(other("opening it was canceled"));
        }
    }
    Reader::new(bytes).map_err(|refusal| match refusal {
        Refusal::NotAProject => ProjectError::NotAProject { path: path.to_owned() },
        Refusal::Newer(found) => ProjectError::Newer { path: path.to_owned(), found, known: VERSION },
        Refusal::Damaged(flaw) => flaw.in_project(path),
    })
}
