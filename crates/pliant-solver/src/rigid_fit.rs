//! The rigid motion that carries one set of points nearest to another (Procrustes).

use glam::{DMat3, DQuat, DVec3};

use crate::kernels::rotations::{Ties, best_rotation};
use crate::kernels::sums::outer;

/// x ↦ to + R (x − from).
#[derive(Clone, Copy, Debug)]
pub(crate) struct RigidMotion {
    pub(crate) rotation: DQuat,
    from: DVec3,
    to: DVec3,
}

impl RigidMotion {
    /// The motion with the least sum of squared distances. Where the points leave the rotation open (fewer than three,
    /// or on a line), it is the one nearest to `otherwise`.
    pub(crate) fn fit(pairs: impl Iterator<Item = (DVec3, DVec3)> + Clone, otherwise: DQuat) -> RigidMotion {
        let (mut n, mut from, mut to) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for (rest, now) in pairs.clone() {
            n += 1.0;
            from += (rest - from) / n;
            to += (now - to) / n;
        }
        let t = pairs.fold(DMat3::ZERO, |t, (rest, now)| t + outer(now - to, rest - from));
        RigidMotion { rotation: best_rotation(t, otherwise, Ties::Nearest), from, to }
    }

    /// The image of a point.
    pub(crate) fn apply(&self, p: DVec3) -> DVec3 {
        self.to + self.rotation * (p - self.from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rigid_motion_is_found_again_and_one_point_is_only_moved() {
        let rotation = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.5);
        let points: Vec<DVec3> = (0..5).map(|i| DVec3::new(i as f64, (i * i) as f64, (i % 2) as f64)).collect();
        let moved: Vec<DVec3> = points.iter().map(|&p| rotation * p + DVec3::new(7.0, -3.0, 2.0)).collect();
        let fit = RigidMotion::fit(points.iter().copied().zip(moved.iter().copied()), DQuat::IDENTITY);
        for (i, (&p, &q)) in points.iter().zip(&moved).enumerate() {
            assert!(fit.apply(p).distance(q) < 1e-12, "point {i}: {} instead of {q}", fit.apply(p));
        }
        let single = RigidMotion::fit([(points[1], moved[1])].into_iter(), rotation);
        assert_eq!(single.rotation, rotation);
        assert_eq!(single.apply(points[1]), moved[1]);
    }
}
