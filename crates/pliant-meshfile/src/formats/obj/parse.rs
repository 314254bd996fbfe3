//! Statements of OBJ into geometry.

use super::text::{Statement, Statements, Word};
use crate::shape::{NONE, ShapePart};
use crate::{Fault, Warning, budget, polygon};
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;
use std::ops::Range;

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
    /// Names used by `usemtl`; `ShapePart::material` counts in it.
    pub(super) material_names: Vec<String>,
    pub(super) libraries: Vec<String>,
    /// Triangles that each face of more than three corners was cut into.
    pub(super) polygons: Vec<Range<u32>>,
    pub(super) warnings: Vec<Warning>,
}

/// A polygon, still by corners: faces may name vertices that come later.
struct Face {
    first_corner: usize,
    line: usize,
    group: u32,
}

/// Libraries looked at in one file; real files name one.
pub(super) const MAX_LIBRARIES: usize = 64;

/// Zero-based indices of vertex, texture coordinate and normal.
type CornerIndex = (u32, u32, u32);

#[derive(Default)]
struct Reader {
    out: Parsed,
    colored: Vec<(usize, [f32; 4])>,
    faces: Vec<Face>,
    corners: Vec<CornerIndex>,
    /// Groups that have faces.
    groups: Vec<(String, Option<usize>)>,
    /// Whether the name or the material changed since the last face.
    starts_group: bool,
    names: Option<budget::Purse>,
    name: String,
    material: Option<usize>,
    known_materials: HashMap<String, usize>,
    n_thin: usize,
}

pub(super) fn parse(bytes: &[u8], name: &str) -> Result<Parsed, Fault> {
    let mut reader = Reader { name: name.to_owned(), starts_group: true, ..Reader::default() };
    for (statement, line) in Statements::new(bytes) {
        reader.statement(statement, line)?;
    }
    reader.finish()
}

