//! The two half steps on plain arrays: the memory they work in, and their order of sums.

use glam::{DMat3, DQuat, DVec3};

use crate::analysis::Layout;
use crate::kernels::energy::{DIRECT_BELOW, Noise, component_frames, framed_terms, vertex_energies};
use crate::kernels::nines::{Eight, Nine, Nines, NinesRef};
use crate::kernels::parallel::{CHUNK, chunks, chunks_with};
use crate::kernels::quad::Quad;
use crate::kernels::rotations::Ties;
use crate::kernels::sums::{
    Computed, GatheredPull, Now, StarPull, edge_pulls, neighborhood_sum, prefix_sums, run_sum, vertex_pulls,
};
use crate::kernels::turning::{LOT, Lot};
use crate::kernels::wide::{Kernel, Wide, dispatch};
use crate::rings::Rings;

/// p' and R of every vertex, internal numbering.
pub(crate) struct Pose {
    pub(crate) positions: Vec<DVec3>,
    /// R_k as matrices, kept equal to `turns`; after the last there are zeros.
    rotations: Nines,
    /// R_k as unit quaternions.
    pub(crate) turns: Vec<DQuat>,
}

impl Clone for Pose {
    fn clone(&self) -> Pose {
        let Pose { positions, rotations, turns } = self;
        Pose { positions: positions.clone(), rotations: rotations.clone(), turns: turns.clone() }
    }

    /// Into the same memory, which a derived one would not use.
    fn clone_from(&mut self, other: &Pose) {
        self.positions.clone_from(&other.positions);
        self.rotations.clone_from(&other.rotations);
        self.turns.clone_from(&other.turns);
    }
}

impl Pose {
    pub(crate) fn at_rest(rest: &[DVec3]) -> Pose {
        let n = rest.len();
        let mut pose = Pose { positions: rest.to_vec(), rotations: Nines::default(), turns: vec![DQuat::IDENTITY; n] };
        pose.rotations.resize(n + 1);
        pose.set_turns(|_| DQuat::IDENTITY);
        pose
    }

    pub(crate) fn set_turns(&mut self, turn: impl Fn(usize) -> DQuat) {
        for k in 0..self.turns.len() {
            self.turns[k] = turn(k);
            self.rotations.set(k, DMat3::from_quat(self.turns[k]));
        }
    }

    /// R_k.
    pub(crate) fn rotation(&self, k: usize) -> DMat3 {
        self.rotations.get(k)
    }
}

/// What a local step found out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalOutcome {
    /// Eq. (1).
    pub(crate) energy: f64,
    pub(crate) noise: Noise,
}

/// Memory of the half steps, reserved once.
pub(crate) struct Workspace {
    /// f_e.
    pulls: Vec<Quad>,
    /// P; empty with r = 1 everywhere.
    prefix: Nines,
    /// Whether any vertex has r = 1.
    has_stars: bool,
    /// First slot of every block.
    slot_bounds: Vec<u32>,
    /// Right-hand side and solution of the system.
    pub(crate) rhs: Vec<Quad>,
    /// Σ d w ‖e‖² of every block of edges.
    rest_squares: Vec<f64>,
    /// Two numbers per vertex: terms of its energy.
    terms: Vec<[f64; 2]>,
    energies: Vec<f64>,
    /// One rotation per component.
    frames: Vec<DQuat>,
    /// What every chunk of vertices adds.
    parts: Vec<Part>,
    /// What every block of edges adds.
    partial: Vec<f64>,
}

impl Workspace {
    pub(crate) fn new(layout: &Layout) -> Workspace {
        let n = layout.n_vertices();
        Workspace {
            pulls: Vec::new(),
            prefix: Nines::default(),
            has_stars: true,
            slot_bounds: layout.slot_bounds(),
            rhs: vec![Quad::ZERO; n],
            rest_squares: vec![0.0; layout.n_blocks()],
            terms: Vec::new(),
            energies: vec![0.0; n],
            frames: Vec::with_capacity(layout.component.iter().max().map_or(0, |&last| last as usize + 1)),
            parts: vec![Part::default(); n.div_ceil(CHUNK)],
            partial: vec![0.0; layout.n_blocks()],
        }
    }

