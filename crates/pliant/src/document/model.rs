//! What was opened and never changes while it is edited.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use pliant_meshfile::MeshFile;
use pliant_solver::{Mesh, MeshError, Rigidity, RigidityError};

use super::findings::{Finding, caution, findings};
use super::{polygons, textures};
use crate::viewport::TextureSet;

/// An opened mesh: the file it came from and the surface the solver sees.
///
/// *View space* is world space moved so that the surface's center is the origin; it is what single precision, the
/// camera and the picking work in. Its axes and units are the world's.
pub struct Model {
    /// Name shown in the title: the file's stem.
    pub name: String,
    /// The file, kept whole for saving.
    pub file: MeshFile,
    /// Surface points and triangles (welded), the solver's numbering.
    pub mesh: Arc<Mesh>,
    /// The same triangles, shared with the picture.
    pub triangles: Arc<[[u32; 3]]>,
    /// r that the file carried, else 1 everywhere.
    pub rigidity: Rigidity,
    /// World position of the origin of view space.
    pub origin: DVec3,
    /// Smallest and largest corner of the rest surface, in view space.
    pub bounds: (Vec3, Vec3),
    /// Edges that only cut the file's polygons, as [`ViewScene::unmarked_edges`](crate::viewport::ViewScene) has them.
    pub cut_edges: Option<Arc<[u8]>>,
    /// Base color of every surface point (linear RGBA8), when the file names any.
    pub base_colors: Option<Arc<[[u8; 4]]>>,
    /// Pictures of the file on the surface, once [`Model::load_textures`] has read them.
    pub textures: Option<Arc<TextureSet>>,
    /// What the user should know about the file, one sentence each.
    pub warnings: Vec<String>,
    /// What is unusual about the surface.
    pub findings: Vec<Finding>,
}

/// Why a file cannot be edited.
#[derive(Debug, thiserror::Error)]
pub enum ModelError {
    /// The file could not be read.
    #[error(transparent)]
    Open(#[from] pliant_meshfile::OpenError),
    /// Its surface cannot be used.
    #[error("{name}: {source}")]
    Mesh {
        /// File name.
        name: String,
        /// What is wrong.
        source: MeshError,
    },
    /// Its rigidity cannot be used.
    #[error("{name}: {source}")]
    Rigidity {
        /// File name.
        name: String,
        /// What is wrong.
        source: RigidityError,
    },
}

impl Model {
    /// Opens a mesh file. Takes as long as reading and welding do; call it off the window's thread.
    pub fn open(path: &Path) -> Result<Model, ModelError> {
        Model::from_file(pliant_meshfile::open(path)?)
    }

    /// Takes over a mesh file that is already in memory.
    pub fn from_file(file: MeshFile) -> Result<Model, ModelError> {
        let name = model_name(&file);
        let mesh = Mesh::new(file.points(), file.point_triangles())
            .map_err(|source| ModelError::Mesh { name: name.clone(), source })?;
        let mut warnings: Vec<String> = file.warnings.iter().map(ToString::to_string).collect();
        let rigidity = match file.point_rigidity() {
            Some((r, disagreement)) => {
                if disagreement {
                    warnings.push("vertices at the same place disagree on r: the largest is used".into());
                }
                Rigidity::new(r).map_err(|source| ModelError::Rigidity { name: name.clone(), source })?
            }
            None => Rigidity::uniform(mesh.n_vertices(), 1),
        };
        let findings = findings(&file, &mesh);
        warnings.extend(caution(&findings));
        let (lo, hi) = bounds_of(mesh.positions());
        let origin = (lo + hi) * 0.5;
        Ok(Model {
            name,
            triangles: mesh.triangles().into(),
            rigidity,
            origin,
            bounds: ((lo - origin).as_vec3(), (hi - origin).as_vec3()),
            cut_edges: polygons::cuts(&file.triangles, file.polygons()),
            base_colors: base_colors(&file),
            textures: None,
            warnings,
            findings,
            mesh: Arc::new(mesh),
            file,
        })
    }

    /// Reads and decodes the file's pictures for the screen; those that cannot be shown are named in the warnings. Seconds for large
    /// ones.
    pub fn load_textures(&mut self) {
        let decoded = textures::decode(&self.file);
        self.textures = decoded.set;
        self.base_colors = decoded.base_colors.or(self.base_colors.take());
        self.warnings.extend(decoded.warning);
    }

    /// World position as seen by the camera.
    pub fn to_view(&self, world: DVec3) -> Vec3 {
        (world - self.origin).as_vec3()
    }

    /// Back from view space.
    pub fn to_world(&self, view: Vec3) -> DVec3 {
        view.as_dvec3() + self.origin
    }

    /// Mean length of (a thousand of) the edges, world units.
    pub fn mean_edge(&self) -> f64 {
        let (edges, positions) = (self.mesh.edges(), self.mesh.positions());
        let some = edges.iter().step_by(edges.len().div_ceil(1000).max(1));
        let (n, sum) = some
            .fold((0, 0.0), |(n, sum), &[a, b]| (n + 1, sum + positions[a as usize].distance(positions[b as usize])));
        sum / f64::from(n.max(1))
    }

    /// Length of the diagonal of the rest surface's bounding box.
    pub fn diagonal(&self) -> f32 {
        (self.bounds.1 - self.bounds.0).length()
    }
}

fn model_name(file: &MeshFile) -> String {
    let stem = file.path.as_deref().and_then(Path::file_stem);
    stem.map_or_else(|| "untitled".into(), |stem| stem.to_string_lossy().into_owned())
}

/// Smallest and largest corner of the box around `points`; the origin twice when there are none.
pub(crate) fn bounds_of(points: &[DVec3]) -> (DVec3, DVec3) {
    let Some(&first) = points.first() else {
        return (DVec3::ZERO, DVec3::ZERO);
    };
    points.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p)))
}

/// Vertex colors of the file, or the base color of the material of (one of) the faces around each point.
fn base_colors(file: &MeshFile) -> Option<Arc<[[u8; 4]]>> {
    // One gray for everything says nothing: the picture's own clay looks better.
    let is_gray = |[r, g, b, _]: [f32; 4]| r == g && g == b;
    let plain = file.parts.windows(2).all(|pair| pair[0].base_color == pair[1].base_color)
        && file.parts.first().is_none_or(|part| is_gray(part.base_color));
    if plain && file.colors.is_none() {
        return None;
    }
    Some(colors_of(file, file.parts.iter().map(|part| (part.triangles.clone(), part.base_color))))
}

/// The colors of these ranges of triangles at every surface point, times the colors of the vertices.
pub(super) fn colors_of(file: &MeshFile, parts: impl Iterator<Item = (Range<usize>, [f32; 4])>) -> Arc<[[u8; 4]]> {
    let mut of_vertex = vec![[1.0_f32; 4]; file.positions.len()];
    for (triangles, color) in parts {
        for &v in file.triangles[triangles].as_flattened() {
            of_vertex[v as usize] = color;
        }
    }
    if let Some(colors) = &file.colors {
        for (base, color) in of_vertex.iter_mut().zip(colors) {
            *base = std::array::from_fn(|c| base[c] * color[c]);
        }
    }
    let mut out = vec![[255_u8; 4]; file.weld.n_points()];
    for (&point, color) in file.weld.point_of_vertex.iter().zip(&of_vertex) {
        out[point as usize] = color.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    }
    out.into()
}
