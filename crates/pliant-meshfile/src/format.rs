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
    /// Polygon File Format of Stanford, text or binary.
    Ply,
    /// Triangles without sharing, text or binary.
    Stl,
    /// Object File Format of Geomview, text.
    Off,
}

impl Format {
    const ALL: [Format; 6] = [Format::Obj, Format::Gltf, Format::Glb, Format::Ply, Format::Stl, Format::Off];

    /// Endings of the files that can be opened, for dialogs.
    pub const EXTENSIONS: &[&str] = &{
        let mut extensions = [""; Format::ALL.len()];
        let mut i = 0;
        while i < extensions.len() {
            extensions[i] = Format::ALL[i].extension();
            i += 1;
        }
        extensions
    };

    /// The ending of its files' names, without the dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Format::Obj => "obj",
            Format::Gltf => "gltf",
            Format::Glb => "glb",
            Format::Ply => "ply",
            Format::Stl => "stl",
            Format::Off => "off",
        }
    }

    /// Whether its files are always text, so that what they begin with can tell the encoding.
    pub(crate) const fn is_text(self) -> bool {
        matches!(self, Format::Obj | Format::Gltf | Format::Off)
    }

    /// The format of a file by the ending of its name, upper or lower case.
    pub fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?.to_str()?;
        Format::ALL.into_iter().find(|format| format.extension().eq_ignore_ascii_case(extension))
    }
}
