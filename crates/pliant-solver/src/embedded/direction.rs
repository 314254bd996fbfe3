//! The step of Gauss–Newton: A δ = −½ gradient, with A = JᵀJ and a little more on its diagonal.
//!
//! # Idea
//! A has twelve unknowns a node, and factoring it takes several frames of a screen. But E_rot is so stiff against
//! stretching that turning and moving hardly feel it: on the six unknowns of these, A is factored (an eighth of the work),
//! on the six of stretching it is inverted node by node, and with both as preconditioner the conjugate gradients arrive
//! in a few rounds at the step of the whole matrix.
//!
//! Seen from the nodes' own rotations, t included, the factored part changes only where neighbors turn against each
//! other. So a factor serves for many steps, until the rounds tell that it is out of date.

use std::sync::Arc;

use glam::{DQuat, DVec3};

use super::affine::{Affine, ZERO, add_scaled, dot, shift};
use super::energy::Terms;
use super::frames::{Frame, Local, STRETCHES, TURNS, basis, coefficients, upper_left};
use super::quadratic::{Block, Quadratic};
use crate::kernels::quad::Quad;
use crate::linear::{FactorError, Ordered, Pattern, System};

/// Unknowns of a node in the factored system: turns and t.
const ROWS: usize = TURNS + 3;
/// More on the diagonal, relative to it: where nothing resists (a component held at a single vertex) there is no step, and
/// elsewhere it is far below what resists (bending of a whole component: some 1e-4).
const DAMPING: f64 = 1e-8;
/// The conjugate gradients end when the error, measured by the preconditioner, is that part of the first: Gauss–Newton
/// itself is no more exact, and a round costs half as much as the factorization.
const ENOUGH: f64 = 1e-2;
/// Rounds from which on the factor is renewed in the next step: a factorization costs as much as some six rounds, and a
/// new factor needs four to seven.
const OUT_OF_DATE: usize = 9;
/// Or after so many rounds; the step so far lowers E none the less.
const MOST_ROUNDS: usize = 40;

type Stretch = [[f64; STRETCHES]; STRETCHES];

/// The fixed structure of the system, and the memory for it.
pub(super) struct Direction {
    system: System,
    pattern: Arc<Pattern>,
    slots: Vec<u32>,
    values: Vec<f64>,
    frames: Vec<Frame>,
    jacobians: Vec<[Local; 6]>,
    /// What resists the turning of every node alone.
    turnings: Vec<[[f64; TURNS]; TURNS]>,
    /// Cholesky factors of the stretching of every node.
    stretches: Vec<Stretch>,
    rows: Vec<Quad>,
    /// Residual, preconditioned residual, search direction, its product.
    vectors: [Vec<Affine>; 4],
    /// Whether the system is to be factored anew.
    is_due: bool,
    /// Rounds of the last step.
    pub(super) rounds: usize,
}

impl Direction {
    pub(super) fn new(terms: &Terms) -> Result<Direction, FactorError> {
        let n = terms.nodes.len();
        let (ordered, slots) = Ordered::of_blocks(&terms.nodes, &terms.links, ROWS as u32);
        let pattern = Arc::new(ordered.analyzed());
        let rest = Frame::of(&super::affine::IDENTITY, DQuat::IDENTITY);
        Ok(Direction {
            system: System::new(pattern.clone())?,
            values: vec![0.0; pattern.n_values()],
            pattern,
            slots,
            frames: vec![rest; n],
            jacobians: vec![[[0.0; 9]; 6]; n],
            turnings: vec![[[0.0; TURNS]; TURNS]; n],
            stretches: vec![[[0.0; STRETCHES]; STRETCHES]; n],
            rows: vec![Quad::ZERO; n * ROWS],
            vectors: std::array::from_fn(|_| vec![ZERO; n]),
            is_due: true,
            rounds: 0,
        })
    }

