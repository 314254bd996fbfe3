//! Which vertices are not free: those held by the caller, and those of components without any held vertex.

use std::ops::Range;

use glam::{DQuat, DVec3};

use crate::analysis::Layout;
use crate::mesh::is_usable;
use crate::rigid_fit::RigidMotion;
use crate::{SolveError, VertexId};

/// What happens to a component without any held vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LooseComponents {
    /// It stays where it is at rest.
    #[default]
    KeepAtRest,
    /// It follows the rigid motion that fits the group of held vertices nearest to it at rest. A group is a set of
    /// held vertices joined by edges.
    FollowNearest,
}

/// The held vertices with their targets, and all that follows from which vertices are held.
pub(crate) struct Held {
    /// In the caller's order and numbering.
    pub(crate) vertices: Vec<VertexId>,
    /// The same vertices, internal.
    pub(crate) internal: Vec<u32>,
    pub(crate) targets: Vec<DVec3>,
    /// Group of each held vertex: held vertices joined by edges.
    pub(crate) group: Vec<u32>,
    pub(crate) n_groups: usize,
    /// Whether a vertex is held or of a loose component, by internal number.
    pub(crate) is_fixed: Vec<bool>,
    /// Loose components as reported: number of vertices, first vertex of the caller.
    pub(crate) loose_reported: Vec<(usize, VertexId)>,
    loose: Vec<Loose>,
    policy: LooseComponents,
}

/// A component without held vertices: consecutive internal numbers.
struct Loose {
    vertices: Range<usize>,
    nearest_group: u32,
}

impl Held {
    /// `positions` become the targets.
    pub(crate) fn new(
        layout: &Layout,
        vertices: &[VertexId],
        positions: &[DVec3],
        policy: LooseComponents,
    ) -> Result<Held, SolveError> {
        let internal = internal_numbers(layout, vertices)?;
        let mut is_fixed = vec![false; layout.n_vertices()];
        internal.iter().for_each(|&v| is_fixed[v as usize] = true);
        let (group, n_groups) = groups(layout, &internal, &is_fixed);
        let loose = loose_components(layout, &internal, &group);
        let mut loose_reported = Vec::with_capacity(loose.len());
        for component in &loose {
            is_fixed[component.vertices.clone()].fill(true);
            let callers = &layout.to_caller[component.vertices.clone()];
            loose_reported.push((callers.len(), VertexId(callers.iter().copied().min().unwrap_or(0))));
        }
        loose_reported.sort_unstable_by_key(|component| component.1);
        let targets = internal.iter().map(|&v| positions[v as usize]).collect();
        Ok(Held {
            vertices: vertices.to_vec(),
            internal,
            targets,
            group,
            n_groups,
            is_fixed,
            loose_reported,
            loose,
            policy,
        })
    }

    /// One finite target per held vertex, in the caller's order.
    pub(crate) fn set_targets(&mut self, targets: &[DVec3]) -> Result<(), SolveError> {
        if targets.len() != self.vertices.len() {
            let (got, expected) = (targets.len(), self.vertices.len());
            return Err(SolveError::WrongLength { what: "handle targets", got, expected });
        }
        if let Some(bad) = targets.iter().position(|&t| !is_usable(t)) {
            return Err(SolveError::TargetNotFinite { vertex: self.vertices[bad].0 });
        }
        self.targets.copy_from_slice(targets);
        Ok(())
    }

    /// Puts every fixed vertex where it belongs: held ones exactly on their targets.
    pub(crate) fn place(&self, rest: &[DVec3], positions: &mut [DVec3]) {
        for (&v, &target) in self.internal.iter().zip(&self.targets) {
            positions[v as usize] = target;
        }
        for component in &self.loose {
            let range = component.vertices.clone();
            match self.policy {
                LooseComponents::KeepAtRest => positions[range.clone()].copy_from_slice(&rest[range]),
                LooseComponents::FollowNearest => {
                    let motion = self.group_motion(component.nearest_group, rest, DQuat::IDENTITY);
                    range.for_each(|v| positions[v] = motion.apply(rest[v]));
                }
            }
        }
    }

    /// The rigid motion that fits a group best.
    pub(crate) fn group_motion(&self, group: u32, rest: &[DVec3], otherwise: DQuat) -> RigidMotion {
        self.motion_of(rest, otherwise, |i| self.group[i] == group)
    }

    /// The rigid motion that fits those held vertices best that `is_in` says yes to (asked by place in the list).
    pub(crate) fn motion_of(&self, rest: &[DVec3], otherwise: DQuat, is_in: impl Fn(usize) -> bool) -> RigidMotion {
        let places = (0..self.internal.len()).filter(|&i| is_in(i));
        let places: Vec<usize> = places.collect();
        RigidMotion::fit(places.iter().map(|&i| (rest[self.internal[i] as usize], self.targets[i])), otherwise)
    }
}

fn internal_numbers(layout: &Layout, vertices: &[VertexId]) -> Result<Vec<u32>, SolveError> {
    if vertices.is_empty() {
        return Err(SolveError::NoHandles);
    }
    let n_vertices = layout.n_vertices();
    let mut seen = vec![false; n_vertices];
    let mut internal = Vec::with_capacity(vertices.len());
    for &vertex in vertices {
        let Some(seen) = seen.get_mut(vertex.index()) else {
            return Err(SolveError::HeldOutOfRange { vertex: vertex.0, n_vertices });
        };
        if std::mem::replace(seen, true) {
            return Err(SolveError::HeldTwice { vertex: vertex.0 });
        }
        internal.push(layout.to_internal[vertex.index()]);
    }
    Ok(internal)
}

/// Group of each held vertex, numbered in the order of the list, and their number.
fn groups(layout: &Layout, internal: &[u32], is_held: &[bool]) -> (Vec<u32>, usize) {
    const NONE: u32 = u32::MAX;
    let mut group_of = vec![NONE; layout.n_vertices()];
    let mut n_groups = 0;
    let mut stack = Vec::new();
    for &first in internal {
        if group_of[first as usize] != NONE {
            continue;
        }
        group_of[first as usize] = n_groups;
        stack.push(first);
        while let Some(v) = stack.pop() {
            for spoke in layout.spokes(v as usize) {
                let w = spoke.vertex as usize;
                if is_held[w] && group_of[w] == NONE {
                    group_of[w] = n_groups;
                    stack.push(spoke.vertex);
                }
            }
        }
        n_groups += 1;
    }
    (internal.iter().map(|&v| group_of[v as usize]).collect(), n_groups as usize)
}

fn loose_components(layout: &Layout, internal: &[u32], group: &[u32]) -> Vec<Loose> {
    let n_components = layout.component.iter().max().map_or(0, |&last| last as usize + 1);
    let mut has_held = vec![false; n_components];
    internal.iter().for_each(|&v| has_held[layout.component[v as usize] as usize] = true);
    let mut loose = Vec::new();
    let mut first = 0;
    for members in layout.component.chunk_by(|a, b| a == b) {
        let vertices = first..first + members.len();
        first = vertices.end;
        if has_held[members[0] as usize] {
            continue;
        }
        let points = &layout.rest[vertices.clone()];
        let center = points.iter().map(|&p| p / points.len() as f64).sum::<DVec3>();
        let distance = |i: &usize| layout.rest[internal[*i] as usize].distance_squared(center);
        let nearest = (0..internal.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        loose.push(Loose { vertices, nearest_group: nearest.map_or(0, |i| group[i]) });
    }
    loose
}
