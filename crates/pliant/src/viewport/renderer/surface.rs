//! The surface on the device: streams for what moves, chunks of corners for what stays.

use super::super::{SurfaceFrame, ViewScene};
use super::chunk::{Chunk, Corners, whole_triangles};
use super::colors::{base_roots, vertex_colors};
use super::gpu::Gpu;
use super::layouts::Layouts;
use super::programs::{Pipelines, Program};
use super::stream::{Stream, Written};
use super::textures::Textures;
use std::sync::Arc;

/// Vertices and corners of the surface.
pub(super) struct Surface {
    positions: Stream,
    normals: Stream,
    colors: Stream,
    /// Colors under the textures; empty without.
    bases: Stream,
    chunks: Vec<Chunk>,
    /// Unique edges, only where the fetching programs are not to be had.
    edges: Vec<Corners>,
    /// Corners of the faces that are pointed out.
    flaws: Vec<Corners>,
    textures: Textures,
    /// Bound in place of what a mesh does not have.
    nothing: wgpu::Buffer,
    largest_chunk: u64,
    largest_binding: u64,
    mixed: Vec<[u8; 4]>,
    shown: Option<Shown>,
}

/// What the device holds.
struct Shown {
    scene: ViewScene,
    is_textured: bool,
}

impl Surface {
    /// Nothing yet.
    pub(super) fn new(gpu: &Gpu, layouts: &Layouts) -> Surface {
        let limits = gpu.device.limits();
        let largest_binding = if layouts.fetch.is_some() { limits.max_storage_buffer_binding_size } else { 0 };
        let storage = if layouts.fetch.is_some() { wgpu::BufferUsages::STORAGE } else { wgpu::BufferUsages::empty() };
        let usage = wgpu::BufferUsages::VERTEX | storage;
        Surface {
            positions: Stream::new("positions", usage),
            normals: Stream::new("normals", usage),
            colors: Stream::new("colors", usage),
            bases: Stream::new("base colors", usage),
            chunks: Vec::new(),
            edges: Vec::new(),
            flaws: Vec::new(),
            textures: Textures::default(),
            nothing: gpu.buffer("nothing", usage, &[0; 4]),
            largest_chunk: match largest_binding {
                0 => limits.max_buffer_size,
                binding => binding.min(limits.max_buffer_size),
            },
            largest_binding,
            mixed: Vec::new(),
            shown: None,
        }
    }

    /// Brings what the device does not hold yet: 24 bytes a vertex for a new frame, 4 for new colors, 12 a triangle for a new mesh
    /// (24 more with textures).
    pub(super) fn upload(&mut self, gpu: &Gpu, layouts: &Layouts, scene: &ViewScene) {
        let shown = self.shown.take();
        let before = shown.as_ref().map(|shown| &shown.scene);
        let is_textured = self.can_show_textures(scene);
        let same_mode = shown.as_ref().is_some_and(|shown| shown.is_textured == is_textured);
        let same_mesh = same_mode && before.is_some_and(|before| before.same_mesh(scene));
        let same_frame = before.is_some_and(|before| Arc::ptr_eq(&before.frame, &scene.frame));
        let n_vertices = scene.frame.positions.len();
        let same_count = before.is_some_and(|before| before.frame.positions.len() == n_vertices);
        let same_colors = same_mode && same_count && before.is_some_and(|before| before.same_colors(scene));
        let same_bases = same_mode && same_count && before.is_some_and(|before| before.same_bases(scene));
        let same_flaws = before.is_some_and(|before| before.same_flaws(scene));

        let mut rebind = false;
        if !same_mesh {
            self.chunks = self.upload_chunks(gpu, scene, is_textured);
            self.edges.clear();
            rebind = true;
        }
        if !same_frame {
            rebind |= self.upload_frame(gpu, &scene.frame);
        }
        if !same_colors {
            vertex_colors(scene, n_vertices, is_textured, &mut self.mixed);
            rebind |= self.colors.write(gpu, bytemuck::cast_slice(&self.mixed)) == Written::Anew;
        }
        if !same_bases {
            let n_bases = if is_textured { n_vertices } else { 0 };
            rebind |= self.bases.write(gpu, bytemuck::cast_slice(&base_roots(scene, n_bases))) == Written::Anew;
        }
        if !same_flaws {
            let faces = scene.flaws.as_deref().unwrap_or_default();
            self.flaws = self.upload_corners(gpu, bytemuck::cast_slice(faces));
        }
        if rebind {
            self.bind(gpu, layouts);
        }
        self.upload_textures(gpu, layouts, scene, is_textured);
        let cannot_fetch = self.chunks.iter().any(|chunk| chunk.fetch.is_none());
        if scene.wireframe && self.edges.is_empty() && cannot_fetch {
            let edges = marked_edges(&scene.triangles, scene.unmarked_edges.as_deref());
            self.edges = self.upload_corners(gpu, bytemuck::cast_slice(&edges));
        }
        self.shown = Some(Shown { scene: scene.clone(), is_textured });
    }

