//! The same OFF text with other numbers in its vertices.

use super::OffSource;
use super::read::vertex_words;
use crate::formats::words::{Word, Words, shortest, shortest_single};
use crate::formats::{Edit, Output, turning};
use crate::normals;
use glam::DQuat;

/// The file again; a number is touched only if it changed.
pub(super) fn rewrite(source: &OffSource, edit: &Edit<'_>) -> Output {
    let moved = (0..edit.positions.len()).any(|vertex| edit.moved(vertex));
    let bytes = if moved { with_changes(source, edit) } else { source.bytes.clone() };
    Output { bytes, beside: Vec::new(), warnings: Vec::new(), origin: None }
}

fn with_changes(source: &OffSource, edit: &Edit<'_>) -> Vec<u8> {
    let bytes = &source.bytes;
    let turns: Vec<Option<DQuat>> =
        if source.header.has.normals { turning::vertex_turns(edit, &source.normals) } else { Vec::new() };
    let mut out = Vec::with_capacity(bytes.len() + bytes.len() / 8);
    let mut copied = 0;
    let mut replace = |word: &Word<'_>, text: String| {
        out.extend_from_slice(&bytes[copied..word.start]);
        out.extend_from_slice(text.as_bytes());
        copied = word.end();
    };
    let mut words = Words::new(bytes, source.header.body, true);
    let mut row = Vec::new();
    for (vertex, new) in edit.positions.iter().enumerate() {
        vertex_words(&mut words, &source.header, &mut row).expect("the file was read before");
        let old = edit.mesh.positions[vertex];
        for axis in (0..3).filter(|&axis| new[axis] != old[axis]) {
            replace(&row[axis], shortest(new[axis]));
        }
        if let Some(turn) = turns.get(vertex).copied().flatten() {
            let normal = normals::turned(source.normals[vertex], turn);
            (0..3).for_each(|axis| replace(&row[3 + axis], shortest_single(normal[axis])));
        }
    }
    out.extend_from_slice(&bytes[copied..]);
    out
}
