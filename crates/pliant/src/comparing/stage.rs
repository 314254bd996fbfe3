//! The same light, ground and camera for every surface that is compared.
//!
//! All surfaces are first [placed](Stage::place), which tells how much room they take; the pictures are drawn afterwards. The
//! camera looks from where that of `pliant render` does, as near as shows the shape at rest, where handles go to, and all that
//! became of it. A surface that ran away beyond all this does not make the others tiny: the picture then cuts it off.

use std::collections::HashSet;
use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};
use pliant_geometry::VertexNormals;
use pliant_solver::Mesh;

use crate::viewport::{Camera, Coloring, Dot, Line, SurfaceFrame, Theme, ViewScene};

/// Placed coordinates are at most this large, in radii of the scene: far beyond every picture, far within single precision.
const FARTHEST: f64 = 1e6;

/// Points nearer to each other than this part of the radius are one, as for the targets of a handles file.
const SAME: f64 = 1e-9;

/// Size of a picture: twice that at which it is shown, for dense screens and for paper (by eye).
pub const PICTURE_PX: [u32; 2] = [720, 600];
/// Pixels of a picture in a point of the page.
const DENSITY: f32 = 2.0;
/// The part of the view that stays free on each side (by eye).
const MARGIN: f32 = 0.06;
/// Cells of the picture that hold one dot each, in points (by eye: wider than a dot with its outline).
const DOT_SPACING: f32 = 11.0;

/// Where the vertices of a surface are on the stage.
pub type Placed = Vec<Vec3>;

/// What is marked in one picture.
#[derive(Clone, Debug, Default)]
pub struct Marks {
    /// Linear color of every vertex; none: clay.
    pub colors: Option<Arc<[[u8; 4]]>>,
    /// Over the surface.
    pub dots: Vec<Dot>,
    /// From here to there.
    pub lines: Vec<Line>,
}

/// Where surfaces with the same triangles are looked at.
pub struct Stage {
    triangles: Arc<[[u32; 3]]>,
    normals: VertexNormals,
    center: DVec3,
    /// Half the diagonal of rest shape and targets, which is 1 on the stage.
    radius: f64,
    /// What is expected to be seen, and as much again on all sides.
    room: (Vec3, Vec3),
    /// What is looked at so far.
    bounds: (Vec3, Vec3),
    view: View,
}

/// The narrowest view of points from a given direction: their supports along the four sides of the view's pyramid.
#[derive(Clone, Copy)]
struct View {
    camera: Camera,
    /// Half the view's width and height at depth 1.
    tangents: [f32; 2],
    /// Right, left, top, bottom.
    supports: [f32; 4],
}

impl View {
    fn new() -> View {
        let camera = Camera::framing(Vec3::splat(-1.0), Vec3::splat(1.0));
        let [width, height] = PICTURE_PX.map(|side| side as f32);
        // The field of view is that of the shorter side.
        let half = (0.5 * camera.fov_y_radians).tan() * (1.0 - MARGIN) / width.min(height);
        View { camera, tangents: [width * half, height * half], supports: [f32::NEG_INFINITY; 4] }
    }

    fn add(&mut self, point: Vec3) {
        let (across, up, depth) =
            (point.dot(self.camera.right()), point.dot(self.camera.up()), point.dot(self.camera.forward()));
        let [wide, high] = self.tangents.map(|tangent| tangent * depth);
        let reached = [across - wide, -across - wide, up - high, -up - high];
        self.supports = std::array::from_fn(|side| self.supports[side].max(reached[side]));
    }

    /// The camera whose view touches the points: an eye at `e` sees one if `|(p − e)·right| ≤ tangent (p − e)·forward`, and
    /// likewise upward. Looks at the depth of `middle`.
    fn camera(&self, middle: Vec3) -> Camera {
        let [right, left, top, bottom] = self.supports;
        let depth = f32::min(-(right + left) / (2.0 * self.tangents[0]), -(top + bottom) / (2.0 * self.tangents[1]));
        let forward = self.camera.forward();
        // Points in one place would be looked at from within.
        let distance = (middle.dot(forward) - depth).max(0.5);
        let target = self.camera.right() * (right - left) * 0.5 + self.camera.up() * (top - bottom) * 0.5;
        Camera { target: target + forward * middle.dot(forward), distance, ..self.camera }
    }
}

