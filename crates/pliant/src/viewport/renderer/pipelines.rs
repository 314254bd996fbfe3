//! The programs with their fixed state: what is blended, what is tested against depth, what comes from which buffer.

use super::super::shaders;
use super::instances::{DOT_LAYOUT, LINE_LAYOUT};
use super::layouts::Layouts;
use super::targets::{COLOR, DEPTH};
use wgpu::CompareFunction::{Always, GreaterEqual};
use wgpu::PrimitiveTopology::{LineList, TriangleList, TriangleStrip};

/// Compiled programs, whatever the number of samples.
#[derive(Clone)]
pub(super) struct Modules {
    background: wgpu::ShaderModule,
    surface: wgpu::ShaderModule,
    wireframe: wgpu::ShaderModule,
    edges: wgpu::ShaderModule,
    grid: wgpu::ShaderModule,
    dots: wgpu::ShaderModule,
    lines: wgpu::ShaderModule,
    picture_only: wgpu::PipelineLayout,
    with_fetch: Option<wgpu::PipelineLayout>,
}

impl Modules {
    /// Compiles all programs.
    pub(super) fn new(device: &wgpu::Device, layouts: &Layouts) -> Modules {
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
        Modules {
            background: module("background", shaders::BACKGROUND),
            surface: module("surface", shaders::SURFACE),
            wireframe: module("wireframe", shaders::WIREFRAME),
            edges: module("edges", shaders::EDGES),
            grid: module("grid", shaders::GRID),
            dots: module("dots", shaders::DOTS),
            lines: module("lines", shaders::LINES),
            picture_only: layout(&[Some(&layouts.picture)]),
            with_fetch: layouts.fetch.as_ref().map(|fetch| layout(&[Some(&layouts.picture), Some(fetch)])),
        }
    }
}

/// Everything that can be drawn, for one number of samples.
#[derive(Clone)]
pub(super) struct Pipelines {
    pub(super) background: wgpu::RenderPipeline,
    pub(super) surface: wgpu::RenderPipeline,
    /// `None` where vertices cannot be fetched by number; `edges` over `surface` then.
    pub(super) wireframe: Option<wgpu::RenderPipeline>,
    pub(super) edges: wgpu::RenderPipeline,
    pub(super) grid: wgpu::RenderPipeline,
    pub(super) dots_hidden: wgpu::RenderPipeline,
    pub(super) dots_visible: wgpu::RenderPipeline,
    pub(super) lines: wgpu::RenderPipeline,
    pub(super) lines_on_top: wgpu::RenderPipeline,
}

/// What differs between pipelines.
struct Recipe<'a> {
    label: &'static str,
    layout: &'a wgpu::PipelineLayout,
    module: &'a wgpu::ShaderModule,
    fragment: &'static str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
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

const fn one(stride: u64, attributes: &'static [wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout { array_stride: stride, step_mode: wgpu::VertexStepMode::Vertex, attributes }
}

impl Pipelines {
    /// Builds all pipelines for a number of samples.
    pub(super) fn new(device: &wgpu::Device, layouts: &Layouts, modules: &Modules, samples: u32) -> Pipelines {
        debug_assert_eq!(layouts.fetch.is_some(), modules.with_fetch.is_some());
        let build = |recipe: &Recipe<'_>| build(device, recipe, samples);
        let mark = |label, module, fragment, buffers, depth| {
            let (layout, topology) = (&modules.picture_only, TriangleStrip);
            build(&Recipe { label, layout, module, fragment, buffers, topology, depth, opaque: false })
        };
        let surface = Recipe {
            label: "surface",
            layout: &modules.picture_only,
            module: &modules.surface,
            fragment: "fragment",
            buffers: &SURFACE_LAYOUT,
            topology: TriangleList,
            depth: GreaterEqual,
            opaque: true,
        };
        let background = Recipe {
            label: "background",
            module: &modules.background,
            buffers: &[],
            depth: GreaterEqual,
            opaque: false,
            ..surface
        };
        let wireframe =
            |layout| Recipe { label: "wireframe", layout, module: &modules.wireframe, buffers: &[], ..surface };
        let edges = Recipe {
            label: "edges",
            module: &modules.edges,
            buffers: &EDGE_LAYOUT,
            topology: LineList,
            opaque: false,
            ..surface
        };
        Pipelines {
            background: build(&background),
            surface: build(&surface),
            wireframe: modules.with_fetch.as_ref().map(|layout| build(&wireframe(layout))),
            edges: build(&edges),
            grid: mark("grid", &modules.grid, "fragment", &[], GreaterEqual),
            dots_hidden: mark("hidden dots", &modules.dots, "hidden", &[Some(DOT_LAYOUT)], Always),
            dots_visible: mark("dots", &modules.dots, "visible", &[Some(DOT_LAYOUT)], GreaterEqual),
            lines: mark("lines", &modules.lines, "fragment", &[Some(LINE_LAYOUT)], GreaterEqual),
            lines_on_top: mark("lines on top", &modules.lines, "fragment", &[Some(LINE_LAYOUT)], Always),
        }
    }
}

fn build(device: &wgpu::Device, recipe: &Recipe<'_>, samples: u32) -> wgpu::RenderPipeline {
    let blend = if recipe.opaque { None } else { Some(wgpu::BlendState::ALPHA_BLENDING) };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(recipe.label),
        layout: Some(recipe.layout),
        vertex: wgpu::VertexState {
            module: recipe.module,
            entry_point: Some("vertex"),
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
