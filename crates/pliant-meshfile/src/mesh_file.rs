//! A mesh file as opened, and the ways in and out.

mod morphs;

pub use morphs::{MorphShape, Morphs};

use crate::formats::{Before, Edit, Motion, Opened, Output, Source, entry};
use crate::generated::Generated;
use crate::pack::Original;
use crate::saving::{self, Known, SaveOptions};
use crate::shape::{NO_MATERIAL, Part};
use crate::watch::Stage;
use crate::{Fault, Format, SaveError, Textures, Warning, Weld, Welding, budget, files, normals, rigidity};
use glam::{DQuat, DVec3, Vec2};
use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A mesh file as opened: its geometry in world space, and everything else untouched for saving.
#[derive(Clone, Debug)]
pub struct MeshFile {
    /// Where it came from; `None` for meshes from memory.
    pub path: Option<PathBuf>,
    /// The format it came in.
    pub format: Format,
    /// World-space position of every file vertex, in file order and the file's units. Finite.
    pub positions: Vec<DVec3>,
    /// Triangles over file vertices, polygons cut by ear clipping. Every index is in range.
    pub triangles: Vec<[u32; 3]>,
    /// Which surface point each file vertex stands for.
    pub weld: Weld,
    /// How that was decided.
    pub welding: Welding,
    /// r of every file vertex, from 1 to 1000, when the file or its sidecar `NAME.rigidity.json` carries one.
    pub rigidity: Option<Vec<u16>>,
    /// Texture coordinates of every file vertex, for display, origin at the lower left.
    pub uvs: Option<Vec<Vec2>>,
    /// Color of every file vertex, red, green, blue, alpha, for display.
    pub colors: Option<Vec<[f32; 4]>>,
    /// The pieces the file names, with ascending ranges that cover `triangles`.
    pub parts: Vec<Part>,
    /// What was skipped or changed for display on opening.
    pub warnings: Vec<Warning>,
    source: Arc<dyn Source>,
    pub(crate) known: Known,
    pub(crate) original: Option<Arc<Original>>,
}

/// A move this small, in extents of the mesh, is rounding in what computed it: a solver that leaves a surface as it is
/// gives it back within 1e-14 or so (measured on meshes up to 100,000 vertices), single precision begins at 1e-7.
const ROUNDING: f64 = 1e-12;

/// The files that [`MeshFile::save`] may write beside a mesh file of this name: whatever else lies there by these names
/// is lost.
pub fn side_files(mesh: &Path) -> Vec<PathBuf> {
    let Some(format) = Format::of(mesh) else { return Vec::new() };
    let entry = entry(format);
    let mut files = (entry.beside)(mesh);
    if entry.rigidity_in_sidecar {
        files.push(rigidity::sidecar_of(mesh));
    }
    files
}

impl MeshFile {
    /// What a format gave, with its vertices welded.
    pub(crate) fn welded(
        format: Format,
        opened: Opened,
        welding: Welding,
        stage: Stage<'_>,
    ) -> Result<MeshFile, Fault> {
        let weld = Weld::new(&opened.positions, welding, || opened.source.bindings(), stage)?;
        let mut file = MeshFile::of(format, opened, weld, welding);
        if let Welding::Within(distance) = welding {
            file.note_near(distance)?;
        }
        Ok(file)
    }

