//! The formats by name.

use std::path::Path;

/// A way of storing meshes in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ, text.
    Obj,
    /// glTF 2.0, JSON with buffers beside or inside it.
    Gltf,
    /// glTF 2.0, one binary file.
    Glb,
}

impl Format {
    const ALL: [Format; 3] = [Format::Obj, Format::Gltf, Format::Glb];

    /// Endings of the files that can be opened, for dialogs.
    pub const EXTENSIONS: &[&str] = &[Format::Obj.extension(), Format::Gltf.extension(), Format::Glb.extension()];

    /// The ending of its files' names, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Format::Obj => "obj",
            Format::Gltf => "gltf",
            Format::Glb => "glb",
        }
    }

    /// The format of a file by the ending of its name, upper or lower case.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?;
        Format::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }
}
