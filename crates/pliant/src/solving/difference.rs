//! What a newer wish wants otherwise than the one before: found once, and all that is done follows from it.

use glam::DVec3;
use pliant_solver::VertexId;

use super::SolveRequest;
use crate::document::held_by;

/// Targets that jump farther than this fraction of the bounding box's diagonal are a new start, not a drag (by eye:
/// a fast mouse moves a tenth of the window in a frame).
const JUMP_FRACTION: f64 = 0.25;

/// What differs, for wishes about the same mesh and weights that the same preparation serves.
pub(super) struct Difference {
    /// The document's pose jumped.
    pub(super) jumped: bool,
    pub(super) sizes: bool,
    pub(super) held: bool,
    pub(super) targets: bool,
    /// Targets of the same held vertices went so far that the pose is no good beginning.
    pub(super) leaps: bool,
    /// The newer held vertices and their targets.
    pub(super) to: (Vec<VertexId>, Vec<DVec3>),
}

impl Difference {
    pub(super) fn between(
        (old, held, targets): (&SolveRequest, &[VertexId], &[DVec3]),
        new: &SolveRequest,
    ) -> Difference {
        let to = held_by(&new.groups);
        let same_held = to.0 == held;
        Difference {
            jumped: new.epoch != old.epoch,
            sizes: new.method.kind.is_of_rings() && new.rigidity != old.rigidity,
            held: !same_held,
            targets: !same_held || to.1 != targets,
            leaps: same_held && is_leap(new, targets, &to.1),
            to,
        }
    }

    /// Whether it is for more than other targets near the old ones.
    pub(super) fn is_another_system(&self) -> bool {
        self.jumped || self.sizes || self.held || self.leaps
    }

    pub(super) fn is_nothing(&self) -> bool {
        !self.targets && !self.is_another_system()
    }
}

/// Whether targets are so far from where held vertices are that the pose is no good beginning.
pub(super) fn is_leap(wish: &SolveRequest, from: &[DVec3], to: &[DVec3]) -> bool {
    let farthest = from.iter().zip(to).map(|(a, b)| a.distance_squared(*b)).fold(0.0, f64::max).sqrt();
    farthest > JUMP_FRACTION * f64::from(wish.model.diagonal())
}

/// Whether the pose of a wish is that at rest.
pub(super) fn is_rest(wish: &SolveRequest) -> bool {
    *wish.pose.positions == *wish.model.mesh.positions()
}

/// Whether every held vertex is held at rest. The first target that moved ends the search.
pub(super) fn holds_at_rest(wish: &SolveRequest) -> bool {
    let rest = wish.model.mesh.positions();
    wish.groups.iter().all(|group| group.vertices.iter().zip(group.targets()).all(|(v, p)| p == rest[v.index()]))
}
