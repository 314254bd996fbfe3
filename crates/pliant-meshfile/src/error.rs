//! What can go wrong, each as one line: which file, where in it, what to do.

use std::fmt;
use std::path::PathBuf;

/// Why a file was not opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// The file system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The name ends like no format that is known.
    #[error(
        "{}: not a mesh file by its name; OBJ (.obj), glTF (.gltf), GLB (.glb), PLY (.ply), STL (.stl) and OFF (.off) can be opened",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
    },
    /// The content is not usable.
    #[error("{}: {fault}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: Fault,
    },
}

impl OpenError {
    /// Whether the caller asked for it, so that nothing is wrong with the file.
    pub fn is_canceled(&self) -> bool {
        matches!(self, OpenError::Content { fault: Fault::Canceled, .. })
    }
}

/// What is wrong with the content of a file.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// Something at a place is not as the format demands.
    #[error("{place}: {problem}")]
    Malformed {
        /// Where: a line, an accessor, a vertex.
        place: String,
        /// What is wrong there.
        problem: String,
    },
    /// The file does not start as its format demands, or breaks off.
    #[error("{0}")]
    Container(String),
    /// A format was read without error but holds no triangle.
    #[error("holds no faces: there is no surface to deform")]
    Empty,
    /// More than the program is willing to hold.
    #[error("{found} {what} are more than the limit of {limit}")]
    Budget {
        /// What was counted.
        what: &'static str,
        /// How many the file has or claims.
        found: u64,
        /// How many are accepted.
        limit: u64,
    },
    /// A regular file was expected.
    #[error("is not a regular file")]
    NotAFile,
    /// One rigidity per vertex was expected.
    #[error("holds {found} rigidities, the mesh has {expected} vertices: one per vertex is needed")]
    RigidityCount {
        /// Entries in the file.
        found: usize,
        /// File vertices of the mesh.
        expected: usize,
    },
    /// A sidecar that was read for its name alone.
    #[error("{fault}; it is read because it lies beside {mesh}: correct, rename or delete it")]
    Sidecar {
        /// Name of the mesh file.
        mesh: String,
        /// What is wrong with the sidecar.
        fault: Box<Fault>,
    },
    /// A rigidity that is no whole number from 1 to 1000.
    #[error("entry {entry} is {value}: a rigidity is a whole number from 1 to 1000")]
    Rigidity {
        /// Index of the entry, from 0.
        entry: usize,
        /// The value found, as text.
        value: String,
    },
    /// The caller no longer wanted the file.
    #[error("opening it was canceled")]
    Canceled,
    /// Welding within a distance took all of the surface.
    #[error("welding within {distance} leaves no surface: no triangle is that large; choose a smaller distance")]
    WeldedAway {
        /// The distance, in the file's units.
        distance: f64,
    },
    /// A mesh file was given for its rigidity and carries none.
    #[error("carries no rigidity (no _RIGIDITY attribute, rigidity property or sidecar)")]
    NoRigidity,
}

impl Fault {
    pub(crate) fn at(place: impl Into<String>, problem: impl Into<String>) -> Fault {
        Fault::Malformed { place: place.into(), problem: problem.into() }
    }

    pub(crate) fn in_file(self, path: impl Into<PathBuf>) -> OpenError {
        OpenError::Content { path: path.into(), fault: self }
    }
}

/// Why a file was not saved. Unless the error says otherwise, nothing was written or touched.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file system refused.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The target.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The mesh is saved, but a file that belongs to it could not take its name.
    #[error(
        "{}: saved, but {} could not be replaced: {source}; what belongs there waits in a hidden file beside it, save again",
        path.display(), beside.display()
    )]
    Unfinished {
        /// The target.
        path: PathBuf,
        /// The file beside it.
        beside: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The name ends like no format that can be written.
    #[error("{}: not a mesh file by its name; use .obj, .gltf, .glb, .ply, .stl or .off", path.display())]
    UnknownFormat {
        /// The target.
        path: PathBuf,
    },
    /// The number of surface points or rigidities does not fit the mesh.
    #[error("{}: not saved: {found} {what} were given for {expected} surface points", path.display())]
    Count {
        /// The target.
        path: PathBuf,
        /// What was counted.
        what: &'static str,
        /// How many were given.
        found: usize,
        /// How many the mesh has.
        expected: usize,
    },
    /// A coordinate that is not finite, or not in the range of the file's numbers.
    #[error("{}: not saved: the position of vertex {vertex} is not finite or too large for the format", path.display())]
    NotFinite {
        /// The target.
        path: PathBuf,
        /// File vertex, from 0.
        vertex: usize,
    },
    /// A rigidity outside 1 to 1000.
    #[error("{}: not saved: rigidity {value} of surface point {point} is not from 1 to 1000", path.display())]
    Rigidity {
        /// The target.
        path: PathBuf,
        /// Surface point, from 0.
        point: usize,
        /// The value given.
        value: u16,
    },
    /// The format cannot hold that much.
    #[error("{}: not saved: {bytes} bytes are more than a GLB file can hold (4 GiB)", path.display())]
    TooLarge {
        /// The target.
        path: PathBuf,
        /// Bytes needed.
        bytes: u64,
    },
    /// More text than would be read again.
    #[error("{}: not saved: its {bytes} bytes of JSON could not be opened again ({limit} at most); save as .glb", path.display())]
    TooMuchText {
        /// The target.
        path: PathBuf,
        /// Bytes needed.
        bytes: u64,
        /// Bytes that are read.
        limit: u64,
    },
    /// Several shapes cannot be put into that file.
    #[error("{}: not saved: {reason}", path.display())]
    NoMorphs {
        /// The target.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// A document that could not be encoded.
    #[error("{}: not saved: {reason}", path.display())]
    Encode {
        /// The target.
        path: PathBuf,
        /// Why.
        reason: String,
    },
}

/// Something a person should know about a file that was opened or saved: one sentence, printed by `Display`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning(
    /// The sentence.
    pub String,
);

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}
