//! The spokes of every vertex with what is constant about them, and the sums over them: all of r = 1.
//!
//! | symbol | shape | meaning |
//! |---|---|---|
//! | e, e' | 3 per spoke | p_i − p_j at rest and now, from the vertex i at the center |
//! | w | 1 per spoke | weight of the edge |
//! | T_i | 3 × 3 per vertex | Σ_j w e' eᵀ |
//! | f_i | 3 per vertex | Σ_j (w (R_i + R_j) e − 2 w e'), which is (b − A p')_i where r = 1 everywhere |

use glam::DVec3;
use pulp::bytemuck::cast_slice;

use crate::analysis::{Layout, Spoke};
use crate::kernels::nines::{Nine, NinesRef};
use crate::kernels::quad::Quad;
use crate::kernels::wide::Wide;

/// Set in the edge of a spoke whose center is the second end of the edge.
const SECOND: u32 = 1 << 31;

/// What of spokes and edges is constant, in the order in which it is read; 40 bytes per spoke and 32 per edge.
pub(crate) struct Stars {
    /// The vertex at the other end of each spoke.
    neighbors: Vec<u32>,
    /// w e and w of each spoke.
    spokes: Vec<Quad>,
    /// Each spoke's edge, with [`SECOND`] or without.
    spoke_edges: Vec<u32>,
    /// w e and w of each edge, from its first end.
    pub(crate) edges: Vec<Quad>,
}

/// Positions as plain numbers, three each.
#[derive(Clone, Copy)]
pub(crate) struct Flat<'a>(&'a [f64]);

impl<'a> Flat<'a> {
    pub(crate) fn new(positions: &'a [DVec3]) -> Flat<'a> {
        Flat(cast_slice(positions))
    }

    /// A position, and a fourth number that means nothing but is finite where positions are: three numbers are loaded in
    /// several steps, four in one.
    #[inline(always)]
    pub(crate) fn get<W: Wide>(self, wide: W, i: usize) -> W::Four {
        // A register from either branch: joined number by number, the four would be loaded one by one.
        match self.0.get(3 * i..3 * i + 4).and_then(|numbers| numbers.first_chunk()) {
            Some(&numbers) => wide.four(numbers),
            None => wide.four([self.0[3 * i], self.0[3 * i + 1], self.0[3 * i + 2], 0.0]),
        }
    }

    #[inline(always)]
    pub(crate) fn vector(self, i: usize) -> DVec3 {
        DVec3::from_slice(&self.0[3 * i..3 * i + 3])
    }
}

impl Stars {
    /// `ends`, e and w of the edges, and the spokes by vertex.
    pub(crate) fn new((ends, rest, weight): (&[[u32; 2]], &[DVec3], &[f64]), spokes: &[Spoke]) -> Stars {
        let constant = |(&e, &w): (&DVec3, &f64)| Quad([e.x * w, e.y * w, e.z * w, w]);
        let edges: Vec<Quad> = rest.iter().zip(weight).map(constant).collect();
        // The first end of an edge is the smaller one.
        let is_first = |spoke: &Spoke| ends[spoke.edge as usize][1] == spoke.vertex;
        let outward = |spoke: &Spoke| {
            let Quad([x, y, z, w]) = edges[spoke.edge as usize];
            if is_first(spoke) { Quad([x, y, z, w]) } else { Quad([-x, -y, -z, w]) }
        };
        Stars {
            neighbors: spokes.iter().map(|spoke| spoke.vertex).collect(),
            spokes: spokes.iter().map(outward).collect(),
            spoke_edges: spokes.iter().map(|s| if is_first(s) { s.edge } else { s.edge | SECOND }).collect(),
            edges,
        }
    }

    #[inline(always)]
    fn range(layout: &Layout, i: usize) -> std::ops::Range<usize> {
        layout.offsets[i] as usize..layout.offsets[i + 1] as usize
    }

    /// T_i, its ninth number as the third of four; adds w ‖e'‖² of its spokes to `squares`, coordinate by coordinate.
    #[inline(always)]
    pub(crate) fn moment<W: Wide>(
        &self,
        wide: W,
        (layout, now): (&Layout, Flat<'_>),
        i: usize,
        squares: &mut W::Four,
    ) -> (W::Eight, W::Four) {
        let center = now.get(wide, i);
        let range = Stars::range(layout, i);
        let (mut eight, mut ninth) = (wide.eight([0.0; 8]), wide.splat4(0.0));
        for (&j, &Quad(rest)) in self.neighbors[range.clone()].iter().zip(&self.spokes[range]) {
            let edge = wide.sub4(center, now.get(wide, j as usize));
            let (weight, rest) = (wide.splat4(rest[3]), wide.four(rest));
            eight = wide.fma8(wide.rows(edge), wide.columns(rest), eight);
            ninth = wide.fma4(edge, rest, ninth);
            *squares = wide.fma4(wide.mul4(edge, edge), weight, *squares);
        }
        (eight, ninth)
    }

    /// f_i.
    #[inline(always)]
    pub(crate) fn pull<W: Wide>(
        &self,
        wide: W,
        (layout, now): (&Layout, Flat<'_>),
        rotations: NinesRef<'_>,
        i: usize,
    ) -> W::Four {
        let rotations = rotations.of_one_length();
        let center = now.get(wide, i);
        let range = Stars::range(layout, i);
        let (mut eight, mut ninth) = (wide.eight([0.0; 8]), 0.0);
        let (mut rests, mut drift) = (wide.splat4(0.0), wide.splat4(0.0));
        for (&j, &Quad(rest)) in self.neighbors[range.clone()].iter().zip(&self.spokes[range]) {
            let Nine { eight: r, ninth: r9 } = rotations.get(j as usize);
            let edge = wide.sub4(center, now.get(wide, j as usize));
            ninth += r9 * rest[2];
            let (weight, rest) = (wide.splat4(rest[3]), wide.four(rest));
            eight = wide.fma8(wide.eight(r.0), wide.columns(rest), eight);
            rests = wide.add4(rests, rest);
            drift = wide.fma4(edge, weight, drift);
        }
        let Nine { eight: r, ninth: r9 } = rotations.get(i);
        eight = wide.fma8(wide.eight(r.0), wide.columns(rests), eight);
        let last = wide.fma4(wide.splat4(r9), rests, wide.splat4(ninth));
        wide.sub4(wide.folded(eight, last), wide.add4(drift, drift))
    }

    /// The sum of what is given for the edges of a vertex, taken from the center outward.
    #[inline(always)]
    pub(crate) fn gathered<W: Wide>(&self, wide: W, layout: &Layout, of_edges: &[Quad], i: usize) -> W::Four {
        let mut sum = wide.splat4(0.0);
        for &edge in &self.spoke_edges[Stars::range(layout, i)] {
            let sign = f64::from_bits(u64::from(edge & SECOND) << 32);
            let here = wide.four(of_edges[(edge & !SECOND) as usize].0);
            sum = wide.add4(sum, wide.xor4(here, wide.splat4(sign)));
        }
        sum
    }
}
