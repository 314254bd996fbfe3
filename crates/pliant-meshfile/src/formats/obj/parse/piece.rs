//! What one piece of OBJ text says, by itself.

use super::super::text::{Statement, Word, Words};
use super::corner::{CornerIndex, corner};
use super::{MAX_LIBRARIES, Skipped};
use crate::{Fault, budget};
use glam::{DVec3, Vec2, Vec3};

/// Lists of a piece, and what in them only the pieces before can complete.
#[derive(Default)]
pub(super) struct Piece {
    /// Whether nothing comes before it.
    from_start: bool,
    pub(super) positions: Vec<DVec3>,
    pub(super) colored: Vec<(u32, [f32; 4])>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    /// Where each `v` statement begins in the text.
    pub(super) vertex_at: Vec<u64>,
    pub(super) normal_at: Vec<u64>,
    /// The first corner of each face; faces may name vertices that come later.
    pub(super) faces: Vec<u32>,
    /// Lines of the faces, in a piece that starts at the first line.
    pub(super) lines: Vec<u32>,
    pub(super) corners: Vec<CornerIndex>,
    /// Corners, and the places in them, that count from the start of the piece.
    pub(super) relative: Vec<(u32, u8)>,
    /// Where the name or the material changes.
    pub(super) changes: Vec<Change>,
    /// Of what follows the last face.
    pub(super) pending: Change,
    pub(super) libraries: Vec<String>,
    pub(super) n_thin: usize,
    pub(super) skipped: Skipped,
}

/// The statements that name group and material of the faces from one on, if any do.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Change {
    pub(super) first_face: u32,
    pub(super) name_at: Option<u64>,
    pub(super) material_at: Option<u64>,
}

impl Change {
    pub(super) fn is_any(&self) -> bool {
        self.name_at.is_some() || self.material_at.is_some()
    }
}

impl Piece {
    pub(super) fn of_whole_text() -> Piece {
        Piece { from_start: true, ..Piece::default() }
    }

    pub(super) fn statement(&mut self, statement: Statement<'_>, line: usize) -> Result<(), Fault> {
        let mut words = statement.words();
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.bytes {
            b"v" => self.vertex(statement, words, line)?,
            b"vn" => {
                let mut next = || finite(words.next().and_then(|w| w.number()));
                self.normals.push(Vec3::new(next(), next(), next()));
                self.normal_at.push(statement.start as u64);
            }
            b"vt" => {
                // One number is a coordinate along a line.
                let mut next = || finite(words.next().and_then(|w| w.number()));
                self.uvs.push(Vec2::new(next(), next()));
            }
            b"f" | b"fo" => self.face(words, line)?,
            b"o" | b"g" => self.pending.name_at = Some(statement.start as u64),
            b"usemtl" => self.pending.material_at = Some(statement.start as u64),
            b"mtllib" => {
                let library = statement.rest();
                if self.libraries.len() < MAX_LIBRARIES && !self.libraries.contains(&library) {
                    self.libraries.push(library);
                }
            }
            b"l" | b"p" => self.skipped.lines += 1,
            b"curv" | b"curv2" | b"surf" => self.skipped.curves += 1,
            _ => {}
        }
        Ok(())
    }

    fn vertex(&mut self, statement: Statement<'_>, mut words: Words<'_>, line: usize) -> Result<(), Fault> {
        let vertex = self.positions.len();
        let mut place = [0.0; 3];
        for (k, value) in place.iter_mut().enumerate() {
            *value = coordinate(words.next(), k)
                .map_err(|problem| Fault::at(format!("line {line}, vertex {vertex}"), problem))?;
        }
        // Four numbers are a weight, which means nothing for polygons; six or more end in a color.
        let mut more = words.take(4).filter_map(|word| word.number());
        if let (Some(r), Some(g), Some(b)) = (more.next(), more.next(), more.next()) {
            let alpha = more.next().unwrap_or(1.0);
            self.colored.push((vertex as u32, [r, g, b, alpha].map(|x| finite(Some(x)))));
        }
        self.positions.push(DVec3::from_array(place));
        self.vertex_at.push(statement.start as u64);
        Ok(())
    }

    fn face(&mut self, words: Words<'_>, line: usize) -> Result<(), Fault> {
        let first_corner = self.corners.len();
        let known = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for word in words {
            let at = self.corners.len() as u32;
            let corner = corner(&word, known, self.from_start, line, |k| self.relative.push((at, k as u8)))?;
            self.corners.push(corner);
            let n = self.corners.len() - first_corner;
            budget::check("corners of one polygon", n as u64, budget::POLYGON_CORNERS)?;
        }
        if self.corners.len() - first_corner < 3 {
            self.corners.truncate(first_corner);
            while self.relative.last().is_some_and(|&(corner, _)| corner as usize >= first_corner) {
                self.relative.pop();
            }
            self.n_thin += 1;
            return Ok(());
        }
        if self.pending.is_any() {
            let change = std::mem::take(&mut self.pending);
            self.changes.push(Change { first_face: self.faces.len() as u32, ..change });
        }
        self.faces.push(first_corner as u32);
        if self.from_start {
            self.lines.push(u32::try_from(line).unwrap_or(u32::MAX));
        }
        Ok(())
    }
}

/// Coordinate `k` of a vertex, or what is wrong with it.
fn coordinate(word: Option<Word<'_>>, k: usize) -> Result<f64, String> {
    let Some(word) = word else { return Err(format!("has {k} coordinates, 3 are needed")) };
    match word.number() {
        Some(number) if number.is_finite() => Ok(number),
        Some(_) => Err(format!("coordinate {} is not finite", word.shown())),
        None => Err(format!("{} is not a number", word.shown())),
    }
}

/// A number for display, zero where it is none that single precision holds.
fn finite(number: Option<f64>) -> f32 {
    number.map(|x| x as f32).filter(|x| x.is_finite()).unwrap_or(0.0)
}
