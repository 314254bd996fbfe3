//! Which vertices a click or an outline means.

use glam::Vec2;
use pliant_solver::{Mesh, VertexId};

use super::Context;

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
    if outline.len() < 3 {
        return Vec::new();
    }
    let (lo, hi) = outline.iter().fold((outline[0], outline[0]), |(lo, hi), &p| (lo.min(p), hi.max(p)));
    let frame = context.surface.frame().clone();
    let view = context.view;
    let mut inside: Vec<VertexId> = Vec::new();
    for (v, &position) in (0..).zip(&frame.positions) {
        let Some((px, _)) = view.camera.project(position, view.size) else {
            continue;
        };
        if px.cmpge(lo).all() && px.cmple(hi).all() && contains(outline, px) {
            inside.push(VertexId(v));
        }
    }
    if !through {
        inside.retain(|&v| context.surface.is_visible(v, &view));
    }
    inside
}

fn contains(outline: &[Vec2], p: Vec2) -> bool {
    let mut inside = false;
    let mut a = outline[outline.len() - 1];
    for &b in outline {
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
        a = b;
    }
    inside
}
