//! Fewer iterations: L-BFGS on p', with the factored system of the global step for its first Hessian.
//!
//! With R the best rotations for p', E is a function of p' alone, and half its gradient is A p' − b: the derivative of R
//! drops out, because E is least in R. The plain global step p' ← p' + A⁻¹ (b − A p') is a step of steepest descent as A
//! measures it. It is slow along motions that bend gently, to which A is much stiffer than the surface, whose rotations
//! follow. The last few steps tell by how much.
//!
//! | symbol | meaning |
//! |---|---|
//! | f | b − A p', minus half the gradient; 0 at fixed vertices |
//! | v | A⁻¹ f, the plain step |
//! | s | a step taken before |
//! | y | f before it − f after it, the change of half the gradient |
//! | w | A⁻¹ y = v before it − v after it |
//! | d | H f, the step to be tried; H is the inverse Hessian that s and y suggest |
//!
//! Only s and w are kept, in single precision and in units of the mesh. What the recursion needs of y are inner
//! products, and those are differences of products with f (see [`history`]). So a step costs one solve, as a plain one,
//! three passes over the kept vectors, and a local step for the energy at p' + d.
//!
//! *E never rises*: if E falls short of a small part of what the slope promises, the step is halved; if that does not
//! help either, the plain step is taken instead, whose v is at hand, and the history begins anew.
//!
//! *From frame to frame of a drag* targets move. The first step is then plain, with the rotations of before: it spreads
//! the motion of the handles over the surface. E was another function before, but its curvature is nearly the same, so
//! the pairs stay. They go when A or the pose is replaced.

mod history;
mod vectors;

use glam::DVec3;

use self::history::{Direction, History, Pending, Products};
use self::vectors::{Course, Partial, Record};
use crate::parallel::{CHUNK, chunks};
use crate::quad::Quad;

/// The part of the decrease promised by the slope that is asked for (usual).
const ENOUGH: f64 = 1e-4;
/// Halvings before the plain step is taken. Each costs a local step.
const MOST_HALVINGS: u32 = 2;

/// A step that waits for its energy.
#[derive(Clone, Copy, Debug)]
struct Trial {
    /// Fraction of d that was taken.
    length: f64,
    /// E before the step.
    energy: f64,
    /// f·d.
    fd: f64,
    halvings: u32,
    /// Whether d is v, which cannot raise E.
    is_plain: bool,
    /// f·v and the products of f.
    fv: f64,
    products: Products,
    slot: usize,
}

/// What a trial step came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// The energy is as low as it should be.
    Taken,
    /// Positions were set to another trial: rotations and energy are needed again.
    Again,
}

/// The memory of L-BFGS, reserved once: 248 bytes per vertex.
pub(crate) struct Lbfgs {
    history: History,
    records: Vec<Record>,
    /// f and v of the last step.
    f: Vec<Quad>,
    v: Vec<Quad>,
    /// p' before the last step.
    before: Vec<DVec3>,
    /// Products of `f`.
    products: Products,
    partial: Vec<Partial>,
    /// Lengths of the mesh to 1: what is kept in single precision must not overflow.
    unit: f64,
    pending: Option<Pending>,
    trial: Option<Trial>,
}

impl Lbfgs {
    pub(crate) fn new(rest: &[DVec3]) -> Lbfgs {
        let n = rest.len();
        let first = rest.first().copied().unwrap_or_default();
        let size = rest.iter().fold(DVec3::ZERO, |size, &p| size.max((p - first).abs())).max_element();
        let unit = 1.0 / size;
        Lbfgs {
            history: History::default(),
            records: vec![Record::default(); n],
            f: vec![Quad::ZERO; n],
            v: vec![Quad::ZERO; n],
            before: vec![DVec3::ZERO; n],
            products: Products::default(),
            partial: vec![Partial::default(); n.div_ceil(CHUNK)],
            unit: if unit.is_finite() { unit } else { 1.0 },
            pending: None,
            trial: None,
        }
    }

    /// Forgets everything: A or the pose is another.
    pub(crate) fn forget(&mut self) {
        self.history.clear();
        self.interrupt();
    }

    /// The next step has another energy than the last: the last makes no pair.
    pub(crate) fn interrupt(&mut self) {
        self.pending = None;
        self.trial = None;
    }

    /// Pairs remembered.
    #[cfg(test)]
    pub(crate) fn n_pairs(&self) -> usize {
        self.history.len()
    }

    /// Takes in f, before it is solved for.
    pub(crate) fn take_gradient(&mut self, f: &[Quad]) {
        self.products = vectors::products(f, &mut self.f, &self.v, &self.records, &mut self.partial);
    }

    /// Takes in v and sets positions to p' + d. `energy` is E at p'.
    pub(crate) fn propose(&mut self, v: &[Quad], energy: f64, positions: &mut [DVec3]) {
        let mut products = self.products;
        let pending = self.pending.take();
        let place = pending.map(|pending| (pending.slot, pending.factor));
        let fv = vectors::remember_change((&self.f, v), &mut self.v, &mut self.records, place, &mut self.partial);
        if let Some(pending) = pending {
            self.history.complete(&pending, &mut products, fv);
        }
        let mut direction = self.history.direction(&products, fv);
        // Not a descent, or not a number.
        if !(direction.fd > 0.0 && direction.fd.is_finite()) {
            self.history.clear();
            direction = Direction { fd: fv, ..Direction::default() };
        }
        self.before.copy_from_slice(positions);
        let slot = self.history.make_room();
        self.trial = Some(Trial { length: 1.0, energy, fd: direction.fd, halvings: 0, is_plain: direction.slots().is_empty(), fv, products, slot });
        self.advance(&direction, slot, positions);
    }

    fn advance(&mut self, direction: &Direction, slot: usize, positions: &mut [DVec3]) {
        let course = Course { direction, slot, unit: self.unit };
        vectors::advance(course, &self.v, &mut self.records, &self.before, positions);
    }

    /// Judges the energy at the trial step; `rounding` is by how much it may seem to rise.
    pub(crate) fn judge(&mut self, energy: f64, rounding: f64, positions: &mut [DVec3]) -> Verdict {
        let Some(trial) = &mut self.trial else {
            return Verdict::Taken;
        };
        let promised = 2.0 * trial.length * trial.fd;
        if trial.is_plain || energy <= trial.energy - ENOUGH * promised || (energy - trial.energy).abs() <= rounding {
            self.settle();
            return Verdict::Taken;
        }
        if trial.halvings < MOST_HALVINGS {
            trial.halvings += 1;
            trial.length *= 0.5;
            let before = &self.before;
            chunks(positions, |first, positions| {
                for (p, before) in positions.iter_mut().zip(&before[first..]) {
                    *p = *before + (*p - *before) * 0.5;
                }
            });
            return Verdict::Again;
        }
        self.history.clear();
        (trial.length, trial.fd, trial.is_plain) = (1.0, trial.fv, true);
        let plain = Direction { fd: trial.fv, ..Direction::default() };
        let slot = trial.slot;
        self.advance(&plain, slot, positions);
        Verdict::Again
    }

    /// The trial step stands, and will make a pair.
    fn settle(&mut self) {
        let Some(Trial { length, fd, fv, mut products, slot, .. }) = self.trial.take() else {
            return;
        };
        products.fs[slot] = fd * self.unit;
        self.pending = Some(Pending { slot, factor: self.unit / length, products, fv });
    }
}
