//! Where an iteration begins, and the search for a good beginning after a jump of the handles.
//!
//! Every iteration descends into the nearest valley. After a jump, four beginnings are tried, each by one plain
//! iteration, and the lowest energy goes on:
//!
//! 1. the rotations of the current pose, unless they are the next;
//! 2. R = I, as in the paper;
//! 3. in each component the rotation of the rigid motion that fits its held vertices best: if all of them moved by one
//!    rigid motion, this is the answer, with E = 0;
//! 4. rotations blended between the groups of held vertices: each group's rotation is fitted, and its logarithm (seen
//!    from the largest group of the component) is spread harmonically, by one solve with the factored system.

use glam::{DQuat, DVec3};

use crate::Solver;
use crate::analysis::Layout;
use crate::held::Held;
use crate::kernels::quad::Quad;
use crate::linear::System;

/// Where an iteration begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Rest positions and every rotation the identity, as in the paper (3.2); the next half step is global.
    Rest,
    /// The current positions and rotations are kept (warm start): a small move of handles.
    Keep,
    /// After a jump: several candidates (kept pose, R = I, rigid motion of each component, rotations blended
    /// harmonically from the rigid motions of the handle groups) are each iterated once and the lowest energy wins.
    /// Costs up to four iterations and one more solve, one iteration less at rest; stops at once where E = 0.
    Auto,
}

impl Solver {
    /// One iteration each tells the candidates apart: on bends of a bar, a cylinder, an uneven body, a cactus and an animal
    /// at r = 1, 2 and 6, the one that was lowest after one iteration was still lowest after three.
    pub(crate) fn start_auto(&mut self) {
        let before = self.pose.clone();
        let Solver { analysis, rings, held, system, workspace, .. } = self;
        let (layout, held) = (&analysis.layout, &*held);
        let rigid = component_turns(layout, held);
        let blended = blended_turns((layout, held), &rigid, &rings.stiffness, system, &mut workspace.rhs);
        let mut best = None;
        for candidate in 0..4 {
            self.pose.clone_from(&before);
            match candidate {
                0 if before.turns.iter().all(|&turn| turn == DQuat::IDENTITY) => continue,
                0 => {}
                1 => self.pose.set_turns(|_| DQuat::IDENTITY),
                2 => self.pose.set_turns(|k| rigid[k]),
                _ => match &blended {
                    Some(turns) => self.pose.set_turns(|k| turns[k]),
                    None => continue,
                },
            }
            self.comparable = None;
            self.forget();
            self.step();
            let energy = self.energy;
            if best.as_ref().is_none_or(|(lowest, _)| energy < *lowest) {
                best = Some((energy, self.pose.clone()));
            }
            if energy == 0.0 {
                break;
            }
        }
        if let Some((energy, pose)) = best {
            (self.energy, self.comparable, self.pose) = (energy, Some(energy), pose);
        }
        self.iteration = 0;
    }
}

/// For every vertex the rotation that fits the held vertices of its component; the identity in loose components.
pub(crate) fn component_turns(layout: &Layout, held: &Held) -> Vec<DQuat> {
    let everywhere = held.motion_of_all(&layout.rest).rotation;
    let mut turns = vec![DQuat::IDENTITY; layout.n_vertices()];
    let mut first = 0;
    for members in layout.component.chunk_by(|a, b| a == b) {
        let vertices = first..first + members.len();
        first = vertices.end;
        let here = held.by_component.list(members[0] as usize);
        if !here.is_empty() {
            turns[vertices].fill(held.motion_of(&layout.rest, everywhere, here).rotation);
        }
    }
    turns
}

/// Rotations between those of the groups of held vertices; none if there is only one group. `rigid`: as from
/// [`component_turns`]. The system is that of the global step with these stiffnesses of the edges; `rhs` is room for it.
pub(crate) fn blended_turns(
    (layout, held): (&Layout, &Held),
    rigid: &[DQuat],
    stiffness: &[f64],
    system: &mut System,
    rhs: &mut [Quad],
) -> Option<Vec<DQuat>> {
    let n_groups = held.by_group.len();
    if n_groups < 2 {
        return None;
    }
    // A vertex of each group, for its component.
    let member: Vec<usize> =
        (0..n_groups).map(|group| held.internal[held.by_group.list(group)[0] as usize] as usize).collect();
    let turns: Vec<DQuat> = (0..n_groups)
        .map(|group| held.motion_of(&layout.rest, rigid[member[group]], held.by_group.list(group)).rotation)
        .collect();
    // The largest group of each component, the first of equals.
    let size = |group: usize| held.by_group.list(group).len();
    let mut largest: Vec<Option<usize>> = vec![None; held.by_component.len()];
    for group in 0..n_groups {
        let largest = &mut largest[layout.component[member[group]] as usize];
        if largest.is_none_or(|other| size(group) > size(other)) {
            *largest = Some(group);
        }
    }
    let reference = |v: usize| largest[layout.component[v] as usize].map_or(DQuat::IDENTITY, |g| turns[g]);
    let mut logarithms = vec![DVec3::ZERO; layout.n_vertices()];
    for (i, &v) in held.internal.iter().enumerate() {
        let relative = reference(v as usize).conjugate() * turns[held.group[i] as usize];
        logarithms[v as usize] = logarithm(relative);
    }
    spread((layout, &held.is_fixed), stiffness, &logarithms, rhs);
    system.solve_in_place(rhs);
    (0..layout.n_vertices()).filter(|&v| !held.is_fixed[v]).for_each(|v| logarithms[v] = rhs[v].xyz());
    Some((0..layout.n_vertices()).map(|v| reference(v) * exponential(logarithms[v])).collect())
}

/// The right-hand side with which values at fixed vertices are extended harmonically to the free ones.
fn spread((layout, is_fixed): (&Layout, &[bool]), stiffness: &[f64], values: &[DVec3], rhs: &mut [Quad]) {
    for (i, rhs) in rhs.iter_mut().enumerate() {
        let mut pull = DVec3::ZERO;
        if !is_fixed[i] {
            for spoke in layout.spokes(i).iter().filter(|spoke| is_fixed[spoke.vertex as usize]) {
                pull += values[spoke.vertex as usize] * stiffness[spoke.edge as usize];
            }
        }
        *rhs = pull.into();
    }
}

/// The rotation vector of the shorter way.
fn logarithm(q: DQuat) -> DVec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let v = DVec3::new(q.x, q.y, q.z);
    let sine = v.length();
    if sine == 0.0 { DVec3::ZERO } else { v * (2.0 * sine.atan2(q.w) / sine) }
}

/// The rotation about a vector by its length.
fn exponential(v: DVec3) -> DQuat {
    DQuat::from_scaled_axis(v)
}
