//! A buffer that is written again and again and made anew only when it is too small.

use super::gpu::Gpu;

/// A growing buffer on the device.
pub(super) struct Stream {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

/// Where a write ended up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Written {
    /// In the buffer of before.
    InPlace,
    /// In a new buffer (or none is needed or possible any more): bind it again.
    Anew,
}

impl Stream {
    /// An empty stream; nothing is allocated.
    pub(super) fn new(label: &'static str, usage: wgpu::BufferUsages) -> Stream {
        Stream { label, usage: usage | wgpu::BufferUsages::COPY_DST, buffer: None }
    }

    /// The buffer, if there is anything in it.
    pub(super) fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.buffer.as_ref()
    }

    /// Replaces the contents. Bytes beyond what a buffer of this device can hold leave the stream empty, with a warning.
    pub(super) fn write(&mut self, gpu: &Gpu, bytes: &[u8]) -> Written {
        let written = self.reserve(gpu, bytes.len() as u64);
        if let Some(buffer) = &self.buffer {
            gpu.write(buffer, bytes);
        }
        written
    }

    /// Makes room for `size` bytes, zeros if the buffer is new. Keeps a larger buffer unless it is four times too large.
    pub(super) fn reserve(&mut self, gpu: &Gpu, size: u64) -> Written {
        let held = self.buffer.as_ref().map_or(0, wgpu::Buffer::size);
        if size > 0 && size <= held && size >= held / 4 {
            return Written::InPlace;
        }
        let most = gpu.device.limits().max_buffer_size;
        self.buffer = None;
        if size > most {
            log::warn!(
                "{} of {size} bytes not drawn: this graphics device holds at most {most} in one buffer",
                self.label
            );
        } else if size > 0 {
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(self.label),
                size,
                usage: self.usage,
                mapped_at_creation: false,
            }));
        }
        Written::Anew
    }
}
