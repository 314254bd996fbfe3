//! E = E_rot + 10 E_reg + 100 E_con in unit-box coordinates (or with other weights), and half its gradient.
//!
//! | symbol | meaning |
//! |---|---|
//! | g_j, R_j, t_j | place of node j at rest, and what it does: p ↦ R_j (p − g_j) + g_j + t_j |
//! | c_1, c_2, c_3 | columns of R_j |
//! | E_rot | Σ_j (c_1·c_2)² + (c_1·c_3)² + (c_2·c_3)² + Σ_a (c_a·c_a − 1)² |
//! | E_reg | Σ over linked (j, k), both ways around, ‖R_j (g_k − g_j) + g_j + t_j − g_k − t_k‖² |
//! | E_con | Σ over held vertices ‖Σ_j w_j [R_j (v − g_j) + g_j + t_j] − target‖² |

use glam::{DMat3, DVec3};

use super::affine::{Affine, add_outer, linear, times};

/// Weight of E_rot: only ratios count.
pub(super) const ROTATION: f64 = 1.0;

/// Weights of the other energies beside that of E_rot (rotations), 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EnergyWeights {
    /// Of E_reg: how much linked nodes should agree.
    pub regularity: f64,
    /// Of E_con: how strongly handles pull.
    pub constraint: f64,
}

impl Default for EnergyWeights {
    /// Those of the paper by Sumner, Schmid and Pauly.
    fn default() -> EnergyWeights {
        EnergyWeights { regularity: 10.0, constraint: 100.0 }
    }
}

/// The terms of E for the nodes that some held vertex has a hold on. All lengths are those of the unit box.
pub(super) struct Terms {
    /// g of every node.
    pub(super) nodes: Vec<DVec3>,
    /// Pairs (lower, upper).
    pub(super) links: Vec<[u32; 2]>,
    pub(super) held: HeldTerms,
    pub(super) weights: EnergyWeights,
}

/// The held vertices, `k` entries each.
#[derive(Default)]
pub(super) struct HeldTerms {
    pub(super) k: usize,
    /// Node and w (v − g, 1).
    pub(super) entries: Vec<(u32, [f64; 4])>,
    /// Σ w g of each.
    pub(super) constants: Vec<DVec3>,
    pub(super) targets: Vec<DVec3>,
}

impl HeldTerms {
    /// Of each held vertex: its entries, and the constant less the target.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&[(u32, [f64; 4])], DVec3)> {
        let constants = self.constants.iter().zip(&self.targets).map(|(&constant, &target)| constant - target);
        self.entries.chunks_exact(self.k.max(1)).zip(constants)
    }
}

/// Pairs of columns whose products are asked for, 0 or 1.
pub(super) const PRODUCTS: [(usize, usize); 6] = [(0, 1), (0, 2), (1, 2), (0, 0), (1, 1), (2, 2)];

/// What should be zero of a rotation: c_a·c_b, less 1 for a = b.
pub(super) fn unlike_rotation(r: DMat3) -> [f64; 6] {
    PRODUCTS.map(|(a, b)| r.col(a).dot(r.col(b)) - if a == b { 1.0 } else { 0.0 })
}

impl Terms {
    /// E.
    pub(super) fn energy(&self, x: &[Affine]) -> f64 {
        let rotation: f64 = x.iter().map(|x| unlike_rotation(linear(x)).iter().map(|f| f * f).sum::<f64>()).sum();
        let mut regularity = 0.0;
        for &[j, k] in &self.links {
            let d = self.nodes[k as usize] - self.nodes[j as usize];
            regularity += unlike_neighbor(&x[j as usize], &x[k as usize], d).length_squared();
            regularity += unlike_neighbor(&x[k as usize], &x[j as usize], -d).length_squared();
        }
        ROTATION * rotation + self.weights.regularity * regularity + self.weights.constraint * self.constraint(x)
    }

    /// E_con.
    fn constraint(&self, x: &[Affine]) -> f64 {
        self.held.iter().map(|(entries, constant)| off_target(x, entries, constant).length_squared()).sum()
    }

    /// The largest distance of a held vertex from its target.
    pub(super) fn largest_error(&self, x: &[Affine]) -> f64 {
        self.held.iter().map(|(entries, constant)| off_target(x, entries, constant).length()).fold(0.0, f64::max)
    }

    /// What rounding can make of E where it should be zero: every residual is a difference of numbers of the size of the
    /// box, after some ten operations.
    pub(super) fn floor(&self) -> f64 {
        let n = 6.0 * ROTATION * self.nodes.len() as f64
            + 2.0 * self.weights.regularity * self.links.len() as f64
            + self.weights.constraint * self.held.targets.len() as f64;
        let reach = self.held.targets.iter().fold(1.0, |most: f64, p| most.max(p.abs().max_element()));
        n * (16.0 * f64::EPSILON * reach).powi(2)
    }

    /// Half the gradient of E.
    pub(super) fn gradient(&self, x: &[Affine], out: &mut [Affine]) {
        for (out, x) in out.iter_mut().zip(x) {
            *out = rotation_gradient(linear(x));
        }
        for &[j, k] in &self.links {
            let d = self.nodes[k as usize] - self.nodes[j as usize];
            for (j, k, d) in [(j as usize, k as usize, d), (k as usize, j as usize, -d)] {
                let r = unlike_neighbor(&x[j], &x[k], d) * self.weights.regularity;
                add_outer(&mut out[j], r, &[d.x, d.y, d.z, 1.0]);
                add_outer(&mut out[k], r, &[0.0, 0.0, 0.0, -1.0]);
            }
        }
        for (entries, constant) in self.held.iter() {
            let r = off_target(x, entries, constant) * self.weights.constraint;
            entries.iter().for_each(|(j, c)| add_outer(&mut out[*j as usize], r, c));
        }
    }
}

/// R_j d + t_j − d − t_k for a neighbor k at d from j.
fn unlike_neighbor(j: &Affine, k: &Affine, d: DVec3) -> DVec3 {
    times(j, &[d.x, d.y, d.z, 1.0]) - d - super::affine::shift(k)
}

fn off_target(x: &[Affine], entries: &[(u32, [f64; 4])], constant: DVec3) -> DVec3 {
    entries.iter().fold(constant, |sum, (j, c)| sum + times(&x[*j as usize], c))
}

/// Half the gradient of E_rot of one node.
fn rotation_gradient(r: DMat3) -> Affine {
    let mut columns = [DVec3::ZERO; 3];
    for ((a, b), f) in PRODUCTS.into_iter().zip(unlike_rotation(r)) {
        columns[a] += r.col(b) * (ROTATION * f);
        columns[b] += r.col(a) * (ROTATION * f);
    }
    super::affine::affine(DMat3::from_cols(columns[0], columns[1], columns[2]), DVec3::ZERO)
}
