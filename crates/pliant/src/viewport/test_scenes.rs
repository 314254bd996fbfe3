//! Scenes for tests.

use super::{Axis, Camera, SurfaceFrame, Theme, ViewScene};
use glam::Vec3;
use std::sync::Arc;

/// A flat sheet of `cells` by `cells` squares of two triangles each across the view, seen from the front.
pub(super) fn sheet(cells: u32) -> ViewScene {
    let row = cells + 1;
    let place = |i: u32| i as f32 / cells as f32 * 2.0 - 1.0;
    let positions: Vec<Vec3> = (0..row * row).map(|i| Vec3::new(place(i % row), place(i / row), 0.0)).collect();
    let triangles: Arc<[[u32; 3]]> = (0..cells * cells)
        .flat_map(|cell| {
            let a = cell / cells * row + cell % cells;
            [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]
        })
        .collect();
    let bounds = (Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0));
    let mut camera = Camera::framing(bounds.0, bounds.1);
    camera.look_along(Axis::Front);
    camera.frame(bounds.0, bounds.1);
    let frame = SurfaceFrame { normals: vec![Vec3::Z; positions.len()], positions };
    ViewScene { theme: Theme::Light, ..ViewScene::plain(triangles, Arc::new(frame), camera, bounds) }
}
