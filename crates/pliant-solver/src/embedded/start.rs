//! Where the iteration begins, and the search for a good beginning after a jump of the handles.
//!
//! As with r-ring: the current state, rest, the rigid motion of each component, and rotations blended harmonically between
//! those of the groups of held vertices are tried, each by one step, and the lowest energy goes on.

use glam::{DQuat, DVec3};

use super::Embedded;
use super::affine::{Affine, IDENTITY, rigid};
use super::quadratic::Quadratic;
use crate::Start;
use crate::rigid_fit::RigidMotion;

/// Rounds of conjugate gradients on a graph of some hundred nodes; a start need not be exact.
const MOST_ROUNDS: usize = 200;
/// And the part of the first residual at which they end.
const ENOUGH: f64 = 1e-6;

impl Embedded {
    /// Begins anew from a [`Start`]; the iteration count returns to 0. [`Start::Auto`] costs up to four steps.
    pub fn start(&mut self, start: Start) {
        match start {
            Start::Keep => {}
            Start::Rest => self.x.fill(IDENTITY),
            Start::Auto => self.start_auto(),
        }
        self.iteration = 0;
        self.refresh();
    }

    fn start_auto(&mut self) {
        let before = self.x.clone();
        let motions = self.component_motions();
        let mut best: Option<(f64, Vec<Affine>)> = None;
        for candidate in 0..4 {
            match candidate {
                0 => {}
                1 if before.iter().all(|x| *x == IDENTITY) => continue,
                1 => self.x.fill(IDENTITY),
                2 => self.follow(&motions),
                _ if !self.blend(&motions) => continue,
                _ => {}
            }
            let energy = self.step().energy;
            if best.as_ref().is_none_or(|(lowest, _)| energy < *lowest) {
                best = Some((energy, self.x.clone()));
            }
            if energy == 0.0 {
                break;
            }
        }
        if let Some((_, x)) = best {
            self.x = x;
        }
    }

    /// For every active node the motion that fits the held vertices of its component.
    fn component_motions(&self) -> Vec<RigidMotion> {
        let everywhere = self.fit(self.held.by_component.all(), DQuat::IDENTITY).rotation;
        let motions: Vec<RigidMotion> = (0..self.held.by_component.len())
            .map(|component| self.fit(self.held.by_component.list(component), everywhere))
            .collect();
        self.active.iter().map(|&node| motions[self.component_of(node)]).collect()
    }

    fn component_of(&self, node: u32) -> usize {
        self.analysis.layout.component[self.graph.nodes[node as usize] as usize] as usize
    }

    fn follow(&mut self, motions: &[RigidMotion]) {
        for (i, motion) in motions.iter().enumerate() {
            let p = self.rest_of_node(self.active[i]);
            self.x[i] = rigid(motion.rotation, (motion.apply(p) - p) / self.graph.size);
        }
    }

    /// Rotations between those of the groups. False if there is only one group.
    fn blend(&mut self, motions: &[RigidMotion]) -> bool {
        let (held, n_groups) = (&self.held, self.held.by_group.len());
        if n_groups < 2 {
            return false;
        }
        // The node with the most weight of every held vertex takes its rotation.
        let mut logarithms = vec![DVec3::ZERO; self.x.len()];
        let mut is_pinned = vec![false; self.x.len()];
        let mut reference: Vec<Option<(usize, DQuat)>> = vec![None; held.by_component.len()];
        let mut order: Vec<usize> = (0..n_groups).collect();
        order.sort_by_key(|&group| std::cmp::Reverse(held.by_group.list(group).len()));
        for group in order {
            let places = held.by_group.list(group);
            let first = held.internal[places[0] as usize] as usize;
            let component = self.analysis.layout.component[first] as usize;
            let otherwise = self.fit(held.by_component.list(component), DQuat::IDENTITY).rotation;
            let turn = self.fit(places, otherwise).rotation;
            // Seen from the largest group of the component.
            let (_, base) = *reference[component].get_or_insert((group, turn));
            for &place in places {
                let v = held.vertices[place as usize].index();
                let heaviest = self.graph.carriers_of(v).reduce(|a, b| if b.1 > a.1 { b } else { a });
                let Some(node) = heaviest.map(|(node, _)| self.place_of[node as usize] as usize) else { continue };
                if !std::mem::replace(&mut is_pinned[node], true) {
                    logarithms[node] = (base.conjugate() * turn).to_scaled_axis_short();
                }
            }
        }
        self.spread(&is_pinned, &mut logarithms);
        for (i, logarithm) in logarithms.into_iter().enumerate() {
            let base = reference[self.component_of(self.active[i])].map_or(motions[i].rotation, |(_, turn)| turn);
            self.x[i] = rigid(base * DQuat::from_scaled_axis(logarithm), DVec3::ZERO);
        }
        self.place_nodes();
        true
    }

