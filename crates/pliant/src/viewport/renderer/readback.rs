//! From the device back to an image in memory.

use super::super::GpuError;
use super::targets::Targets;
use std::sync::mpsc;
use std::time::Duration;

/// A software adapter on a busy machine may need seconds for a large picture; a device that takes longer than this hangs.
const PATIENCE: Duration = Duration::from_secs(60);
const BYTES_PER_PIXEL: u32 = 4;

/// The picture as tightly packed RGBA8. Waits for the device.
pub(super) fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    targets: &Targets,
) -> Result<image::RgbaImage, GpuError> {
    let [width, height] = targets.size;
    let tight = width * BYTES_PER_PIXEL;
    // Rows of a copy start at multiples of 256 bytes.
    let padded = tight.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let size = u64::from(padded) * u64::from(height);
    if size > device.limits().max_buffer_size {
        return Err(unreadable(format!("{width} x {height} pixels exceed its largest buffer")));
    }
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("picture read back"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("read back") });
    encoder.copy_texture_to_buffer(
        targets.color.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded),
                rows_per_image: Some(height),
            },
        },
        targets.color.size(),
    );
    let submission = queue.submit([encoder.finish()]);

    let (sender, receiver) = mpsc::channel();
    buffer.map_async(wgpu::MapMode::Read, .., move |mapped| {
        // Nobody listens any more if waiting failed already.
        let _ = sender.send(mapped);
    });
    device
        .poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: Some(PATIENCE) })
        .map_err(|error| unreadable(error.to_string()))?;
    receiver.try_recv().map_err(|_| unreadable("no answer".into()))?.map_err(|error| unreadable(error.to_string()))?;
    let mapped = buffer.get_mapped_range(..).map_err(|error| unreadable(error.to_string()))?;
    let mut pixels = Vec::with_capacity(tight as usize * height as usize);
    for row in mapped.chunks_exact(padded as usize) {
        pixels.extend_from_slice(&row[..tight as usize]);
    }
    image::RgbaImage::from_raw(width, height, pixels).ok_or_else(|| unreadable("too few bytes".into()))
}

fn unreadable(reason: String) -> GpuError {
    GpuError::Unreadable { reason }
}
