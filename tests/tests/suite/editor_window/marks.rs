//! What each tool shows under the pointer and over the surface, looked for in the pixels of the window.
//!
//! The bar is seen square from its front, one vertex in the middle of the viewport and its neighbors 40 points away, so
//! that a test knows where a mark has to be. A picture with the mark is held against one without, or against the mark's
//! own color; a pixel to each side is left to how an adapter draws lines. The harness draws an arrow of its own where the
//! pointer is, to the right and down from it: tests look elsewhere.

mod handles;
mod painting;
mod selecting;

use super::*;
use egui::{CursorIcon, Pos2, vec2};
use image::RgbaImage;
use pliant::viewport::{Axis, Projection};

/// Points between neighboring vertices on screen.
const CELL: f32 = 40.0;
/// The one color that means *this one*: outlines of box and lasso.
const ACCENT: [u8; 3] = [240, 160, 60];
const WHITE: [u8; 3] = [255, 255, 255];
/// How far a pixel may be from the color of a mark that covers it wholly, in levels: the softened edge of thin lines.
const NEAR: f32 = 60.0;

/// The window and the vertex in the middle of its viewport.
struct Stage {
    window: Window,
    middle: u32,
    _folder: tempfile::TempDir,
}

/// The viewport, cut out of a picture of the window.
struct Picture {
    pixels: RgbaImage,
    corner: Pos2,
}

impl Stage {
    fn new(tool: egui::Key) -> Stage {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut window = window(folder.path());
        let session = window.state_mut().session();
        let size = session.viewport_size();
        let open = session.open_mut().expect("open");
        open.camera.look_along(Axis::Front);
        open.camera.projection = Projection::Orthographic;
        let positions = open.surface.frame().positions.clone();
        let order = |p: &glam::Vec3| (-p.z, p.truncate().length());
        let middle = (0..positions.len())
            .min_by(|&a, &b| order(&positions[a]).partial_cmp(&order(&positions[b])).expect("finite"))
            .expect("a vertex");
        open.camera.target = positions[middle];
        // The paper's bar has cells of a sixth of a unit.
        let cell_px = 1.0 / 6.0 / open.camera.world_per_px(open.camera.target, size);
        open.camera.distance *= cell_px / CELL;
        let mut stage = Stage { window, middle: middle as u32, _folder: folder };
        press(&mut stage.window, tool);
        stage
    }

    fn session(&mut self) -> &mut Session {
        self.window.state_mut().session()
    }

    /// A place on the front of the bar, in cells to the right of the middle and up.
    fn at(&mut self, right: f32, up: f32) -> Pos2 {
        let middle = self.middle;
        place(&mut self.window, middle) + vec2(right, -up) * CELL
    }

    fn hover(&mut self, at: Pos2) {
        self.window.hover_at(at);
        self.window.run_steps(2);
    }

    fn press_at(&mut self, at: Pos2) {
        self.hover(at);
        self.window.drag_at(at);
        self.window.step();
    }

    /// Moves the pressed pointer along a line.
    fn draw_to(&mut self, from: Pos2, to: Pos2) {
        for k in 1..=6 {
            self.window.hover_at(from.lerp(to, k as f32 / 6.0));
            self.window.step();
        }
    }

    fn drop_at(&mut self, at: Pos2) {
        self.window.drop_at(at);
        self.window.run_steps(2);
    }

    /// What the viewport shows, with smooth edges: the picture is refined once nothing has moved for a moment.
    fn picture(&mut self) -> Picture {
        std::thread::sleep(Duration::from_millis(400));
        self.window.run_steps(3);
        let picture = self.window.render().unwrap_or_else(|error| panic!("{error}: {NO_ADAPTER}"));
        let rect = self.window.get_by_label("viewport").rect();
        let (corner, size) = (rect.min.floor(), rect.size());
        let [x, y, width, height] = [corner.x, corner.y, size.x, size.y].map(|value| value as u32);
        Picture { pixels: image::imageops::crop_imm(&picture, x, y, width, height).to_image(), corner }
    }

    /// The picture with the pointer elsewhere.
    fn without_pointer(&mut self) -> Picture {
        let corner = self.window.get_by_label("viewport").rect().left_top();
        self.hover(corner - vec2(4.0, 4.0));
        self.picture()
    }

    fn cursor(&mut self) -> CursorIcon {
        self.window.step();
        self.window.output().platform_output.cursor_icon
    }
}

impl Picture {
    /// Colors of the pixel there and of its neighbors.
    fn around(&self, at: Pos2) -> [[f32; 3]; 9] {
        let (x, y) = ((at.x - self.corner.x) as i32, (at.y - self.corner.y) as i32);
        std::array::from_fn(|k| {
            let (x, y) = (x + k as i32 % 3 - 1, y + k as i32 / 3 - 1);
            let [r, g, b, _] = self.pixels.get_pixel(x as u32, y as u32).0.map(f32::from);
            [r, g, b]
        })
    }

    /// How near this color comes to what is there, in levels of the worst channel.
    fn distance(&self, at: Pos2, color: [u8; 3]) -> f32 {
        let far = |seen: [f32; 3]| (0..3).map(|c| (seen[c] - f32::from(color[c])).abs()).fold(0.0, f32::max);
        self.around(at).into_iter().map(far).fold(f32::MAX, f32::min)
    }

    /// How much brighter it is there than in another picture of the same view.
    fn brighter(&self, at: Pos2, other: &Picture) -> f32 {
        let gain = |(a, b): ([f32; 3], [f32; 3])| (0..3).map(|c| a[c] - b[c]).sum::<f32>() / 3.0;
        self.around(at).into_iter().zip(other.around(at)).map(gain).fold(f32::MIN, f32::max)
    }

    /// Whether anything is drawn there that another picture of the same view does not show.
    fn differs(&self, at: Pos2, other: &Picture) -> bool {
        let far = |(a, b): ([f32; 3], [f32; 3])| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
        self.around(at).into_iter().zip(other.around(at)).map(far).fold(0.0, f32::max) > 12.0
    }

    /// Asserts that a color lies all along a line.
    fn assert_line(&self, from: Pos2, to: Pos2, color: [u8; 3], what: &str) {
        for k in 1..10 {
            let at = from.lerp(to, k as f32 / 10.0);
            let far = self.distance(at, color);
            assert!(far < NEAR, "{what}: at {at} the nearest to {color:?} is {far} levels off");
        }
    }

    /// Asserts a disc of this color, wholly covered in its middle.
    fn assert_dot(&self, at: Pos2, color: [u8; 3], what: &str) {
        let far = self.distance(at, color);
        assert!(far < 12.0, "{what}: at {at} the nearest to {color:?} is {far} levels off");
    }

    /// Asserts a bright ring about a place, seen square, and nothing but the surface within, left of the place.
    fn assert_ring(&self, center: Pos2, radius: f32, other: &Picture, what: &str) {
        let around = |radius: f32| (0..24).map(move |k| center + radius * egui::Vec2::angled(k as f32 * 0.2618 + 0.1));
        for at in around(radius) {
            let gain = self.brighter(at, other);
            assert!(gain > 25.0, "{what}: at {at} only {gain} levels brighter than without");
        }
        let stray: Vec<Pos2> = around(0.5 * radius).filter(|at| at.x < center.x && self.differs(*at, other)).collect();
        assert!(stray.is_empty(), "{what}: something lies within the ring, at {stray:?}");
    }
}
