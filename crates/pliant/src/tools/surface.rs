//! The surface as it is on screen, ready to be asked what is under the pointer.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use pliant_geometry::{Bvh, Growth, Occlusion, Ray, Sight, SurfaceDistance};
use pliant_solver::VertexId;
use rayon::prelude::*;

use super::prompt::promptly;
use super::{Card, View};
use crate::document::Model;
use crate::viewport::SurfaceFrame;

/// A sheet that is so much nearer, in viewing distances, hides what is behind it; what is less is the surface itself.
/// By eye; about a pixel of the picture.
const SLACK: f32 = 1e-3;
/// For fewer vertices than this, rays are cheaper than a picture of depths (a ray takes about a microsecond).
const RAYS_ALONE: usize = 4096;
/// Rays that are worth a task.
const RAYS_PER_TASK: usize = 256;

/// What a ray met first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Triangle that was hit.
    pub triangle: u32,
    /// Its corner nearest to the point.
    pub vertex: VertexId,
    /// The point, view space.
    pub position: Vec3,
    /// Normal of the surface there, unit length.
    pub normal: Vec3,
}

/// Hierarchy and adjacency for picking on a moving surface. The hierarchy is refitted when it is next asked after the
/// surface moved, so that nothing is spent while nobody points.
pub struct Surface {
    triangles: Arc<[[u32; 3]]>,
    frame: Arc<SurfaceFrame>,
    bvh: Bvh,
    bvh_is_current: bool,
    distance: SurfaceDistance,
}

impl Surface {
    /// Builds the hierarchy. O(n log n).
    pub fn new(model: &Model, frame: Arc<SurfaceFrame>) -> Surface {
        Surface {
            bvh: Bvh::new(&frame.positions, &model.triangles),
            bvh_is_current: true,
            distance: SurfaceDistance::new(frame.positions.len(), &model.triangles),
            triangles: model.triangles.clone(),
            frame,
        }
    }

    /// The surface on screen.
    pub fn frame(&self) -> &Arc<SurfaceFrame> {
        &self.frame
    }

    /// A front that leaves a vertex along the surface; `None` where no triangle is.
    pub fn front_from(&self, Card { vertex, triangle, .. }: Card) -> Option<Growth> {
        let at = *self.frame.positions.get(vertex.index())?;
        self.distance.growth(&self.frame.positions, &self.triangles, triangle, at)
    }

    /// Takes over new positions of the same surface.
    pub fn set_frame(&mut self, frame: Arc<SurfaceFrame>) {
        self.frame = frame;
        self.bvh_is_current = false;
    }

    /// What lies under a pixel.
    pub fn pick(&mut self, px: Vec2, view: &View) -> Option<Pick> {
        self.refit();
        let ray = view.camera.ray(px, view.size);
        let hit = self.bvh.cast(ray, &self.frame.positions, &self.triangles)?;
        let corners = self.triangles[hit.triangle as usize];
        let weights = hit.barycentric;
        let nearest = (0..3).max_by(|&a, &b| weights[a].total_cmp(&weights[b])).unwrap_or(0);
        let blend = |of: &[Vec3]| (0..3).map(|c| of[corners[c] as usize] * weights[c]).sum::<Vec3>();
        Some(Pick {
            triangle: hit.triangle,
            vertex: VertexId(corners[nearest]),
            position: blend(&self.frame.positions),
            normal: blend(&self.frame.normals).normalize_or(Vec3::Y),
        })
    }

    /// Whether nothing hides a vertex from the eye.
    pub fn is_visible(&mut self, v: VertexId, view: &View) -> bool {
        self.refit();
        self.is_seen(v, view)
    }

    /// Those of some vertices that nothing hides from the eye, in the same order. A ray for each where they are few; of
    /// many, only where a picture of depths leaves doubts.
    pub fn visible_of(&mut self, vertices: Vec<VertexId>, view: &View) -> Vec<VertexId> {
        self.refit();
        promptly(|| self.seen_of(vertices, view))
    }

    /// The hierarchy must be current.
    fn seen_of(&self, vertices: Vec<VertexId>, view: &View) -> Vec<VertexId> {
        let vertices = vertices.into_par_iter().with_min_len(RAYS_PER_TASK);
        if vertices.len() < RAYS_ALONE {
            return vertices.filter(|&v| self.is_seen(v, view)).collect();
        }
        let positions = &self.frame.positions;
        let picture = Occlusion::new(positions, &self.triangles, view.camera.lens(view.size));
        let slack = SLACK * view.camera.distance;
        let is_visible = |&v: &VertexId| match picture.sight(positions[v.index()], slack) {
            Sight::Clear => true,
            Sight::Hidden => false,
            Sight::Doubtful => self.is_seen(v, view),
        };
        vertices.filter(is_visible).collect()
    }

    /// The hierarchy must be current.
    fn is_seen(&self, v: VertexId, view: &View) -> bool {
        let position = self.frame.positions[v.index()];
        let Some((px, _)) = view.camera.project(position, view.size) else {
            return false;
        };
        let ray = view.camera.ray(px, view.size);
        let along = (position - ray.origin).dot(ray.direction) / ray.direction.length_squared();
        // Its own faces are at exactly this distance. Orthographic rays begin far before the eye, so their own length says
        // nothing.
        let slack = SLACK * along.abs().min(view.camera.distance / ray.direction.length());
        !self.bvh.is_blocked(
            Ray { origin: ray.origin, direction: ray.direction },
            along - slack,
            &self.frame.positions,
            &self.triangles,
        )
    }

    /// Vertices within `radius` of a picked point along the surface, in no order.
    pub fn within(&mut self, pick: &Pick, radius: f32) -> Vec<VertexId> {
        let Pick { triangle, position, .. } = *pick;
        let found = self.distance.within(&self.frame.positions, &self.triangles, triangle, position, radius);
        found.into_iter().map(|(v, _)| VertexId(v)).collect()
    }

    /// A front that leaves a picked point and can be sent on as far as needed.
    pub fn growth(&self, pick: &Pick) -> Option<Growth> {
        self.distance.growth(&self.frame.positions, &self.triangles, pick.triangle, pick.position)
    }

    /// The triangles, shared with the picture.
    pub fn triangles(&self) -> &Arc<[[u32; 3]]> {
        &self.triangles
    }

    fn refit(&mut self) {
        if !self.bvh_is_current {
            promptly(|| self.bvh.refit(&self.frame.positions, &self.triangles));
            self.bvh_is_current = true;
        }
    }
}
