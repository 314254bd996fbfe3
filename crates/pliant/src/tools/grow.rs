//! Filling by dragging: a front leaves the pressed point along the surface and follows the drag.

use std::sync::Arc;

use glam::Vec2;
use pliant_geometry::{Crossing, Growth};
use pliant_solver::{Rigidity, VertexId};

use super::{Context, Mirror, Pick};
use crate::viewport::{Line, SurfaceFrame};

/// Vertices the front passes while the window waits: about 10 ms of work (measured: 0.6 to 0.8 µs each).
const VERTICES_AT_A_TIME: usize = 14_000;

/// A fill that grows and shrinks under the hand.
pub(super) struct Grow {
    growth: Growth,
    /// The surface when the drag began: distances are measured on it, whatever the solver makes of it meanwhile.
    frame: Arc<SurfaceFrame>,
    mirror: Option<Arc<Mirror>>,
    /// r before the drag.
    before: Rigidity,
    r: u16,
    from_px: Vec2,
    world_per_px: f32,
    radius: f32,
    /// Whether each vertex lies within the radius.
    is_inside: Vec<bool>,
    /// Whether each vertex has the new r: those inside and their images.
    is_filled: Vec<bool>,
    n_filled: usize,
    line: Vec<[Crossing; 2]>,
    is_behind: bool,
}

impl Grow {
    /// From a pressed point, nothing filled yet.
    pub(super) fn new(pick: &Pick, px: Vec2, context: &Context<'_>) -> Option<Grow> {
        let frame = context.surface.frame().clone();
        let n = frame.positions.len();
        Some(Grow {
            growth: context.surface.growth(pick)?,
            mirror: context.prepared.mirror.clone(),
            before: context.document.scene().rigidity.clone(),
            r: context.options.rigidity,
            from_px: px,
            world_per_px: context.view.camera.world_per_px(pick.position, context.view.size),
            radius: 0.0,
            is_inside: vec![false; n],
            is_filled: vec![false; n],
            n_filled: 0,
            line: Vec::new(),
            is_behind: false,
            frame,
        })
    }

    /// Takes the fill to the pointer: as far along the surface as the pointer is from where it was pressed. Returns what
    /// changed. The last call of a drag does all that is left, others only so much.
    pub(super) fn follow(&mut self, px: Vec2, is_last: bool, context: &Context<'_>) -> Vec<(VertexId, u16)> {
        self.radius = px.distance(self.from_px) * self.world_per_px;
        let (positions, triangles) = (&self.frame.positions, context.surface.triangles());
        let most = if is_last { usize::MAX } else { VERTICES_AT_A_TIME };
        self.is_behind = !self.growth.grow(positions, triangles, self.radius, most);
        self.growth.line(positions, triangles, self.radius, &mut self.line);
        let mut turned = Vec::new();
        for (v, distance) in self.growth.reached() {
            let inside = distance <= self.radius;
            if self.is_inside[v as usize] != inside {
                self.is_inside[v as usize] = inside;
                turned.push(v);
            }
        }
        self.values(&turned)
    }

    /// New r of vertices that the front has passed, either way, and of their images.
    fn values(&mut self, turned: &[u32]) -> Vec<(VertexId, u16)> {
        let mut values = Vec::new();
        let mirror = self.mirror.clone();
        for &v in turned {
            let images = mirror.as_ref().map_or(&[][..], |mirror| mirror.map.across(v));
            for &w in std::iter::once(&v).chain(images) {
                let source = mirror.as_ref().and_then(|mirror| mirror.map.source(w));
                let filled = self.is_inside[w as usize] || source.is_some_and(|source| self.is_inside[source as usize]);
                if std::mem::replace(&mut self.is_filled[w as usize], filled) != filled {
                    self.n_filled = if filled { self.n_filled + 1 } else { self.n_filled - 1 };
                    let r = if filled { self.r } else { self.before.as_slice()[w as usize] };
                    values.push((VertexId(w), r));
                }
            }
        }
        values
    }

    /// Whether the front has not yet come as far as the pointer.
    pub(super) fn is_behind(&self) -> bool {
        self.is_behind
    }

    /// How far the fill goes, model units.
    pub(super) fn radius(&self) -> f32 {
        self.radius
    }

    /// Vertices that have the new r.
    pub(super) fn n_filled(&self) -> usize {
        self.n_filled
    }

    /// r that the fill gives.
    pub(super) fn r(&self) -> u16 {
        self.r
    }

    /// The front, on the surface as it is on screen.
    pub(super) fn line(&self, context: &Context<'_>) -> Vec<Line> {
        let frame = context.surface.frame();
        let lift = 1.5 * self.world_per_px; // clear of the surface's own pixels
        let at = |crossing: &Crossing| {
            let [a, b] = crossing.edge.map(|v| v as usize);
            let normal = match (frame.normals.get(a), frame.normals.get(b)) {
                (Some(a), Some(b)) => a.lerp(*b, crossing.along),
                _ => glam::Vec3::ZERO,
            };
            frame.positions[a].lerp(frame.positions[b], crossing.along) + normal * lift
        };
        let piece = |[a, b]: &[Crossing; 2]| Line {
            a: at(a),
            b: at(b),
            color: [255, 255, 255, 240],
            width_px: 2.0,
            on_top: false,
        };
        self.line.iter().map(piece).collect()
    }
}
