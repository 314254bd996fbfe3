//! Pieces into one mesh, in the order of the text.

use super::super::text::statement_at;
use super::corner::NOT_THERE;
use super::piece::{Change, Piece};
use super::{MAX_LIBRARIES, NONE, Parsed};
use crate::shape::ShapePart;
use crate::watch::Stage;
use crate::{Fault, Warning, budget, polygon};
use std::collections::HashMap;

/// Faces put together between two looks at whether they are still wanted: some milliseconds.
const FACES: usize = 1 << 15;

/// Puts pieces together and cuts their polygons into triangles.
pub(super) fn assemble(bytes: &[u8], name: &str, pieces: Vec<Piece>, stage: Stage<'_>) -> Result<Parsed, Fault> {
    let mut groups = Groups::new(bytes, name);
    let mut whole = Piece::of_whole_text();
    reserve(&mut whole, &pieces);
    let n = pieces.len();
    for (i, piece) in pieces.into_iter().enumerate() {
        stage.part(0.0, 0.3).tell(i, n)?;
        groups.of_piece(&piece, whole.faces.len())?;
        if n == 1 { whole = piece } else { append(&mut whole, piece)? }
    }
    let Groups { runs, named, material_names, .. } = groups;
    let mut out = Parsed { material_names, ..Parsed::default() };
    out.positions = std::mem::take(&mut whole.positions);
    out.uvs = std::mem::take(&mut whole.uvs);
    out.normals = std::mem::take(&mut whole.normals);
    out.vertex_at = std::mem::take(&mut whole.vertex_at);
    out.normal_at = std::mem::take(&mut whole.normal_at);
    out.libraries = std::mem::take(&mut whole.libraries);
    let n_loose = cut_faces(&mut out, &mut whole, Runs { runs, named }, stage.part(0.3, 1.0))?;
    note(&mut out, &whole, n_loose);
    Ok(out)
}

fn reserve(whole: &mut Piece, pieces: &[Piece]) {
    if pieces.len() == 1 {
        return;
    }
    let sum = |of: fn(&Piece) -> usize| pieces.iter().map(of).sum();
    whole.positions.reserve_exact(sum(|piece| piece.positions.len()));
    whole.vertex_at.reserve_exact(sum(|piece| piece.positions.len()));
    whole.uvs.reserve_exact(sum(|piece| piece.uvs.len()));
    whole.normals.reserve_exact(sum(|piece| piece.normals.len()));
    whole.normal_at.reserve_exact(sum(|piece| piece.normals.len()));
    whole.faces.reserve_exact(sum(|piece| piece.faces.len()));
    whole.corners.reserve_exact(sum(|piece| piece.corners.len()));
}

/// Appends a piece; a vertex before the first is a fault.
fn append(whole: &mut Piece, mut piece: Piece) -> Result<(), Fault> {
    let before = [whole.positions.len(), whole.uvs.len(), whole.normals.len()];
    for &(corner, k) in &piece.relative {
        let (index, k) = (&mut piece.corners[corner as usize][usize::from(k)], usize::from(k));
        let counted = before[k] as i64 + i64::from(index.cast_signed());
        *index = match u32::try_from(counted) {
            Ok(counted) if counted < NOT_THERE => counted,
            _ if k > 0 => NOT_THERE,
            _ => return Err(Fault::at("a face", "counts back beyond the first vertex")),
        };
    }
    let first_corner = whole.corners.len() as u32;
    whole.colored.extend(piece.colored.iter().map(|&(vertex, color)| (before[0] as u32 + vertex, color)));
    whole.positions.append(&mut piece.positions);
    whole.uvs.append(&mut piece.uvs);
    whole.normals.append(&mut piece.normals);
    whole.vertex_at.append(&mut piece.vertex_at);
    whole.normal_at.append(&mut piece.normal_at);
    whole.faces.extend(piece.faces.iter().map(|&corner| first_corner + corner));
    whole.corners.append(&mut piece.corners);
    for library in piece.libraries {
        if whole.libraries.len() < MAX_LIBRARIES && !whole.libraries.contains(&library) {
            whole.libraries.push(library);
        }
    }
    whole.n_thin += piece.n_thin;
    whole.skipped.lines += piece.skipped.lines;
    whole.skipped.curves += piece.skipped.curves;
    // Lines are known in one piece alone; several are read again where one matters.
    whole.lines.clear();
    Ok(())
}

/// Which faces belong to which group: runs of faces of one name and material.
struct Groups<'a> {
    bytes: &'a [u8],
    name: String,
    material: Option<usize>,
    /// Whether the name or the material changed since the last face.
    is_changed: bool,
    known_materials: HashMap<String, usize>,
    material_names: Vec<String>,
    names: budget::Purse,
    /// The first face of each run.
    runs: Vec<usize>,
    named: Vec<(String, Option<usize>)>,
}

