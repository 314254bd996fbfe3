//! Meshes, handles and solvers to be timed.

use crate::shapes::handles::Handles;
use crate::shapes::{Shape, bar, body};
use glam::{DMat4, DQuat, DVec3};
use pliant_solver::{Analysis, LooseComponents, Mesh, Neighborhoods, Rigidity, SolveError, Solver, VertexId, Weights};
use std::sync::Arc;

/// How far everything is bent, in degrees.
pub(crate) const BEND: f64 = 70.0;

/// A shape with its handles.
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) shape: Shape,
    pub(crate) handles: Handles,
}

impl Scene {
    /// The bumpy ellipsoid of 10 `cuts`² + 2 vertices.
    pub(crate) fn body(cuts: u32) -> Scene {
        let shape = body::body(cuts);
        let handles = body::bend(&shape, BEND);
        Scene { name: "body", shape, handles }
    }

    /// Whether it is the body of so many cuts.
    pub(crate) fn is_body_of(&self, cuts: u32) -> bool {
        self.name == "body" && self.n_vertices() == (10 * cuts * cuts + 2) as usize
    }

    /// The bar with `cells` cells across, about 30 `cells`² vertices.
    pub(crate) fn bar(cells: u32) -> Scene {
        let (shape, handles) = bar::bent(cells, BEND);
        Scene { name: "bar", shape, handles }
    }

    /// The sample with painted joints, and its r.
    pub(crate) fn creature() -> (Scene, Vec<u16>) {
        let sample = crate::shapes::creature::CREATURE;
        let shape = (sample.make)();
        let handles = (sample.handles)(&shape).swap_remove(0).1;
        let r = sample.rigidity.map_or_else(Vec::new, |rigidity| rigidity(&shape));
        (Scene { name: "creature", shape, handles }, r)
    }

    pub(crate) fn n_vertices(&self) -> usize {
        self.shape.positions.len()
    }

    pub(crate) fn mesh(&self) -> Arc<Mesh> {
        let mesh = Mesh::new(self.shape.positions.clone(), self.shape.triangles.clone());
        Arc::new(mesh.expect("shapes have finite coordinates and refer to their own vertices"))
    }

    /// Held vertices and where they go.
    pub(crate) fn held(&self) -> (Vec<VertexId>, Vec<DVec3>) {
        self.handles.targets(&self.shape).into_iter().map(|(v, to)| (VertexId(v), to)).unzip()
    }

    /// Where the held vertices are on the way, from 0 at rest to 1 at the end: groups turn and shift evenly.
    pub(crate) fn targets_at(&self, way: f64) -> Vec<DVec3> {
        let mut handles = self.handles.clone();
        for (v, to) in &mut handles.moved {
            *to = self.shape.positions[*v as usize].lerp(*to, way);
        }
        for (vertices, matrix) in &mut handles.groups {
            let middle =
                vertices.iter().map(|&v| self.shape.positions[v as usize]).sum::<DVec3>() / vertices.len() as f64;
            let turn = DQuat::IDENTITY.slerp(DQuat::from_mat4(matrix), way);
            let shift = middle.lerp(matrix.transform_point3(middle), way) - turn * middle;
            *matrix = DMat4::from_rotation_translation(turn, shift);
        }
        handles.targets(&self.shape).into_iter().map(|(_, to)| to).collect()
    }

    /// The `n` vertices nearest to the top of the middle, nearest first: where a brush or a new handle comes down.
    pub(crate) fn dab(&self, n: usize) -> Vec<u32> {
        let positions = &self.shape.positions;
        let (low, high) = positions.iter().fold((positions[0], positions[0]), |(a, b), &p| (a.min(p), b.max(p)));
        let top = low.midpoint(high).with_y(high.y);
        let mut order: Vec<u32> = (0..positions.len() as u32).collect();
        order.sort_by(|&a, &b| {
            let distance = |v: u32| positions[v as usize].distance_squared(top);
            distance(a).total_cmp(&distance(b))
        });
        order.truncate(n);
        order
    }
}

/// A solver of a scene that is to be bent.
pub(crate) fn solver(scene: &Scene, analysis: &Arc<Analysis>, rigidity: &Rigidity) -> Result<Solver, SolveError> {
    factored(scene, analysis, rigidity, Neighborhoods::new(analysis, rigidity)?)
}

/// The same with the neighborhoods found already.
pub(crate) fn factored(
    scene: &Scene,
    analysis: &Arc<Analysis>,
    rigidity: &Rigidity,
    neighborhoods: Neighborhoods,
) -> Result<Solver, SolveError> {
    let (held, targets) = scene.held();
    let mut solver = Solver::new(analysis.clone(), neighborhoods, rigidity, &held, LooseComponents::KeepAtRest)?;
    solver.set_targets(&targets)?;
    Ok(solver)
}

/// Order and weights as the command line makes them.
pub(crate) fn analyze(mesh: &Arc<Mesh>) -> Arc<Analysis> {
    Arc::new(Analysis::new(mesh.clone(), Weights::Clamped))
}
