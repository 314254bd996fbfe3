//! A pose from outside: the nodes that bend the surface nearly like it.
//!
//! Nodes cannot make every pose. Each takes the rigid motion that fits the vertices it carries best, by their weights: what
//! nodes do is nearly rigid wherever E is low, and the next steps find the rest.

use glam::{DMat3, DQuat, DVec3};

use super::affine::{IDENTITY, rigid};
use super::{Embedded, INACTIVE};
use crate::SolveError;
use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::sums::outer;
use crate::mesh::is_usable;

/// What one node carries, then and now: sums over its vertices, weighted.
#[derive(Clone, Copy, Default)]
struct Carried {
    weight: f64,
    rest: DVec3,
    now: DVec3,
    products: DMat3,
}

impl Embedded {
    /// Replaces what the nodes do (undo, another method), so that the surface comes near these positions of all vertices.
    /// Targets stay.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`. On error all is as it was.
    pub fn set_pose(&mut self, positions: &[DVec3]) -> Result<(), SolveError> {
        let (got, expected) = (positions.len(), self.analysis.layout.n_vertices());
        if got != expected {
            return Err(SolveError::WrongLength { what: "positions", got, expected });
        }
        if let Some(bad) = positions.iter().position(|&p| !is_usable(p)) {
            return Err(SolveError::TargetNotFinite { vertex: bad as u32 });
        }
        if positions == self.rest_positions() {
            self.x.fill(IDENTITY);
        } else {
            self.fit_nodes(positions, |_| true);
        }
        self.refresh();
        Ok(())
    }

    /// Fits those of the active nodes that are wanted, by their place.
    pub(super) fn fit_nodes(&mut self, positions: &[DVec3], is_wanted: impl Fn(usize) -> bool) {
        let center = self.graph.center;
        // Sums of products lose digits far from where they are measured from.
        let n = positions.len().max(1) as f64;
        let middle = positions.iter().fold(DVec3::ZERO, |sum, p| sum + *p / n);
        let mut carried = vec![Carried { products: DMat3::ZERO, ..Carried::default() }; self.active.len()];
        for (v, (&rest, &now)) in self.rest_positions().iter().zip(positions).enumerate() {
            let (rest, now) = (rest - center, now - middle);
            for (node, w) in self.graph.carriers_of(v) {
                let place = self.place_of[node as usize];
                if place != INACTIVE {
                    let sums = &mut carried[place as usize];
                    sums.weight += w;
                    sums.rest += rest * w;
                    sums.now += now * w;
                    sums.products += outer(now * w, rest);
                }
            }
        }
        for (i, sums) in carried.into_iter().enumerate().filter(|(place, _)| is_wanted(*place)) {
            let Carried { weight, rest, now, products } = sums;
            if weight <= 0.0 {
                self.x[i] = IDENTITY;
                continue;
            }
            let (rest, now) = (rest / weight, now / weight);
            let turn = best_rotation(products - outer(now * weight, rest), DQuat::IDENTITY, Ties::Nearest);
            let node = self.rest_of_node(self.active[i]) - center;
            let moved = turn * (node - rest) + now + middle;
            self.x[i] = rigid(turn, (moved - node - center) / self.graph.size);
        }
    }
}