    /// Draws the surface, with its edges and textures if asked.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: Pipelines<'_>, scene: &ViewScene) {
        let Some(program) = self.program(scene) else {
            let program = if scene.see_through { Program::SurfaceThrough } else { Program::Surface };
            if self.set_vertices(pass) && pipelines.set(pass, program) {
                self.chunks.iter().for_each(|chunk| chunk.corners.draw(pass));
                if scene.wireframe && pipelines.set(pass, Program::Edges) {
                    self.edges.iter().for_each(|edges| edges.draw(pass));
                }
            }
            return;
        };
        if !pipelines.set(pass, program) {
            return;
        }
        let is_textured = self.shown.as_ref().is_some_and(|shown| shown.is_textured);
        for chunk in &self.chunks {
            pass.set_bind_group(1, chunk.fetch.as_ref(), &[]);
            let (first, end) = (chunk.first, chunk.first + chunk.corners.n);
            if is_textured {
                self.textures.for_each_run(first..end, |texture, run| {
                    pass.set_bind_group(2, texture, &[]);
                    pass.draw(run.start - first..run.end - first, 0..1);
                });
            } else {
                pass.draw(0..chunk.corners.n, 0..1);
            }
        }
    }

    /// Draws the faces that are pointed out over the surface; faintly also where it hides them.
    pub(super) fn draw_flaws(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: Pipelines<'_>) {
        if self.flaws.is_empty() || !self.set_vertices(pass) {
            return;
        }
        for program in [Program::FlawsHidden, Program::Flaws] {
            if pipelines.set(pass, program) {
                self.flaws.iter().for_each(|faces| faces.draw(pass));
            }
        }
    }

    /// The program that fetches vertices by number, where one is needed and can be had.
    fn program(&self, scene: &ViewScene) -> Option<Program> {
        if self.chunks.iter().any(|chunk| chunk.fetch.is_none()) {
            return None;
        }
        let is_textured = self.shown.as_ref().is_some_and(|shown| shown.is_textured);
        match (is_textured, scene.wireframe, scene.see_through) {
            (false, false, _) => None,
            (false, true, false) => Some(Program::Wired),
            (false, true, true) => Some(Program::WiredThrough),
            (true, false, false) => Some(Program::Textured),
            (true, false, true) => Some(Program::TexturedThrough),
            (true, true, false) => Some(Program::TexturedWired),
            (true, true, true) => Some(Program::TexturedWiredThrough),
        }
    }

    fn set_vertices(&self, pass: &mut wgpu::RenderPass<'_>) -> bool {
        let buffers = [self.positions.buffer(), self.normals.buffer(), self.colors.buffer()];
        for (slot, buffer) in (0..).zip(buffers) {
            let Some(buffer) = buffer else { return false };
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        true
    }

    /// Why no textures can be shown on a surface of so many vertices, if so: vertices must be fetched by number for them.
    pub(super) fn textures_obstacle(&self, n_vertices: usize) -> Option<&'static str> {
        let bytes = (n_vertices * size_of::<glam::Vec3>()) as u64;
        match self.largest_binding {
            0 => Some("this graphics device has not enough storage buffers for them"),
            most if bytes > most => Some("the mesh is too large for them on this graphics device"),
            _ => None,
        }
    }

    /// Whether there are textures to see, and they can be shown.
    fn can_show_textures(&self, scene: &ViewScene) -> bool {
        let is_able = self.textures_obstacle(scene.frame.positions.len()).is_none();
        is_able && scene.shows_textures() && scene.textures.as_ref().is_some_and(|set| set.fits(scene.triangles.len()))
    }

    fn upload_textures(&mut self, gpu: &Gpu, layouts: &Layouts, scene: &ViewScene, is_textured: bool) {
        match &scene.textures {
            Some(set) if is_textured => {
                if !self.textures.hold(set) {
                    self.textures.upload(gpu, &layouts.texture, set);
                }
            }
            Some(set) if self.textures.hold(set) => {}
            _ => self.textures.clear(),
        }
    }

    /// Positions and normals. Normals of another count are not used (the surface is shaded flat), but their buffer must exist.
    fn upload_frame(&mut self, gpu: &Gpu, frame: &SurfaceFrame) -> bool {
        let positions: &[u8] = bytemuck::cast_slice(&frame.positions);
        let normals = if frame.normals.len() == frame.positions.len() {
            self.normals.write(gpu, bytemuck::cast_slice(&frame.normals))
        } else {
            self.normals.reserve(gpu, positions.len() as u64)
        };
        let positions = self.positions.write(gpu, positions);
        Written::Anew == positions || Written::Anew == normals
    }

    /// The triangles with what belongs to them, in as many parts as the device's limits ask for.
    fn upload_chunks(&self, gpu: &Gpu, scene: &ViewScene, is_textured: bool) -> Vec<Chunk> {
        let most = whole_triangles(self.largest_chunk);
        let storage = self.largest_binding > 0;
        (0..scene.triangles.len())
            .step_by(most)
            .map(|start| {
                let end = (start + most).min(scene.triangles.len());
                Chunk::new(gpu, scene, start..end, storage, is_textured)
            })
            .collect()
    }

    /// Corners for indexed drawing, in as many parts as the device's limits ask for: whole triangles and whole edges.
    fn upload_corners(&self, gpu: &Gpu, corners: &[u32]) -> Vec<Corners> {
        let most = (self.largest_chunk / 4 / 6 * 6).max(6) as usize;
        corners.chunks(most).map(|corners| Corners::new(gpu, corners, false)).collect()
    }

    /// Binds the buffers for fetching by number, where that is possible and they are not too large for it.
    fn bind(&mut self, gpu: &Gpu, layouts: &Layouts) {
        self.chunks.iter_mut().for_each(|chunk| chunk.fetch = None);
        let (Some(layout), Some(positions), Some(normals), Some(colors)) =
            (&layouts.fetch, self.positions.buffer(), self.normals.buffer(), self.colors.buffer())
        else {
            return;
        };
        if positions.size() > self.largest_binding {
            return;
        }
        let bases = self.bases.buffer().unwrap_or(&self.nothing);
        for chunk in &mut self.chunks {
            chunk.bind(gpu, layout, [positions, normals, colors, bases], &self.nothing);
        }
    }
}

/// Each edge of the triangles once, lower vertex first, sorted; without those that are not to be drawn.
fn marked_edges(triangles: &[[u32; 3]], unmarked: Option<&[u8]>) -> Vec<[u32; 2]> {
    let edge = |a: u32, b: u32| [a.min(b), a.max(b)];
    let of_triangle = |(t, &[a, b, c]): (usize, &[u32; 3])| {
        let bits = unmarked.and_then(|bits| bits.get(t)).copied().unwrap_or(0);
        let across = [edge(b, c), edge(c, a), edge(a, b)];
        (0..3).filter(move |k| bits >> k & 1 == 0).map(move |k| across[k])
    };
    let mut edges: Vec<_> = triangles.iter().enumerate().flat_map(of_triangle).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
