//! Dots and lines: one small instance each, spread to pixels in the vertex program.

use super::super::{Dot, Line, ViewScene};
use super::gpu::Gpu;
use super::instances::{DotInstance, LineInstance};
use super::programs::{Pipelines, Program};
use super::stream::Stream;
use std::sync::Arc;

/// Dots and lines of the picture on the device.
pub(super) struct Marks {
    dots: Stream,
    lines: Stream,
    n_dots: u32,
    /// Lines that the surface hides come first, then those on top.
    n_lines: [u32; 2],
    shown_dots: Option<Arc<[Dot]>>,
    shown_lines: Option<Arc<[Line]>>,
}

impl Marks {
    /// Nothing yet.
    pub(super) fn new() -> Marks {
        Marks {
            dots: Stream::new("dots", wgpu::BufferUsages::VERTEX),
            lines: Stream::new("lines", wgpu::BufferUsages::VERTEX),
            n_dots: 0,
            n_lines: [0, 0],
            shown_dots: None,
            shown_lines: None,
        }
    }

    /// Brings the scene's marks to the device, if they are not there already.
    pub(super) fn upload(&mut self, gpu: &Gpu, scene: &ViewScene) {
        if !self.shown_dots.as_ref().is_some_and(|dots| Arc::ptr_eq(dots, &scene.dots)) {
            let instances: Vec<DotInstance> = scene.dots.iter().map(DotInstance::from).collect();
            self.n_dots = instances.len() as u32;
            self.dots.write(gpu, bytemuck::cast_slice(&instances));
        }
        if !self.shown_lines.as_ref().is_some_and(|lines| Arc::ptr_eq(lines, &scene.lines)) {
            let of =
                |on_top: bool| scene.lines.iter().filter(move |line| line.on_top == on_top).map(LineInstance::from);
            let instances: Vec<LineInstance> = of(false).chain(of(true)).collect();
            let n_on_top = scene.lines.iter().filter(|line| line.on_top).count() as u32;
            self.n_lines = [instances.len() as u32 - n_on_top, n_on_top];
            self.lines.write(gpu, bytemuck::cast_slice(&instances));
        }
        self.shown_dots = Some(scene.dots.clone());
        self.shown_lines = Some(scene.lines.clone());
    }

    /// Draws all marks, back to front by kind.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: Pipelines<'_>) {
        let [n_hideable, n_on_top] = self.n_lines;
        let mut quads = |program, instances: &Stream, range: std::ops::Range<u32>| {
            if let Some(buffer) = instances.buffer()
                && !range.is_empty()
                && pipelines.set(pass, program)
            {
                // Four corners for each instance.
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..4, range);
            }
        };
        quads(Program::Lines, &self.lines, 0..n_hideable);
        quads(Program::DotsHidden, &self.dots, 0..self.n_dots);
        quads(Program::Dots, &self.dots, 0..self.n_dots);
        quads(Program::LinesOnTop, &self.lines, n_hideable..n_hideable + n_on_top);
    }
}
