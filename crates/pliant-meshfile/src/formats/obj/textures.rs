//! Pictures of the materials (`map_Kd`).

use super::source::ObjSource;
use super::text::Statement;
use crate::rigidity::quoted;
use crate::shape::{NO_MATERIAL, NONE};
use crate::textures::{Gatherer, Run, Textures, Wrapping};
use glam::Vec2;

/// What a library says of a material's picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Map {
    /// Its file, beside the library.
    file: String,
    /// Whether its edge goes on beyond it.
    is_clamped: bool,
}

impl Map {
    /// Out of a `map_Kd` statement of a library in this folder beside the model (empty: the model's own). Options are
    /// passed over but for `-clamp on`; what follows is a name, with blanks perhaps.
    pub(super) fn parse(statement: Statement<'_>, library_folder: &str) -> Option<Map> {
        let words: Vec<String> =
            statement.words().skip(1).map(|word| String::from_utf8_lossy(word.bytes).into_owned()).collect();
        let (mut at, mut is_clamped) = (0, false);
        while let Some(option) = words.get(at).filter(|word| word.starts_with('-') && word.len() > 1) {
            let most = match option.as_str() {
                "-o" | "-s" | "-t" => 3,
                "-mm" => 2,
                _ => 1,
            };
            is_clamped |= option == "-clamp" && words.get(at + 1).is_some_and(|word| word == "on");
            let is_number = |word: &&String| word.parse::<f64>().is_ok();
            let n_numbers = words[at + 1..].iter().take(most).take_while(is_number).count();
            at += 1 + if most == 1 { 1 } else { n_numbers };
        }
        let name = words.get(at..)?.join(" ").replace('\\', "/");
        let name = name.strip_prefix("./").unwrap_or(&name);
        let file = format!("{library_folder}{name}");
        (!name.is_empty()).then_some(Map { file, is_clamped })
    }
}

/// The pictures of a file on its triangles. A picture takes the place of the material's color: exporters leave black or
/// gray there.
pub(super) fn textures(source: &ObjSource) -> Textures {
    let mut gatherer = Gatherer::new();
    let mut known: Vec<(&Map, Option<usize>)> = Vec::new();
    let mut pictures = Vec::new();
    for map in &source.maps {
        let picture = map.as_ref().filter(|_| !source.uvs.is_empty()).and_then(|map| {
            if let Some((_, picture)) = known.iter().find(|(other, _)| *other == map) {
                return *picture;
            }
            let wrapping = if map.is_clamped { Wrapping::Clamp } else { Wrapping::Repeat };
            let bytes = gatherer.read(source.folder.as_ref(), &map.file);
            let picture = gatherer.take(quoted(&map.file), bytes, ([wrapping; 2], None));
            known.push((map, picture));
            picture
        });
        pictures.push(picture);
    }
    let runs = source.parts.iter().map(|part| {
        let picture = part.material.and_then(|material| pictures.get(material).copied().flatten());
        let color = part.material.map_or(NO_MATERIAL, |material| source.materials[material].base_color);
        let tint = if picture.is_some() { [1.0; 4] } else { color };
        Run { triangles: part.triangles.clone(), picture, tint }
    });
    let uvs = || {
        let corner = |&(uv, _): &(u32, u32)| if uv == NONE { Vec2::ZERO } else { source.uvs[uv as usize] };
        source.corners.iter().map(|corners| corners.each_ref().map(corner)).collect()
    };
    gatherer.on(runs.collect(), source.corners.len(), uvs)
}