    /// Prepares for these rings; r = 1 everywhere needs nothing per edge. Outside of the blocks `touched`, the d_e are
    /// those of the last time.
    pub(crate) fn fit(&mut self, layout: &Layout, rings: &Rings, touched: &[usize]) {
        let has_runs = rings.neighborhoods.has_runs();
        self.prefix.resize(if has_runs { layout.n_edges() + layout.n_blocks() } else { 0 });
        self.pulls.resize(if has_runs { layout.n_edges() } else { 0 }, Quad::ZERO);
        self.has_stars = rings.neighborhoods.r.contains(&1);
        self.terms.resize(rings.moments.len(), [0.0; 2]);
        for &block in touched {
            let edges = layout.blocks[block] as usize..layout.blocks[block + 1] as usize;
            self.rest_squares[block] =
                edges.map(|e| rings.stiffness[e] * layout.edge_rest[e].length_squared()).sum::<f64>();
        }
    }

    /// b − A p' into `rhs`, which is minus half the gradient of the energy; 0 at fixed vertices.
    pub(crate) fn gradient(&mut self, layout: &Layout, rings: &Rings, is_fixed: &[bool], pose: &Pose) {
        let Workspace { pulls, prefix, rhs, has_stars, .. } = self;
        let now = Now::new(layout, &pose.positions);
        let rotations = pose.rotations.as_slices();
        if prefix.is_empty() {
            vertex_pulls(is_fixed, StarPull { now, rotations }, rhs);
        } else {
            let r = Some(&rings.neighborhoods.r[..]).filter(|_| *has_stars);
            edge_pulls((&rings.stiffness, r), now, (&rings.transpose, rotations), pulls);
            vertex_pulls(is_fixed, GatheredPull { layout, pulls }, rhs);
        }
    }

    /// The end of a plain global step: p' ← p' + A⁻¹ (b − A p'), with the solution in `rhs`. Solving for the correction,
    /// rounding of one solve is mended by the next, and distance from the origin costs nothing.
    pub(crate) fn correct(&self, is_fixed: &[bool], pose: &mut Pose) {
        let corrections = &self.rhs;
        chunks(&mut pose.positions, |first, positions| {
            for (i, p) in (first..).zip(positions).filter(|(i, _)| !is_fixed[*i]) {
                *p += corrections[i].xyz();
            }
        });
    }

    /// Given p', the R of least energy (3.2.2).
    pub(crate) fn local(&mut self, layout: &Layout, rings: &Rings, pose: &mut Pose, ties: Ties) -> LocalOutcome {
        let Workspace { prefix, slot_bounds, parts, partial, .. } = self;
        let Pose { positions, rotations, turns } = pose;
        let now = Now::new(layout, positions);
        let mut squares = 0.0;
        if !prefix.is_empty() {
            squares = prefix_sums((layout, &rings.stiffness), now, slot_bounds, prefix, partial);
        }
        let n = turns.len();
        let prefix = prefix.as_slices();
        let out = (&mut turns[..], &mut rotations.eights[..n], &mut rotations.ninths[..n]);
        chunks_with(n, out, parts, |first, (turns, eights, ninths)| {
            dispatch(Turn { rings, now, prefix, ties, first, turns, eights, ninths })
        });
        let part = parts.iter().fold(Part::default(), |sum, part| sum.and(part));
        if prefix.ninths.is_empty() {
            squares = part.squares;
        }
        let scale = squares + self.rest_squares.iter().sum::<f64>();
        let sums = if rings.has_negative { absolute_squares(rings, now) } else { scale };
        let noise = Noise::new(sums, rings.total_stiffness, part.largest);
        let mut energy = scale - 2.0 * part.gain;
        if energy.abs() < DIRECT_BELOW * scale.abs() {
            energy = self.small_energy(layout, rings, pose, noise);
        }
        LocalOutcome { energy, noise }
    }

