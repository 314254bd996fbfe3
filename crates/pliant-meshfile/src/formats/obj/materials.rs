//! Material libraries beside an OBJ file.

use super::parse::Parsed;
use crate::mesh_file::NO_MATERIAL;
use crate::shape::Material;
use crate::{Warning, budget, files};
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// The materials the file uses, in the order of their first use, with base colors from its libraries where they can
/// be read inside `folder`.
pub(super) fn load(parsed: &mut Parsed, folder: Option<&Path>) -> Vec<Material> {
    let unknown = |name: &String| Material { name: name.clone(), base_color: NO_MATERIAL };
    let mut materials: Vec<Material> = parsed.material_names.iter().map(unknown).collect();
    let mut libraries = parsed.libraries.clone();
    // A file that names one library a million times is read once.
    let mut seen = HashSet::new();
    libraries.retain(|library| seen.insert(library.clone()));
    for library in libraries.iter().take(MAX_LIBRARIES) {
        match read_library(folder, library) {
            Ok(known) => apply(&mut materials, &known),
            Err(reason) => {
                let shown = crate::rigidity::quoted(library);
                parsed.warnings.push(Warning(format!("material library {shown} skipped: {reason}")));
            }
        }
    }
    materials
}

/// Libraries looked at in one file; real files name one.
const MAX_LIBRARIES: usize = 64;

fn read_library(folder: Option<&Path>, library: &str) -> Result<Vec<tobj::Material>, String> {
    let bytes = files::read_beside(folder, library, budget::TEXT_BYTES)?;
    // The parser takes UTF-8 and line feeds only, and lets one wrong number spoil the file.
    let text = String::from_utf8_lossy(&bytes).replace('\r', "\n");
    let kept = |line: &&str| {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("newmtl") => words.next().is_some(),
            Some("Kd") => words.clone().count() >= 3 && words.take(3).all(|w| w.parse::<f32>().is_ok()),
            Some("d") => words.next().is_some_and(|w| w.parse::<f32>().is_ok()),
            _ => false,
        }
    };
    let text: String = text.lines().filter(kept).flat_map(|line| [line, "\n"]).collect();
    let (materials, _) = tobj::load_mtl_buf(&mut text.as_bytes()).map_err(|error| error.to_string())?;
    Ok(materials)
}

fn apply(materials: &mut [Material], known: &[tobj::Material]) {
    let by_name: HashMap<&str, &tobj::Material> = known.iter().rev().map(|m| (m.name.as_str(), m)).collect();
    for material in materials {
        if let Some(found) = by_name.get(material.name.as_str()) {
            let [r, g, b] = found.diffuse.unwrap_or([NO_MATERIAL[0]; 3]);
            material.base_color = [r, g, b, found.dissolve.unwrap_or(1.0)].map(|x| if x.is_finite() { x } else { 1.0 });
        }
    }
}