    /// The rotation of every node as last seen.
    pub(super) fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// Where to go from `x`, written into `step`, given half the gradient there. False if the matrix could not be factored.
    pub(super) fn find(
        &mut self,
        (terms, quadratic): (&Terms, &Quadratic),
        (x, gradient): (&[Affine], &[Affine]),
        step: &mut [Affine],
    ) -> bool {
        self.look(quadratic, x);
        if self.is_due {
            self.assemble(terms, quadratic);
            if self.system.factor(&self.values).is_err() {
                return false;
            }
        }
        let found = self.solve(terms, quadratic, gradient, step);
        self.is_due = self.rounds >= OUT_OF_DATE;
        found
    }

    /// The quadratic part is another: the factor is of no use any more.
    pub(super) fn forget(&mut self) {
        self.is_due = true;
    }

    /// Looks at every node from its rotation.
    fn look(&mut self, quadratic: &Quadratic, x: &[Affine]) {
        for (j, (x, block)) in x.iter().zip(&quadratic.diagonal).enumerate() {
            let frame = Frame::of(x, self.frames[j].turn);
            let (jacobian, own) = frame.own(block);
            let mut stretch: Stretch = std::array::from_fn(|a| std::array::from_fn(|b| own[TURNS + a][TURNS + b]));
            (0..STRETCHES).for_each(|a| stretch[a][a] *= 1.0 + DAMPING);
            self.stretches[j] = cholesky(stretch);
            self.turnings[j] = std::array::from_fn(|a| std::array::from_fn(|b| own[a][b]));
            (self.frames[j], self.jacobians[j]) = (frame, jacobian);
        }
    }

    /// The system of turns and t.
    fn assemble(&mut self, terms: &Terms, quadratic: &Quadratic) {
        let n = self.frames.len();
        for (j, block) in quadratic.diagonal.iter().enumerate() {
            let mut rows = between(block, &self.frames[j], &self.frames[j]);
            for (row, turning) in rows.iter_mut().zip(&self.turnings[j]) {
                row[..TURNS].copy_from_slice(turning);
            }
            let mut slots = self.slots[j * ROWS * (ROWS - 1) / 2..].iter();
            for (a, row) in rows.iter().enumerate() {
                self.values[self.pattern.diagonal(j * ROWS + a)] = row[a] * (1.0 + DAMPING);
                row[a + 1..].iter().zip(&mut slots).for_each(|(value, &slot)| self.values[slot as usize] = *value);
            }
        }
        let slots = self.slots[n * ROWS * (ROWS - 1) / 2..].chunks_exact(ROWS * ROWS);
        for ((&[j, k], block), slots) in terms.links.iter().zip(&quadratic.links).zip(slots) {
            let rows = between(block, &self.frames[j as usize], &self.frames[k as usize]);
            slots.iter().zip(rows.as_flattened()).for_each(|(&slot, &value)| self.values[slot as usize] = value);
        }
    }

    /// Preconditioned conjugate gradients.
    fn solve(&mut self, terms: &Terms, quadratic: &Quadratic, gradient: &[Affine], step: &mut [Affine]) -> bool {
        let [mut r, mut z, mut p, mut ap] = std::mem::take(&mut self.vectors);
        step.fill(ZERO);
        r.fill(ZERO);
        add_scaled(&mut r, -1.0, gradient);
        self.precondition(&r, &mut z);
        p.copy_from_slice(&z);
        let first = dot(&r, &z);
        let mut now = first;
        self.rounds = 0;
        while now > ENOUGH * ENOUGH * first && self.rounds < MOST_ROUNDS {
            quadratic.times(&terms.links, &p, &mut ap);
            for (((frame, jacobian), p), ap) in self.frames.iter().zip(&self.jacobians).zip(&p).zip(&mut ap) {
                frame.add_rotation(jacobian, p, ap);
            }
            let curvature = dot(&p, &ap);
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let length = now / curvature;
            add_scaled(step, length, &p);
            add_scaled(&mut r, -length, &ap);
            self.precondition(&r, &mut z);
            let next = dot(&r, &z);
            let keep = next / now;
            for (p, z) in p.as_flattened_mut().as_flattened_mut().iter_mut().zip(z.as_flattened().as_flattened()) {
                *p = z + keep * *p;
            }
            now = next;
            self.rounds += 1;
        }
        self.vectors = [r, z, p, ap];
        self.rounds > 0
    }

