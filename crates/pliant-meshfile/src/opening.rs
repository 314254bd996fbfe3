//! The ways in: a file or bytes, opened as is wished.

use crate::folder::Folder;
use crate::formats::{Input, entry};
use crate::pack::{Original, Pack, file_name};
use crate::saving::{Known, Unfinished};
use crate::watch::{Stage, watched};
use crate::{Fault, Format, MeshFile, OpenError, Welding, budget, files, rigidity};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// What a caller may choose about opening a file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OpenOptions {
    /// Which file vertices become one surface point.
    pub welding: Welding,
    /// Whether the file is kept in memory as it is, with all it refers to, for [`MeshFile::pack`].
    pub keep: bool,
}

/// Opens a mesh file, its format chosen by the ending of its name, with exact welding.
///
/// References are followed inside the file's folder only. Errors name the file, the place in it and what is wrong.
pub fn open(path: &Path) -> Result<MeshFile, OpenError> {
    OpenOptions::default().open(path)
}

/// Opens a mesh file from memory; `name` stands for its path in messages. No references but data URIs are followed.
pub fn from_bytes(bytes: &[u8], format: Format, name: &str) -> Result<MeshFile, OpenError> {
    OpenOptions::default().from_bytes(bytes, format, name)
}

/// Shares of the work, by what they were measured to take of an OBJ file of a million vertices: reading the bytes,
/// making a mesh of them, welding.
const READ: f64 = 0.1;
const WELD: f64 = 0.8;

impl OpenOptions {
    /// Opens a mesh file, its format chosen by the ending of its name.
    ///
    /// References are followed inside the file's folder only. Errors name the file, the place in it and what is wrong.
    pub fn open(&self, path: &Path) -> Result<MeshFile, OpenError> {
        self.open_with_progress(path, &mut |_| ControlFlow::Continue(()))
    }

    /// The same, while `progress` is told the fraction that is done, ascending up to 1, and stops the opening by
    /// answering [`ControlFlow::Break`]: the error then is [`OpenError::is_canceled`]. It is called from any of the
    /// threads that work but one at a time, every few milliseconds.
    pub fn open_with_progress(
        &self,
        path: &Path,
        progress: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    ) -> Result<MeshFile, OpenError> {
        watched(progress, |stage| self.open_in_stages(path, stage))
    }

    /// Opens a mesh file from memory; `name` stands for its path in messages. No references but data URIs are followed.
    pub fn from_bytes(&self, bytes: &[u8], format: Format, name: &str) -> Result<MeshFile, OpenError> {
        let input = Input { bytes: bytes.to_vec(), folder: None, unfinished: None, name, stage: Stage::unwatched() };
        let mut file = self.read(input, format).map_err(|fault| fault.in_file(name))?;
        if self.keep {
            let (bytes, folder) = (Arc::new(bytes.to_vec()), Folder::packed(Default::default()));
            file.original = Some(Arc::new(Original { bytes, folder, name: file_name(name, format) }));
        }
        Ok(file)
    }

    /// Opens a mesh file that was packed with all it refers to. What is not in the pack is not looked for elsewhere.
    pub fn open_pack(
        &self,
        pack: &Pack,
        progress: &mut (dyn FnMut(f64) -> ControlFlow<()> + Send),
    ) -> Result<MeshFile, OpenError> {
        watched(progress, |stage| self.open_pack_in_stages(pack, stage))
    }

    fn open_pack_in_stages(&self, pack: &Pack, stage: Stage<'_>) -> Result<MeshFile, OpenError> {
        let path = Path::new(&pack.name);
        let format = Format::of(path).ok_or_else(|| OpenError::UnknownFormat { path: path.to_owned() })?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let folder = Folder::packed(pack.beside.clone());
        let bytes = pack.bytes.to_vec();
        let input = Input { bytes, folder: Some(&folder), unfinished: None, name: &name, stage };
        let mut file = self.read(input, format).map_err(|fault| fault.in_file(path))?;
        let sidecar = rigidity::sidecar_of(path).to_string_lossy().into_owned();
        if entry(format).rigidity_in_sidecar
            && let Some(bytes) = pack.beside.get(&sidecar)
        {
            file.rigidity = Some(parsed_sidecar(bytes, &file, path).map_err(|fault| fault.in_file(&sidecar))?);
        }
        if self.keep {
            file.original = Some(Arc::new(Original { bytes: pack.bytes.clone(), folder, name: pack.name.clone() }));
        }
        stage.tell(1, 1).map_err(|fault| fault.in_file(path))?;
        Ok(file)
    }

