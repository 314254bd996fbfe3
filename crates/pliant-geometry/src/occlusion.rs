//! Which of very many points does a surface hide from the eye: a picture of depths, made by the processor.
//!
//! A ray for every vertex of a million takes seconds. Drawing the surface's depth once takes a few hundredths of one, and
//! answers for all points that are clearly before or clearly behind what is drawn around them. The few that are neither
//! (near outlines, in steep places) are left to the caller, who casts rays.
//!
//! A pixel keeps *nearness*, which is linear on screen: 1 / depth in perspective, −depth in a parallel view. Its largest
//! value wins, whatever the order, so that the picture is the same for any number of threads.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Triangles that are worth a task.
const PER_TASK: usize = 4096;

/// From space to pixels. `right`, `down` and `forward` are unit vectors across each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Where depths are counted from.
    pub eye: Vec3,
    /// Along the picture's x axis.
    pub right: Vec3,
    /// Along the picture's y axis.
    pub down: Vec3,
    /// Into the picture.
    pub forward: Vec3,
    /// Pixels for one unit across: at depth 1 in perspective, at any depth else.
    pub focal_px: f32,
    /// Width and height in pixels.
    pub size: Vec2,
    /// Whether what is farther is smaller.
    pub is_perspective: bool,
    /// What is nearer than this is not seen and hides nothing; positive in perspective.
    pub closest_depth: f32,
}

/// What the picture of depths says of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// Nothing around it is nearer.
    Clear,
    /// All around it is nearer by far.
    Hidden,
    /// Neither: cast a ray.
    Doubtful,
}

/// The nearest depth in each pixel.
pub struct Occlusion {
    lens: Lens,
    width: usize,
    height: usize,
    nearest: Vec<AtomicU32>,
}

/// A corner on screen.
#[derive(Clone, Copy)]
struct Corner {
    px: Vec2,
    nearness: f32,
}

impl Lens {
    /// Across and depth of a point, in units of the world.
    fn in_view(&self, point: Vec3) -> Vec3 {
        let from_eye = point - self.eye;
        Vec3::new(from_eye.dot(self.right), from_eye.dot(self.down), from_eye.dot(self.forward))
    }

    fn corner(&self, in_view: Vec3) -> Corner {
        let (scale, nearness) = match self.is_perspective {
            true => (self.focal_px / in_view.z, 1.0 / in_view.z),
            false => (self.focal_px, -in_view.z),
        };
        Corner { px: self.size * 0.5 + in_view.truncate() * scale, nearness }
    }

    fn nearness(&self, depth: f32) -> f32 {
        match self.is_perspective {
            true if depth > 0.0 => 1.0 / depth,
            true => f32::INFINITY,
            false => -depth,
        }
    }
}

impl Occlusion {
    /// Draws a surface. O(triangles + pixels they cover), parallel.
    pub fn new(positions: &[Vec3], triangles: &[[u32; 3]], lens: Lens) -> Occlusion {
        // A picture without extent answers nothing, one beyond any screen is not worth its memory.
        let side = |length: f32| length.clamp(0.0, 8192.0).ceil() as usize;
        let (width, height) = (side(lens.size.x), side(lens.size.y));
        let nearest = std::iter::repeat_with(|| AtomicU32::new(0)).take(width * height).collect();
        let picture = Occlusion { lens, width, height, nearest };
        triangles.par_iter().with_min_len(PER_TASK).for_each(|&triangle| {
            let corner = |v: u32| positions.get(v as usize).map(|&p| lens.in_view(p));
            if let [Some(a), Some(b), Some(c)] = triangle.map(corner) {
                picture.draw([a, b, c]);
            }
        });
        picture
    }

