//! Draws a [`ViewScene`] into an offscreen picture. Long-lived pipelines and buffers here, what is seen in the scene.
//!
//! One pass: background, surface (with or without edges and textures), faces to point out, ground grid, lines, dots twice (dimmed,
//! then in full where nothing hides them), lines on top. A surface that is seen through comes after the grid and leaves no depth. Depth is a reversed float. Colors are encoded to sRGB in the shaders, since sRGB views of a plain target
//! are not to be had everywhere, and so blending happens on encoded colors, as in the rest of the window.

mod chunk;
mod colors;
mod gpu;
mod instances;
mod layouts;
mod marks;
mod programs;
mod readback;
mod stream;
mod surface;
mod targets;
mod textures;
mod uniforms;

#[cfg(test)]
mod tests;

use super::{GpuError, ViewScene};
use glam::Vec3;
use gpu::Gpu;
use marks::Marks;
use programs::{Program, Programs};
use std::sync::Arc;
use surface::Surface;
use targets::Targets;
use uniforms::Picture;

/// Samples a pixel that suit an adapter: 4, or 1 where the processor draws.
pub fn samples_for(info: &wgpu::AdapterInfo) -> u32 {
    if info.device_type == wgpu::DeviceType::Cpu { 1 } else { 4 }
}

/// Long-lived pipelines and buffers; draws offscreen into `Rgba8Unorm` with gamma encoded in the shader.
pub struct Renderer {
    gpu: Gpu,
    programs: Arc<Programs>,
    uniforms: wgpu::Buffer,
    group: wgpu::BindGroup,
    surface: Surface,
    marks: Marks,
    targets: Targets,
    generation: u64,
    shown: Option<ViewScene>,
    ground: Option<Ground>,
    uploaded: u64,
}

/// Where the grid lies: at the bounds a mesh had when it was first drawn, so that the ground rests while the surface moves.
struct Ground {
    triangles: Arc<[[u32; 3]]>,
    bounds: (Vec3, Vec3),
}

