//! The transpose of the neighborhoods in the form in which Q_e = Σ_k M_ke R_k is summed.
//!
//! Along a block of edges, Q changes by the rotations whose runs begin (plus) or end (minus) at an edge. Lists of
//! different lengths cost more in mispredicted branches than in sums. So they are cut into steps of two plus and two
//! minus, filled up with a matrix of zeros, and a block is one plain loop over steps.

use crate::analysis::Layout;
use crate::nines::{Eight, NinesRef};
use crate::transpose::Transpose;
use crate::wide::Wide;

/// Q grows by R of `plus` less R of `minus`; it is that of `edge` (counted from the first of the block) if no other step
/// of this edge follows.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    plus: [u32; 2],
    minus: [u32; 2],
    edge: u32,
}

/// The steps of every block.
#[derive(Default)]
pub(crate) struct Gathers {
    blocks: Vec<Vec<Step>>,
}

impl Gathers {
    /// O(number of runs and edges); in parallel.
    pub(crate) fn new(layout: &Layout, transpose: &Transpose) -> Gathers {
        use rayon::prelude::*;
        let blocks = (0..layout.n_blocks()).into_par_iter().map(|block| steps_of(layout, transpose, block));
        Gathers { blocks: blocks.collect() }
    }

    /// Q of the edges of a block. `rotations` must end with a matrix of zeros.
    #[inline(always)]
    pub(crate) fn sum<W: Wide>(
        &self,
        wide: W,
        block: usize,
        rotations: NinesRef<'_>,
        (eights, ninths): (&mut [Eight], &mut [f64]),
    ) {
        let (mut running, mut ninth) = (wide.eight([0.0; 8]), 0.0);
        for step in &self.blocks[block] {
            let (a, b) = (rotations.get(step.plus[0] as usize), rotations.get(step.plus[1] as usize));
            let (c, d) = (rotations.get(step.minus[0] as usize), rotations.get(step.minus[1] as usize));
            let one = wide.sub8(wide.eight(a.eight.0), wide.eight(c.eight.0));
            let other = wide.sub8(wide.eight(b.eight.0), wide.eight(d.eight.0));
            running = wide.add8(running, wide.add8(one, other));
            ninth += (a.ninth - c.ninth) + (b.ninth - d.ninth);
            (eights[step.edge as usize], ninths[step.edge as usize]) = (Eight(wide.array8(running)), ninth);
        }
    }
}

fn steps_of(layout: &Layout, transpose: &Transpose, block: usize) -> Vec<Step> {
    let zero = layout.n_vertices() as u32;
    let first = layout.blocks[block] as usize;
    let mut steps = Vec::new();
    let (mut plus, mut minus) = (Vec::new(), Vec::new());
    for e in first..layout.blocks[block + 1] as usize {
        transpose.at(e + block, |k, is_plus| if is_plus { plus.push(k as u32) } else { minus.push(k as u32) });
        let n_steps = plus.len().max(minus.len()).div_ceil(2).max(1);
        plus.resize(2 * n_steps, zero);
        minus.resize(2 * n_steps, zero);
        let pairs = plus.chunks_exact(2).zip(minus.chunks_exact(2));
        let edge = (e - first) as u32;
        steps.extend(pairs.map(|(plus, minus)| Step { plus: [plus[0], plus[1]], minus: [minus[0], minus[1]], edge }));
        plus.clear();
        minus.clear();
    }
    steps.shrink_to_fit();
    steps
}
