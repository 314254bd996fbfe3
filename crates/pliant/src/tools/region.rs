//! Which vertices a click, an outline or a brush means.

use glam::{Vec2, Vec3};
use pliant_solver::{Mesh, VertexId};
use rayon::prelude::*;

use super::outline::Outline;
use super::prompt::promptly;
use super::{Context, Pick};
use crate::viewport::Projection;

/// Vertices that are worth a task.
const VERTICES_PER_TASK: usize = 8192;

/// `center` and the vertices within `rings` edges of it, sorted. O(result).
pub(super) fn patch(mesh: &Mesh, center: VertexId, rings: u16) -> Vec<VertexId> {
    let mut patch = vec![center];
    let mut seen = std::collections::HashSet::from([center]);
    let mut ring_start = 0;
    for _ in 0..rings {
        let ring_end = patch.len();
        for k in ring_start..ring_end {
            for &w in mesh.neighbors(patch[k]) {
                if seen.insert(VertexId(w)) {
                    patch.push(VertexId(w));
                }
            }
        }
        ring_start = ring_end;
    }
    patch.sort_unstable();
    patch
}

/// Vertices whose place on screen is inside a closed outline (even–odd rule), hidden ones only when asked for.
pub(super) fn inside_outline(outline: &[Vec2], through: bool, context: &mut Context<'_>) -> Vec<VertexId> {
    let (view, outline) = (context.view, Outline::new(outline));
    let frame = context.surface.frame().clone();
    let vertices = frame.positions.par_iter().with_min_len(VERTICES_PER_TASK).enumerate();
    let is_inside = |&p: &Vec3| view.camera.project(p, view.size).is_some_and(|(px, _)| outline.contains(px));
    let inside = promptly(|| vertices.filter(|(_, p)| is_inside(p)).map(|(v, _)| VertexId(v as u32)).collect());
    if through { inside } else { context.surface.visible_of(inside, &view) }
}

/// What a brush of `radius` covers around a point: measured along the surface, and only what faces the eye as the point
/// itself does, so that it does not reach around an edge. Never empty.
pub(super) fn covered(pick: &Pick, radius: f32, context: &mut Context<'_>) -> Vec<VertexId> {
    let eye = context.view.camera.eye();
    let faces_eye = |position: Vec3, normal: Vec3| match context.view.camera.projection {
        Projection::Perspective => (eye - position).dot(normal) >= 0.0,
        Projection::Orthographic => context.view.camera.forward().dot(normal) <= 0.0,
    };
    let side = faces_eye(pick.position, pick.normal);
    let mut covered = context.surface.within(pick, radius);
    let frame = context.surface.frame();
    covered.retain(|v| match (frame.positions.get(v.index()), frame.normals.get(v.index())) {
        (Some(&position), Some(&normal)) => faces_eye(position, normal) == side,
        _ => true,
    });
    if covered.is_empty() {
        covered.push(pick.vertex); // a brush smaller than a face still takes something
    }
    covered
}
