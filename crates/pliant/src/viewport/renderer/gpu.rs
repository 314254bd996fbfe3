//! The device and its queue, with a count of the bytes that are brought there.

use std::cell::Cell;

/// A device to draw with.
pub(super) struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    written: Cell<u64>,
}

impl Gpu {
    /// Nothing written yet.
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Gpu {
        Gpu { device: device.clone(), queue: queue.clone(), written: Cell::new(0) }
    }

    /// Fills the beginning of a buffer.
    pub(super) fn write(&self, buffer: &wgpu::Buffer, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.queue.write_buffer(buffer, 0, bytes);
            self.count(bytes.len());
        }
    }

    /// A new buffer with these bytes, of which there is at least one.
    pub(super) fn buffer(&self, label: &'static str, usage: wgpu::BufferUsages, bytes: &[u8]) -> wgpu::Buffer {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: bytes.len() as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        self.write(&buffer, bytes);
        buffer
    }

    /// Fills one level of a texture with tightly packed RGBA8.
    pub(super) fn write_level(&self, texture: &wgpu::Texture, level: u32, size: [u32; 2], bytes: &[u8]) {
        let [width, height] = size;
        self.queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level: level, ..texture.as_image_copy() },
            bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * width), rows_per_image: Some(height) },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        self.count(bytes.len());
    }

    /// Bytes written since the last call.
    pub(super) fn take_written(&self) -> u64 {
        self.written.take()
    }

    fn count(&self, n: usize) {
        self.written.set(self.written.get() + n as u64);
    }
}
