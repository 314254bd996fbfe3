//! Bones that move rigidly and joints that bend like a tube: poses whose truth is known.
//!
//! A joint has a pivot P, a direction a from the bone that carries it to the bone it carries, and a band of half width b
//! in which it bends. With s = (x − P)·a, what lies before the band (s ≤ −b) moves with the one bone, what lies behind it
//! (s ≥ b) with the other, each exactly as a rigid body. Inside, the turn grows evenly from nothing to all of it, and the
//! middle line keeps its length:
//!
//! ```text
//! x = P + s a + q, q ⊥ a   ↦   c(s) + R(u) q,   u = (s + b) / 2b,   c' = R(u) a,   c(−b) = P − b a
//! ```
//!
//! so that slices across the middle line stay flat and undistorted, and a surface that no slice meets twice stays free
//! of crossings while the turn is below 2b / (half its thickness).

use glam::{DMat3, DVec3};

use super::handles::sine_and_cosine;

/// Where one bone hangs on another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    /// The bone that carries it. Bone 0 is carried by none, bone j + 1 by joint j.
    pub(crate) parent: usize,
    pub(crate) pivot: DVec3,
    /// Unit vector towards the bone it carries.
    pub(crate) axis: DVec3,
    /// Half the width of the band that bends.
    pub(crate) half: f64,
}

/// A rotation about a unit vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    pub(crate) axis: DVec3,
    pub(crate) degrees: f64,
}

/// What a vertex belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// It moves with a bone.
    Bone(usize),
    /// It lies inside the band of a joint.
    Joint(usize),
}

/// A rigid motion x ↦ M x + t.
#[derive(Clone, Copy, Debug)]
struct Motion {
    turn: DMat3,
    shift: DVec3,
}

impl Motion {
    fn of(&self, x: DVec3) -> DVec3 {
        self.turn * x + self.shift
    }

    /// This one after another.
    fn after(&self, first: &Motion) -> Motion {
        Motion { turn: self.turn * first.turn, shift: self.of(first.shift) }
    }
}

impl Turn {
    /// From a vector along the axis as long as the angle in degrees.
    pub(crate) fn from_vector(vector: DVec3) -> Turn {
        let degrees = vector.length();
        Turn { axis: if degrees > 0.0 { vector / degrees } else { DVec3::X }, degrees }
    }

    /// The matrix of a share of the turn (Rodrigues' formula, the same bits on every machine).
    fn share(self, share: f64) -> DMat3 {
        let (sin, cos) = sine_and_cosine(self.degrees * share);
        let Turn { axis, .. } = self;
        let column = |e: DVec3| e * cos + axis.cross(e) * sin + axis * (axis.dot(e) * (1.0 - cos));
        DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
    }

    /// ∫ R(t) dt from 0 to `share`: what a unit step along the middle line adds up to.
    fn swept(self, share: f64) -> DMat3 {
        let radians = self.degrees.to_radians();
        if radians == 0.0 {
            return DMat3::from_diagonal(DVec3::splat(share));
        }
        let (sin, cos) = sine_and_cosine(self.degrees * share);
        let Turn { axis, .. } = self;
        let (along, across) = (sin / radians, (1.0 - cos) / radians);
        let column = |e: DVec3| e * along + axis.cross(e) * across + axis * (axis.dot(e) * (share - along));
        DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
    }
}

impl Joint {
    /// Where a point at s lies relative to this joint.
    pub(crate) fn along(&self, x: DVec3) -> f64 {
        (x - self.pivot).dot(self.axis)
    }

    /// The point bent, seen from the bone that carries the joint.
    fn bend(&self, turn: Turn, x: DVec3) -> DVec3 {
        let s = self.along(x).clamp(-self.half, self.half);
        let share = (s + self.half) / (2.0 * self.half);
        let start = self.pivot - self.axis * self.half;
        let middle = start + turn.swept(share) * self.axis * (2.0 * self.half);
        middle + turn.share(share) * (x - self.pivot - self.axis * s)
    }

    /// The motion of the bone that is carried, seen from the one that carries.
    fn motion(&self, turn: Turn) -> Motion {
        let matrix = turn.share(1.0);
        let end = self.pivot + self.axis * self.half;
        Motion { turn: matrix, shift: self.bend(turn, end) - matrix * end }
    }
}

/// The points moved by turning every joint, then carried by bone 0's own turn about the origin and shift.
pub(crate) fn bent(
    points: &[DVec3],
    places: &[Place],
    joints: &[Joint],
    turns: &[Turn],
    (root, shift): (Turn, DVec3),
) -> Vec<DVec3> {
    let mut motions = vec![Motion { turn: root.share(1.0), shift }];
    for (joint, turn) in joints.iter().zip(turns) {
        motions.push(motions[joint.parent].after(&joint.motion(*turn)));
    }
    let move_one = |(&x, &place): (&DVec3, &Place)| match place {
        Place::Bone(bone) => motions[bone].of(x),
        Place::Joint(j) => motions[joints[j].parent].of(joints[j].bend(turns[j], x)),
    };
    points.iter().zip(places).map(move_one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOINT: Joint = Joint { parent: 0, pivot: DVec3::new(1.0, 2.0, 3.0), axis: DVec3::Z, half: 0.5 };

    #[test]
    fn bending_is_continuous_and_rigid_outside_the_band() {
        let turn = Turn::from_vector(DVec3::new(30.0, -50.0, 20.0));
        let motion = JOINT.motion(turn);
        let off = DVec3::new(0.3, -0.2, 0.0);
        let before = JOINT.pivot + off - DVec3::Z * 0.5;
        assert!(JOINT.bend(turn, before).distance(before) < 1e-12, "the band's beginning stays");
        let behind = JOINT.pivot + off + DVec3::Z * 0.5;
        assert!(JOINT.bend(turn, behind).distance(motion.of(behind)) < 1e-12, "the band's end goes with the bone");
        assert!((motion.turn.determinant() - 1.0).abs() < 1e-12, "a rotation");
    }

    #[test]
    fn the_middle_line_keeps_its_length() {
        let turn = Turn { axis: DVec3::X, degrees: 80.0 };
        let at = |i: i32| JOINT.bend(turn, JOINT.pivot + DVec3::Z * (f64::from(i) / 1000.0 - 0.5));
        let length: f64 = (0..1000).map(|i| at(i).distance(at(i + 1))).sum();
        // The chord of an angle φ is shorter than its arc by φ²/24 of it; here φ is 0.0014.
        assert!((length - 1.0).abs() < 1e-7, "{length}");
    }
}
