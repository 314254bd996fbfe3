//! What is drawn into: color (resolved), its samples, and depth.

/// Plain bytes: gamma is encoded in the shaders.
pub(super) const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// A float, since depth is reversed: precision then follows distance.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// The textures of one size and number of samples.
pub(super) struct Targets {
    pub(super) size: [u32; 2],
    pub(super) samples: u32,
    pub(super) color: wgpu::Texture,
    pub(super) color_view: wgpu::TextureView,
    samples_view: Option<wgpu::TextureView>,
    depth_view: wgpu::TextureView,
}

impl Targets {
    /// Allocates; `size` within the device's limits.
    pub(super) fn new(device: &wgpu::Device, size: [u32; 2], samples: u32) -> Targets {
        let texture = |label, format, sample_count, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let none = wgpu::TextureUsages::empty();
        let color = texture("picture", COLOR, 1, wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC);
        Targets {
            size,
            samples,
            color_view: view(&color),
            samples_view: (samples > 1).then(|| view(&texture("picture samples", COLOR, samples, none))),
            depth_view: view(&texture("picture depth", DEPTH, samples, none)),
            color,
        }
    }

    /// Begins a pass over cleared targets (depth: far).
    pub(super) fn begin<'e>(&self, encoder: &'e mut wgpu::CommandEncoder) -> wgpu::RenderPass<'e> {
        let (view, resolve_target, store) = match &self.samples_view {
            Some(samples) => (samples, Some(&self.color_view), wgpu::StoreOp::Discard),
            None => (&self.color_view, None, wgpu::StoreOp::Store),
        };
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("viewport"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depth_view,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }
}
