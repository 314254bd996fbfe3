//! What the programs of dots and lines read: one small instance each.

use super::super::{Dot, Line};
use bytemuck::{Pod, Zeroable};

/// A dot on the device.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct DotInstance {
    position: [f32; 3],
    radius: f32,
    color: [u8; 4],
}

/// A line on the device.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct LineInstance {
    a: [f32; 3],
    b: [f32; 3],
    width: f32,
    color: [u8; 4],
}

const DOT_ATTRIBUTES: [wgpu::VertexAttribute; 3] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32, 2 => Unorm8x4];
const LINE_ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32, 3 => Unorm8x4];
/// Buffer of dots, as the program reads it.
pub(super) const DOT_LAYOUT: wgpu::VertexBufferLayout<'static> = instances(size_of::<DotInstance>(), &DOT_ATTRIBUTES);
/// Buffer of lines, as the program reads it.
pub(super) const LINE_LAYOUT: wgpu::VertexBufferLayout<'static> =
    instances(size_of::<LineInstance>(), &LINE_ATTRIBUTES);

const fn instances(stride: usize, attributes: &'static [wgpu::VertexAttribute]) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode: wgpu::VertexStepMode::Instance, attributes }
}

impl From<&Dot> for DotInstance {
    fn from(dot: &Dot) -> DotInstance {
        DotInstance { position: dot.position.to_array(), radius: dot.radius_px, color: dot.color }
    }
}

impl From<&Line> for LineInstance {
    fn from(line: &Line) -> LineInstance {
        LineInstance { a: line.a.to_array(), b: line.b.to_array(), width: line.width_px, color: line.color }
    }
}