    /// Says what welding within a distance joined and what it left of the surface.
    fn note_near(&mut self, distance: f64) -> Result<(), Fault> {
        let collapsed = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|vertex| self.weld.point_of_vertex[vertex as usize]);
            a == b || b == c || c == a
        };
        let n = self.triangles.iter().filter(collapsed).count();
        if n == self.triangles.len() {
            return Err(Fault::WeldedAway { distance });
        }
        let offset = |vertex: usize| self.positions[vertex].distance(self.positions[self.first_of(vertex)]);
        let offsets = (0..self.positions.len()).map(offset).filter(|&offset| offset > 0.0);
        let (joined, widest) = offsets.fold((0, 0.0_f64), |(n, widest), offset| (n + 1, widest.max(offset)));
        if joined > 0 {
            let text = format!("{joined} vertices were welded to others within {distance} (farthest: {widest})");
            self.warnings.push(Warning(text));
        }
        if n > 0 {
            let text = format!("{n} triangles are smaller than the welding distance of {distance} and have no extent");
            self.warnings.push(Warning(text));
        }
        Ok(())
    }

    /// The file vertices at exactly one place, whatever welding was wished and whatever carries them: what tells by its
    /// corners that another file shows the same mesh.
    pub(crate) fn places(&self) -> Cow<'_, Weld> {
        match self.source.bindings() {
            None if self.welding == Welding::Exact => Cow::Borrowed(&self.weld),
            _ => Cow::Owned(Weld::exact(&self.positions)),
        }
    }

    /// The vertex whose place is that of a file vertex's surface point.
    fn first_of(&self, vertex: usize) -> usize {
        self.weld.vertex_of_point[self.weld.point_of_vertex[vertex] as usize] as usize
    }

    fn of(format: Format, opened: Opened, weld: Weld, welding: Welding) -> MeshFile {
        MeshFile {
            path: None,
            format,
            positions: opened.positions,
            triangles: opened.triangles,
            weld,
            welding,
            rigidity: opened.rigidity,
            uvs: opened.uvs,
            colors: opened.colors,
            parts: opened.parts,
            warnings: opened.warnings,
            source: opened.source,
            known: Known::default(),
            original: None,
        }
    }

    /// A mesh that comes from no file (samples): saved as a minimal clean file with smooth normals.
    ///
    /// Positions are to be finite and indices in range; triangles that are not are left out with a warning.
    pub fn from_triangles(name: &str, positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> MeshFile {
        let n_given = triangles.len();
        let mut triangles = triangles;
        triangles.retain(|t| t.iter().all(|&v| positions.get(v as usize).is_some_and(|p| p.is_finite())));
        let warnings = match n_given - triangles.len() {
            0 => Vec::new(),
            n => vec![Warning(format!("{n} triangles of {name} name no vertex and were left out"))],
        };
        let part = Part { name: name.to_owned(), triangles: 0..triangles.len(), base_color: NO_MATERIAL };
        let opened = Opened {
            positions,
            triangles,
            rigidity: None,
            uvs: None,
            colors: None,
            parts: vec![part],
            warnings,
            source: Arc::new(Generated),
        };
        let weld = Weld::exact(&opened.positions);
        MeshFile::of(Format::Glb, opened, weld, Welding::Exact)
    }

    /// Triangles that each polygon of more than three corners was cut into, ascending, where the file has polygons.
    pub fn polygons(&self) -> &[Range<u32>] {
        self.source.polygons()
    }

    /// The pictures that the file lays on its surface, read now, still encoded. Nothing of them is kept here: saving leaves them as
    /// they are in the file.
    pub fn textures(&self) -> Textures {
        self.source.textures(self.before())
    }

    /// How many poses the file holds besides its shape at most, told without reading them.
    pub(crate) fn n_poses(&self, frames: usize) -> usize {
        self.source.n_poses(frames)
    }

    /// The poses the file holds besides its shape, if it holds any, with so many frames of each animation.
    pub(crate) fn motion(&self, frames: usize) -> Result<Option<Box<dyn Motion>>, Fault> {
        self.source.clone().motion(frames)
    }

    /// Rest positions of the surface points, in world space.
    pub fn points(&self) -> Vec<DVec3> {
        self.weld.vertex_of_point.iter().map(|&vertex| self.positions[vertex as usize]).collect()
    }

    /// Triangles over surface points, in the order of `triangles`.
    pub fn point_triangles(&self) -> Vec<[u32; 3]> {
        self.weld.triangles(&self.triangles)
    }

    /// r per surface point, the largest among welded vertices, and whether some of them disagreed.
    pub fn point_rigidity(&self) -> Option<(Vec<u16>, bool)> {
        self.rigidity.as_ref().map(|rigidity| self.weld.largest(rigidity))
    }

    /// Writes this file with new world positions and r of its surface points, everything else as it was opened.
    ///
    /// `to` may be the file that was opened, which is then kept as `NAME~` when it is first saved over. The file is
    /// complete or untouched whatever happens. Returns what the format of `to` could not hold. Without `rigidity` the
    /// file's own stays, if it has any; a sidecar that another model left beside `to` is then filled with ones.
    pub fn save(&self, to: &Path, points: &[DVec3], rigidity: Option<&[u16]>) -> Result<Vec<Warning>, SaveError> {
        self.save_with(to, points, rigidity, SaveOptions::default())
    }

    /// [`MeshFile::save`] with options.
    pub fn save_with(
        &self,
        to: &Path,
        points: &[DVec3],
        rigidity: Option<&[u16]>,
        options: SaveOptions,
    ) -> Result<Vec<Warning>, SaveError> {
        let format = Format::of(to).ok_or_else(|| SaveError::UnknownFormat { path: to.to_owned() })?;
        let edit = self.edit(to, points, rigidity)?;
        let entry = entry(format);
        let mut output = match self.source.rewrite(&edit, to, format) {
            Some(output) => output?,
            None => self.convert(&edit, to, format)?,
        };
        let mut beside = output.beside;
        if entry.rigidity_in_sidecar {
            beside.extend(self.sidecar(&edit, to, output.origin.as_deref(), &mut output.warnings));
        }
        let known = options.backup.then_some(&self.known);
        output.warnings.extend(saving::write(to, &output.bytes, &beside, known)?);
        output.warnings.extend(self.unpack(to));
        Ok(output.warnings)
    }

    /// Puts what a packed file refers to beside the saved one, where nothing has these names yet.
    fn unpack(&self, to: &Path) -> Vec<Warning> {
        let mut warnings = Vec::new();
        for (name, bytes) in self.source.unpacked(to) {
            // Names out of the folder were refused when the pack was made, and are refused of packs made otherwise.
            let path = files::folder_of(to).join(&name);
            let is_plain = Path::new(&name).components().all(|part| matches!(part, std::path::Component::Normal(_)));
            if !is_plain || files::is_taken(&path) {
                let shown = rigidity::quoted(&name);
                warnings.push(Warning(format!("{shown} beside the saved file is not the one from the project")));
            } else if let Err(error) = saving::replace_file(&path, |file| file.write_all(&bytes)) {
                warnings.push(Warning(error.to_string()));
            }
        }
        warnings
    }

    /// What the file refers to and was not read on opening.
    pub(crate) fn references(&self) -> Vec<String> {
        self.source.references()
    }

    /// The sidecar that belongs beside `to`, if any does. `origin` as in [`Output`].
    fn sidecar(
        &self,
        edit: &Edit<'_>,
        to: &Path,
        origin: Option<&[u32]>,
        warnings: &mut Vec<Warning>,
    ) -> Option<(PathBuf, Vec<u8>)> {
        let sidecar = rigidity::sidecar_of(to);
        // What was read from one sidecar goes on in the next.
        if let Some(rigidity) = edit.rigidity.as_ref().or(self.rigidity.as_ref()) {
            let of_new = |origin: &[u32]| origin.iter().map(|&vertex| rigidity[vertex as usize]).collect::<Vec<_>>();
            return Some((sidecar, rigidity::to_json(&origin.map_or_else(|| rigidity.clone(), of_new))));
        }
        // One that another model left would be read as this one's.
        let ones = rigidity::to_json(&vec![1; origin.map_or(self.positions.len(), <[u32]>::len)]);
        let is_stale = files::is_taken(&sidecar)
            && files::read_inside(files::folder_of(&sidecar), &sidecar, budget::TEXT_BYTES).as_ref() != Ok(&ones);
        if !is_stale {
            return None;
        }
        let text = format!("{} was another model's and now holds rigidity 1 everywhere", sidecar.display());
        warnings.push(Warning(text));
        Some((sidecar, ones))
    }

    fn convert(&self, edit: &Edit<'_>, to: &Path, format: Format) -> Result<Output, SaveError> {
        let shape = self.source.shape(edit);
        let entry = entry(format);
        let mut output = (entry.write)(&shape, to)?;
        let mut left: Vec<&str> = shape.left_behind.clone();
        left.extend(entry.holds.lost(&shape));
        if !left.is_empty() {
            output.warnings.push(Warning(format!("not carried over into {}: {}", to.display(), left.join(", "))));
        }
        Ok(output)
    }

    /// Checks what is to be saved and spreads it from surface points to file vertices.
    fn edit(&self, to: &Path, points: &[DVec3], rigidity: Option<&[u16]>) -> Result<Edit<'_>, SaveError> {
        let path = || to.to_owned();
        let expected = self.weld.n_points();
        if points.len() != expected {
            return Err(SaveError::Count { path: path(), what: "positions", found: points.len(), expected });
        }
        if let Some(point) = points.iter().position(|p| !p.is_finite()) {
            return Err(SaveError::NotFinite { path: path(), vertex: self.weld.vertex_of_point[point] as usize });
        }
        if let Some(r) = rigidity {
            if r.len() != expected {
                return Err(SaveError::Count { path: path(), what: "rigidities", found: r.len(), expected });
            }
            if let Some(point) = r.iter().position(|r| !(1..=rigidity::MAX).contains(r)) {
                return Err(SaveError::Rigidity { path: path(), point, value: r[point] });
            }
        }
        let of_vertex = self.weld.point_of_vertex.iter().map(|&point| point as usize);
        let positions = self.spread(points);
        let rigidity = rigidity.map(|r| of_vertex.map(|point| r[point]).collect());
        Ok(Edit { mesh: self.before(), positions, rigidity })
    }

    /// The mesh as it was opened.
    fn before(&self) -> Before<'_> {
        Before {
            positions: &self.positions,
            triangles: &self.triangles,
            weld: &self.weld,
            rigidity: &self.rigidity,
            uvs: &self.uvs,
            colors: &self.colors,
            parts: &self.parts,
        }
    }

    /// World positions of the file vertices for new places of the surface points.
    ///
    /// What was welded within a distance lies beside its point's place. It goes along as if fixed to the surface there:
    /// shifted as the point is, and its offset turned as the faces around the point turn.
    fn spread(&self, points: &[DVec3]) -> Vec<DVec3> {
        let place = |vertex: usize| {
            let (old, first) = (self.positions[vertex], self.positions[self.first_of(vertex)]);
            (old, first, points[self.weld.point_of_vertex[vertex] as usize])
        };
        let is_beside = |&vertex: &usize| {
            let (old, first, _) = place(vertex);
            old != first
        };
        let turns = match self.welding {
            Welding::Within(_) if (0..self.positions.len()).any(|vertex| is_beside(&vertex)) => {
                self.point_turns(points)
            }
            _ => Vec::new(),
        };
        let rounding = ROUNDING * self.extent();
        let spread = |vertex: usize| {
            let (old, first, new) = place(vertex);
            // Unmoved but for rounding: the file's own number stays to the bit, be it a negative zero.
            if new.distance(first) <= rounding {
                old
            } else if old == first {
                new
            } else {
                let offset = old - first;
                let turn = turns.get(self.weld.point_of_vertex[vertex] as usize).copied().flatten();
                new + turn.map_or(offset, |turn| turn * offset)
            }
        };
        (0..self.positions.len()).map(spread).collect()
    }

    /// The largest side of the box around the file vertices.
    fn extent(&self) -> f64 {
        let first = self.positions.first().copied().unwrap_or_default();
        let grow = |(lo, hi): (DVec3, DVec3), p: &DVec3| (lo.min(*p), hi.max(*p));
        let (lo, hi) = self.positions.iter().fold((first, first), grow);
        (hi - lo).max_element()
    }

    /// How the faces around each surface point turn.
    fn point_turns(&self, points: &[DVec3]) -> Vec<Option<DQuat>> {
        let triangles = self.point_triangles();
        let cluster = |t: usize, k: usize| Some(triangles[t][k]);
        normals::turns(&triangles, points.len(), cluster, &self.points(), points)
    }
}