    /// Eq. (1) where the difference of large sums says too little.
    fn small_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose, noise: Noise) -> f64 {
        if rings.moments.is_empty() {
            return self.direct_energy(layout, rings, pose);
        }
        let (energy, size) = self.framed_energy(layout, rings, pose);
        // What will count as 0 needs no digits.
        let uncertain = DIRECT_BELOW * size;
        if energy.abs() >= uncertain || uncertain <= noise.floor() {
            energy
        } else {
            self.direct_energy(layout, rings, pose)
        }
    }

    /// Eq. (1) seen from the frames of the components, and the sum of what was added up.
    fn framed_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose) -> (f64, f64) {
        let Workspace { prefix, slot_bounds, frames, terms, partial, .. } = self;
        component_frames(&layout.component, &pose.turns, frames);
        let (now, frames) = (Now::new(layout, &pose.positions), &frames[..]);
        // δ_e = Fᵀe' − e.
        let deviation = |e: usize| {
            let frame = frames[layout.component[layout.edges[e][0] as usize] as usize];
            frame.conjugate() * now.vector(e) - layout.edge_rest[e]
        };
        let strained = prefix_sums((layout, &rings.stiffness), Computed(deviation), slot_bounds, prefix, partial);
        let prefix = prefix.as_slices();
        chunks(terms, |first, terms| {
            for (k, terms) in (first..).zip(terms) {
                let u = neighborhood_sum((layout, &rings.neighborhoods), deviation, prefix, k);
                let frame = frames[layout.component[k] as usize];
                *terms = framed_terms(frame, pose.turns[k], rings.moments[k], u);
            }
        });
        let mut sums = [strained, strained.abs()];
        for chunk in terms.chunks(CHUNK) {
            sums[0] += chunk.iter().map(|[a, b]| a + b).sum::<f64>();
            sums[1] += chunk.iter().map(|[a, b]| a.abs() + b.abs()).sum::<f64>();
        }
        (sums[0], sums[1])
    }

    /// Eq. (1) summed square by square.
    pub(crate) fn direct_energy(&mut self, layout: &Layout, rings: &Rings, pose: &Pose) -> f64 {
        vertex_energies(layout, &rings.neighborhoods, pose, &mut self.energies);
        self.energies.chunks(CHUNK).map(|chunk| chunk.iter().sum::<f64>()).sum()
    }
}

/// Σ |d w| (‖e'‖² + ‖e‖²): with negative weights, the size of what was added up.
fn absolute_squares(rings: &Rings, now: Now<'_>) -> f64 {
    let squares = |e: usize| now.vector(e).length_squared() + now.layout.edge_rest[e].length_squared();
    rings.stiffness.iter().enumerate().map(|(e, s)| s.abs() * squares(e)).sum()
}

/// What the local step of some vertices adds up to.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    /// Σ ⟨R, T⟩.
    gain: f64,
    /// Σ w ‖e'‖² over the spokes of those with r = 1.
    squares: f64,
    /// Largest coordinate.
    largest: f64,
}

impl Part {
    fn and(self, other: &Part) -> Part {
        Part {
            gain: self.gain + other.gain,
            squares: self.squares + other.squares,
            largest: self.largest.max(other.largest),
        }
    }
}

/// The local step of consecutive vertices.
struct Turn<'a> {
    rings: &'a Rings,
    now: Now<'a>,
    prefix: NinesRef<'a>,
    ties: Ties,
    first: usize,
    turns: &'a mut [DQuat],
    eights: &'a mut [Eight],
    ninths: &'a mut [f64],
}