impl Renderer {
    /// Programs are compiled when they are first drawn with. `samples` a pixel: 4 or more gives 4, anything less 1 (see
    /// [`samples_for`]).
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, samples: u32) -> Renderer {
        Renderer::with(Gpu::new(device, queue), Arc::new(Programs::new(device)), supported(samples))
    }

    /// Another renderer on the same device, for pictures side by side. It shares the compiled programs, which take the most time to
    /// make, and has buffers and targets of its own: 28 bytes a vertex and 12 a triangle, and what the pixels need.
    pub fn sibling(&self) -> Renderer {
        Renderer::with(Gpu::new(&self.gpu.device, &self.gpu.queue), self.programs.clone(), self.targets.samples)
    }

    fn with(gpu: Gpu, programs: Arc<Programs>, samples: u32) -> Renderer {
        let (uniforms, group) = programs.layouts.picture_group(&gpu.device);
        Renderer {
            surface: Surface::new(&gpu, &programs.layouts),
            marks: Marks::new(),
            targets: Targets::new(&gpu.device, [1, 1], samples),
            gpu,
            programs,
            uniforms,
            group,
            generation: 0,
            shown: None,
            ground: None,
            uploaded: 0,
        }
    }

    /// Changes the samples a pixel, for example to refine a picture that stands still. Costs new targets, and so a new generation of
    /// the view, when the number differs.
    pub fn set_samples(&mut self, samples: u32) {
        let samples = supported(samples);
        if samples != self.targets.samples {
            self.replace_targets(self.targets.size, samples);
        }
    }

    /// Draws if anything changed since the last call. Returns the picture's view and its generation: a new number means a new view
    /// (after a change of size), for `update_egui_texture_from_wgpu_texture`. A size beyond the device's is clamped.
    pub fn render(&mut self, scene: &ViewScene, size_px: [u32; 2]) -> (&wgpu::TextureView, u64) {
        let most = self.gpu.device.limits().max_texture_dimension_2d;
        let size = size_px.map(|side| side.clamp(1, most));
        let resized = size != self.targets.size || self.generation == 0;
        if resized {
            self.replace_targets(size, self.targets.samples);
        }
        self.gpu.take_written();
        let unchanged = self.shown.as_ref().is_some_and(|shown| shown.same_picture(scene));
        if !unchanged {
            self.upload(scene);
        }
        if resized || !unchanged {
            let uniforms = Picture::new(scene, size, self.ground(scene));
            self.gpu.write(&self.uniforms, bytemuck::bytes_of(&uniforms));
            self.draw(scene);
            self.shown = Some(scene.clone());
        }
        self.uploaded = self.gpu.take_written();
        (&self.targets.color_view, self.generation)
    }

    /// Why the textures of a scene cannot be shown on this device, if it has any.
    pub fn textures_obstacle(&self, scene: &ViewScene) -> Option<&'static str> {
        scene.textures.as_ref()?;
        self.surface.textures_obstacle(scene.frame.positions.len())
    }

    /// How many bytes the last picture brought to the device: none if nothing changed.
    pub fn uploaded_bytes(&self) -> u64 {
        self.uploaded
    }

    /// Reads the last picture back as tightly packed sRGB RGBA8; a fully transparent one (and a log line) if the device fails.
    pub fn read_pixels(&self) -> image::RgbaImage {
        self.try_read_pixels().unwrap_or_else(|error| {
            log::error!("{error}");
            image::RgbaImage::new(self.targets.size[0], self.targets.size[1])
        })
    }

    /// Reads the last picture back as tightly packed sRGB RGBA8. Waits for the device.
    ///
    /// # Errors
    /// [`GpuError::Unreadable`] when the device fails.
    pub fn try_read_pixels(&self) -> Result<image::RgbaImage, GpuError> {
        readback::read(&self.gpu.device, &self.gpu.queue, &self.targets)
    }

    fn replace_targets(&mut self, size: [u32; 2], samples: u32) {
        self.targets = Targets::new(&self.gpu.device, size, samples);
        self.generation += 1;
        self.shown = None;
    }

    /// Bounds the ground is placed by.
    fn ground(&mut self, scene: &ViewScene) -> (Vec3, Vec3) {
        match &self.ground {
            Some(ground) if Arc::ptr_eq(&ground.triangles, &scene.triangles) => ground.bounds,
            _ => {
                self.ground = Some(Ground { triangles: scene.triangles.clone(), bounds: scene.bounds });
                scene.bounds
            }
        }
    }

    /// Brings what differs from the last picture to the device.
    fn upload(&mut self, scene: &ViewScene) {
        self.surface.upload(&self.gpu, &self.programs.layouts, scene);
        self.marks.upload(&self.gpu, scene);
    }

    fn draw(&self, scene: &ViewScene) {
        let mut encoder =
            self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("viewport") });
        {
            let mut pass = self.targets.begin(&mut encoder);
            pass.set_bind_group(0, &self.group, &[]);
            let pipelines = self.programs.at(self.targets.samples);
            if pipelines.set(&mut pass, Program::Background) {
                pass.draw(0..3, 0..1);
            }
            // What hides nothing comes after what is seen through it.
            if !scene.see_through {
                self.surface.draw(&mut pass, pipelines, scene);
                self.surface.draw_flaws(&mut pass, pipelines);
            }
            if scene.grid && pipelines.set(&mut pass, Program::Grid) {
                pass.draw(0..4, 0..1);
            }
            if scene.see_through {
                self.surface.draw(&mut pass, pipelines, scene);
                self.surface.draw_flaws(&mut pass, pipelines);
            }
            self.marks.draw(&mut pass, pipelines);
        }
        self.gpu.queue.submit([encoder.finish()]);
    }
}

/// 1 and 4 are the numbers of samples every device has.
fn supported(samples: u32) -> u32 {
    if samples >= 4 { 4 } else { 1 }
}
