//! OFF files into geometry.

use super::header::Header;
use crate::formats::faces::{self, Cut, Faces};
use crate::formats::words::{Word, Words};
use crate::watch::{PIECE, Stage};
use crate::{Fault, Warning, budget};
use glam::{DVec3, Vec2, Vec3};

/// What is read of a file. Lists have an entry a vertex, or are empty.
pub(super) struct Parsed {
    pub(super) header: Header,
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) uvs: Vec<Vec2>,
    pub(super) colors: Vec<[f32; 4]>,
    pub(super) cut: Cut,
    /// Whether faces have colors.
    pub(super) faces_more: bool,
    pub(super) warnings: Vec<Warning>,
}

/// Numbers of a vertex that may follow one another: position, normal, color, texture coordinates.
const MOST: usize = 3 + 3 + 4 + 2;

/// Reads a vertex or face a line, as programs write them and as colors need it; where that fails, numbers on whatever
/// lines, which the format allows too.
pub(super) fn parse(bytes: &[u8], stage: Stage<'_>) -> Result<Parsed, Fault> {
    parse_as(bytes, false, stage).or_else(|fault| match fault {
        Fault::Canceled => Err(fault),
        _ => parse_as(bytes, true, stage).map_err(|_| fault),
    })
}

fn parse_as(bytes: &[u8], free: bool, stage: Stage<'_>) -> Result<Parsed, Fault> {
    let header = Header::parse(bytes, free)?;
    if free && header.has.colors {
        return Err(Fault::Empty);
    }
    budget::check("vertices", header.n_vertices, budget::VERTICES)?;
    budget::check("faces", header.n_faces, budget::TRIANGLES)?;
    header.check_room(bytes.len())?;
    let mut out = Parsed {
        positions: Vec::new(),
        normals: Vec::new(),
        uvs: Vec::new(),
        colors: Vec::new(),
        cut: Faces::new(0).cut(&[]),
        faces_more: false,
        warnings: Vec::new(),
        header,
    };
    out.positions.reserve_exact(out.header.n_vertices as usize);
    let mut words = Words::new(bytes, out.header.body, true);
    out.vertices(&mut words, stage)?;
    out.faces(&mut words, stage)?;
    Ok(out)
}

/// The words of the next vertex: those that have to be there, and what else its line holds.
pub(super) fn vertex_words<'a>(words: &mut Words<'a>, header: &Header, out: &mut Vec<Word<'a>>) -> Result<(), String> {
    out.clear();
    let n_needed = header.n_first() + if header.free && header.has.uvs { 2 } else { 0 };
    while out.len() < n_needed {
        out.push(words.anywhere().ok_or("the file breaks off")?);
    }
    while let Some(word) = if header.free { None } else { words.on_line() } {
        if out.len() == MOST {
            return Err(format!("has more than the {MOST} numbers that a vertex may have"));
        }
        out.push(word);
    }
    Ok(())
}

impl Parsed {
    fn vertices(&mut self, words: &mut Words<'_>, stage: Stage<'_>) -> Result<(), Fault> {
        let mut colors = Colors::default();
        let (mut row, mut undeclared) = (Vec::new(), false);
        for vertex in 0..self.header.n_vertices {
            if vertex.is_multiple_of(PIECE as u64) {
                stage.tell(words.at, words.bytes.len())?;
            }
            let read = vertex_words(words, &self.header, &mut row).and_then(|()| self.vertex(&row, &mut colors));
            let place = || format!("{}, vertex {vertex}", words.line(words.at));
            undeclared |= read.map_err(|problem| Fault::at(place(), problem))?;
        }
        self.colors = colors.finish();
        if undeclared {
            let text = "vertices have more numbers than the first line declares: these are kept and not read";
            self.warnings.push(Warning(text.into()));
        }
        Ok(())
    }

