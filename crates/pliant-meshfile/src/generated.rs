//! Meshes that no file holds.

use crate::formats::{Edit, Output, Source};
use crate::shape::{Corner, NONE, Part, Shape, ShapePart};
use crate::{Format, SaveError, normals};
use glam::DVec3;
use std::path::Path;

/// The source of a mesh that no file holds.
#[derive(Debug)]
pub(crate) struct Generated;

impl Source for Generated {
    fn rewrite(&self, _: &Edit<'_>, _: &Path, _: Format) -> Option<Result<Output, SaveError>> {
        None
    }

    fn shape(&self, edit: &Edit<'_>) -> Shape {
        let mesh = edit.mesh;
        let corner = |vertex| Corner { vertex, uv: NONE, normal: vertex };
        let part =
            |part: &Part| ShapePart { name: part.name.clone(), triangles: part.triangles.clone(), material: None };
        // Generated shapes may repeat vertices too: normals are those of the welded surface.
        let points: Vec<DVec3> =
            mesh.weld.vertex_of_point.iter().map(|&vertex| edit.positions[vertex as usize]).collect();
        let of_point = normals::smooth(&points, &mesh.weld.triangles(mesh.triangles));
        Shape {
            normals: mesh.weld.point_of_vertex.iter().map(|&point| of_point[point as usize]).collect(),
            positions: edit.positions.clone(),
            triangles: mesh.triangles.iter().map(|t| t.map(corner)).collect(),
            parts: mesh.parts.iter().map(part).collect(),
            rigidity: edit.rigidity.clone(),
            ..Shape::default()
        }
    }
}
