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
    /// It follows the rigid motion that fits the group of held vertices nearest to it at rest: the group of the held
    /// vertex nearest to its center (the mean of its vertices). A group is a set of held vertices joined by edges.
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
    /// Places in the list, group by group.
    pub(crate) by_group: Grouped,
    /// Places in the list, component by component.
    pub(crate) by_component: Grouped,
    /// Whether a vertex is held or of a loose component, by internal number.
    pub(crate) is_fixed: Vec<bool>,
    /// Loose components as reported: number of vertices, first vertex of the caller.
    pub(crate) loose_reported: Vec<(usize, VertexId)>,
    loose: Vec<Loose>,
    policy: LooseComponents,
    /// The rigid motion of every group for the current targets; empty unless loose components follow.
    motions: Vec<RigidMotion>,
}

/// Numbers 0..n sorted into lists.
pub(crate) struct Grouped {
    /// List l: `members[offsets[l]..offsets[l + 1]]`, ascending.
    offsets: Vec<usize>,
    members: Vec<u32>,
}

impl Grouped {
    fn new(n_lists: usize, list_of: &[u32]) -> Grouped {
        let mut offsets = vec![0; n_lists + 1];
        list_of.iter().for_each(|&list| offsets[list as usize + 1] += 1);
        (0..n_lists).for_each(|list| offsets[list + 1] += offsets[list]);
        let mut members: Vec<u32> = (0..list_of.len() as u32).collect();
        members.sort_by_key(|&i| list_of[i as usize]);
        Grouped { offsets, members }
    }

    /// Number of lists.
    pub(crate) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    pub(crate) fn list(&self, list: usize) -> &[u32] {
        &self.members[self.offsets[list]..self.offsets[list + 1]]
    }

