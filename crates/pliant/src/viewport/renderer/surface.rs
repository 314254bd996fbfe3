//! The surface on the device: streams for what moves, chunks of corners for what stays.

use super::super::{SurfaceFrame, ViewScene};
use super::colors::vertex_colors;
use super::layouts::Layouts;
use super::pipelines::Pipelines;
use super::stream::{Stream, Written};
use std::sync::Arc;

const CORNER_BYTES: u64 = 4;

/// Vertices and corners of the surface.
pub(super) struct Surface {
    positions: Stream,
    normals: Stream,
    colors: Stream,
    chunks: Vec<Chunk>,
    /// Unique edges, only where the wireframe program is not to be had.
    edges: Vec<Chunk>,
    largest_chunk: u64,
    largest_binding: u64,
    mixed: Vec<[u8; 4]>,
    shown: Option<ViewScene>,
}

/// Corner numbers in one buffer, and the group that fetches by them.
struct Chunk {
    buffer: wgpu::Buffer,
    n_corners: u32,
    fetch: Option<wgpu::BindGroup>,
}

impl Surface {
    /// Nothing yet.
    pub(super) fn new(device: &wgpu::Device, layouts: &Layouts) -> Surface {
        let limits = device.limits();
        let largest_binding = if layouts.fetch.is_some() { limits.max_storage_buffer_binding_size } else { 0 };
        let usage = wgpu::BufferUsages::VERTEX
            | if layouts.fetch.is_some() { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::empty() };
        Surface {
            positions: Stream::new("positions", usage),
            normals: Stream::new("normals", usage),
            colors: Stream::new("colors", usage),
            chunks: Vec::new(),
            edges: Vec::new(),
            largest_chunk: match largest_binding {
                0 => limits.max_buffer_size,
                binding => binding.min(limits.max_buffer_size),
            },
            largest_binding,
            mixed: Vec::new(),
            shown: None,
        }
    }

    /// Brings what the device does not hold yet: 24 bytes a vertex for a new frame, 4 for new colors, 12 a triangle for a new mesh.
    pub(super) fn upload(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, layouts: &Layouts, scene: &ViewScene) {
        let shown = self.shown.take();
        let shown = shown.as_ref();
        let same_mesh = shown.is_some_and(|shown| Arc::ptr_eq(&shown.triangles, &scene.triangles));
        let same_frame = shown.is_some_and(|shown| Arc::ptr_eq(&shown.frame, &scene.frame));
        let same_count = shown.is_some_and(|shown| shown.frame.positions.len() == scene.frame.positions.len());
        let same_colors = same_count && shown.is_some_and(|shown| shown.same_colors(scene));

        let mut rebind = false;
        if !same_mesh {
            self.chunks = self.upload_corners(device, queue, bytemuck::cast_slice(&scene.triangles));
            self.edges.clear();
            rebind = true;
        }
        if !same_frame {
            rebind |= self.upload_frame(device, queue, &scene.frame);
        }
        if !same_colors {
            vertex_colors(scene, scene.frame.positions.len(), &mut self.mixed);
            rebind |= self.colors.write(device, queue, bytemuck::cast_slice(&self.mixed)) == Written::Anew;
        }
        if rebind {
            self.bind(device, layouts);
        }
        let needs_edges =
            scene.wireframe && self.edges.is_empty() && self.chunks.iter().any(|chunk| chunk.fetch.is_none());
        if needs_edges {
            let edges = unique_edges(&scene.triangles);
            self.edges = self.upload_corners(device, queue, bytemuck::cast_slice(&edges));
        }
        self.shown = Some(scene.clone());
    }

    /// Draws the surface, with its edges if asked.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: &Pipelines, wireframe: bool) {
        let (Some(positions), Some(normals), Some(colors)) =
            (self.positions.buffer(), self.normals.buffer(), self.colors.buffer())
        else {
            return;
        };
        if wireframe
            && let Some(pipeline) = &pipelines.wireframe
            && self.chunks.iter().all(|chunk| chunk.fetch.is_some())
        {
            pass.set_pipeline(pipeline);
            for chunk in &self.chunks {
                pass.set_bind_group(1, chunk.fetch.as_ref(), &[]);
                pass.draw(0..chunk.n_corners, 0..1);
            }
            return;
        }
        pass.set_pipeline(&pipelines.surface);
        for (slot, buffer) in (0..).zip([positions, normals, colors]) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        self.chunks.iter().for_each(|chunk| chunk.draw_indexed(pass));
        if wireframe && !self.edges.is_empty() {
            pass.set_pipeline(&pipelines.edges);
            self.edges.iter().for_each(|chunk| chunk.draw_indexed(pass));
        }
    }

    /// Positions and normals. Normals of another count are not used (the surface is shaded flat), but their buffer must exist.
    fn upload_frame(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, frame: &SurfaceFrame) -> bool {
        let positions: &[u8] = bytemuck::cast_slice(&frame.positions);
        let normals = if frame.normals.len() == frame.positions.len() {
            self.normals.write(device, queue, bytemuck::cast_slice(&frame.normals))
        } else {
            self.normals.reserve(device, positions.len() as u64)
        };
        let positions = self.positions.write(device, queue, positions);
        Written::Anew == positions || Written::Anew == normals
    }

    /// Corners in as many buffers as the device's limits ask for. A chunk holds whole triangles and whole edges.
    fn upload_corners(&self, device: &wgpu::Device, queue: &wgpu::Queue, corners: &[u32]) -> Vec<Chunk> {
        let most = (self.largest_chunk / CORNER_BYTES / 6 * 6).max(6) as usize;
        let upload = |corners: &[u32]| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("corners"),
                size: size_of_val(corners) as u64,
                usage: self.corner_usage(),
                mapped_at_creation: false,
            });
            queue.write_buffer(&buffer, 0, bytemuck::cast_slice(corners));
            Chunk { buffer, n_corners: corners.len() as u32, fetch: None }
        };
        corners.chunks(most).map(upload).collect()
    }

    fn corner_usage(&self) -> wgpu::BufferUsages {
        let usage = wgpu::BufferUsages::INDEX | wgpu::BufferUsages::COPY_DST;
        if self.largest_binding > 0 { usage | wgpu::BufferUsages::STORAGE } else { usage }
    }

    /// Binds the buffers for fetching by number, where that is possible and they are not too large for it.
    fn bind(&mut self, device: &wgpu::Device, layouts: &Layouts) {
        for chunk in &mut self.chunks {
            chunk.fetch = None;
        }
        let (Some(layout), Some(positions), Some(normals), Some(colors)) =
            (&layouts.fetch, self.positions.buffer(), self.normals.buffer(), self.colors.buffer())
        else {
            return;
        };
        if positions.size() > self.largest_binding {
            return;
        }
        for chunk in &mut self.chunks {
            let buffers = [positions, normals, colors, &chunk.buffer];
            let entries = [0, 1, 2, 3].map(|binding: usize| wgpu::BindGroupEntry {
                binding: binding as u32,
                resource: buffers[binding].as_entire_binding(),
            });
            let group = wgpu::BindGroupDescriptor { label: Some("fetch"), layout, entries: &entries };
            chunk.fetch = Some(device.create_bind_group(&group));
        }
    }
}

impl Chunk {
    fn draw_indexed(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_index_buffer(self.buffer.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.n_corners, 0, 0..1);
    }
}

/// Each edge of the triangles once, lower vertex first, sorted.
fn unique_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
    let mut edges: Vec<_> = triangles.iter().flat_map(|&[a, b, c]| [edge(a, b), edge(b, c), edge(c, a)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
