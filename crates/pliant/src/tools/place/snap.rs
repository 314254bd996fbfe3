//! Onto a vertex: the one near the pointer that a dragged handle snaps to.
//!
//! Vertices count where they were when the drag began: the surface follows the handle, and a target that moves away from
//! what is drawn to it would never be reached.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use pliant_solver::VertexId;
use rayon::prelude::*;

use crate::tools::View;
use crate::tools::prompt::promptly;
use crate::viewport::{Line, SurfaceFrame};

/// How near the pointer must be to a vertex, in points (by eye: two dots of handles).
const REACH_PX: f32 = 16.0;
/// Of the vertices in reach those count that lie this much behind the nearest one at most, in lengths of the reach: the
/// others are on another side of the surface (by eye).
const BEHIND: f32 = 4.0;
/// Half the diagonal of the mark around the vertex, in points: it is seen around the handle's own dot.
const MARK_PX: f32 = 13.0;
/// The mark: a cyan that neither ramp nor handles have (by eye).
const MARK_COLOR: [u8; 4] = [90, 230, 255, 255];

/// The vertex that a handle lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Target {
    pub(super) vertex: VertexId,
    /// Where it was when the drag began, view space.
    pub(super) position: Vec3,
}

/// The vertex nearest to a pixel on the side of the surface that faces the eye, without those that `is_left_out`. A pass
/// over the whole mesh, in parallel.
pub(super) fn target(
    frame: &Arc<SurfaceFrame>,
    px: Vec2,
    view: &View,
    is_left_out: impl Fn(VertexId) -> bool,
) -> Option<Target> {
    let near = |(v, &position): (usize, &Vec3)| {
        let (at, depth) = view.camera.project(position, view.size)?;
        let distance = at.distance(px);
        (distance <= REACH_PX).then_some((VertexId(v as u32), position, depth, distance))
    };
    let mut found: Vec<_> = promptly(|| frame.positions.par_iter().enumerate().filter_map(near).collect());
    found.retain(|&(v, ..)| !is_left_out(v));
    let &(_, foremost, nearest, _) = found.iter().min_by(|a, b| a.2.total_cmp(&b.2))?;
    let most = nearest + BEHIND * REACH_PX * view.camera.world_per_px(foremost, view.size);
    let on_this_side = found.iter().filter(|&&(_, _, depth, _)| depth <= most);
    let &(vertex, position, ..) = on_this_side.min_by(|a, b| a.3.total_cmp(&b.3))?;
    Some(Target { vertex, position })
}

impl Target {
    /// A diamond around the vertex.
    pub(super) fn lines(&self, view: &View) -> impl Iterator<Item = Line> + use<> {
        let half = MARK_PX * view.camera.world_per_px(self.position, view.size);
        let (right, up, at) = (view.camera.right() * half, view.camera.up() * half, self.position);
        let corners = [at + right, at + up, at - right, at - up];
        let side = move |k: usize| (corners[k], corners[(k + 1) % 4]);
        let line = |(a, b)| Line { a, b, color: MARK_COLOR, width_px: 2.0, on_top: true };
        (0..4).map(move |k| line(side(k)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::{Axis, Camera};

    #[test]
    fn a_vertex_on_the_far_side_is_no_target_while_one_on_the_near_side_is_in_reach() {
        let mut camera = Camera::framing(Vec3::splat(-1.0), Vec3::splat(1.0));
        camera.look_along(Axis::Front);
        let view = View { camera, size: Vec2::new(800.0, 600.0) };
        let positions = vec![Vec3::new(0.01, 0.0, 1.0), Vec3::new(0.0, 0.0, -1.0), Vec3::new(0.9, 0.0, 1.0)];
        let frame = Arc::new(SurfaceFrame { positions: positions.clone(), normals: Vec::new() });
        let middle = view.size * 0.5;
        let at = |px, left_out: u32| target(&frame, px, &view, |v| v.0 == left_out).map(|target| target.vertex.0);
        assert_eq!(at(middle, 9), Some(0));
        assert_eq!(at(middle, 0), Some(1), "the only one left");
        let (far, _) = view.camera.project(positions[2], view.size).expect("in front of the eye");
        assert_eq!(at(far + Vec2::new(3.0, 2.0), 9), Some(2));
        assert_eq!(at(far.lerp(middle, 0.5), 9), None, "nothing in reach");
    }
}
