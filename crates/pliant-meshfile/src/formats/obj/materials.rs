//! Material libraries beside an OBJ file.

use super::parse::{MAX_LIBRARIES, Parsed};
use super::text::Statements;
use super::textures::Map;
use crate::folder::Folder;
use crate::saving::Unfinished;
use crate::shape::{Material, NO_MATERIAL};
use crate::{Warning, budget, files};
use std::collections::HashMap;

/// What is wanted of a material.
type Wanted<'a> = (&'a mut [f32; 4], &'a mut Option<Map>);

/// The materials the file uses, in the order of their first use, with base colors and pictures from its libraries where they can
/// be read inside `folder`.
pub(super) fn load(
    parsed: &mut Parsed,
    folder: Option<&Folder>,
    unfinished: Option<&Unfinished>,
) -> (Vec<Material>, Vec<Option<Map>>) {
    let unknown = |name: &String| Material { name: name.clone(), base_color: NO_MATERIAL };
    let mut materials: Vec<Material> = parsed.material_names.iter().map(unknown).collect();
    let mut maps: Vec<Option<Map>> = vec![None; materials.len()];
    let slots = materials.iter_mut().map(|material| &mut material.base_color).zip(&mut maps);
    let mut wanted: HashMap<&str, Wanted<'_>> = parsed.material_names.iter().map(String::as_str).zip(slots).collect();
    let mut left = budget::TEXT_BYTES;
    let mut read = |name: &str| -> Result<(), String> {
        let waiting = unfinished.and_then(|unfinished| unfinished.temporary_of(name.as_ref()));
        let folder = folder.ok_or("no folder to look in")?;
        let bytes = match (waiting, folder.path()) {
            (Some(waiting), Some(disk)) => {
                let bytes = files::read_inside(disk, waiting, left)?;
                folder.keep(name, &bytes);
                bytes
            }
            _ => folder.read(name, left)?,
        };
        left -= bytes.len() as u64;
        let beside = name.rfind('/').map_or("", |end| &name[..=end]);
        find(&mut wanted, &bytes, beside);
        Ok(())
    };
    for line in &parsed.libraries {
        // One file whose name may hold blanks, or else several with blanks between them.
        let Err(reason) = read(line) else { continue };
        let several = line.split_whitespace().take(MAX_LIBRARIES).map(|name| (name, read(name)));
        let (found, mut missing): (Vec<_>, Vec<_>) = several.partition(|(_, result)| result.is_ok());
        if found.is_empty() {
            missing = vec![(line, Err(reason))];
        }
        for (name, result) in missing {
            let shown = crate::rigidity::quoted(name);
            let reason = result.err().unwrap_or_default();
            parsed.warnings.push(Warning(format!("material library {shown} skipped: {reason}")));
        }
    }
    (materials, maps)
}

/// Takes what is `wanted` from a library that lies in this folder beside the model: the first of each name, and nothing else is
/// kept.
fn find<'a>(wanted: &mut HashMap<&'a str, Wanted<'a>>, library: &[u8], folder: &str) {
    let mut found: Option<Wanted<'a>> = None;
    for (statement, _) in Statements::new(library) {
        let mut words = statement.words();
        let Some(keyword) = words.next() else { continue };
        if keyword.bytes == b"newmtl" {
            found = wanted.remove(statement.rest().as_str());
        }
        let Some((color, map)) = &mut found else { continue };
        let mut next = || words.next().and_then(|word| word.number()).map(|x| x as f32).filter(|x| x.is_finite());
        match keyword.bytes {
            b"Kd" => {
                if let (Some(r), Some(g), Some(b)) = (next(), next(), next()) {
                    color[..3].copy_from_slice(&[r, g, b]);
                }
            }
            b"map_Kd" if map.is_none() => **map = Map::parse(statement, folder),
            b"d" => color[3] = next().unwrap_or(color[3]),
            _ => {}
        }
    }
}
