//! The step of Gauss–Newton: as much of its change as lowers E well.

use glam::{DMat3, DQuat, DVec3};

use super::Embedded;
use super::affine::{self, Affine, shift};
use super::direction::Direction;
use super::frames::{self, Frame};
use crate::StepReport;

/// How often a step is halved before it is given up.
const MOST_HALVINGS: usize = 20;
/// The whole change is taken unless E is lowest before this part of it.
const TOO_FAR: f64 = 0.8;
/// The least part that is tried at once.
const SHORTEST: f64 = 0.1;
/// The part of the decrease that the gradient promises which a step must keep (Armijo's rule, with the usual number).
const KEPT: f64 = 1e-4;

impl Embedded {
    /// One step of Gauss–Newton; E never rises.
    pub fn step(&mut self) -> StepReport {
        self.global_step();
        self.local_step()
    }

    /// What the last step achieved: there is no second half.
    pub fn local_step(&mut self) -> StepReport {
        self.report
    }

    /// The whole step.
    pub fn global_step(&mut self) {
        let before = self.terms.energy(&self.x);
        self.iteration += 1;
        self.energy = before;
        if before > self.terms.floor() {
            self.terms.gradient(&self.x, &mut self.gradient);
            let at = (&self.x[..], &self.gradient[..]);
            let problem = (&self.terms, &self.quadratic);
            if self.direction.as_mut().is_some_and(|direction| direction.find(problem, at, &mut self.change)) {
                self.advance(before);
            }
        }
        if self.energy <= self.terms.floor() {
            self.energy = 0.0;
        }
        let relative_decrease = if before == 0.0 { 0.0 } else { (before - self.energy) / before };
        self.report = StepReport { energy: self.energy, iteration: self.iteration, relative_decrease };
    }

    /// Takes as much of the change as lowers E well: all of it, or up to where the parabola through what is known of E is
    /// lowest, and half of that should it come to it. Where a component is strained much, the whole change may go twice as
    /// far as it should, and then iterations would swing to and fro.
    fn advance(&mut self, before: f64) {
        let slope = 2.0 * affine::dot(&self.gradient, &self.change);
        let whole = self.try_length(1.0);
        let lowest = -slope / (2.0 * (whole - before - slope));
        let (mut length, mut energy) = (1.0, whole);
        if lowest < TOO_FAR || whole.is_nan() {
            length = if lowest.is_nan() { 0.5 } else { lowest.max(SHORTEST) };
            energy = self.try_length(length);
            if energy > whole {
                (length, energy) = (1.0, self.try_length(1.0));
            }
        }
        for _ in 0..MOST_HALVINGS {
            if energy <= before + KEPT * length * slope {
                std::mem::swap(&mut self.x, &mut self.tried);
                self.energy = energy;
                return;
            }
            length *= 0.5;
            energy = self.try_length(length);
        }
    }

    /// E after a part of the change.
    fn try_length(&mut self, length: f64) -> f64 {
        let frames = self.direction.as_ref().map_or(&[][..], Direction::frames);
        for (((tried, x), change), frame) in self.tried.iter_mut().zip(&self.x).zip(&self.change).zip(frames) {
            *tried = turned(x, change, frame, length);
        }
        self.terms.energy(&self.tried)
    }

    /// Rounds of the inner iteration in the last step.
    #[cfg(test)]
    pub(crate) fn rounds(&self) -> usize {
        self.direction.as_ref().map_or(0, |direction| direction.rounds)
    }
}

/// x after a part of a change, with R moved along rotations: Q exp(ω) (P + S + W (I − P)), W ω's matrix, which agrees to
/// first order.
fn turned(x: &Affine, change: &Affine, frame: &Frame, length: f64) -> Affine {
    let local = frame.local(change);
    let mut turn = [0.0; 9];
    turn[..frames::TURNS].copy_from_slice(&local[..frames::TURNS]);
    let mut stretch = local;
    stretch[..frames::TURNS].fill(0.0);
    let (turn, stretch) = (frames::combined(&turn), frames::combined(&stretch));
    let axis = DVec3::new(turn.col(1)[2], turn.col(2)[0], turn.col(0)[1]);
    let q = frame.turn * DQuat::from_scaled_axis(axis * length);
    let inner = frame.p + (stretch + turn * (DMat3::IDENTITY - frame.p)) * length;
    affine::affine(DMat3::from_quat(q.normalize()) * inner, shift(x) + shift(change) * length)
}