    /// Takes the numbers of one vertex; true where there are more than were declared.
    fn vertex(&mut self, row: &[Word<'_>], colors: &mut Colors) -> Result<bool, String> {
        let has = self.header.has;
        self.positions.push(DVec3::new(row[0].finite()?, row[1].finite()?, row[2].finite()?));
        let single = |word: &Word<'_>| word.number().map(|x| x as f32).filter(|x| x.is_finite()).unwrap_or(0.0);
        if has.normals {
            self.normals.push(Vec3::new(single(&row[3]), single(&row[4]), single(&row[5])));
        }
        let mut more = &row[self.header.n_first()..];
        if has.uvs {
            let (before, [u, v]) = more.split_last_chunk().ok_or("has no texture coordinates, which STOFF declares")?;
            self.uvs.push(Vec2::new(single(u), single(v)));
            more = before;
        }
        if has.colors {
            colors.push(&more[..more.len().min(4)]);
            return Ok(more.len() > 4);
        }
        Ok(!more.is_empty())
    }

    fn faces(&mut self, words: &mut Words<'_>, stage: Stage<'_>) -> Result<(), Fault> {
        let mut faces = Faces::new(self.positions.len());
        let mut corners = Vec::new();
        for face in 0..self.header.n_faces {
            if face.is_multiple_of(PIECE as u64) {
                stage.tell(words.at, words.bytes.len())?;
            }
            // What follows the corners on a line is a color.
            let mut read = || -> Result<(), String> {
                face_corners(words, &mut corners)?;
                if !self.header.free {
                    self.faces_more |= words.on_line().is_some();
                    words.rest_of_line();
                }
                faces.push(&corners)
            };
            read().map_err(|problem| Fault::at(format!("{}, face {face}", words.line(words.at)), problem))?;
        }
        self.cut = faces.cut(&self.positions);
        self.warnings.append(&mut self.cut.warnings);
        if self.cut.triangles.is_empty() {
            return Err(faces::none(self.positions.len(), ""));
        }
        if words.anywhere().is_some() {
            self.warnings.push(Warning("what follows the last face is kept and not read".into()));
        }
        Ok(())
    }
}

fn face_corners(words: &mut Words<'_>, out: &mut Vec<u32>) -> Result<(), String> {
    out.clear();
    let word = words.anywhere().ok_or("the file breaks off")?;
    let n = word.whole().ok_or_else(|| format!("{} is no number of corners", word.shown()))?;
    let left = words.bytes.len() - words.at;
    budget::check("corners of one polygon", n, budget::POLYGON_CORNERS).map_err(|fault| fault.to_string())?;
    // A blank and a digit each.
    if n.saturating_mul(2) > left as u64 {
        return Err(format!("says it has {n} corners, {left} bytes are left"));
    }
    for _ in 0..n {
        let word = words.anywhere().ok_or("the file breaks off")?;
        let corner = word.whole().and_then(|x| u32::try_from(x).ok());
        out.push(corner.ok_or_else(|| format!("{} is no number of a vertex", word.shown()))?);
    }
    Ok(())
}

/// Colors of vertices, of which only the whole file tells whether they run to 1 or to 255.
#[derive(Default)]
struct Colors {
    of_vertex: Vec<Option<[f32; 4]>>,
    has_point: bool,
    largest: f32,
}

impl Colors {
    /// Takes three or four numbers; one is an entry of a table that the file does not hold.
    fn push(&mut self, words: &[Word<'_>]) {
        let mut color = [f32::NAN; 4];
        for (slot, word) in color.iter_mut().zip(words) {
            let x = word.number().map(|x| x as f32).filter(|x| x.is_finite()).unwrap_or(0.0);
            self.has_point |= word.text.contains(&b'.');
            self.largest = self.largest.max(x);
            *slot = x;
        }
        self.of_vertex.push((words.len() >= 3).then_some(color));
    }

    fn finish(self) -> Vec<[f32; 4]> {
        let full = if self.has_point || self.largest <= 1.0 { 1.0 } else { 255.0 };
        let scaled = |x: f32| if x.is_nan() { 1.0 } else { x / full };
        self.of_vertex.into_iter().map(|color| color.map_or([1.0; 4], |color| color.map(scaled))).collect()
    }
}