    fn open_in_stages(&self, path: &Path, stage: Stage<'_>) -> Result<MeshFile, OpenError> {
        let Some(format) = Format::of(path) else {
            return Err(match std::fs::metadata(path) {
                Err(source) => OpenError::Read { path: path.to_owned(), source },
                Ok(_) => OpenError::UnknownFormat { path: path.to_owned() },
            });
        };
        let bytes = files::read_in_stages(path, budget::FILE_BYTES, stage.part(0.0, READ))?;
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let unfinished = Unfinished::of(path, &bytes);
        let folder = Folder::on_disk(files::folder_of(path), self.keep);
        let kept = self.keep.then(|| Arc::new(bytes.clone()));
        let input = Input {
            bytes,
            folder: Some(&folder),
            unfinished: unfinished.as_ref(),
            name: &name,
            stage: stage.part(READ, 1.0),
        };
        let mut file = self.read(input, format).map_err(|fault| fault.in_file(path))?;
        file.path = Some(path.to_owned());
        file.known = Known::opened(path);
        if entry(format).rigidity_in_sidecar {
            read_sidecar(&mut file, path, &folder, unfinished.as_ref())?;
        }
        if let Some(bytes) = kept {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            file.original = Some(Arc::new(Original { bytes, folder, name }));
        }
        stage.tell(1, 1).map_err(|fault| fault.in_file(path))?;
        Ok(file)
    }

    fn read(&self, input: Input<'_>, format: Format) -> Result<MeshFile, Fault> {
        let stage = input.stage;
        if format.is_text() && [[0xfe, 0xff], [0xff, 0xfe]].iter().any(|mark| input.bytes.starts_with(mark)) {
            return Err(Fault::Container("is text in UTF-16: save it as UTF-8 in a text editor and open that".into()));
        }
        let input = Input { stage: stage.part(0.0, WELD), ..input };
        let opened = (entry(format).read)(input)?;
        if opened.triangles.is_empty() {
            return Err(Fault::Empty);
        }
        MeshFile::welded(format, opened, self.welding, stage.part(WELD, 1.0))
    }
}

/// A sidecar that is broken is an error, since saving over it would lose it.
fn read_sidecar(
    file: &mut MeshFile,
    mesh: &Path,
    folder: &Folder,
    unfinished: Option<&Unfinished>,
) -> Result<(), OpenError> {
    let sidecar = rigidity::sidecar_of(mesh);
    let waiting = unfinished.and_then(|unfinished| unfinished.temporary_of(sidecar.file_name()?));
    let name = sidecar.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let sidecar = waiting.map_or(sidecar, Path::to_owned);
    if !files::is_taken(&sidecar) {
        return Ok(());
    }
    let read = files::read_inside(files::folder_of(&sidecar), &sidecar, budget::TEXT_BYTES);
    let rigidity = read
        .map_err(|reason| in_sidecar(Fault::Container(format!("cannot be read: {reason}")), mesh))
        .inspect(|bytes| folder.keep(&name, bytes))
        .and_then(|bytes| parsed_sidecar(&bytes, file, mesh))
        .map_err(|fault| fault.in_file(&sidecar))?;
    file.rigidity = Some(rigidity);
    Ok(())
}

fn parsed_sidecar(bytes: &[u8], file: &MeshFile, mesh: &Path) -> Result<Vec<u16>, Fault> {
    rigidity::parse(bytes, file.positions.len()).map_err(|fault| in_sidecar(fault, mesh))
}

fn in_sidecar(fault: Fault, mesh: &Path) -> Fault {
    let mesh = mesh.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Fault::Sidecar { mesh, fault: Box::new(fault) }
}
