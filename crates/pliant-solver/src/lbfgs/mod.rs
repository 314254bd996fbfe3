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
//! What A says of motions that no pair knows is stretched by what the newest pair says, up to twice: see [`history`].
//!
//! *From frame to frame of a drag* targets move. The first step is then plain, with the rotations of before: it spreads
//! the motion of the handles over the surface. E was another function before, but its curvature is nearly the same, so
//! the pairs stay. They go when A or the pose is replaced.

mod history;
mod vectors;

use glam::DVec3;

use self::history::{Direction, History, Pending, Products};
use self::vectors::{Course, Partial, Record};
use crate::kernels::parallel::{CHUNK, chunks};
use crate::kernels::quad::Quad;

/// The part of the decrease promised by the slope that is asked for (usual).
const ENOUGH: f64 = 1e-4;
/// Halvings before the plain step is taken. Each costs a local step; five brought no more than two.
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

    /// The energy that the next step can be judged by. None if it must be plain: E at the current pose is not known, or
    /// nothing is left of it.
    pub(crate) fn basis(&self, comparable: Option<f64>) -> Option<f64> {
        comparable.filter(|&energy| energy != 0.0 && !self.is_waiting())
    }

    /// Whether a step was proposed whose energy is not known yet.
    fn is_waiting(&self) -> bool {
        self.trial.is_some()
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
            direction = Direction::plain(fv);
        }
        self.before.copy_from_slice(positions);
        let slot = self.history.make_room();
        self.trial = Some(Trial {
            length: 1.0,
            energy,
            fd: direction.fd,
            halvings: 0,
            is_plain: direction.slots().is_empty(),
            fv,
            products,
            slot,
        });
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
        let plain = Direction::plain(trial.fv);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    type Vectors = Vec<DVec3>;

    fn dot(a: &Vectors, b: &Vectors) -> f64 {
        a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
    }

    fn sum(a: &Vectors, factor: f64, b: &Vectors) -> Vectors {
        a.iter().zip(b).map(|(a, b)| *a + *b * factor).collect()
    }

    /// The two loops as in any textbook, for pairs (s, y), oldest first.
    fn textbook(f: &Vectors, pairs: &[(Vectors, Vectors)], solve: &dyn Fn(&Vectors) -> Vectors) -> Vectors {
        let mut q = f.clone();
        let mut alphas = Vec::new();
        for (s, y) in pairs.iter().rev() {
            let alpha = dot(s, &q) / dot(s, y);
            q = sum(&q, -alpha, y);
            alphas.push(alpha);
        }
        let stretch = pairs.last().map_or(1.0, |(s, y)| (dot(s, y) / dot(y, &solve(y))).clamp(1.0, 2.0));
        let mut d: Vectors = solve(&q).iter().map(|&x| x * stretch).collect();
        for ((s, y), alpha) in pairs.iter().zip(alphas.iter().rev()) {
            let beta = dot(y, &d) / dot(s, y);
            d = sum(&d, alpha - beta, s);
        }
        d
    }

    #[test]
    fn steps_are_those_of_the_textbook_though_y_is_never_kept() {
        let n = 50;
        let mut random = Random::new(9);
        // E = x·Hx with Hessian below A, both diagonal; the minimum is 0.
        let a: Vec<f64> = (0..n).map(|_| 2.0 + random.signed()).collect();
        let h: Vec<f64> = a.iter().map(|a| a * (0.51 + 0.49 * random.signed())).collect();
        let energy = |x: &Vectors| x.iter().zip(&h).map(|(x, h)| x.length_squared() * h).sum::<f64>();
        let pull = |x: &Vectors| -> Vectors { x.iter().zip(&h).map(|(x, h)| *x * -h).collect() };
        let solve = |f: &Vectors| -> Vectors { f.iter().zip(&a).map(|(f, a)| *f / *a).collect() };
        let quads = |x: &Vectors| -> Vec<Quad> { x.iter().map(|&x| x.into()).collect() };

        let mut x: Vectors = (0..n).map(|_| random.vector()).collect();
        let mut lbfgs = Lbfgs::new(&x);
        let mut pairs: Vec<(Vectors, Vectors)> = Vec::new();
        // More steps than pairs, so that some are forgotten.
        for step in 0..3 * history::PAIRS {
            let f = pull(&x);
            let expected = textbook(&f, &pairs[pairs.len().saturating_sub(history::PAIRS)..], &solve);
            let before = x.clone();
            lbfgs.take_gradient(&quads(&f));
            lbfgs.propose(&quads(&solve(&f)), energy(&before), &mut x);
            let got = sum(&x, -1.0, &before);
            // What is kept has seven digits; differences of products lose some.
            let error = dot(&sum(&got, -1.0, &expected), &sum(&got, -1.0, &expected)) / dot(&expected, &expected);
            assert!(error.sqrt() < 1e-4, "step {step}: off by {}", error.sqrt());
            while lbfgs.judge(energy(&x), 0.0, &mut x) == Verdict::Again {}
            let taken = sum(&x, -1.0, &before);
            pairs.push((taken, sum(&f, -1.0, &pull(&x))));
        }
    }

    #[test]
    fn a_step_that_does_not_lower_the_energy_ends_as_the_plain_step() {
        let x = vec![DVec3::X, DVec3::Y, DVec3::Z];
        let pulls = |size: f64| -> Vec<Quad> { x.iter().map(|&x| Quad::from(x * size)).collect() };
        let mut lbfgs = Lbfgs::new(&x);
        let mut now = x.clone();
        for size in [-1.0, -0.5] {
            lbfgs.take_gradient(&pulls(size));
            lbfgs.propose(&pulls(0.5 * size), 1.0, &mut now);
            assert!(lbfgs.is_waiting());
            if size == -1.0 {
                assert_eq!(lbfgs.judge(0.9, 0.0, &mut now), Verdict::Taken);
            }
        }
        let before = lbfgs.before.clone();
        let mut tried = 0;
        while lbfgs.judge(2.0, 0.0, &mut now) == Verdict::Again {
            tried += 1;
        }
        assert_eq!(tried, MOST_HALVINGS + 1);
        assert_eq!(lbfgs.n_pairs(), 0);
        for (i, (got, before)) in now.iter().zip(&before).enumerate() {
            assert_eq!(*got, *before + x[i] * -0.25, "vertex {i}");
        }
    }
}