    /// What hides a point of this surface, or of any other: `slack` is a depth that no sheet before it comes nearer.
    pub fn sight(&self, point: Vec3, slack: f32) -> Sight {
        let in_view = self.lens.in_view(point);
        let Corner { px, .. } = self.lens.corner(in_view);
        let corner = (px - 0.5).floor();
        let is_inside =
            corner.cmpge(Vec2::ZERO).all() && corner.x + 1.0 < self.width as f32 && corner.y + 1.0 < self.height as f32;
        if !is_inside || in_view.z < self.lens.closest_depth {
            return Sight::Doubtful;
        }
        let (x, y) = (corner.x as usize, corner.y as usize);
        let around = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]
            .map(|(x, y)| self.nearest[y * self.width + x].load(Ordering::Relaxed));
        let (least, most) = around.iter().fold((u32::MAX, 0), |(lo, hi), &n| (lo.min(n), hi.max(n)));
        if most <= ordered(self.lens.nearness(in_view.z - slack)) {
            Sight::Clear
        } else if least > ordered(self.lens.nearness(in_view.z - CLEARLY * slack)) {
            Sight::Hidden
        } else {
            Sight::Doubtful
        }
    }

    /// Draws a triangle, cut where it comes too near.
    fn draw(&self, triangle: [Vec3; 3]) {
        let near = self.lens.closest_depth;
        if triangle.iter().all(|p| p.z >= near) {
            self.fill(triangle.map(|p| self.lens.corner(p)));
            return;
        }
        let (mut cut, mut n) = ([Vec3::ZERO; 4], 0);
        for (a, b) in [(triangle[0], triangle[1]), (triangle[1], triangle[2]), (triangle[2], triangle[0])] {
            if a.z >= near {
                cut[n] = a;
                n += 1;
            }
            if (a.z >= near) != (b.z >= near) {
                cut[n] = a.lerp(b, (near - a.z) / (b.z - a.z)).with_z(near);
                n += 1;
            }
        }
        for k in 2..n {
            self.fill([cut[0], cut[k - 1], cut[k]].map(|p| self.lens.corner(p)));
        }
    }

    /// Row by row, so that long slivers cost their length only.
    fn fill(&self, corners: [Corner; 3]) {
        let [a, b, c] = corners;
        let (ab, ac) = (b.px - a.px, c.px - a.px);
        let area = ab.perp_dot(ac);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let (to_b, to_c) = (b.nearness - a.nearness, c.nearness - a.nearness);
        let slope = Vec2::new(to_b * ac.y - to_c * ab.y, to_c * ab.x - to_b * ac.x) / area;
        if !slope.is_finite() {
            return;
        }
        let nearnesses = corners.map(|corner| corner.nearness);
        let range = nearnesses.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &n| (lo.min(n), hi.max(n)));
        let (top, bottom) = span(corners.map(|corner| corner.px.y), self.height);
        for row in top..bottom {
            let y = row as f32 + 0.5;
            let (left, right) = span(crossings(corners, y), self.width);
            for column in left..right {
                let px = Vec2::new(column as f32 + 0.5, y);
                let nearness = (a.nearness + (px - a.px).dot(slope)).clamp(range.0, range.1);
                let pixel = &self.nearest[row * self.width + column];
                let value = ordered(nearness);
                if value > pixel.load(Ordering::Relaxed) {
                    pixel.fetch_max(value, Ordering::Relaxed);
                }
            }
        }
    }
}

/// Hidden is only what lies this many slacks behind all around it: in a groove, the walls at both sides are nearer than
/// its bottom (by eye: walls up to 84° from the picture).
const CLEARLY: f32 = 10.0;

/// Places where the sides of a triangle meet a row, between its topmost and its lowest corner.
fn crossings(corners: [Corner; 3], y: f32) -> [f32; 3] {
    let side = |i: usize| {
        let (a, b) = (corners[i].px, corners[(i + 1) % 3].px);
        if (a.y > y) == (b.y > y) { f32::NAN } else { a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)) }
    };
    [side(0), side(1), side(2)]
}

/// Pixels whose centers lie between the smallest and the largest of some places; NaN counts as absent.
fn span(places: [f32; 3], n: usize) -> (usize, usize) {
    let (lo, hi) = places.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    if lo > hi {
        return (0, 0);
    }
    let pixel = |at: f32| (at - 0.5).ceil().clamp(0.0, n as f32) as usize;
    (pixel(lo), pixel(hi))
}