    pub(crate) fn all(&self) -> &[u32] {
        &self.members
    }
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
        let n_components = layout.component.iter().max().map_or(0, |&last| last as usize + 1);
        let component_of: Vec<u32> = internal.iter().map(|&v| layout.component[v as usize]).collect();
        let by_component = Grouped::new(n_components, &component_of);
        let loose = loose_components(layout, (&internal, &group), &by_component);
        let mut loose_reported = Vec::with_capacity(loose.len());
        for component in &loose {
            is_fixed[component.vertices.clone()].fill(true);
            let callers = &layout.to_caller[component.vertices.clone()];
            loose_reported.push((callers.len(), VertexId(callers.iter().copied().min().unwrap_or(0))));
        }
        loose_reported.sort_unstable_by_key(|component| component.1);
        let targets = internal.iter().map(|&v| positions[v as usize]).collect();
        let mut held = Held {
            vertices: vertices.to_vec(),
            internal,
            targets,
            by_group: Grouped::new(n_groups, &group),
            group,
            by_component,
            is_fixed,
            loose_reported,
            loose,
            policy,
            motions: Vec::new(),
        };
        held.fit_motions(&layout.rest);
        Ok(held)
    }

    /// One finite target per held vertex, in the caller's order.
    pub(crate) fn set_targets(&mut self, rest: &[DVec3], targets: &[DVec3]) -> Result<(), SolveError> {
        if targets.len() != self.vertices.len() {
            let (got, expected) = (targets.len(), self.vertices.len());
            return Err(SolveError::WrongLength { what: "handle targets", got, expected });
        }
        if let Some(bad) = targets.iter().position(|&t| !is_usable(t)) {
            return Err(SolveError::TargetNotFinite { vertex: self.vertices[bad].0 });
        }
        self.targets.copy_from_slice(targets);
        self.fit_motions(rest);
        Ok(())
    }

    fn fit_motions(&mut self, rest: &[DVec3]) {
        if self.policy == LooseComponents::FollowNearest && !self.loose.is_empty() {
            let motion = |group| self.motion_of(rest, DQuat::IDENTITY, self.by_group.list(group));
            self.motions = (0..self.by_group.len()).map(motion).collect();
        }
    }

    /// Puts every fixed vertex where it belongs: held ones exactly on their targets.
    pub(crate) fn place(&self, rest: &[DVec3], positions: &mut [DVec3]) {
        for (&v, &target) in self.internal.iter().zip(&self.targets) {
            positions[v as usize] = target;
        }
        for component in &self.loose {
            let range = component.vertices.clone();
            match self.motions.get(component.nearest_group as usize) {
                None => positions[range.clone()].copy_from_slice(&rest[range]),
                Some(motion) => range.for_each(|v| positions[v] = motion.apply(rest[v])),
            }
        }
    }

    /// Components without held vertices: their vertices, and the group of held vertices that is nearest.
    pub(crate) fn loose_parts(&self) -> impl Iterator<Item = (Range<usize>, usize)> + '_ {
        self.loose.iter().map(|component| (component.vertices.clone(), component.nearest_group as usize))
    }

    /// Whether loose components follow the nearest group.
    pub(crate) fn loose_follow(&self) -> bool {
        self.policy == LooseComponents::FollowNearest
    }

    /// The rigid motion that fits all held vertices best.
    pub(crate) fn motion_of_all(&self, rest: &[DVec3]) -> RigidMotion {
        self.motion_of(rest, DQuat::IDENTITY, self.by_component.all())
    }

    /// The rigid motion that fits those held vertices best that are at `places` in the list.
    pub(crate) fn motion_of(&self, rest: &[DVec3], otherwise: DQuat, places: &[u32]) -> RigidMotion {
        let pair = |&i: &u32| (rest[self.internal[i as usize] as usize], self.targets[i as usize]);
        RigidMotion::fit(places.iter().map(pair), otherwise)
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

fn loose_components(layout: &Layout, (internal, group): (&[u32], &[u32]), by_component: &Grouped) -> Vec<Loose> {
    let nearest = NearestHeld::new(layout, internal);
    let mut loose = Vec::new();
    let mut first = 0;
    for members in layout.component.chunk_by(|a, b| a == b) {
        let vertices = first..first + members.len();
        first = vertices.end;
        if !by_component.list(members[0] as usize).is_empty() {
            continue;
        }
        let points = &layout.rest[vertices.clone()];
        let center = points.iter().map(|&p| p / points.len() as f64).sum::<DVec3>();
        loose.push(Loose { vertices, nearest_group: group[nearest.to(center)] });
    }
    loose
}

/// Held vertices at rest by ascending x: those near in x are looked at first, and the others not at all.
struct NearestHeld {
    /// With the place in the list.
    points: Vec<(DVec3, usize)>,
}

impl NearestHeld {
    fn new(layout: &Layout, internal: &[u32]) -> NearestHeld {
        let mut points: Vec<_> = internal.iter().map(|&v| layout.rest[v as usize]).zip(0..).collect();
        points.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        NearestHeld { points }
    }

    /// Place in the list of the held vertex nearest to `p`, the first of equals.
    fn to(&self, p: DVec3) -> usize {
        let middle = self.points.partition_point(|(q, _)| q.x < p.x);
        let (below, above) = self.points.split_at(middle);
        let mut best = (f64::INFINITY, usize::MAX);
        let mut look = |&(q, place): &(DVec3, usize)| {
            let distance = q.distance_squared(p);
            if (distance, place) < best {
                best = (distance, place);
            }
            // Those further on are at least as far in x alone.
            (q.x - p.x).powi(2) <= best.0
        };
        // `all` ends at the first that is too far.
        let _ = above.iter().all(&mut look);
        let _ = below.iter().rev().all(&mut look);
        if best.1 == usize::MAX { 0 } else { best.1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::Random;

    #[test]
    fn the_nearest_held_vertex_is_that_of_a_search_through_all() {
        let mut random = Random::new(2);
        // Rounded to a coarse grid, so that there are ties.
        let mut point = |_| (random.vector() * 4.0).round();
        let all: Vec<DVec3> = (0..200).map(&mut point).collect();
        let mut points: Vec<_> = all.iter().copied().zip(0..).collect();
        points.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        let nearest = NearestHeld { points };
        for p in (0..100).map(&mut point) {
            let distance = |i: &usize| all[*i].distance_squared(p);
            let plain = (0..all.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            assert_eq!(Some(nearest.to(p)), plain, "nearest to {p}");
        }
    }
}
