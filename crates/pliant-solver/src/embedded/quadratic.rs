//! The part of the Gauss–Newton matrix that does not change: E_reg and E_con are quadratic and treat the three coordinates
//! alike, so theirs is three times the same matrix of 4 × 4 blocks, on (R_c1, R_c2, R_c3, t_c) of the nodes.

use super::affine::Affine;
use super::energy::{EnergyWeights, HeldTerms, Terms};

pub(super) type Block = [[f64; 4]; 4];

/// Blocks on the diagonal, and for every link (lower, upper) the block with the lower one's rows.
#[derive(Default)]
pub(super) struct Quadratic {
    pub(super) diagonal: Vec<Block>,
    pub(super) links: Vec<Block>,
    /// Links by ends: those of node j with upper ones are `begin[j]..begin[j + 1]`, since links ascend.
    begin: Vec<usize>,
}

impl Quadratic {
    pub(super) fn new(terms: &Terms) -> Quadratic {
        let n = terms.nodes.len();
        let begin = (0..=n as u32).map(|j| terms.links.partition_point(|link| link[0] < j)).collect();
        let zero = [[0.0; 4]; 4];
        let mut new = Quadratic { diagonal: vec![zero; n], links: vec![zero; terms.links.len()], begin };
        new.assemble(terms);
        new
    }

    /// For other places of nodes or other held vertices, with the same links.
    pub(super) fn assemble(&mut self, terms: &Terms) {
        self.diagonal.fill([[0.0; 4]; 4]);
        self.links.fill([[0.0; 4]; 4]);
        let EnergyWeights { regularity, .. } = terms.weights;
        for (&[j, k], block) in terms.links.iter().zip(&mut self.links) {
            let (j, k) = (j as usize, k as usize);
            let d = terms.nodes[k] - terms.nodes[j];
            // R_j d + t_j − t_k, and the other way around.
            let (mine, theirs, unit) = ([d.x, d.y, d.z, 1.0], [-d.x, -d.y, -d.z, 1.0], [0.0, 0.0, 0.0, -1.0]);
            add(&mut self.diagonal[j], regularity, &mine, &mine);
            add(&mut self.diagonal[j], regularity, &unit, &unit);
            add(&mut self.diagonal[k], regularity, &theirs, &theirs);
            add(&mut self.diagonal[k], regularity, &unit, &unit);
            add(block, regularity, &mine, &unit);
            add(block, regularity, &unit, &theirs);
        }
        self.add_held(terms, &terms.held);
    }

    fn add_held(&mut self, terms: &Terms, held: &HeldTerms) {
        let EnergyWeights { constraint, .. } = terms.weights;
        for (entries, _) in held.iter() {
            for (at, (j, a)) in entries.iter().enumerate() {
                add(&mut self.diagonal[*j as usize], constraint, a, a);
                for (k, b) in &entries[at + 1..] {
                    let ((j, a), (k, b)) = if j < k { ((*j, a), (*k, b)) } else { ((*k, b), (*j, a)) };
                    let links = self.begin[j as usize]..self.begin[j as usize + 1];
                    // Nodes that carry a vertex together are linked; others have no weight, and entries of zeros.
                    if let Ok(place) = terms.links[links.clone()].binary_search_by_key(&k, |link| link[1]) {
                        add(&mut self.links[links.start + place], constraint, a, b);
                    }
                }
            }
        }
    }

    /// y = A x for all three coordinates.
    pub(super) fn times(&self, links: &[[u32; 2]], x: &[Affine], y: &mut [Affine]) {
        for ((y, x), block) in y.iter_mut().zip(x).zip(&self.diagonal) {
            for (y, x) in y.iter_mut().zip(x) {
                *y = combine([0.0; 4], block, x);
            }
        }
        for (&[j, k], block) in links.iter().zip(&self.links) {
            let (j, k) = (j as usize, k as usize);
            for c in 0..3 {
                // The blocks of the lower one's rows, times x_k; and transposed, times x_j.
                let (below, above) = (x[k][c], x[j][c]);
                for a in 0..4 {
                    y[j][c][a] += (0..4).map(|b| block[a][b] * below[b]).sum::<f64>();
                }
                y[k][c] = combine(y[k][c], block, &above);
            }
        }
    }
}

/// y + Bᵀ x.
#[inline]
fn combine(mut y: [f64; 4], block: &Block, x: &[f64; 4]) -> [f64; 4] {
    for (row, x) in block.iter().zip(x) {
        y.iter_mut().zip(row).for_each(|(y, b)| *y += b * x);
    }
    y
}

fn add(block: &mut Block, factor: f64, a: &[f64; 4], b: &[f64; 4]) {
    for (row, a) in block.iter_mut().zip(a) {
        row.iter_mut().zip(b).for_each(|(x, b)| *x += factor * a * b);
    }
}