impl Kernel for Turn<'_> {
    type Output = Part;

    #[inline(always)]
    fn run<W: Wide>(self, wide: W) -> Part {
        let Turn { rings, now, prefix, ties, first, turns, eights, ninths } = self;
        let Now { layout, positions, .. } = now;
        let mut lot = Lot::new();
        let (mut gain, mut squares, mut largest) = (0.0, wide.splat4(0.0), DVec3::ZERO);
        let out = eights.chunks_mut(LOT).zip(ninths.chunks_mut(LOT));
        for ((first, turns), out) in (first..).step_by(LOT).zip(turns.chunks_mut(LOT)).zip(out) {
            for (lane, &turn) in turns.iter().enumerate() {
                let k = first + lane;
                let (eight, ninth) = if rings.neighborhoods.r[k] == 1 {
                    let (eight, last) = layout.stars.moment(wide, (layout, positions), k, &mut squares);
                    (eight, wide.array4(last)[2])
                } else {
                    run_sum(wide, &rings.neighborhoods, prefix, k)
                };
                lot.load(lane, Nine { eight: Eight(wide.array8(eight)), ninth }, turn);
                // A vertex without edges adds no rounding to the energy, however far away it is.
                if layout.offsets[k] != layout.offsets[k + 1] {
                    // In this order what is not a number is passed over.
                    largest = positions.vector(k).abs().max(largest);
                }
            }
            gain += lot.solve(wide, ties, turns, out);
        }
        let [x, y, z, _] = wide.array4(squares);
        Part { gain, squares: x + y + z, largest: largest.max_element() }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::kernels::rotations::best_rotation;
    use crate::kernels::sums::outer;
    use crate::test_support::{Random, bumpy_sheet, mixed_rigidity};
    use crate::{Analysis, Neighborhoods, Rigidity, Weights};

    #[test]
    fn gradient_rotations_and_energy_are_those_of_plain_sums_for_any_sizes() {
        let mesh = Arc::new(bumpy_sheet(23));
        let (n, m) = (mesh.n_vertices(), mesh.n_edges());
        let analysis = Analysis::new(mesh, Weights::Clamped);
        let layout = &analysis.layout;
        let mut random = Random::new(31);
        for rigidity in [Rigidity::uniform(n, 1), Rigidity::uniform(n, 2), mixed_rigidity(n, 7), mixed_rigidity(n, 40)]
        {
            let neighborhoods = Neighborhoods::new(&analysis, &rigidity).expect("one size per vertex");
            let rings = Rings::new(layout, neighborhoods);
            let mut workspace = Workspace::new(layout);
            workspace.fit(layout, &rings, &Vec::from_iter(0..layout.n_blocks()));
            let mut pose = Pose::at_rest(&layout.rest);
            pose.positions.iter_mut().for_each(|p| *p += random.vector() * 0.3);
            let turns: Vec<DQuat> = (0..n).map(|_| DQuat::from_scaled_axis(random.vector())).collect();
            pose.set_turns(|k| turns[k]);
            let is_fixed: Vec<bool> = (0..n).map(|v| v % 17 == 3).collect();

            let (mut q, mut d, mut t) = (vec![DMat3::ZERO; m], vec![0.0; m], vec![DMat3::ZERO; n]);
            let now =
                |e: usize| pose.positions[layout.edges[e][0] as usize] - pose.positions[layout.edges[e][1] as usize];
            for (k, t) in t.iter_mut().enumerate() {
                rings.neighborhoods.for_each_edge(layout, k, |e| {
                    q[e] += pose.rotation(k);
                    d[e] += 1.0;
                    *t += outer(now(e), layout.edge_rest[e]) * layout.weight[e];
                });
            }
            let (mut pulls, mut sizes) = (vec![DVec3::ZERO; n], vec![0.0; n]);
            for (e, &[i, j]) in layout.edges.iter().enumerate() {
                let (w, rest) = (layout.weight[e], layout.edge_rest[e]);
                let pull = (q[e] * rest - now(e) * d[e]) * w;
                let size = w * d[e] * (now(e).length() + rest.length());
                for (end, sign) in [(i as usize, 1.0), (j as usize, -1.0)] {
                    pulls[end] += pull * sign;
                    sizes[end] += size;
                }
            }
            workspace.gradient(layout, &rings, &is_fixed, &pose);
            for i in 0..n {
                let (got, expected) = (workspace.rhs[i].xyz(), if is_fixed[i] { DVec3::ZERO } else { pulls[i] });
                let off = got.distance(expected);
                assert!(off <= 1e-12 * sizes[i], "r to {}, vertex {i}: {got} and {expected}", rigidity.max());
            }
            let LocalOutcome { energy, .. } = workspace.local(layout, &rings, &mut pose, Ties::Nearest);
            for k in 0..n {
                let (got, expected) = (pose.turns[k], best_rotation(t[k], turns[k], Ties::Nearest));
                let off = 1.0 - got.dot(expected).abs();
                assert!(off < 1e-12, "r to {}, vertex {k}: {got} and {expected}", rigidity.max());
            }
            let direct = workspace.direct_energy(layout, &rings, &pose);
            assert!((energy - direct).abs() <= 1e-12 * direct, "r to {}: {energy} and {direct}", rigidity.max());
        }
    }
}
