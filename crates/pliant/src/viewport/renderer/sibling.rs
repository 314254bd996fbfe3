//! A second picture beside the first.

use super::Renderer;
use super::marks::Marks;
use super::surface::Surface;
use super::targets::Targets;

impl Renderer {
    /// Another renderer on the same device. It shares the compiled programs, which take the most time to make, and has
    /// buffers and targets of its own: 28 bytes a vertex and 12 a triangle, and what the pixels need.
    pub fn sibling(&self) -> Renderer {
        let (uniforms, group) = self.layouts.picture_group(&self.device);
        Renderer {
            surface: Surface::new(&self.device, &self.layouts),
            marks: Marks::new(),
            targets: Targets::new(&self.device, [1, 1], self.targets.samples),
            device: self.device.clone(),
            queue: self.queue.clone(),
            layouts: self.layouts.clone(),
            modules: self.modules.clone(),
            pipelines: self.pipelines.clone(),
            uniforms,
            group,
            generation: 0,
            shown: None,
            ground: None,
        }
    }
}
