//! The same OBJ text with other numbers in its `v` and `vn` lines.

use super::source::ObjSource;
use super::text::statement_at;
use crate::formats::{Edit, Output};
use crate::shape::NONE;
use crate::{SaveError, Warning, normals};
use glam::Vec3;
use std::collections::HashMap;
use std::io::Write;
use std::path::Path;

/// The file again; a line is touched only if its vertex moved or its normal turned.
pub(super) fn rewrite(source: &ObjSource, edit: &Edit<'_>, to: &Path) -> Result<Output, SaveError> {
    let mut changes: Vec<(u64, [String; 3])> = Vec::new();
    for (vertex, (&at, position)) in source.vertex_at.iter().zip(&edit.positions).enumerate() {
        if edit.moved(vertex) {
            changes.push((at, position.to_array().map(|x| x.to_string())));
        }
    }
    let normals = turned_normals(source, edit);
    let mut warnings = stranded_libraries(source, to);
    warnings.extend(torn_normals(source, edit, &normals));
    for (&at, (normal, turned)) in source.normal_at.iter().zip(normals) {
        if turned {
            changes.push((at, normal.to_array().map(|x| x.to_string())));
        }
    }
    changes.sort_unstable_by_key(|change| change.0);
    let mut bytes = Vec::with_capacity(source.bytes.len() + changes.len() * 16);
    let mut copied = 0;
    for (at, numbers) in &changes {
        for (word, number) in statement_at(&source.bytes, *at as usize).words().skip(1).zip(numbers) {
            bytes.extend_from_slice(&source.bytes[copied..word.start]);
            write!(bytes, "{number}").expect("memory can be written");
            copied = word.end;
        }
    }
    bytes.extend_from_slice(&source.bytes[copied..]);
    Ok(Output { bytes, beside: Vec::new(), warnings, origin: None })
}

/// Every normal of the file for the new shape, and whether it changed.
///
/// A `vn` line may serve corners of several vertices (all corners of a flat side); it then turns with their faces
/// together.
pub(super) fn turned_normals(source: &ObjSource, edit: &Edit<'_>) -> Vec<(Vec3, bool)> {
    let mesh = edit.mesh;
    let cluster = |t: usize, k: usize| {
        let normal = source.corners[t][k].1;
        (normal != NONE).then_some(normal)
    };
    let turns = normals::turns(mesh.triangles, source.normals.len(), cluster, mesh.positions, &edit.positions);
    let apply = |(&normal, turn): (&Vec3, Option<_>)| match turn {
        Some(turn) => (normals::turned(normal, turn), true),
        None => (normal, false),
    };
    source.normals.iter().zip(turns).map(apply).collect()
}

/// Normals of one line that turn apart by less look alike.
const TORN_DEGREES: f32 = 5.0;

/// Says how many `vn` lines serve vertices that would turn them in different directions.
fn torn_normals(source: &ObjSource, edit: &Edit<'_>, of_line: &[(Vec3, bool)]) -> Option<Warning> {
    if !of_line.iter().any(|(_, turned)| *turned) {
        return None;
    }
    let triangles = &edit.mesh.triangles;
    // The normals as they would turn if each vertex had its own.
    let mut own: HashMap<(u32, u32), u32> = HashMap::new();
    let mut of_corner = Vec::with_capacity(triangles.len());
    for (triangle, corners) in triangles.iter().zip(&source.corners) {
        let mut number = |k: usize| {
            let next = own.len() as u32;
            *own.entry((triangle[k], corners[k].1)).or_insert(next)
        };
        of_corner.push([number(0), number(1), number(2)]);
    }
    let cluster = |t: usize, k: usize| Some(of_corner[t][k]);
    let turns = normals::turns(triangles, own.len(), cluster, edit.mesh.positions, &edit.positions);
    let mut torn: Vec<u32> = Vec::new();
    for ((_, normal), cluster) in own {
        let Some(&(shared, _)) = of_line.get(normal as usize) else { continue };
        let rest = source.normals[normal as usize];
        let alone = turns[cluster as usize].map_or(rest, |turn| normals::turned(rest, turn));
        if alone.angle_between(shared) > TORN_DEGREES.to_radians() {
            torn.push(normal);
        }
    }
    torn.sort_unstable();
    torn.dedup();
    let n = torn.len();
    let text = format!("shading is approximate where one vn line serves vertices that turn apart (lines: {n})");
    (n > 0).then_some(Warning(text))
}

fn stranded_libraries(source: &ObjSource, to: &Path) -> Vec<Warning> {
    let Some(folder) = &source.folder else { return Vec::new() };
    let Some(disk) = folder.path().filter(|_| !source.libraries.is_empty() && !folder.holds(to)) else {
        return Vec::new();
    };
    let names: Vec<String> = source.libraries.iter().map(|name| crate::rigidity::quoted(name)).collect();
    let text = format!(
        "the material library {} stays in {}: copy it beside the saved file to keep the materials",
        names.join(", "),
        disk.display()
    );
    vec![Warning(text)]
}
