//! What one picture shows. Values and shared arrays only: the renderer finds out what changed by comparing pointers.

use super::{Camera, TextureSet};
use glam::Vec3;
use std::sync::Arc;

/// Positions and unit normals of the surface points at one moment, ready for upload. World units, one entry a vertex.
#[derive(Clone, Debug, Default)]
pub struct SurfaceFrame {
    /// Where each vertex is.
    pub positions: Vec<Vec3>,
    /// Which way the surface faces at each vertex. If the count differs from the positions', the surface is shaded flat.
    pub normals: Vec<Vec3>,
}

/// How a triangle's light is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Shading {
    /// From the vertex normals: a smooth surface.
    Smooth,
    /// From the triangle itself: facets.
    Flat,
    /// From a painted ball instead of lamps.
    Matcap(Matcap),
}

/// A material painted on a ball, from which every point takes what leans away from the eye as it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Matcap {
    /// Warm modelling clay.
    Clay,
    /// Glazed porcelain with sharp reflections.
    Porcelain,
    /// Brushed metal between sky and ground.
    Metal,
    /// Reflected stripes, which show how smooth a surface is.
    Stripes,
}

impl Matcap {
    /// All of them, in the order of menus.
    pub const ALL: [Matcap; 4] = [Matcap::Clay, Matcap::Porcelain, Matcap::Metal, Matcap::Stripes];
}

/// What colors the surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Coloring {
    /// The base colors.
    Plain,
    /// r of each vertex through the rigidity ramp.
    Rigidity,
    /// Two colors: soft, and stiff from this r on.
    SoftStiff {
        /// The smallest r that counts as stiff.
        stiff_from: u16,
    },
    /// One value a vertex in 0..=1 through the heat ramp.
    Energy,
    /// One value a vertex in 0..=1 through the ramp of two directions, 0.5 unchanged.
    Stretch,
}

/// Dark or light surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// A light surface before a dark ground.
    Dark,
    /// A slightly darker surface before a light ground.
    Light,
}

/// An outlined disc of constant size on screen; dimmed where the surface hides it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Its center in the world.
    pub position: Vec3,
    /// sRGB and opacity.
    pub color: [u8; 4],
    /// Radius in points, without the outline.
    pub radius_px: f32,
}

/// A straight line of constant width on screen: brush circle, gizmo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// One end in the world.
    pub a: Vec3,
    /// The other end.
    pub b: Vec3,
    /// sRGB and opacity.
    pub color: [u8; 4],
    /// Width in points.
    pub width_px: f32,
    /// Drawn over everything; otherwise hidden behind the surface.
    pub on_top: bool,
}

/// What a click would give to some vertices, shown before it is made.
#[derive(Clone, Debug)]
pub struct Preview {
    /// One flag a vertex.
    pub vertices: Arc<[bool]>,
    /// r they would get.
    pub r: u16,
}

/// Everything one picture shows. Cheap to clone; the renderer uploads only arrays it has not seen (compared by pointer).
#[derive(Clone)]
pub struct ViewScene {
    /// Corners of each triangle, counterclockwise from outside.
    pub triangles: Arc<[[u32; 3]]>,
    /// Positions and normals.
    pub frame: Arc<SurfaceFrame>,
    /// r of each vertex, for [`Coloring::Rigidity`] and [`Coloring::SoftStiff`].
    pub rigidity: Arc<[u16]>,
    /// One value a vertex in 0..=1, for [`Coloring::Energy`] and [`Coloring::Stretch`].
    pub values: Option<Arc<[f32]>>,
    /// One flag a vertex: tinted as selected.
    pub selected: Option<Arc<[bool]>>,
    /// One flag a vertex: shown paler, since painting leaves it alone.
    pub locked: Option<Arc<[bool]>>,
    /// What a click would fill.
    pub preview: Option<Preview>,
    /// Pictures on the surface, seen where base colors are, and tinted by them. Not shown where the device cannot fetch vertices by
    /// number.
    pub textures: Option<Arc<TextureSet>>,
    /// Faces to point out, by their vertices: drawn in a warning color, faintly also where the surface hides them.
    pub flaws: Option<Arc<[[u32; 3]]>>,
    /// Base color of each vertex (linear), seen plain and through a ramp that is not opaque. `None`: clay.
    pub base_colors: Option<Arc<[[u8; 4]]>>,
    /// Handles, anchors and the like.
    pub dots: Arc<[Dot]>,
    /// Brush circle, gizmo and the like.
    pub lines: Arc<[Line]>,
    /// What colors the surface.
    pub coloring: Coloring,
    /// r at the ramp's end (the ramp starts at 1).
    pub ramp_max: u16,
    /// How much the ramp covers the base color, 0..=1.
    pub color_opacity: f32,
    /// Smooth or facets.
    pub shading: Shading,
    /// Edges of the triangles over the surface.
    pub wireframe: bool,
    /// Where the wireframe has no lines: bit k of a triangle is set where its edge across from corner k is no edge of the file's,
    /// but cuts a polygon. `None`: lines everywhere.
    pub unmarked_edges: Option<Arc<[u8]>>,
    /// The surface hides only little of what is behind it.
    pub see_through: bool,
    /// A faint grid on the ground, where the floor of the bounds was when this mesh was first drawn.
    pub grid: bool,
    /// Dark or light surroundings.
    pub theme: Theme,
    /// From where.
    pub camera: Camera,
    /// Smallest and largest corner of the current surface: fits depth, and places the grid when a mesh is first drawn.
    pub bounds: (Vec3, Vec3),
    /// Physical pixels in a point: sizes of dots and lines follow it.
    pub pixels_per_point: f32,
}

