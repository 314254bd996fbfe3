//! A new OBJ file of a mesh that came from elsewhere.

use crate::formats::Output;
use crate::formats::outlines::Outlines;
use crate::shape::{Corner, Material, NONE, Shape};
use crate::{SaveError, files};
use std::collections::HashSet;
use std::fmt::Write;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Writes text that depends on the shape alone, and a material library where there are materials.
pub(crate) fn write(shape: &Shape, to: &Path) -> Result<Output, SaveError> {
    let mut text = String::new();
    let mut beside = Vec::new();
    let names = material_names(&shape.materials);
    if !shape.materials.is_empty() {
        let mark = mark(to);
        let library = library_for(to, &mark);
        let name = library.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        line(&mut text, format_args!("mtllib {name}"));
        beside.push((library, material_library(&mark, &names, &shape.materials).into_bytes()));
    }
    write_lists(&mut text, shape);
    let outlines = Outlines::of(&shape.triangles, &shape.polygons);
    for part in &shape.parts {
        line(&mut text, format_args!("o {}", one_line(&part.name)));
        if let Some(name) = part.material.and_then(|m| names.get(m)) {
            line(&mut text, format_args!("usemtl {name}"));
        }
        for face in outlines.of_range(part.triangles.clone()) {
            text.push('f');
            for &corner in face {
                text.push(' ');
                text.push_str(&corner_text(corner));
            }
            text.push('\n');
        }
    }
    Ok(Output { bytes: text.into_bytes(), beside, warnings: Vec::new(), origin: None })
}

fn line(text: &mut String, content: std::fmt::Arguments<'_>) {
    text.write_fmt(content).expect("strings can be written");
    text.push('\n');
}

fn write_lists(text: &mut String, shape: &Shape) {
    for (i, p) in shape.positions.iter().enumerate() {
        match &shape.colors {
            Some(colors) => {
                let [r, g, b, _] = colors[i];
                line(text, format_args!("v {} {} {} {r} {g} {b}", p.x, p.y, p.z));
            }
            None => line(text, format_args!("v {} {} {}", p.x, p.y, p.z)),
        }
    }
    for uv in &shape.uvs {
        line(text, format_args!("vt {} {}", uv.x, uv.y));
    }
    for n in &shape.normals {
        line(text, format_args!("vn {} {} {}", n.x, n.y, n.z));
    }
}

fn corner_text(corner: Corner) -> String {
    let number = |index: u32| u64::from(index) + 1;
    let v = number(corner.vertex);
    match (corner.uv, corner.normal) {
        (NONE, NONE) => format!("{v}"),
        (uv, NONE) => format!("{v}/{}", number(uv)),
        (NONE, normal) => format!("{v}//{}", number(normal)),
        (uv, normal) => format!("{v}/{}/{}", number(uv), number(normal)),
    }
}

/// The first line of a library that belongs to `to` and may go when `to` is written again.
fn mark(to: &Path) -> String {
    let name = to.file_name().unwrap_or_default().to_string_lossy();
    format!("# Materials of {}, written by Pliant\n", one_line(&name))
}

/// The material library that [`write()`] may write beside `to`.
pub(crate) fn beside(to: &Path) -> Vec<PathBuf> {
    vec![library_for(to, &mark(to))]
}

/// Where the library of `to` goes: `NAME.mtl`, or beside a library of another model `NAME-2.mtl` and so on.
fn library_for(to: &Path, mark: &str) -> PathBuf {
    let first = to.with_extension("mtl");
    if !belongs_to_another(&first, mark) {
        return first;
    }
    let stem = to.file_stem().unwrap_or_default();
    let numbered = |i: u32| {
        let mut name = stem.to_owned();
        name.push(format!("-{i}.mtl"));
        to.with_file_name(name)
    };
    // A folder holds fewer files than there are numbers.
    (2..=u32::MAX).map(numbered).find(|path| !belongs_to_another(path, mark)).unwrap_or(first)
}

fn belongs_to_another(library: &Path, mark: &str) -> bool {
    if !files::is_taken(library) {
        return false;
    }
    // Asked before opening: opening a pipe without a writer waits for ever.
    if !library.is_file() {
        return true;
    }
    let mut start = Vec::new();
    let read = File::open(library).and_then(|file| file.take(mark.len() as u64).read_to_end(&mut start));
    read.is_err() || start != mark.as_bytes()
}

/// A name for each material, on one line, and of two that would be alike the second with a number.
fn material_names(materials: &[Material]) -> Vec<String> {
    let given: HashSet<String> = materials.iter().map(|material| one_line(&material.name)).collect();
    let (mut used, mut number) = (HashSet::new(), 1);
    let unique = |material: &Material| {
        let name = one_line(&material.name);
        let mut unique = name.clone();
        while (unique != name && given.contains(&unique)) || !used.insert(unique.clone()) {
            number += 1;
            unique = format!("{name}.{number}");
        }
        unique
    };
    materials.iter().map(unique).collect()
}

fn material_library(mark: &str, names: &[String], materials: &[Material]) -> String {
    let mut text = mark.to_owned();
    for (name, material) in names.iter().zip(materials) {
        let [r, g, b, alpha] = material.base_color;
        line(&mut text, format_args!("newmtl {name}\nKd {r} {g} {b}\nd {alpha}"));
    }
    text
}

/// A name that fits a line and can be told from a missing one.
fn one_line(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() || c == '\\' { '_' } else { c }).collect();
    let name = name.trim();
    if name.is_empty() { "unnamed".into() } else { name.into() }
}