    /// Extends values at pinned nodes harmonically over the links.
    fn spread(&self, is_pinned: &[bool], values: &mut [DVec3]) {
        let links = &self.terms.links;
        let (mut diagonal, mut rhs) = (vec![0.0; values.len()], vec![DVec3::ZERO; values.len()]);
        let mut off = vec![0.0; links.len()];
        for (link, off) in links.iter().zip(&mut off) {
            let [j, k] = link.map(|node| node as usize);
            for (here, there) in [(j, k), (k, j)] {
                diagonal[here] += 1.0;
                if is_pinned[there] {
                    rhs[here] += values[there];
                }
            }
            *off = if is_pinned[j] || is_pinned[k] { 0.0 } else { -1.0 };
        }
        for (i, _) in is_pinned.iter().enumerate().filter(|(_, is_pinned)| **is_pinned) {
            (diagonal[i], rhs[i]) = (1.0, values[i]);
        }
        values.copy_from_slice(&conjugate_gradients(&diagonal, (links, &off), rhs));
    }

    /// The best t for the R that there are: a linear system.
    fn place_nodes(&mut self) {
        let Quadratic { diagonal, links, .. } = &self.quadratic;
        let diagonal: Vec<f64> = diagonal.iter().map(|block| block[3][3]).collect();
        let off: Vec<f64> = links.iter().map(|block| block[3][3]).collect();
        self.terms.gradient(&self.x, &mut self.gradient);
        let rhs = self.gradient.iter().map(|gradient| -super::affine::shift(gradient)).collect();
        let shifts = conjugate_gradients(&diagonal, (&self.terms.links, &off), rhs);
        for (x, shift) in self.x.iter_mut().zip(shifts) {
            x.iter_mut().zip(shift.to_array()).for_each(|(row, shift)| row[3] += shift);
        }
    }
}

/// The rotation vector of the shorter way.
trait ShortWay {
    fn to_scaled_axis_short(self) -> DVec3;
}

impl ShortWay for DQuat {
    fn to_scaled_axis_short(self) -> DVec3 {
        if self.w < 0.0 { (-self).to_scaled_axis() } else { self.to_scaled_axis() }
    }
}

/// Solves a symmetric positive definite system on a graph, for three right-hand sides at once.
fn conjugate_gradients(diagonal: &[f64], (links, off): (&[[u32; 2]], &[f64]), rhs: Vec<DVec3>) -> Vec<DVec3> {
    let scaled = |r: &[DVec3]| -> Vec<DVec3> { r.iter().zip(diagonal).map(|(r, d)| *r / d.max(1e-300)).collect() };
    let dot = |a: &[DVec3], b: &[DVec3]| -> f64 { a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum() };
    let mut x = vec![DVec3::ZERO; rhs.len()];
    let mut r = rhs;
    let mut z = scaled(&r);
    let mut p = z.clone();
    let first = dot(&r, &z);
    let mut now = first;
    for _ in 0..MOST_ROUNDS {
        if now <= ENOUGH * ENOUGH * first {
            break;
        }
        let mut ap: Vec<DVec3> = p.iter().zip(diagonal).map(|(p, d)| *p * *d).collect();
        for (link, &off) in links.iter().zip(off) {
            let [j, k] = link.map(|node| node as usize);
            ap[j] += p[k] * off;
            ap[k] += p[j] * off;
        }
        let length = now / dot(&p, &ap);
        if !length.is_finite() {
            break;
        }
        x.iter_mut().zip(&p).for_each(|(x, p)| *x += *p * length);
        r.iter_mut().zip(&ap).for_each(|(r, ap)| *r -= *ap * length);
        z = scaled(&r);
        let next = dot(&r, &z);
        p.iter_mut().zip(&z).for_each(|(p, z)| *p = *z + *p * (next / now));
        now = next;
    }
    x
}
