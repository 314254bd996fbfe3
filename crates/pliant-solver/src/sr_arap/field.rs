//! The rotations of all vertices, and what they feel.

use glam::{DMat3, DQuat, DVec3};

use super::colors::Colors;
use crate::analysis::Layout;
use crate::kernels::parallel::{CHUNK, chunks, chunks_with};
use crate::kernels::quad::Quad;
use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::sums::outer;

/// R of a vertex, as quaternion and as matrix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) q: DQuat,
    pub(super) r: DMat3,
}

impl Turn {
    pub(super) fn new(q: DQuat) -> Turn {
        Turn { q, r: DMat3::from_quat(q) }
    }
}

/// What of the energy is constant.
pub(super) struct Constants {
    pub(super) colors: Colors,
    /// α A v_i: half of what couples R_i with each neighbor, from its side.
    pub(super) share: Vec<f64>,
}

/// The constants with the positions p' of a moment.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    pub(super) layout: &'a Layout,
    pub(super) constants: &'a Constants,
    pub(super) positions: &'a [DVec3],
}

impl Field<'_> {
    /// Σ_j w e' eᵀ + α A Σ_j (v_i + v_j) R_j, given R_j by place.
    #[inline]
    fn wanted(&self, i: usize, turn: impl Fn(usize) -> DMat3) -> DMat3 {
        let Field { layout, constants, positions } = *self;
        let mut t = DMat3::ZERO;
        for spoke in layout.spokes(i) {
            let (j, e) = (spoke.vertex as usize, spoke.edge as usize);
            let rest = layout.rest[i] - layout.rest[j];
            t += outer((positions[i] - positions[j]) * layout.weight[e], rest);
            t += turn(constants.colors.place_of[j] as usize) * (constants.share[i] + constants.share[j]);
        }
        t
    }

    /// One sweep: every vertex takes the rotation that is best with those of its neighbors, color after color.
    pub(super) fn sweep(&self, turns: &mut [Turn]) {
        let colors = &self.constants.colors;
        for bounds in colors.begin.windows(2) {
            let (first, end) = (bounds[0], bounds[1]);
            let (before, rest) = turns.split_at_mut(first);
            let (mine, after) = rest.split_at_mut(end - first);
            let (before, after) = (&*before, &*after);
            // Neighbors are of other colors.
            let turn = |place: usize| if place < first { before[place].r } else { after[place - end].r };
            chunks(mine, |at, mine| {
                for (turn_of, &v) in mine.iter_mut().zip(&colors.vertices[first + at..]) {
                    let t = self.wanted(v as usize, turn);
                    *turn_of = Turn::new(best_rotation(t, turn_of.q, Ties::Nearest));
                }
            });
        }
    }

    /// The torque on every vertex: minus half the derivative of E by a turn ω_i, R_i ← exp(ω_i) R_i.
    pub(super) fn torques(&self, turns: &[Turn], out: &mut [Quad]) {
        chunks(out, |first, out| {
            for (i, out) in (first..).zip(out) {
                let mine = turns[self.constants.colors.place_of[i] as usize].r;
                let s = self.wanted(i, |place| turns[place].r) * mine.transpose();
                *out = DVec3::new(s.y_axis.z - s.z_axis.y, s.z_axis.x - s.x_axis.z, s.x_axis.y - s.y_axis.x).into();
            }
        });
    }

    /// Minus half the derivative of E by every position; 0 at fixed vertices.
    pub(super) fn pulls(&self, turns: &[Turn], is_fixed: &[bool], out: &mut [Quad]) {
        let Field { layout, constants, positions } = *self;
        let turn = |v: usize| turns[constants.colors.place_of[v] as usize].r;
        chunks(out, |first, out| {
            for (i, out) in (first..).zip(out) {
                let (mine, mut pull) = (turn(i), DVec3::ZERO);
                for spoke in layout.spokes(i).iter().filter(|_| !is_fixed[i]) {
                    let (j, w) = (spoke.vertex as usize, layout.weight[spoke.edge as usize]);
                    let (rest, now) = (layout.rest[i] - layout.rest[j], positions[i] - positions[j]);
                    pull += ((mine + turn(j)) * rest - 2.0 * now) * w;
                }
                *out = pull.into();
            }
        });
    }

    /// E; `parts` is room for the sum of every chunk.
    pub(super) fn energy(&self, turns: &[Turn], parts: &mut [f64]) -> f64 {
        let n = self.layout.n_vertices();
        chunks_with(n, &mut vec![(); n][..], parts, |first, items| {
            (first..first + items.len()).map(|i| self.energy_of(i, turns)).sum()
        });
        parts[..n.div_ceil(CHUNK)].iter().sum()
    }

    /// The summand of vertex i in E.
    #[inline]
    pub(super) fn energy_of(&self, i: usize, turns: &[Turn]) -> f64 {
        let Field { layout, constants, positions } = *self;
        let turn = |v: usize| turns[constants.colors.place_of[v] as usize].r;
        let mine = turn(i);
        let mut sum = 0.0;
        for spoke in layout.spokes(i) {
            let (j, w) = (spoke.vertex as usize, layout.weight[spoke.edge as usize]);
            let (rest, now) = (layout.rest[i] - layout.rest[j], positions[i] - positions[j]);
            let unlike = mine - turn(j);
            let squares =
                unlike.x_axis.length_squared() + unlike.y_axis.length_squared() + unlike.z_axis.length_squared();
            sum += w * (now - mine * rest).length_squared() + constants.share[i] * squares;
        }
        sum
    }
}