/// Bits whose order as whole numbers is the order of the numbers; 0 is below all.
fn ordered(number: f32) -> u32 {
    let bits = number.to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_shapes::{Noise, soup};
    use crate::{Bvh, Ray};

    fn lens(is_perspective: bool) -> Lens {
        Lens {
            eye: Vec3::new(0.0, 0.0, 4.0),
            right: Vec3::X,
            down: Vec3::NEG_Y,
            forward: Vec3::NEG_Z,
            focal_px: if is_perspective { 500.0 } else { 120.0 },
            size: Vec2::new(400.0, 300.0),
            is_perspective,
            closest_depth: if is_perspective { 0.04 } else { -100.0 },
        }
    }

    /// Whether a ray from the eye, or from far behind it, is free up to a point.
    fn is_clear(point: Vec3, lens: &Lens, slack: f32, bvh: &Bvh, shape: &(Vec<Vec3>, Vec<[u32; 3]>)) -> bool {
        let origin = if lens.is_perspective { lens.eye } else { point - lens.forward * 50.0 };
        let way = point - origin;
        let ray = Ray { origin, direction: way.normalize() };
        !bvh.is_blocked(ray, way.length() - slack, &shape.0, &shape.1)
    }

    #[test]
    fn what_is_clear_or_hidden_is_so_for_rays_too() {
        for is_perspective in [true, false] {
            let mut noise = Noise(5);
            // Large faces, so that nothing fits between two pixels.
            let (mut positions, triangles) = soup(40, 0.5, &mut noise);
            let n_corners = positions.len();
            positions.extend((0..2000).map(|_| noise.point()));
            let (shape, lens, slack) = ((positions, triangles), lens(is_perspective), 0.004);
            let bvh = Bvh::new(&shape.0, &shape.1);
            let picture = Occlusion::new(&shape.0, &shape.1, lens);
            let (mut counts, mut wrong) = ([0; 3], 0);
            for &point in &shape.0[n_corners..] {
                let (sight, clear) = (picture.sight(point, slack), is_clear(point, &lens, slack, &bvh, &shape));
                counts[sight as usize] += 1;
                wrong += usize::from(sight == Sight::Clear && !clear || sight == Sight::Hidden && clear);
            }
            assert!(counts[0] > 300 && counts[1] > 300, "clear, hidden and doubtful: {counts:?}");
            // Rays pass a hair beside an edge where the nearest pixels are all on its other side.
            assert!(wrong * 100 < counts[0] + counts[1], "{wrong} wrong of {counts:?}");
            assert!(counts[2] * 4 < counts[0] + counts[1], "too many doubts: {counts:?}");
        }
    }

    #[test]
    fn a_face_that_reaches_behind_the_eye_hides_what_it_covers() {
        let positions = vec![Vec3::new(-50.0, -0.5, 10.0), Vec3::new(50.0, -0.5, 10.0), Vec3::new(0.0, -0.5, -90.0)];
        let picture = Occlusion::new(&positions, &[[0, 1, 2]], lens(true));
        assert_eq!(picture.sight(Vec3::new(0.0, -0.7, 0.0), 0.004), Sight::Hidden, "under the floor");
        assert_eq!(picture.sight(Vec3::new(0.0, -0.3, 0.0), 0.004), Sight::Clear, "over the floor");
    }

    #[test]
    fn broken_faces_and_pictures_without_extent_hide_nothing() {
        let positions = vec![Vec3::NAN, Vec3::INFINITY, Vec3::ZERO, Vec3::X];
        let triangles = [[0, 1, 2], [2, 2, 3], [2, 3, 99], [1, 2, 3]];
        let picture = Occlusion::new(&positions, &triangles, lens(true));
        assert_eq!(picture.sight(Vec3::new(0.1, 0.1, -2.0), 0.004), Sight::Clear);
        for size in [Vec2::ZERO, Vec2::NAN, Vec2::NEG_ONE] {
            let picture = Occlusion::new(&positions, &triangles, Lens { size, ..lens(true) });
            assert_eq!(picture.sight(Vec3::ZERO, 0.004), Sight::Doubtful);
        }
        assert_eq!(Occlusion::new(&positions, &triangles, lens(true)).sight(Vec3::NAN, 0.1), Sight::Doubtful);
    }
}
