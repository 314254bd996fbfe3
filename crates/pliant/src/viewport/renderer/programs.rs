//! The programs with their fixed state: what is blended, what is tested against depth, what comes from which buffer.
//!
//! Compiling a program takes longer than drawing with it, so each is compiled when it is first drawn with, and shared by all
//! renderers of a device.

use super::super::shaders;
use super::instances::{DOT_LAYOUT, LINE_LAYOUT};
use super::layouts::Layouts;
use super::targets::{COLOR, DEPTH};
use std::sync::OnceLock;
use wgpu::CompareFunction::{Always, GreaterEqual};
use wgpu::PrimitiveTopology::{LineList, TriangleList, TriangleStrip};

/// Everything that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Program {
    /// The gradient behind everything.
    Background,
    /// The ground.
    Grid,
    /// The surface from indexed vertices.
    Surface,
    /// The same, seen through.
    SurfaceThrough,
    /// The surface with its edges.
    Wired,
    /// The same, seen through.
    WiredThrough,
    /// The surface with its textures.
    Textured,
    /// The same, seen through.
    TexturedThrough,
    /// The surface with edges and textures.
    TexturedWired,
    /// The same, seen through.
    TexturedWiredThrough,
    /// Edges over a surface that was drawn without.
    Edges,
    /// Faces to point out, where the surface does not hide them.
    Flaws,
    /// The same faces, faintly, wherever they are.
    FlawsHidden,
    /// Dots, dimmed, wherever they are.
    DotsHidden,
    /// Dots where the surface does not hide them.
    Dots,
    /// Lines that the surface hides.
    Lines,
    /// Lines over everything.
    LinesOnTop,
}

const N_PROGRAMS: usize = Program::LinesOnTop as usize + 1;

/// Pipelines of one number of samples, once they were asked for.
type Built = [OnceLock<wgpu::RenderPipeline>; N_PROGRAMS];

/// All programs of a device.
pub(super) struct Programs {
    device: wgpu::Device,
    pub(super) layouts: Layouts,
    background: wgpu::ShaderModule,
    surface: wgpu::ShaderModule,
    fetched: wgpu::ShaderModule,
    edges: wgpu::ShaderModule,
    grid: wgpu::ShaderModule,
    dots: wgpu::ShaderModule,
    lines: wgpu::ShaderModule,
    picture_only: wgpu::PipelineLayout,
    with_fetch: Option<wgpu::PipelineLayout>,
    with_texture: Option<wgpu::PipelineLayout>,
    /// For one sample a pixel, and for four.
    built: [Built; 2],
}

/// The programs for one number of samples.
#[derive(Clone, Copy)]
pub(super) struct Pipelines<'a> {
    programs: &'a Programs,
    samples: u32,
}

/// What differs between pipelines.
#[derive(Clone, Copy)]
struct Recipe<'a> {
    label: &'static str,
    layout: &'a wgpu::PipelineLayout,
    module: &'a wgpu::ShaderModule,
    vertex: &'static str,
    fragment: &'static str,
    buffers: &'static [Option<wgpu::VertexBufferLayout<'static>>],
    topology: wgpu::PrimitiveTopology,
    /// Compared how; opaque things also write depth and do not blend.
    depth: wgpu::CompareFunction,
    opaque: bool,
}

