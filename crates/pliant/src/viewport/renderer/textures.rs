//! Textures on the device.

use super::super::{Texture, TextureSet, Wrap};
use super::gpu::Gpu;
use std::ops::Range;
use std::sync::Arc;

/// Texels are stored as sRGB; the sampler gives linear light.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// The textures of the picture, each with its sampler in a group.
#[derive(Default)]
pub(super) struct Textures {
    held: Option<Held>,
}

struct Held {
    set: Arc<TextureSet>,
    groups: Vec<wgpu::BindGroup>,
    white: wgpu::BindGroup,
}

impl Textures {
    /// Whether these are the textures on the device.
    pub(super) fn hold(&self, set: &Arc<TextureSet>) -> bool {
        self.held.as_ref().is_some_and(|held| Arc::ptr_eq(&held.set, set))
    }

    /// Brings the textures to the device.
    pub(super) fn upload(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout, set: &Arc<TextureSet>) {
        let white = Texture { size: [1, 1], levels: vec![vec![255; 4]], wrap: [Wrap::Repeat; 2] };
        self.held = Some(Held {
            set: set.clone(),
            groups: set.images.iter().map(|image| group(gpu, layout, image)).collect(),
            white: group(gpu, layout, &white),
        });
    }

    /// Frees what is not shown any more.
    pub(super) fn clear(&mut self) {
        self.held = None;
    }

    /// Calls `draw` with the texture of each run of triangles that has corners in this range.
    pub(super) fn for_each_run(&self, corners: Range<u32>, mut draw: impl FnMut(&wgpu::BindGroup, Range<u32>)) {
        let Some(held) = &self.held else { return };
        for (triangles, image) in &held.set.runs {
            let part = (3 * triangles.start).max(corners.start)..(3 * triangles.end).min(corners.end);
            if !part.is_empty() {
                draw(image.and_then(|image| held.groups.get(image)).unwrap_or(&held.white), part);
            }
        }
    }
}

/// A texture and its sampler. What is larger than the device allows begins with a smaller level.
fn group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, image: &Texture) -> wgpu::BindGroup {
    let most = gpu.device.limits().max_texture_dimension_2d;
    let sizes = (0..image.levels.len() as u32).map(|level| image.size.map(|side| (side >> level).max(1)));
    let levels: Vec<_> = sizes.zip(&image.levels).filter(|(size, _)| size.iter().all(|side| *side <= most)).collect();
    let [width, height] = levels.first().map_or([1, 1], |(size, _)| *size);
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("texture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels.len().max(1) as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, (size, bytes)) in (0..).zip(levels) {
        gpu.write_level(&texture, level, size, bytes);
    }
    let address = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("texture"),
        address_mode_u: address(image.wrap[0]),
        address_mode_v: address(image.wrap[1]),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("texture"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
        ],
    })
}
