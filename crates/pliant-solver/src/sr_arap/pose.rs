//! A pose from outside, and the share of every vertex in the energy.

use glam::{DMat3, DQuat, DVec3};

use super::SrArap;
use super::field::{Field, Turn};
use crate::SolveError;
use crate::kernels::parallel::on_pool;
use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::sums::outer;
use crate::mesh::is_usable;

/// Times that all rotations are turned to each other after a pose was taken over. The first guess knows only the edges of
/// each vertex; more bring the energy down by less than the first step does (by eye).
const TURNS: usize = 3;

impl SrArap {
    /// Replaces the current pose (undo, another method): positions of all vertices. Rotations become good ones for them,
    /// whatever the pose was before. Targets stay.
    ///
    /// # Errors
    /// [`SolveError::WrongLength`], `TargetNotFinite`. On error all is as it was.
    pub fn set_pose(&mut self, positions: &[DVec3]) -> Result<(), SolveError> {
        let layout = &self.analysis.layout;
        let (got, expected) = (positions.len(), layout.n_vertices());
        if got != expected {
            return Err(SolveError::WrongLength { what: "positions", got, expected });
        }
        if let Some(bad) = positions.iter().position(|&p| !is_usable(p)) {
            return Err(SolveError::TargetNotFinite { vertex: bad as u32 });
        }
        for (p, &caller) in self.positions.iter_mut().zip(&layout.to_caller) {
            *p = positions[caller as usize];
        }
        self.turn_alone();
        self.forget();
        let is_rest = self.positions == self.analysis.layout.rest;
        on_pool(got, || {
            for _ in 0..if is_rest { 0 } else { TURNS } {
                self.energy = self.turn_all();
            }
        });
        self.comparable = None;
        Ok(())
    }

    /// Every vertex takes the rotation that is best for its edges, without regard to its neighbors.
    fn turn_alone(&mut self) {
        let SrArap { analysis, constants, positions, turns, .. } = self;
        let layout = &analysis.layout;
        for (turn, &v) in turns.iter_mut().zip(&constants.colors.vertices) {
            let i = v as usize;
            let t = layout.spokes(i).iter().fold(DMat3::ZERO, |t, spoke| {
                let (j, w) = (spoke.vertex as usize, layout.weight[spoke.edge as usize]);
                t + outer((positions[i] - positions[j]) * w, layout.rest[i] - layout.rest[j])
            });
            *turn = Turn::new(best_rotation(t, DQuat::IDENTITY, Ties::Nearest));
        }
    }

    /// The share of each vertex in the energy: the summand of i in the formula above.
    pub fn vertex_energies(&self) -> Vec<f64> {
        let SrArap { analysis, constants, positions, turns, .. } = self;
        let field = Field { layout: &analysis.layout, constants, positions };
        analysis.layout.to_internal.iter().map(|&v| field.energy_of(v as usize, turns)).collect()
    }
}