impl Reader {
    fn statement(&mut self, statement: Statement<'_>, line: usize) -> Result<(), Fault> {
        let mut words = statement.words();
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.bytes {
            b"v" => self.vertex(statement, line),
            b"vn" => {
                let [x, y, z] = numbers(words, line, "normal", true)?.map(|x| finite(Some(x)));
                budget::check("normals", self.out.normals.len() as u64 + 1, budget::CORNERS)?;
                self.out.normals.push(Vec3::new(x, y, z));
                self.out.normal_at.push(statement.start as u64);
                Ok(())
            }
            b"vt" => {
                // One number is a coordinate along a line.
                let mut next = || finite(words.next().and_then(|w| w.number()));
                budget::check("texture coordinates", self.out.uvs.len() as u64 + 1, budget::CORNERS)?;
                self.out.uvs.push(Vec2::new(next(), next()));
                Ok(())
            }
            b"f" | b"fo" => self.face(words, line),
            b"o" | b"g" => {
                self.name = budget::short_name(statement.rest());
                self.starts_group = true;
                Ok(())
            }
            b"usemtl" => {
                let name = statement.rest();
                let next = self.known_materials.len();
                let index = *self.known_materials.entry(name.clone()).or_insert(next);
                if index == next {
                    self.out.material_names.push(name);
                }
                self.material = Some(index);
                self.starts_group = true;
                Ok(())
            }
            b"mtllib" => {
                let library = statement.rest();
                if self.out.libraries.len() < MAX_LIBRARIES && !self.out.libraries.contains(&library) {
                    self.out.libraries.push(library);
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// The group that a face goes into; names without faces make none.
    fn group(&mut self) -> Result<u32, Fault> {
        if std::mem::take(&mut self.starts_group) {
            let goes_on = self.groups.last().is_some_and(|(name, m)| *name == self.name && *m == self.material);
            if !goes_on {
                self.names.get_or_insert_with(budget::Purse::of_names).spend(self.name.len())?;
                self.groups.push((self.name.clone(), self.material));
            }
        }
        Ok(self.groups.len() as u32 - 1)
    }

    fn vertex(&mut self, statement: Statement<'_>, line: usize) -> Result<(), Fault> {
        let vertex = self.out.positions.len();
        budget::check("vertices", vertex as u64 + 1, budget::VERTICES)?;
        let mut words = statement.words();
        words.next();
        let [x, y, z] = numbers(words, line, &format!("vertex {vertex}"), false)?;
        let more: Vec<f64> = statement.words().skip(4).take(4).filter_map(|w| w.number()).collect();
        // Four numbers are a weight, which means nothing for polygons; six or more end in a color.
        if let [r, g, b, ..] = more[..] {
            let alpha = more.get(3).copied().unwrap_or(1.0);
            self.colored.push((vertex, [r, g, b, alpha].map(|x| finite(Some(x)))));
        }
        self.out.positions.push(DVec3::new(x, y, z));
        self.out.vertex_at.push(statement.start as u64);
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = Word<'a>>, line: usize) -> Result<(), Fault> {
        let first_corner = self.corners.len();
        let known = [self.out.positions.len(), self.out.uvs.len(), self.out.normals.len()];
        for word in words {
            self.corners.push(corner(&word, known, line)?);
            let n = self.corners.len() - first_corner;
            budget::check("corners of one polygon", n as u64, budget::POLYGON_CORNERS)?;
        }
        if self.corners.len() - first_corner < 3 {
            self.corners.truncate(first_corner);
            self.n_thin += 1;
            return Ok(());
        }
        let group = self.group()?;
        self.faces.push(Face { first_corner, line, group });
        let n_triangles = self.corners.len() - 2 * self.faces.len();
        budget::check("triangles", n_triangles as u64, budget::TRIANGLES)
    }

    fn finish(mut self) -> Result<Parsed, Fault> {
        let mut n_loose = 0;
        let faces = std::mem::take(&mut self.faces);
        let (mut outline, mut cut, mut tests) = (Vec::new(), Vec::new(), polygon::MAX_TESTS);
        let mut group = None;
        for (i, face) in faces.iter().enumerate() {
            let end = faces.get(i + 1).map_or(self.corners.len(), |next| next.first_corner);
            for corner in &mut self.corners[face.first_corner..end] {
                n_loose += check_corner(corner, &self.out, face.line)?;
            }
            if group != Some(face.group) {
                group = Some(face.group);
                self.begin_part(face.group);
            }
            let corners = &self.corners[face.first_corner..end];
            outline.clear();
            outline.extend(corners.iter().map(|c| self.out.positions[c.0 as usize]));
            cut.clear();
            polygon::triangulate(&outline, &mut tests, &mut cut);
            if outline.len() > 3 {
                let first = self.out.triangles.len() as u32;
                self.out.polygons.push(first..first + cut.len() as u32);
            }
            for triangle in &cut {
                let of = triangle.map(|local| corners[local as usize]);
                self.out.triangles.push(of.map(|c| c.0));
                self.out.corners.push(of.map(|c| (c.1, c.2)));
            }
            if let Some(part) = self.out.parts.last_mut() {
                part.triangles.end = self.out.triangles.len();
            }
        }
        if tests == 0 {
            let text = "polygons are too intricate to cut with care: some triangles may be turned over";
            self.out.warnings.push(Warning(text.into()));
        }
        self.note(n_loose);
        Ok(self.out)
    }

    fn begin_part(&mut self, group: u32) {
        // Taken: each group is one run of faces.
        let (name, material) = std::mem::take(&mut self.groups[group as usize]);
        let at = self.out.triangles.len();
        self.out.parts.push(ShapePart { name, triangles: at..at, material });
    }

    fn note(&mut self, n_loose: usize) {
        if self.n_thin > 0 {
            let text = format!("{} faces have fewer than three corners and were skipped", self.n_thin);
            self.out.warnings.push(Warning(text));
        }
        if n_loose > 0 {
            let text = format!("{n_loose} corners name texture coordinates or normals that do not exist");
            self.out.warnings.push(Warning(text));
        }
        if !self.colored.is_empty() {
            let mut colors = vec![[1.0; 4]; self.out.positions.len()];
            for &(vertex, color) in &self.colored {
                colors[vertex] = color;
            }
            self.out.colors = Some(colors);
        }
    }
}

/// A number for display, zero where it is none that single precision holds.
fn finite(number: Option<f64>) -> f32 {
    number.map(|x| x as f32).filter(|x| x.is_finite()).unwrap_or(0.0)
}

/// Three finite numbers; a normal that is none counts as zero, since nothing depends on it.
fn numbers<'a>(
    mut words: impl Iterator<Item = Word<'a>>,
    line: usize,
    what: &str,
    lenient: bool,
) -> Result<[f64; 3], Fault> {
    let mut triple = [0.0; 3];
    for (k, value) in triple.iter_mut().enumerate() {
        let place = || format!("line {line}, {what}");
        match words.next() {
            None if lenient => {}
            None => return Err(Fault::at(place(), format!("has {k} coordinates, 3 are needed"))),
            Some(word) => match word.number() {
                Some(number) if number.is_finite() => *value = number,
                _ if lenient => {}
                Some(_) => return Err(Fault::at(place(), format!("coordinate {} is not finite", word.shown()))),
                None => return Err(Fault::at(place(), format!("{} is not a number", word.shown()))),
            },
        }
    }
    Ok(triple)
}

/// `v`, `v/vt`, `v//vn` or `v/vt/vn`; negative indices count back from the last one `known` so far.
fn corner(word: &Word<'_>, known: [usize; 3], line: usize) -> Result<CornerIndex, Fault> {
    let bad = |problem: String| Fault::at(format!("line {line}, face corner {}", word.shown()), problem);
    let mut indices = [NONE; 3];
    let mut n = 0;
    for (k, field) in word.bytes.split(|&b| b == b'/').enumerate() {
        n = k;
        if k > 2 || (field.is_empty() && k > 0) {
            continue;
        }
        let text = std::str::from_utf8(field).unwrap_or_default();
        let index: i64 = text.parse().map_err(|_| bad("is not a vertex number".into()))?;
        let zero_based = if index < 0 { known[k] as i64 + index } else { index - 1 };
        indices[k] = match u32::try_from(zero_based) {
            Ok(index) if index != NONE => index,
            // Texture coordinates and normals that do not exist are passed over, vertices are not.
            _ if k > 0 => NONE - 1,
            _ if index == 0 => return Err(bad("vertices are numbered from 1, there is no vertex 0".into())),
            _ => return Err(bad(format!("there are {} vertices so far", known[0]))),
        };
    }
    if n > 2 {
        return Err(bad("has more than three indices".into()));
    }
    Ok((indices[0], indices[1], indices[2]))
}

/// Refuses a missing vertex, and forgets missing attributes; returns how many were forgotten.
fn check_corner(corner: &mut CornerIndex, out: &Parsed, line: usize) -> Result<usize, Fault> {
    if corner.0 as usize >= out.positions.len() {
        let problem = format!("face names vertex {}, the file has {}", u64::from(corner.0) + 1, out.positions.len());
        return Err(Fault::at(format!("line {line}"), problem));
    }
    let mut n_loose = 0;
    for (index, known) in [(&mut corner.1, out.uvs.len()), (&mut corner.2, out.normals.len())] {
        if *index != NONE && *index as usize >= known {
            *index = NONE;
            n_loose += 1;
        }
    }
    Ok(n_loose)
}
