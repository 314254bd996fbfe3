//! The transpose of the neighborhoods in the form in which Q_e = Σ_k M_ke R_k is summed.
//!
//! Along a block of edges, Q grows by the rotations whose runs begin at an edge, and shrinks by those whose runs end
//! there. Lists of different lengths cost more in mispredicted branches than in sums. So they are cut into steps of
//! four, filled up with zeros, and a block is one plain loop over steps. Negative rotations are at hand
//! ([`Rotations`](crate::nines::Rotations)), so all are added.

use crate::analysis::Layout;
use crate::nines::{Eight, NinesRef};
use crate::transpose::Transpose;
use crate::wide::Wide;

/// Q grows by four matrices of the list; it is that of `edge` (counted from the first of the block) if no other step of
/// this edge follows.
#[derive(Clone, Copy)]
struct Step {
    matrices: [u32; 4],
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

    /// Q of the edges of a block.
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
            let (a, b) = (rotations.get(step.matrices[0] as usize), rotations.get(step.matrices[1] as usize));
            let (c, d) = (rotations.get(step.matrices[2] as usize), rotations.get(step.matrices[3] as usize));
            let one = wide.add8(wide.eight(a.eight.0), wide.eight(b.eight.0));
            let other = wide.add8(wide.eight(c.eight.0), wide.eight(d.eight.0));
            running = wide.add8(running, wide.add8(one, other));
            ninth += (a.ninth + b.ninth) + (c.ninth + d.ninth);
            (eights[step.edge as usize], ninths[step.edge as usize]) = (Eight(wide.array8(running)), ninth);
        }
    }
}

fn steps_of(layout: &Layout, transpose: &Transpose, block: usize) -> Vec<Step> {
    let zero = 2 * layout.n_vertices() as u32;
    let first = layout.blocks[block] as usize;
    let (mut steps, mut matrices) = (Vec::new(), Vec::new());
    for e in first..layout.blocks[block + 1] as usize {
        transpose.at(e + block, |k, plus| matrices.push(2 * k as u32 + u32::from(!plus)));
        matrices.resize(matrices.len().next_multiple_of(4).max(4), zero);
        let edge = (e - first) as u32;
        steps.extend(matrices.as_chunks().0.iter().map(|&matrices| Step { matrices, edge }));
        matrices.clear();
    }
    steps.shrink_to_fit();
    steps
}
