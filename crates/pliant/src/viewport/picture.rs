//! One picture of a scene without a window: what `pliant render` and the tests use.

use super::{GpuError, Headless, Renderer, ViewScene};

/// A still picture may take its time: always four samples a pixel, also in software.
const SAMPLES: u32 = 4;

/// One picture of a scene, opaque sRGB. Opens a device for it; a size beyond what the device can draw is clamped.
///
/// # Errors
/// [`GpuError::NoAdapter`] without any device, [`GpuError::Unreadable`] when it fails underway.
pub fn picture(scene: &ViewScene, size_px: [u32; 2]) -> Result<image::RgbaImage, GpuError> {
    picture_on(&Headless::new()?, scene, size_px)
}

/// The same on a device that is open already.
///
/// # Errors
/// [`GpuError::Unreadable`] when the device fails or complains underway: what it drew then is not the scene.
pub fn picture_on(headless: &Headless, scene: &ViewScene, size_px: [u32; 2]) -> Result<image::RgbaImage, GpuError> {
    Pictures::new(headless)?.draw(scene, size_px)
}

/// Several pictures on one device: programs are compiled once, and arrays that scenes share are brought there once.
pub struct Pictures<'a> {
    headless: &'a Headless,
    renderer: Renderer,
}

impl<'a> Pictures<'a> {
    /// Prepares to draw.
    ///
    /// # Errors
    /// [`GpuError::Unreadable`] when the device complains.
    pub fn new(headless: &'a Headless) -> Result<Pictures<'a>, GpuError> {
        // Complaints about earlier work are logged already and say nothing about these pictures.
        headless.take_error();
        let renderer = Renderer::new(&headless.device, &headless.queue, SAMPLES);
        check(headless)?;
        Ok(Pictures { headless, renderer })
    }

    /// One picture of a scene, opaque sRGB; a size beyond what the device can draw is clamped.
    ///
    /// # Errors
    /// [`GpuError::Unreadable`] when the device fails or complains underway: what it drew then is not the scene.
    pub fn draw(&mut self, scene: &ViewScene, size_px: [u32; 2]) -> Result<image::RgbaImage, GpuError> {
        // After each step, since the first complaint names the cause and later ones only what follows from it.
        self.renderer.render(scene, size_px);
        check(self.headless)?;
        let picture = self.renderer.try_read_pixels();
        // The device's own words say more than that nothing could be read.
        check(self.headless)?;
        picture
    }
}

/// Whether the device is still there and content.
fn check(headless: &Headless) -> Result<(), GpuError> {
    match headless.lost().or_else(|| headless.take_error()) {
        Some(reason) => Err(GpuError::Unreadable { reason }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_scenes::sheet;
    use super::*;

    #[test]
    fn a_complaint_of_the_device_is_an_error_and_not_a_blank_picture() {
        // Less room for uniforms than one picture takes.
        let tiny = wgpu::Limits { max_uniform_buffer_binding_size: 16, ..wgpu::Limits::defaults() };
        let headless = Headless::with_limits(tiny).expect("any adapter; `apt-get install mesa-vulkan-drivers`");
        for attempt in 0..2 {
            let result = picture_on(&headless, &sheet(4), [16, 16]);
            let reason = match &result {
                Err(GpuError::Unreadable { reason }) => reason,
                other => panic!("attempt {attempt}: expected an error, got {other:?}"),
            };
            assert!(reason.to_lowercase().contains("binding"), "attempt {attempt}: {reason}");
        }
    }

    #[test]
    fn an_earlier_complaint_does_not_spoil_the_next_picture() {
        let headless = Headless::new().unwrap_or_else(|error| panic!("{error}"));
        let _too_large = headless.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("too large"),
            size: headless.device.limits().max_buffer_size + 4,
            usage: wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let picture = picture_on(&headless, &sheet(4), [16, 16]).expect("a picture");
        assert_eq!(picture.dimensions(), (16, 16));
    }
}