    /// z = M⁻¹ r.
    fn precondition(&mut self, r: &[Affine], z: &mut [Affine]) {
        let rows = self.rows.chunks_exact_mut(ROWS);
        for ((((r, z), rows), frame), stretch) in r.iter().zip(&mut *z).zip(rows).zip(&self.frames).zip(&self.stretches)
        {
            let mut local = frame.local(r);
            let pull = (frame.q.transpose() * shift(r)).to_array();
            for a in 0..TURNS {
                rows[a].0[0] = local[a];
                rows[TURNS + a].0[0] = pull[a];
            }
            local[..TURNS].fill(0.0);
            solve_cholesky(stretch, &mut local[TURNS..]);
            *z = frame.change(&local);
        }
        self.system.solve_in_place(&mut self.rows);
        for ((z, rows), frame) in z.iter_mut().zip(self.rows.chunks_exact(ROWS)).zip(&self.frames) {
            let mut local = [0.0; TURNS + STRETCHES];
            (0..TURNS).for_each(|a| local[a] = rows[a].0[0]);
            let turned = frame.change(&local);
            let moved = frame.q * DVec3::from_array(std::array::from_fn(|c| rows[TURNS + c].0[0]));
            for ((z, turned), moved) in z.iter_mut().zip(&turned).zip(moved.to_array()) {
                (0..3).for_each(|a| z[a] += turned[a]);
                z[3] = moved;
            }
        }
    }
}

/// The block of the factored system for nodes j and k, from theirs of the quadratic part: turns and t of j against turns
/// and t of k, each seen from its own node.
fn between(block: &Block, j: &Frame, k: &Frame) -> [[f64; ROWS]; ROWS] {
    let l = upper_left(block);
    // Q_kᵀ Q_j.
    let turn = k.q.transpose() * j.q;
    let back = turn.transpose();
    let right = DVec3::new(block[0][3], block[1][3], block[2][3]);
    let below = DVec3::new(block[3][0], block[3][1], block[3][2]);
    let mut rows = [[0.0; ROWS]; ROWS];
    for m in 0..TURNS {
        // tr(Q_j B_m L B_nᵀ Q_kᵀ)
        rows[m][..TURNS].copy_from_slice(&coefficients(turn * basis(m) * l)[..TURNS]);
        rows[m][TURNS..].copy_from_slice(&(turn * (basis(m) * right)).to_array());
        let pulled = (back * (basis(m) * below)).to_array();
        (0..3).for_each(|c| rows[TURNS + c][m] = pulled[c]);
        // t_jᵀ t_k in the coordinates of the box.
        (0..3).for_each(|c| rows[TURNS + m][TURNS + c] = block[3][3] * back.col(c)[m]);
    }
    rows
}

/// The lower factor of a positive matrix. A pivot that is not positive becomes infinite, and nothing moves that way.
fn cholesky(mut a: Stretch) -> Stretch {
    for j in 0..STRETCHES {
        for k in 0..j {
            let l = a[j][k];
            (j..STRETCHES).for_each(|i| a[i][j] -= l * a[i][k]);
        }
        let pivot = if a[j][j] > 0.0 { a[j][j].sqrt() } else { f64::INFINITY };
        (j + 1..STRETCHES).for_each(|i| a[i][j] /= pivot);
        a[j][j] = pivot;
    }
    a
}

fn solve_cholesky(l: &Stretch, x: &mut [f64]) {
    for i in 0..STRETCHES {
        let sum: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i][i];
    }
    for i in (0..STRETCHES).rev() {
        let sum: f64 = (i + 1..STRETCHES).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i][i];
    }
}
