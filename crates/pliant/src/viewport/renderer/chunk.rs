//! A part of the triangles in buffers of its own, small enough for the device: corners, texture coordinates, which edges are lines.

use super::super::ViewScene;
use super::gpu::Gpu;
use std::ops::Range;

/// Triangles whose bits share a word.
const PER_WORD: usize = 8;
/// The largest thing a chunk stores of a corner: two texture coordinates.
const CORNER_BYTES: u64 = 8;

/// How many triangles a chunk holds at most, if no buffer may be larger: a multiple of those whose bits share a word.
pub(super) fn whole_triangles(largest_buffer: u64) -> usize {
    ((largest_buffer / CORNER_BYTES / 3) as usize / PER_WORD * PER_WORD).max(PER_WORD)
}

/// Corner numbers in one buffer, three a triangle or two an edge.
pub(super) struct Corners {
    buffer: wgpu::Buffer,
    pub(super) n: u32,
}

impl Corners {
    /// Uploads corners, of which there is at least one; `fetched` for programs that read them by number.
    pub(super) fn new(gpu: &Gpu, corners: &[u32], fetched: bool) -> Corners {
        let storage = if fetched { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::empty() };
        let buffer = gpu.buffer("corners", wgpu::BufferUsages::INDEX | storage, bytemuck::cast_slice(corners));
        Corners { buffer, n: corners.len() as u32 }
    }

    /// Draws with the vertices and the program that are set.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_index_buffer(self.buffer.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.n, 0, 0..1);
    }
}

/// A part of the triangles.
pub(super) struct Chunk {
    pub(super) corners: Corners,
    /// Number of its first corner in the whole mesh.
    pub(super) first: u32,
    /// Four bits a triangle; `None` where nothing is fetched.
    unmarked: Option<wgpu::Buffer>,
    /// Texture coordinates of each corner.
    uvs: Option<wgpu::Buffer>,
    /// All that fetching programs read, where they can.
    pub(super) fetch: Option<wgpu::BindGroup>,
}

impl Chunk {
    /// Uploads a range of the scene's triangles, which is not empty and begins with a whole word of bits.
    pub(super) fn new(gpu: &Gpu, scene: &ViewScene, part: Range<usize>, fetched: bool, textured: bool) -> Chunk {
        let storage = wgpu::BufferUsages::STORAGE;
        let corners = Corners::new(gpu, bytemuck::cast_slice(&scene.triangles[part.clone()]), fetched);
        let unmarked = fetched.then(|| {
            let bits = scene.unmarked_edges.as_deref().unwrap_or_default();
            let bits = &bits[part.start.min(bits.len())..part.end.min(bits.len())];
            let mut words: Vec<u32> = bits.chunks(PER_WORD).map(word).collect();
            // One word for eight triangles costs little; the length of an array is not told alike by all drivers.
            words.resize(part.len().div_ceil(PER_WORD), 0);
            gpu.buffer("edges that are no lines", storage, bytemuck::cast_slice(&words))
        });
        let uvs = scene
            .textures
            .as_ref()
            .filter(|_| textured)
            .map(|set| gpu.buffer("texture coordinates", storage, bytemuck::cast_slice(&set.uvs[part.clone()])));
        Chunk { corners, first: 3 * part.start as u32, unmarked, uvs, fetch: None }
    }

    /// Binds positions, normals, colors and base colors with what is the chunk's own.
    pub(super) fn bind(
        &mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        [positions, normals, colors, bases]: [&wgpu::Buffer; 4],
        nothing: &wgpu::Buffer,
    ) {
        let own = |buffer: &'_ Option<wgpu::Buffer>| buffer.clone().unwrap_or_else(|| nothing.clone());
        let (unmarked, uvs) = (own(&self.unmarked), own(&self.uvs));
        let buffers = [positions, normals, colors, &self.corners.buffer, &unmarked, &uvs, bases];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let group = wgpu::BindGroupDescriptor { label: Some("fetch"), layout, entries: &entries };
        self.fetch = Some(gpu.device.create_bind_group(&group));
    }
}

/// The bits of up to eight triangles, the first in the lowest four.
fn word(bits: &[u8]) -> u32 {
    bits.iter().rev().fold(0, |word, bits| word << 4 | u32::from(bits & 7))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_of_a_triangle_are_where_the_program_looks_for_them() {
        let bits = [1, 2, 4, 7, 0, 3, 5, 6];
        for n in 0..=8 {
            let packed = word(&bits[..n]);
            for (triangle, bits) in bits[..n].iter().enumerate() {
                assert_eq!(packed >> (4 * (triangle % 8)) & 7, u32::from(*bits), "triangle {triangle} of {n}");
            }
        }
    }

    #[test]
    fn chunks_begin_with_a_whole_word_of_bits() {
        for largest in [200, 24_000, 128 << 20, u64::MAX / 4] {
            let n = whole_triangles(largest);
            assert!(n > 0 && n.is_multiple_of(PER_WORD), "{n}");
            assert!(3 * n as u64 * CORNER_BYTES <= largest);
        }
    }
}
