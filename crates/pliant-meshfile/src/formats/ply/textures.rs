//! The picture that a comment of the header names: `comment TextureFile brick.png`, as MeshLab writes it.

use super::PlySource;
use crate::formats::Before;
use crate::rigidity::quoted;
use crate::shape::NO_MATERIAL;
use crate::textures::{Gatherer, Run, Textures, Wrapping};
use glam::Vec2;

/// The picture of a file on all its triangles.
pub(super) fn textures(source: &PlySource, mesh: Before<'_>) -> Textures {
    let mut gatherer = Gatherer::new();
    let refuse = |why: &str| {
        let told = source.header.pictures.iter().map(|name| format!("{} ({why})", quoted(name)));
        Textures { missing: told.collect(), ..Textures::default() }
    };
    let (name, uvs) = match (&source.header.pictures[..], mesh.uvs) {
        ([], _) => return Textures::default(),
        ([_, _, ..], _) => return refuse("which of several pictures belongs to a face is not read"),
        (_, None) => return refuse("the vertices have no texture coordinates"),
        ([name], Some(uvs)) => (name, uvs),
    };
    let bytes = gatherer.read(source.folder.as_ref(), name);
    let picture = gatherer.take(quoted(name), bytes, ([Wrapping::Repeat; 2], None));
    let n_triangles = mesh.triangles.len();
    let runs = vec![Run { triangles: 0..n_triangles, picture, tint: NO_MATERIAL }];
    let corner = |&vertex: &u32| uvs.get(vertex as usize).copied().unwrap_or(Vec2::ZERO);
    gatherer.on(runs, n_triangles, || mesh.triangles.iter().map(|t| t.each_ref().map(corner)).collect())
}