impl Stage {
    /// A stage around the mesh at rest and all `targets`.
    pub fn new(mesh: &Mesh, targets: &[DVec3]) -> Stage {
        let points = || mesh.positions().iter().chain(targets);
        let first = mesh.positions()[0];
        let (low, high) = points().fold((first, first), |(low, high), &p| (low.min(p), high.max(p)));
        let half = (high - low) * 0.5;
        let radius = half.length();
        let mut stage = Stage {
            triangles: mesh.triangles().into(),
            normals: VertexNormals::new(mesh.n_vertices(), mesh.triangles()),
            center: low + half,
            radius: if radius > 0.0 { radius } else { 1.0 },
            room: (Vec3::splat(-3.0), Vec3::splat(3.0)),
            bounds: (Vec3::ZERO, Vec3::ZERO),
            view: View::new(),
        };
        let corners = (stage.point(low), stage.point(high));
        stage.room = (corners.0 - 2.0, corners.1 + 2.0);
        stage.bounds = corners;
        points().for_each(|&p| stage.view.add(stage.point(p)));
        stage
    }

    /// Where a point of the world is on the stage.
    pub fn point(&self, world: DVec3) -> Vec3 {
        let place = (world - self.center) / self.radius;
        place.clamp(DVec3::splat(-FARTHEST), DVec3::splat(FARTHEST)).as_vec3()
    }

    /// Whether two points of the world are one: decimal copies of coordinates differ in their last digits.
    pub fn is_same(&self, a: DVec3, b: DVec3) -> bool {
        a.distance(b) <= SAME * self.radius
    }

    /// Puts a surface on the stage, and makes room for it.
    pub fn place(&mut self, positions: &[DVec3]) -> Placed {
        let placed: Placed = positions.iter().map(|&p| self.point(p)).collect();
        for &p in &placed {
            let seen = p.clamp(self.room.0, self.room.1);
            self.bounds = (self.bounds.0.min(seen), self.bounds.1.max(seen));
            self.view.add(seen);
        }
        placed
    }

    /// One of these dots in each cell of a grid over the pictures, so that they leave something to be seen of what they
    /// mark. Stands once all surfaces are placed.
    pub fn apart(&self, dots: impl IntoIterator<Item = Dot>) -> Vec<Dot> {
        let (camera, size) = (self.camera(), Vec2::new(PICTURE_PX[0] as f32, PICTURE_PX[1] as f32));
        let mut taken = HashSet::new();
        let mut is_free = |dot: &Dot| {
            let cell = |(at, _): (Vec2, f32)| (at / (DENSITY * DOT_SPACING)).floor().as_ivec2();
            camera.project(dot.position, size).is_some_and(|seen| taken.insert(cell(seen)))
        };
        dots.into_iter().filter(|dot| is_free(dot)).collect()
    }

    /// The surface as it is, with marks, and with the triangles among `flaws` pointed out.
    pub fn shape(&self, placed: &Placed, marks: &Marks, flaws: &[[u32; 3]]) -> ViewScene {
        ViewScene {
            base_colors: marks.colors.clone(),
            dots: marks.dots.as_slice().into(),
            lines: marks.lines.as_slice().into(),
            flaws: (!flaws.is_empty()).then(|| flaws.into()),
            ..self.scene(placed)
        }
    }

    /// The surface colored by one number a vertex, from 0 to 1 through the ramp of energies.
    pub fn energies(&self, placed: &Placed, values: Vec<f32>) -> ViewScene {
        ViewScene { values: Some(values.into()), coloring: Coloring::Energy, ..self.scene(placed) }
    }

    /// The surface colored by r, on a ramp from 1 to `ramp_max`.
    pub fn rigidity(&self, placed: &Placed, rigidity: &[u16], ramp_max: u16) -> ViewScene {
        ViewScene { rigidity: rigidity.into(), ramp_max, coloring: Coloring::Rigidity, ..self.scene(placed) }
    }

