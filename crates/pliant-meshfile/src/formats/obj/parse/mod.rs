//! OBJ text into geometry.
//!
//! **Idea.** The text is cut at ends of statements into pieces that are read side by side ([`piece`]), and the pieces are
//! put together in order ([`assemble`]): only then is it known how many vertices come before one, which negative indices
//! count from, and which group goes on from the piece before. Where the cuts are changes nothing. A piece that meets
//! anything wrong gives up, and the text is read once more from its beginning in one piece, which finds what is wrong
//! first, at which line, with the numbers of the whole file.

mod assemble;
mod corner;
mod piece;

use super::text::{Statements, cuts};
use crate::shape::{NONE, ShapePart};
use crate::watch::Stage;
use crate::{Fault, Warning, budget};
use glam::{DVec3, Vec2, Vec3};
use piece::Piece;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering::Relaxed};

/// Geometry and names of an OBJ file. Every index is in range.
#[derive(Default)]
pub(super) struct Parsed {
    pub(super) positions: Vec<DVec3>,
    pub(super) colors: Option<Vec<[f32; 4]>>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) normals: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) corners: Vec<[(u32, u32); 3]>,
    pub(super) vertex_at: Vec<u64>,
    pub(super) normal_at: Vec<u64>,
    pub(super) parts: Vec<ShapePart>,
    /// Names used by `usemtl` for faces; `ShapePart::material` counts in it.
    pub(super) material_names: Vec<String>,
    pub(super) libraries: Vec<String>,
    /// Triangles that each face of more than three corners was cut into.
    pub(super) polygons: Vec<Range<u32>>,
    pub(super) skipped: Skipped,
    pub(super) warnings: Vec<Warning>,
}

/// How many elements the file has that are no faces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Skipped {
    /// Lines and points.
    pub(super) lines: usize,
    /// Free-form curves and surfaces.
    pub(super) curves: usize,
}

/// Libraries looked at in one file; real files name one.
pub(super) const MAX_LIBRARIES: usize = 64;

/// Bytes of a piece: about ten milliseconds of one core, after which it is asked whether the file is still wanted.
const PIECE_BYTES: usize = 1 << 20;
/// Statements read between two looks at that where there are no pieces.
const STATEMENTS: usize = 1 << 14;
/// Share of reading in the work, before what was read is put together.
const READ: f64 = 0.7;

pub(super) fn parse(bytes: &[u8], name: &str, stage: Stage<'_>) -> Result<Parsed, Fault> {
    parse_in_pieces(bytes, name, PIECE_BYTES, stage)
}

fn parse_in_pieces(bytes: &[u8], name: &str, size: usize, stage: Stage<'_>) -> Result<Parsed, Fault> {
    let cuts = cuts(bytes, size);
    if cuts.len() > 1 {
        let parsed = read_in_pieces(bytes, &cuts, stage.part(0.0, READ))
            .and_then(|pieces| assemble::assemble(bytes, name, pieces, stage.part(READ, 1.0)));
        if matches!(parsed, Ok(_) | Err(Fault::Canceled)) {
            return parsed;
        }
    }
    let mut piece = Piece::of_whole_text();
    let reading = stage.part(0.0, READ);
    for (i, (statement, line)) in Statements::new(bytes).enumerate() {
        if i % STATEMENTS == 0 {
            reading.tell(statement.start, bytes.len())?;
        }
        piece.statement(statement, line)?;
        if i % STATEMENTS == 0 {
            Counts::default().add(&piece)?;
        }
    }
    Counts::default().add(&piece)?;
    assemble::assemble(bytes, name, vec![piece], stage.part(READ, 1.0))
}

fn read_in_pieces(bytes: &[u8], cuts: &[Range<usize>], stage: Stage<'_>) -> Result<Vec<Piece>, Fault> {
    let (counts, n_done) = (Counts::default(), AtomicUsize::new(0));
    let read = |range: &Range<usize>| {
        let mut piece = if range.start == 0 { Piece::of_whole_text() } else { Piece::default() };
        for (statement, _) in Statements::within(bytes, range.clone()) {
            piece.statement(statement, 0)?;
        }
        counts.add(&piece)?;
        stage.tell(n_done.fetch_add(1, Relaxed) + 1, cuts.len())?;
        Ok(piece)
    };
    cuts.par_iter().map(read).collect()
}

/// What was read so far of what there are limits for.
#[derive(Default)]
struct Counts {
    vertices: AtomicU64,
    normals: AtomicU64,
    uvs: AtomicU64,
    triangles: AtomicU64,
}

impl Counts {
    /// Refuses what goes beyond a limit.
    fn add(&self, piece: &Piece) -> Result<(), Fault> {
        let n_triangles = piece.corners.len() - 2 * piece.faces.len();
        for (what, counter, n, limit) in [
            ("vertices", &self.vertices, piece.positions.len(), budget::VERTICES),
            ("normals", &self.normals, piece.normals.len(), budget::CORNERS),
            ("texture coordinates", &self.uvs, piece.uvs.len(), budget::CORNERS),
            ("triangles", &self.triangles, n_triangles, budget::TRIANGLES),
        ] {
            budget::check(what, counter.fetch_add(n as u64, Relaxed) + n as u64, limit)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What depends on the text alone: everything but the warnings' order, which is the same too.
    fn summary(parsed: Result<Parsed, Fault>) -> String {
        match parsed {
            Err(fault) => fault.to_string(),
            Ok(p) => {
                let bits: Vec<_> = p.positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect();
                let parts = format!("{:?} {:?} {:?} {:?}", p.parts, p.material_names, p.libraries, p.polygons);
                let lists = format!("{:?} {:?} {:?} {:?}", p.colors, p.uvs, p.normals, p.triangles);
                let rest = format!("{:?} {:?} {:?} {:?}", p.corners, p.vertex_at, p.normal_at, p.warnings);
                format!("{bits:?}\n{parts}\n{lists}\n{rest}")
            }
        }
    }

    #[test]
    fn where_the_text_is_cut_changes_nothing() {
        let good = "\u{feff}# start \\\nmtllib a b.mtl\no one\nv 0 0 0\nv 1 0 0 1 0 0\r\nv 1 \\\r\n1 0\rv 0 1 0\nvt 0 0\nvn 0 0 1\n\
                    f -4//-1 -3//-1 -2/-1\\\n/-1 -1\nusemtl red\nf 1 2 3\ng two\nusemtl blue\ng one\nusemtl red\nf 1 3 4\n\
                    usemtl blue\nf 1/1 2/9 3\nmtllib c.mtl\nf 1 2\nl 1 2\nv 0 0 1 0 0 0 1\ng\nf -1 -2 -3 -4 -5\n";
        let bad = [
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\nf 1 2 x\n",
            "v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\nf 1 2 3\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",
            "v 0 0 0\nv 1 0 0\nv 0 \\\n1\nv 0 nan 0\n",
            "v 0 0 0\n\n\nv 1 zero 0\n",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1/1 2 3\n",
        ];
        for text in [good].iter().chain(&bad) {
            let whole = summary(parse_in_pieces(text.as_bytes(), "name", usize::MAX, Stage::unwatched()));
            for size in 1..text.len() {
                let cut = summary(parse_in_pieces(text.as_bytes(), "name", size, Stage::unwatched()));
                assert_eq!(cut, whole, "cut into pieces of {size} bytes:\n{text}");
            }
        }
    }
}
