//! `pliant …` as a function call: the same entry as the program's, with its streams caught.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use pliant::cli::{Console, main_with};
use tempfile::TempDir;

use crate::shapes::Vector;

/// What one run of the program left behind.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Exit code.
    pub code: u8,
    /// Standard output.
    pub out: String,
    /// Standard error.
    pub err: String,
}

impl Outcome {
    /// Panics unless the run succeeded.
    #[track_caller]
    pub fn expect_done(self) -> Self {
        assert_eq!(self.code, 0, "exit code\nout: {}\nerr: {}", self.out, self.err);
        self
    }
}

/// Runs `pliant` with these arguments, without the program's own name.
pub fn pliant<I>(arguments: I) -> Outcome
where
    I: IntoIterator,
    I::Item: Into<OsString>,
{
    let arguments = arguments.into_iter().map(Into::into);
    let arguments: Vec<OsString> = [OsString::from("pliant")].into_iter().chain(arguments).collect();
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let code = main_with(arguments, &mut Console::new(&mut out, &mut err, false));
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("only text is written");
    Outcome { code, out: text(out), err: text(err) }
}

/// A folder of its own for one test, removed afterwards.
#[derive(Debug)]
pub struct Folder(TempDir);

impl Default for Folder {
    fn default() -> Self {
        Self::new()
    }
}

impl Folder {
    /// A new, empty folder.
    pub fn new() -> Self {
        Folder(tempfile::tempdir().expect("the system's folder for temporary files"))
    }

    /// The path of a file in it, as text for a command line.
    pub fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("names in tests are text").to_owned()
    }

    /// Writes a file and returns its path.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a new file in a new folder");
        path
    }

    /// Names of everything in it, sorted.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("a folder that exists");
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.expect("a readable entry").file_name();
        let mut names: Vec<String> = entries.map(|entry| name(entry).to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// The JSON in a file.
pub fn read_json(path: impl AsRef<Path>) -> serde_json::Value {
    let bytes = std::fs::read(path.as_ref()).expect("a file written before");
    serde_json::from_slice(&bytes).expect("JSON")
}

/// Positions of a mesh file's vertices, as the file layer reads them.
pub fn read_positions(path: impl Into<PathBuf>) -> Vec<Vector> {
    let file = pliant_meshfile::open(&path.into()).expect("a mesh written before");
    file.positions.iter().map(|position| position.to_array()).collect()
}

/// The text of a handles file that sends each vertex to its target.
pub fn handles_json(handles: &[(usize, Vector)]) -> String {
    let moved: Vec<_> = handles.iter().map(|(vertex, to)| serde_json::json!({ "vertex": vertex, "to": to })).collect();
    serde_json::json!({ "moved": moved }).to_string()
}
