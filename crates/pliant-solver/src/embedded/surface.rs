//! Where the vertices are, given what the nodes do.

use glam::{DMat3, DQuat, DVec3};

use super::affine::{Affine, ZERO, linear, shift, times};
use super::{Embedded, apply};
use crate::rigid_fit::RigidMotion;

impl Embedded {
    /// Positions of all vertices written into `out`; entries beyond the vertices stay.
    pub fn positions_into(&self, out: &mut [DVec3]) {
        let n = self.analysis.layout.n_vertices().min(out.len());
        apply::apply(&self.graph, &self.table(), self.rest_positions(), &mut out[..n]);
    }

    /// Positions of all vertices.
    pub fn positions(&self) -> Vec<DVec3> {
        let mut positions = vec![DVec3::ZERO; self.analysis.layout.n_vertices()];
        self.positions_into(&mut positions);
        positions
    }

    pub(super) fn rest_positions(&self) -> &[DVec3] {
        self.rest.as_deref().unwrap_or(self.analysis.mesh().positions())
    }

    pub(super) fn rest_of_node(&self, node: u32) -> DVec3 {
        let layout = &self.analysis.layout;
        self.rest_positions()[layout.to_caller[self.graph.nodes[node as usize] as usize] as usize]
    }

    /// What every node does to vertices, see `apply.rs`.
    pub(super) fn table(&self) -> Vec<Affine> {
        let (center, size) = (self.graph.center, self.graph.size);
        let mut table = vec![ZERO; self.graph.n_nodes()];
        for (&node, x) in self.active.iter().zip(&self.x) {
            let g = self.rest_of_node(node) - center;
            table[node as usize] = apply::displacement(linear(x), shift(x) * size, g);
        }
        if self.held.loose_follow() && !self.held.loose_reported.is_empty() {
            self.follow_groups(&mut table);
        }
        table
    }

    /// Nodes of loose components take part in the motion of the nearest group.
    fn follow_groups(&self, table: &mut [Affine]) {
        let groups = 0..self.held.by_group.len();
        let motions: Vec<RigidMotion> =
            groups.map(|group| self.fit(self.held.by_group.list(group), DQuat::IDENTITY)).collect();
        let component = &self.analysis.layout.component;
        let mut motion_of = vec![None; self.held.by_component.len()];
        for (vertices, group) in self.held.loose_parts() {
            motion_of[component[vertices.start] as usize] = Some(motions[group]);
        }
        for (node, entry) in table.iter_mut().enumerate() {
            if let Some(motion) = motion_of[component[self.graph.nodes[node] as usize] as usize] {
                let p = self.rest_of_node(node as u32);
                let r = DMat3::from_quat(motion.rotation);
                *entry = apply::displacement(r, motion.apply(p) - p, p - self.graph.center);
            }
        }
    }

    /// Where one vertex is.
    pub(super) fn moved(&self, table: &[Affine], v: usize) -> DVec3 {
        let p = self.rest_positions()[v];
        let arm = p - self.graph.center;
        self.graph
            .carriers_of(v)
            .fold(p, |sum, (node, w)| sum + times(&table[node as usize], &[arm.x, arm.y, arm.z, 1.0]) * w)
    }
}
