//! Pictures of surfaces: all of a figure from one camera, cropped to what they show together.

use std::sync::Arc;

use glam::{DVec3, EulerRot, Quat, Vec2, Vec3};
use image::imageops::{FilterType, resize};
use image::{Rgba, RgbaImage};
use pliant::viewport::{Camera, Coloring, Dot, Headless, Projection, SurfaceFrame, Theme, ViewScene, picture_on};
use pliant_geometry::VertexNormals;
use pliant_solver::Mesh;

use crate::failure::Failure;
use crate::measures::diagonal;
use crate::models::Posing;

/// Drawn so many times finer than kept: takes the grain out, which single pixels have against bands.
const FINER: u32 = 2;
/// Vertical field of view: a long lens, so that little leans (by eye).
const FIELD_OF_VIEW: f32 = 0.35;
/// Part of the picture left free at each side (by eye).
const MARGIN: f32 = 0.04;
/// The shorter side in longer ones, at least (by eye: what is thin needs air).
const SLIMMEST: f32 = 0.2;
/// Rounds of fitting the camera: the last one moves it by less than a pixel.
const ROUNDS: usize = 12;
/// Yellow as the paper's handles.
const YELLOW: [u8; 4] = [255, 214, 10, 255];
/// Handles are shown so far apart at least, in diagonals of the shape: of a patch all over, enough to see it (by eye).
const DOTS_APART: f64 = 0.018;

/// From where, in degrees: about the upright axis, then up or down, then the picture turned.
#[derive(Clone, Copy)]
pub(crate) struct View {
    pub(crate) yaw: f32,
    pub(crate) pitch: f32,
    pub(crate) roll: f32,
}

/// A camera that shows some surfaces wholly, and the size of its pictures.
pub(crate) struct Stage {
    camera: Camera,
    size: [u32; 2],
    bounds: (Vec3, Vec3),
}

impl Stage {
    /// For pictures whose longer side has so many pixels.
    pub(crate) fn new(view: View, longest: u32, surfaces: &[&[DVec3]]) -> Stage {
        let points: Vec<Vec3> = surfaces.iter().flat_map(|surface| surface.iter().map(|p| p.as_vec3())).collect();
        let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = points.iter().copied().reduce(Vec3::max).unwrap_or_default();
        let [yaw, pitch, roll] = [view.yaw, view.pitch, view.roll].map(f32::to_radians);
        let mut camera = Camera {
            orientation: Quat::from_euler(EulerRot::YXZ, yaw, pitch, roll),
            projection: Projection::Perspective,
            fov_y_radians: FIELD_OF_VIEW,
            ..Camera::framing(low, high)
        };
        camera.frame(low, high);
        let longest = longest as f32;
        let mut size = Vec2::splat(longest);
        for _ in 0..ROUNDS {
            let (from, to) = extent(&camera, size, &points);
            camera.target -= camera.drag_in_view_plane(camera.target, size * 0.5 - (from + to) * 0.5, size);
            let reach = (to - from).max(Vec2::ONE);
            // Margins are as wide on all sides; the lens counts along the shorter side.
            let scale = reach.max_element() / (longest * (1.0 - 2.0 * MARGIN));
            let fitted = (reach / scale + 2.0 * MARGIN * longest).round().max(Vec2::splat(SLIMMEST * longest));
            camera.distance *= scale * fitted.min_element() / size.min_element();
            size = fitted;
        }
        Stage { camera, size: size.to_array().map(|side| side as u32), bounds: (low, high) }
    }

    /// A surface in a pose.
    pub(crate) fn shot<'a>(&self, mesh: &'a Mesh, posed: &[DVec3]) -> Shot<'a> {
        let positions: Vec<Vec3> = posed.iter().map(|p| p.as_vec3()).collect();
        let triangles: Arc<[[u32; 3]]> = mesh.triangles().into();
        let mut normals = Vec::new();
        VertexNormals::new(positions.len(), &triangles).compute(&positions, &triangles, &mut normals);
        let frame = Arc::new(SurfaceFrame { positions, normals });
        let mut scene = ViewScene::plain(triangles, frame, self.camera, self.bounds);
        (scene.theme, scene.pixels_per_point) = (Theme::Light, FINER as f32);
        Shot { size: self.size, mesh, scene }
    }
}

/// Where in the picture the points lie.
fn extent(camera: &Camera, size: Vec2, points: &[Vec3]) -> (Vec2, Vec2) {
    let seen = points.iter().filter_map(|&p| camera.project(p, size)).map(|(px, _)| px);
    seen.fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(from, to), px| (from.min(px), to.max(px)))
}

/// One picture in the making.
pub(crate) struct Shot<'a> {
    size: [u32; 2],
    mesh: &'a Mesh,
    scene: ViewScene,
}

impl Shot<'_> {
    /// Facets and edges are seen.
    pub(crate) fn with_wires(mut self) -> Self {
        self.scene.wireframe = true;
        self
    }

    /// Yellow dots at the handles.
    pub(crate) fn with_handles(mut self, posing: &Posing) -> Self {
        let rest = self.mesh.positions();
        let apart = DOTS_APART * diagonal(rest);
        let mut kept: Vec<DVec3> = Vec::new();
        let mut dots = Vec::new();
        for v in &posing.held {
            let p = rest[v.index()];
            if kept.iter().all(|other| other.distance(p) >= apart) {
                kept.push(p);
                dots.push(Dot { position: self.scene.frame.positions[v.index()], color: YELLOW, radius_px: 1.6 });
            }
        }
        self.scene.dots = dots.into();
        self
    }

    /// The colors of r, up to this one.
    pub(crate) fn with_rigidity(mut self, r: &[u16], most: u16) -> Self {
        (self.scene.rigidity, self.scene.ramp_max, self.scene.coloring) = (r.into(), most, Coloring::Rigidity);
        self
    }

    /// Two colors, stiff from this r on.
    pub(crate) fn with_soft_and_stiff(mut self, r: &[u16], stiff_from: u16) -> Self {
        (self.scene.rigidity, self.scene.coloring) = (r.into(), Coloring::SoftStiff { stiff_from });
        self
    }

    /// Values from 0 to their largest through the ramp of energies.
    pub(crate) fn with_heat(mut self, values: &[f64]) -> Self {
        let largest = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        self.scene.values = Some(values.iter().map(|value| (value / largest) as f32).collect());
        self.scene.coloring = Coloring::Energy;
        self
    }

    /// Drawn finer than wanted, then made smaller, on white: on a page a ground of its own is only a frame, and takes most
    /// of the bytes.
    pub(crate) fn draw(&self, headless: &Headless) -> Result<RgbaImage, Failure> {
        let [width, height] = self.size;
        let fine = [width * FINER, height * FINER];
        let nothing = ViewScene { triangles: Arc::new([]), dots: Arc::new([]), ..self.scene.clone() };
        let ground = picture_on(headless, &nothing, fine)?;
        let mut drawn = picture_on(headless, &self.scene, fine)?;
        for (pixel, ground) in drawn.pixels_mut().zip(ground.pixels()) {
            if pixel == ground {
                *pixel = Rgba([255; 4]);
            }
        }
        Ok(resize(&drawn, width, height, FilterType::Triangle))
    }
}
