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
/// [`GpuError::Unreadable`] when the device fails underway.
pub fn picture_on(headless: &Headless, scene: &ViewScene, size_px: [u32; 2]) -> Result<image::RgbaImage, GpuError> {
    let mut renderer = Renderer::new(&headless.device, &headless.queue, SAMPLES);
    renderer.render(scene, size_px);
    renderer.try_read_pixels()
}