impl ViewScene {
    /// A surface of clay in smooth shading on a dark ground, with nothing over it or under it.
    pub fn plain(triangles: Arc<[[u32; 3]]>, frame: Arc<SurfaceFrame>, camera: Camera, bounds: (Vec3, Vec3)) -> Self {
        ViewScene {
            rigidity: vec![1; frame.positions.len()].into(),
            triangles,
            frame,
            values: None,
            selected: None,
            locked: None,
            preview: None,
            textures: None,
            flaws: None,
            base_colors: None,
            dots: Arc::new([]),
            lines: Arc::new([]),
            coloring: Coloring::Plain,
            ramp_max: 6,
            color_opacity: 1.0,
            shading: Shading::Smooth,
            wireframe: false,
            unmarked_edges: None,
            see_through: false,
            grid: false,
            theme: Theme::Dark,
            camera,
            bounds,
            pixels_per_point: 1.0,
        }
    }

    /// Would both give the same picture? Arrays are the same if they are the same allocation.
    pub(super) fn same_picture(&self, other: &ViewScene) -> bool {
        self.same_mesh(other)
            && Arc::ptr_eq(&self.frame, &other.frame)
            && self.same_colors(other)
            && self.same_flaws(other)
            && Arc::ptr_eq(&self.dots, &other.dots)
            && Arc::ptr_eq(&self.lines, &other.lines)
            && self.shading == other.shading
            && (self.wireframe, self.grid, self.see_through) == (other.wireframe, other.grid, other.see_through)
            && self.camera == other.camera
            && self.bounds == other.bounds
            && self.pixels_per_point == other.pixels_per_point
    }

    /// Are triangles, lines on them and textures the same?
    pub(super) fn same_mesh(&self, other: &ViewScene) -> bool {
        Arc::ptr_eq(&self.triangles, &other.triangles)
            && same(&self.unmarked_edges, &other.unmarked_edges)
            && same(&self.textures, &other.textures)
    }

    /// Would both point out the same faces?
    pub(super) fn same_flaws(&self, other: &ViewScene) -> bool {
        same(&self.flaws, &other.flaws)
    }

    /// Is what lies under the textures the same?
    pub(super) fn same_bases(&self, other: &ViewScene) -> bool {
        same(&self.base_colors, &other.base_colors)
            && same(&self.textures, &other.textures)
            && same(&self.locked, &other.locked)
            && same_preview(&self.preview, &other.preview)
    }

    /// Whether anything of the textures would be seen: an opaque ramp covers them.
    pub(super) fn shows_textures(&self) -> bool {
        self.textures.is_some() && (self.coloring == Coloring::Plain || self.color_opacity < 1.0)
    }

    /// Would both color the vertices alike?
    pub(super) fn same_colors(&self, other: &ViewScene) -> bool {
        Arc::ptr_eq(&self.rigidity, &other.rigidity)
            && same(&self.values, &other.values)
            && same(&self.selected, &other.selected)
            && self.same_bases(other)
            && (self.ramp_max, self.color_opacity) == (other.ramp_max, other.color_opacity)
            && (self.theme, &self.coloring) == (other.theme, &other.coloring)
    }
}

fn same_preview(a: &Option<Preview>, b: &Option<Preview>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(&a.vertices, &b.vertices) && a.r == b.r,
        (None, None) => true,
        _ => false,
    }
}

/// The same allocation, or none on both sides.
fn same<T: ?Sized>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}