/// Positions, normals, colors, each in a buffer of its own.
const SURFACE_LAYOUT: [Option<wgpu::VertexBufferLayout<'static>>; 3] = [
    Some(one(12, &wgpu::vertex_attr_array![0 => Float32x3])),
    Some(one(12, &wgpu::vertex_attr_array![1 => Float32x3])),
    Some(one(4, &wgpu::vertex_attr_array![2 => Unorm8x4])),
];
const EDGE_LAYOUT: [Option<wgpu::VertexBufferLayout<'static>>; 1] =
    [Some(one(12, &wgpu::vertex_attr_array![0 => Float32x3]))];
const DOTS_LAYOUT: [Option<wgpu::VertexBufferLayout<'static>>; 1] = [Some(DOT_LAYOUT)];
const LINES_LAYOUT: [Option<wgpu::VertexBufferLayout<'static>>; 1] = [Some(LINE_LAYOUT)];

const fn one(stride: u64, attributes: &'static [wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout { array_stride: stride, step_mode: wgpu::VertexStepMode::Vertex, attributes }
}

impl Programs {
    /// Reads all programs; compiles none yet.
    pub(super) fn new(device: &wgpu::Device) -> Programs {
        let layouts = Layouts::new(device);
        let module = |label, text: &'static str| {
            let source = wgpu::ShaderSource::Wgsl(text.into());
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
        };
        let layout = |groups: &[Option<&wgpu::BindGroupLayout>]| {
            device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("viewport"),
                bind_group_layouts: groups,
                immediate_size: 0,
            })
        };
        let (picture, fetch, texture) = (&layouts.picture, layouts.fetch.as_ref(), &layouts.texture);
        Programs {
            background: module("background", shaders::BACKGROUND),
            surface: module("surface", shaders::SURFACE),
            fetched: module("fetched surface", shaders::FETCHED),
            edges: module("edges", shaders::EDGES),
            grid: module("grid", shaders::GRID),
            dots: module("dots", shaders::DOTS),
            lines: module("lines", shaders::LINES),
            picture_only: layout(&[Some(picture)]),
            with_fetch: fetch.map(|fetch| layout(&[Some(picture), Some(fetch)])),
            with_texture: fetch.map(|fetch| layout(&[Some(picture), Some(fetch), Some(texture)])),
            built: std::array::from_fn(|_| std::array::from_fn(|_| OnceLock::new())),
            device: device.clone(),
            layouts,
        }
    }

    /// The programs for 1 or 4 samples a pixel.
    pub(super) fn at(&self, samples: u32) -> Pipelines<'_> {
        Pipelines { programs: self, samples }
    }

    /// How a program is made; `None` where the device cannot fetch vertices by number and the program must.
    fn recipe(&self, program: Program) -> Option<Recipe<'_>> {
        let surface = Recipe {
            label: "surface",
            layout: &self.picture_only,
            module: &self.surface,
            vertex: "vertex",
            fragment: "fragment",
            buffers: &SURFACE_LAYOUT,
            topology: TriangleList,
            depth: GreaterEqual,
            opaque: true,
        };
        let fetched = Recipe { label: "fetched surface", module: &self.fetched, buffers: &[], ..surface };
        let mark = Recipe { topology: TriangleStrip, opaque: false, ..surface };
        let dots = Recipe { label: "dots", module: &self.dots, buffers: &DOTS_LAYOUT, ..mark };
        let lines = Recipe { label: "lines", module: &self.lines, buffers: &LINES_LAYOUT, ..mark };
        let flaws = Recipe { label: "flaws", vertex: "flaw_vertex", fragment: "flaw", ..surface };
        let wired = |opaque| {
            let layout = self.with_fetch.as_ref()?;
            Some(Recipe { layout, fragment: "wired", opaque, ..fetched })
        };
        let textured = |fragment, opaque| {
            let layout = self.with_texture.as_ref()?;
            Some(Recipe { layout, fragment, opaque, ..fetched })
        };
        Some(match program {
            Program::Background => {
                Recipe { label: "background", module: &self.background, buffers: &[], opaque: false, ..surface }
            }
            Program::Grid => Recipe { label: "grid", module: &self.grid, buffers: &[], ..mark },
            Program::Surface => surface,
            Program::SurfaceThrough => Recipe { opaque: false, ..surface },
            Program::Wired => wired(true)?,
            Program::WiredThrough => wired(false)?,
            Program::Textured => textured("textured", true)?,
            Program::TexturedThrough => textured("textured", false)?,
            Program::TexturedWired => textured("textured_wired", true)?,
            Program::TexturedWiredThrough => textured("textured_wired", false)?,
            Program::Edges => Recipe {
                label: "edges",
                module: &self.edges,
                buffers: &EDGE_LAYOUT,
                topology: LineList,
                opaque: false,
                ..surface
            },
            Program::Flaws => flaws,
            Program::FlawsHidden => Recipe { fragment: "flaw_hidden", depth: Always, opaque: false, ..flaws },
            Program::DotsHidden => Recipe { fragment: "hidden", depth: Always, ..dots },
            Program::Dots => Recipe { fragment: "visible", ..dots },
            Program::Lines => lines,
            Program::LinesOnTop => Recipe { depth: Always, ..lines },
        })
    }
}

impl Pipelines<'_> {
    /// Draws with `program` from here on; `false` where this device has no such program.
    pub(super) fn set(self, pass: &mut wgpu::RenderPass<'_>, program: Program) -> bool {
        let Some(recipe) = self.programs.recipe(program) else { return false };
        let built = &self.programs.built[usize::from(self.samples > 1)][program as usize];
        pass.set_pipeline(built.get_or_init(|| build(&self.programs.device, &recipe, self.samples)));
        true
    }
}

fn build(device: &wgpu::Device, recipe: &Recipe<'_>, samples: u32) -> wgpu::RenderPipeline {
    let blend = if recipe.opaque { None } else { Some(wgpu::BlendState::ALPHA_BLENDING) };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(recipe.label),
        layout: Some(recipe.layout),
        vertex: wgpu::VertexState {
            module: recipe.module,
            entry_point: Some(recipe.vertex),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: recipe.buffers,
        },
        primitive: wgpu::PrimitiveState { topology: recipe.topology, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(recipe.opaque),
            depth_compare: Some(recipe.depth),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: recipe.module,
            entry_point: Some(recipe.fragment),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState { format: COLOR, blend, write_mask: wgpu::ColorWrites::ALL })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
