//! How shaders reach their data: one group for the whole picture, one for fetching vertices by number, one for a texture.

use super::uniforms::Picture;

/// Storage buffers of the fetching programs: positions, normals, colors, corners, edges without lines, texture coordinates, base
/// colors. Common devices have eight.
pub(super) const FETCHED: u32 = 7;

/// Bind group layouts, and whether vertices can be fetched by number.
#[derive(Clone)]
pub(super) struct Layouts {
    /// Group 0 of every program: the uniforms of one picture.
    pub(super) picture: wgpu::BindGroupLayout,
    /// Group 1 of the fetching programs; `None` where vertex programs have not enough storage buffers.
    pub(super) fetch: Option<wgpu::BindGroupLayout>,
    /// Group 2 of programs with a texture.
    pub(super) texture: wgpu::BindGroupLayout,
}

impl Layouts {
    /// Asks the device what it can do.
    pub(super) fn new(device: &wgpu::Device) -> Layouts {
        let limits = device.limits();
        let can_fetch =
            limits.max_storage_buffers_per_shader_stage >= FETCHED && limits.max_storage_buffer_binding_size > 0;
        let uniform = wgpu::BufferBindingType::Uniform;
        let storage = wgpu::BufferBindingType::Storage { read_only: true };
        let visible = wgpu::ShaderStages::VERTEX_FRAGMENT;
        Layouts {
            picture: layout(device, "picture", &[entry(0, visible, uniform)]),
            fetch: can_fetch.then(|| {
                let entries: Vec<_> =
                    (0..FETCHED).map(|binding| entry(binding, wgpu::ShaderStages::VERTEX, storage)).collect();
                layout(device, "fetch", &entries)
            }),
            texture: layout(device, "texture", &texture()),
        }
    }

    /// The uniform buffer and its group.
    pub(super) fn picture_group(&self, device: &wgpu::Device) -> (wgpu::Buffer, wgpu::BindGroup) {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: size_of::<Picture>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("picture"),
            layout: &self.picture,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        (buffer, group)
    }
}

fn layout(device: &wgpu::Device, label: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
}

/// A picture and how it is looked up.
fn texture() -> [wgpu::BindGroupLayoutEntry; 2] {
    let picture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    let visibility = wgpu::ShaderStages::FRAGMENT;
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
    [entry(0, picture), entry(1, sampler)]
}

fn entry(binding: u32, visibility: wgpu::ShaderStages, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}
