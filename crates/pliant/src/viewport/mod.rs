//! The picture: a camera, and a renderer that draws a [`ViewScene`] into an offscreen target.
//!
//! The idea: the editor states what one picture shows ([`ViewScene`], cheap to clone), the [`Renderer`] compares it with what
//! it drew last and does only what changed. Positions stream into buffers that stay; colors are mixed on the CPU when
//! something about them changed; nothing at all happens when the scene is the same.
//!
//! | object | lives | costs |
//! |---|---|---|
//! | [`Camera`] | a value | arithmetic only, no GPU |
//! | [`ViewScene`] | one picture | a dozen reference counts |
//! | [`Renderer`] | as long as the device | pipelines once, buffers once a mesh, 24 bytes a vertex for each new [`SurfaceFrame`] |
//! | [`Headless`] | a process without a window | adapter and device, about a tenth of a second |
//!
//! This is the only part of the crate that names wgpu.

mod camera;
mod headless;
mod picture;
mod ramp;
mod renderer;
mod scene;
mod shaders;
#[cfg(test)]
mod test_scenes;
mod textures;

pub use camera::{Axis, Camera, Projection};
pub use headless::{DeviceWatch, GpuError, Headless, watch_device};
pub use picture::{Pictures, picture, picture_on};
pub use ramp::{energy_color, rigidity_color, soft_stiff_color, stretch_color};
pub use renderer::{Renderer, samples_for};
pub use scene::{Coloring, Dot, Line, Matcap, Preview, Shading, SurfaceFrame, Theme, ViewScene};
pub use shaders::SHADERS;
pub use textures::{Texture, TextureSet, Wrap};
