//! A new OBJ file of a mesh that came from elsewhere.

use super::super::Output;
use crate::SaveError;
use crate::shape::{Corner, Material, NONE, Shape};
use std::fmt::Write;
use std::path::Path;

/// Writes text that depends on the shape alone, and a material library where there are materials.
pub(crate) fn write(shape: &Shape, to: &Path) -> Result<Output, SaveError> {
    let library = to.with_extension("mtl");
    let mut text = String::new();
    let mut beside = Vec::new();
    if !shape.materials.is_empty() {
        let name = library.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        line(&mut text, format_args!("mtllib {name}"));
        beside.push((library, material_library(&shape.materials).into_bytes()));
    }
    write_lists(&mut text, shape);
    for part in &shape.parts {
        line(&mut text, format_args!("o {}", one_line(&part.name)));
        if let Some(material) = part.material.and_then(|m| shape.materials.get(m)) {
            line(&mut text, format_args!("usemtl {}", one_line(&material.name)));
        }
        for triangle in &shape.triangles[part.triangles.clone()] {
            let [a, b, c] = triangle.map(corner_text);
            line(&mut text, format_args!("f {a} {b} {c}"));
        }
    }
    Ok(Output { bytes: text.into_bytes(), beside, warnings: Vec::new() })
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

fn material_library(materials: &[Material]) -> String {
    let mut text = String::new();
    for material in materials {
        let [r, g, b, alpha] = material.base_color;
        line(&mut text, format_args!("newmtl {}\nKd {r} {g} {b}\nd {alpha}", one_line(&material.name)));
    }
    text
}

/// A name that fits a line and can be told from a missing one.
fn one_line(name: &str) -> String {
    let name: String = name.chars().map(|c| if c.is_control() || c == '\\' { '_' } else { c }).collect();
    let name = name.trim();
    if name.is_empty() { "unnamed".into() } else { name.into() }
}