impl<'a> Groups<'a> {
    fn new(bytes: &'a [u8], name: &str) -> Groups<'a> {
        Groups {
            bytes,
            name: name.to_owned(),
            material: None,
            is_changed: true,
            known_materials: HashMap::new(),
            material_names: Vec::new(),
            names: budget::Purse::of_names(),
            runs: Vec::new(),
            named: Vec::new(),
        }
    }

    /// Goes through a piece whose first face has this number.
    fn of_piece(&mut self, piece: &Piece, first: usize) -> Result<(), Fault> {
        let starts_named = piece.changes.first().is_some_and(|change| change.first_face == 0);
        if !piece.faces.is_empty() && !starts_named {
            self.begin(first)?;
        }
        for change in &piece.changes {
            self.take(change);
            self.begin(first + change.first_face as usize)?;
        }
        self.take(&piece.pending);
        Ok(())
    }

    fn take(&mut self, change: &Change) {
        let named = |at: u64| statement_at(self.bytes, at as usize).rest();
        if let Some(at) = change.material_at {
            let name = named(at);
            let next = self.known_materials.len();
            self.material = Some(*self.known_materials.entry(name.clone()).or_insert_with(|| {
                self.material_names.push(name);
                next
            }));
        }
        if let Some(at) = change.name_at {
            self.name = budget::short_name(named(at));
        }
        self.is_changed |= change.is_any();
    }

    /// A face comes; it starts a run unless it goes on with the last.
    fn begin(&mut self, face: usize) -> Result<(), Fault> {
        if std::mem::take(&mut self.is_changed) {
            let goes_on = self.named.last().is_some_and(|(name, m)| *name == self.name && *m == self.material);
            if !goes_on {
                self.names.spend(self.name.len())?;
                self.runs.push(face);
                self.named.push((self.name.clone(), self.material));
            }
        }
        Ok(())
    }
}

struct Runs {
    runs: Vec<usize>,
    named: Vec<(String, Option<usize>)>,
}

/// Cuts all faces into triangles and counts the attributes that they name and are not there.
fn cut_faces(out: &mut Parsed, whole: &mut Piece, runs: Runs, stage: Stage<'_>) -> Result<usize, Fault> {
    let n_faces = whole.faces.len();
    let n_triangles = whole.corners.len() - 2 * n_faces;
    out.triangles.reserve_exact(n_triangles);
    out.corners.reserve_exact(n_triangles);
    let mut runs = runs.runs.into_iter().zip(runs.named).peekable();
    let (mut outline, mut cut, mut tests, mut n_loose) = (Vec::new(), Vec::new(), polygon::MAX_TESTS, 0);
    for i in 0..n_faces {
        if i % FACES == 0 {
            stage.tell(i, n_faces)?;
        }
        if let Some((_, (name, material))) = runs.next_if(|&(first, _)| first == i) {
            let at = out.triangles.len();
            out.parts.push(ShapePart { name, triangles: at..at, material });
        }
        let end = whole.faces.get(i + 1).map_or(whole.corners.len(), |&next| next as usize);
        let corners = &mut whole.corners[whole.faces[i] as usize..end];
        for corner in &mut *corners {
            n_loose += check_corner(corner, out, || whole.lines.get(i).copied().unwrap_or_default())?;
        }
        if let [a, b, c] = *corners {
            out.triangles.push([a[0], b[0], c[0]]);
            out.corners.push([a, b, c].map(|c| (c[1], c[2])));
        } else {
            outline.clear();
            outline.extend(corners.iter().map(|c| out.positions[c[0] as usize]));
            cut.clear();
            polygon::triangulate(&outline, &mut tests, &mut cut);
            let first = out.triangles.len() as u32;
            out.polygons.push(first..first + cut.len() as u32);
            for triangle in &cut {
                let of = triangle.map(|local| corners[local as usize]);
                out.triangles.push(of.map(|c| c[0]));
                out.corners.push(of.map(|c| (c[1], c[2])));
            }
        }
        if let Some(part) = out.parts.last_mut() {
            part.triangles.end = out.triangles.len();
        }
    }
    if tests == 0 {
        let text = "polygons are too intricate to cut with care: some triangles may be turned over";
        out.warnings.push(Warning(text.into()));
    }
    Ok(n_loose)
}

/// Refuses a missing vertex, and forgets missing attributes; returns how many were forgotten.
fn check_corner(corner: &mut [u32; 3], out: &Parsed, line: impl Fn() -> u32) -> Result<usize, Fault> {
    let [vertex, uv, normal] = corner;
    if *vertex as usize >= out.positions.len() {
        let problem = format!("face names vertex {}, the file has {}", u64::from(*vertex) + 1, out.positions.len());
        return Err(Fault::at(format!("line {}", line()), problem));
    }
    let mut n_loose = 0;
    for (index, known) in [(uv, out.uvs.len()), (normal, out.normals.len())] {
        if *index != NONE && *index as usize >= known {
            *index = NONE;
            n_loose += 1;
        }
    }
    Ok(n_loose)
}

fn note(out: &mut Parsed, whole: &Piece, n_loose: usize) {
    out.skipped = whole.skipped;
    if whole.skipped.curves > 0 {
        let n = whole.skipped.curves;
        let text = format!("{n} free-form curves and surfaces are not shown; the file keeps them as they are");
        out.warnings.push(Warning(text));
    }
    if whole.n_thin > 0 {
        let text = format!("{} faces have fewer than three corners and were skipped", whole.n_thin);
        out.warnings.push(Warning(text));
    }
    if n_loose > 0 {
        let text = format!("{n_loose} corners name texture coordinates or normals that do not exist");
        out.warnings.push(Warning(text));
    }
    if !whole.colored.is_empty() {
        let mut colors = vec![[1.0; 4]; out.positions.len()];
        for &(vertex, color) in &whole.colored {
            colors[vertex as usize] = color;
        }
        out.colors = Some(colors);
    }
}