    fn scene(&self, placed: &Placed) -> ViewScene {
        let mut normals = Vec::new();
        self.normals.compute(placed, &self.triangles, &mut normals);
        let frame = Arc::new(SurfaceFrame { positions: placed.clone(), normals });
        ViewScene {
            theme: Theme::Light,
            grid: true,
            pixels_per_point: DENSITY,
            ..ViewScene::plain(self.triangles.clone(), frame, self.camera(), self.bounds)
        }
    }

    fn camera(&self) -> Camera {
        self.view.camera((self.bounds.0 + self.bounds.1) * 0.5)
    }
}

/// The triangles of these pairs, each once, by their corners.
pub fn pointed_out(pairs: &[[u32; 2]], triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut faces: Vec<u32> = pairs.as_flattened().to_vec();
    faces.sort_unstable();
    faces.dedup();
    faces.into_iter().map(|face| triangles[face as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(size: f64) -> Mesh {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| (p + 7.0) * size);
        Mesh::new(points.into(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).expect("sound indices")
    }

    #[test]
    fn models_of_any_size_look_the_same() {
        let look = |size: f64| {
            let mesh = mesh(size);
            let mut stage = Stage::new(&mesh, &[DVec3::splat(9.0 * size)]);
            let placed = stage.place(mesh.positions());
            (placed, stage.camera())
        };
        // Powers of two: everything is the same to the bit.
        for size in [2.0_f64.powi(-300), 2.0_f64.powi(300)] {
            assert_eq!(look(size), look(1.0), "size {size}");
        }
    }

    #[test]
    fn the_camera_sees_all_surfaces_but_does_not_follow_one_that_ran_away() {
        let mesh = mesh(1.0);
        let mut stage = Stage::new(&mesh, &[]);
        let rest = stage.place(mesh.positions());
        let near = stage.camera();
        let reach = |camera: &Camera| {
            let seen = rest.iter().map(|&p| camera.project(p, Vec2::new(720.0, 600.0)).expect("in front").0);
            seen.fold((Vec2::MAX, Vec2::MIN), |(low, high), p| (low.min(p), high.max(p)))
        };
        let (low, high) = reach(&near);
        let free = low.x.min(low.y).min(720.0 - high.x).min(600.0 - high.y);
        assert!(free > 0.0, "all of it is seen: {low} to {high}");
        // The margin, of the half height or of the half width.
        assert!(
            (high.y - low.y) > 0.93 * 600.0 || (high.x - low.x) > 0.93 * 720.0,
            "as large as can be: {low} to {high}"
        );
        let moved: Vec<DVec3> = mesh.positions().iter().map(|&p| p + DVec3::X).collect();
        stage.place(&moved);
        let both = stage.camera();
        assert!(both.distance > near.distance, "{} from {}", both.distance, near.distance);
        stage.place(&[DVec3::splat(1e30); 4]);
        let away = stage.camera();
        assert!(away.distance < 8.0 * near.distance, "{} from {}", away.distance, near.distance);
        assert_eq!(rest.len(), 4);
    }

    #[test]
    fn a_mesh_in_one_point_has_a_stage() {
        let mesh = Mesh::new(vec![DVec3::ONE; 3], vec![[0, 1, 2]]).expect("sound indices");
        let mut stage = Stage::new(&mesh, &[]);
        assert_eq!(stage.place(mesh.positions()), [Vec3::ZERO; 3]);
        assert!(stage.camera().distance.is_finite());
    }

    #[test]
    fn of_dots_that_would_cover_each_other_one_is_left() {
        let mesh = mesh(1.0);
        let stage = Stage::new(&mesh, &[]);
        let dot = |position| Dot { position, color: [255; 4], radius_px: 2.0 };
        let (one, other) = (stage.point(DVec3::splat(7.0)), stage.point(DVec3::new(8.0, 7.0, 7.0)));
        assert_eq!(stage.apart([dot(one), dot(one + 1e-4), dot(other)]), [dot(one), dot(other)]);
    }

    #[test]
    fn faces_of_several_pairs_are_pointed_out_once() {
        let triangles = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        assert_eq!(pointed_out(&[[0, 2], [1, 2]], &triangles), triangles);
        assert_eq!(pointed_out(&[[0, 2]], &triangles), [[0, 1, 2], [6, 7, 8]]);
    }
}
