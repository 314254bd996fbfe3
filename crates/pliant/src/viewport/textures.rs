//! Textures of a surface: pictures with their smaller copies, and which triangle shows which part of which.

use super::ramp::{encode, linear};
use glam::{Vec2, Vec3};
use std::ops::Range;

/// What lies beyond the edge of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The picture again.
    Repeat,
    /// The picture mirrored.
    Mirror,
    /// Its edge.
    Clamp,
}

/// A picture with copies of half, a quarter, … its size, down to one pixel: far surfaces neither flicker nor cost more.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Width and height of the first level.
    pub size: [u32; 2],
    /// Tightly packed sRGB RGBA8, each level half the one before (rounded down, at least 1).
    pub levels: Vec<Vec<u8>>,
    /// Beyond left and right, beyond top and bottom.
    pub wrap: [Wrap; 2],
}

/// The textures of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TextureSet {
    /// The pictures.
    pub images: Vec<Texture>,
    /// Ranges of triangles, ascending, that cover the surface; each with its picture, if it has one.
    pub runs: Vec<(Range<u32>, Option<usize>)>,
    /// Of each corner of each triangle, origin at the lower left.
    pub uvs: Vec<[Vec2; 3]>,
}

impl TextureSet {
    /// Whether it belongs to a surface of so many triangles.
    pub(super) fn fits(&self, n_triangles: usize) -> bool {
        self.uvs.len() == n_triangles
    }
}

impl Texture {
    /// Makes the smaller copies: means of four pixels, taken in linear light.
    pub fn new(image: image::RgbaImage, wrap: [Wrap; 2]) -> Texture {
        let size = [image.width(), image.height()];
        let (mut level, mut at) = (image.into_raw(), size);
        let light: Vec<f32> = (0..=255).map(|byte| linear([byte; 3]).x).collect();
        let mut levels = Vec::new();
        while at != [1, 1] && !level.is_empty() {
            let smaller = halved(&level, at, &light);
            levels.push(std::mem::replace(&mut level, smaller));
            at = at.map(|side| (side / 2).max(1));
        }
        levels.push(level);
        Texture { size, levels, wrap }
    }

    /// Leaves out the largest copy, unless it is the only one.
    pub fn shrink(&mut self) {
        if self.levels.len() > 1 {
            self.levels.remove(0);
            self.size = self.size.map(|side| (side / 2).max(1));
        }
    }

    /// Memory of all levels.
    pub fn bytes(&self) -> usize {
        self.levels.iter().map(Vec::len).sum()
    }
}

/// Half the size; `light` is the linear light of each byte.
fn halved(level: &[u8], [width, height]: [u32; 2], light: &[f32]) -> Vec<u8> {
    let pixel = |x: u32, y: u32| {
        let start = 4 * (y.min(height - 1) as usize * width as usize + x.min(width - 1) as usize);
        [level[start], level[start + 1], level[start + 2], level[start + 3]]
    };
    let (half_width, half_height) = ((width / 2).max(1), (height / 2).max(1));
    let mut out = Vec::with_capacity(4 * half_width as usize * half_height as usize);
    for y in 0..half_height {
        for x in 0..half_width {
            let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| pixel(2 * x + dx, 2 * y + dy));
            let color = |[r, g, b, _]: [u8; 4]| Vec3::new(light[r as usize], light[g as usize], light[b as usize]);
            out.extend(encode(four.map(color).iter().sum::<Vec3>() * 0.25));
            out.push((four.iter().map(|px| u32::from(px[3])).sum::<u32>().div_ceil(4)) as u8);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_level_is_half_the_one_before() {
        for (width, height) in [(1, 1), (8, 8), (7, 3), (1, 16), (33, 2)] {
            let image = image::RgbaImage::from_pixel(width, height, image::Rgba([10, 200, 90, 255]));
            let texture = Texture::new(image, [Wrap::Repeat; 2]);
            for (level, bytes) in texture.levels.iter().enumerate() {
                let n = (width >> level).max(1) * (height >> level).max(1);
                assert_eq!(bytes.len(), 4 * n as usize, "level {level} of {width} x {height}");
                for px in bytes.chunks(4) {
                    assert!(px.iter().zip([10, 200, 90, 255]).all(|(a, b)| a.abs_diff(b) <= 1), "{px:?}");
                }
            }
            assert_eq!(texture.levels.last().map(Vec::len), Some(4), "down to one pixel");
        }
    }

    #[test]
    fn means_are_taken_in_linear_light() {
        let image = image::RgbaImage::from_fn(2, 2, |x, y| image::Rgba([if (x + y) % 2 == 0 { 0 } else { 255 }; 4]));
        let texture = Texture::new(image, [Wrap::Clamp; 2]);
        // Half the light is 188 in sRGB.
        assert_eq!(texture.levels[1], [188, 188, 188, 128]);
    }

    #[test]
    fn a_shrunk_texture_begins_with_its_next_level() {
        let mut texture = Texture::new(image::RgbaImage::new(6, 4), [Wrap::Mirror; 2]);
        let next = texture.levels[1].clone();
        texture.shrink();
        assert_eq!((texture.size, &texture.levels[0]), ([3, 2], &next));
        (0..9).for_each(|_| texture.shrink());
        assert_eq!((texture.size, texture.bytes()), ([1, 1], 4));
    }
}
