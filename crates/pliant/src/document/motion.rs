//! Motions of groups as numbers that a person reads and types.
//!
//! A group's motion M takes its base positions to where they are held. About the middle *c* of the base it reads
//! M(x) = c + t + R S (x − c) with a rotation R and a symmetric stretch S (polar decomposition): t is the translation,
//! R the rotation, and the lengths of the columns of R S are the scales along the group's own axes.

use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};

use super::Group;

/// Newton's iteration for the polar decomposition doubles its digits each time: from a stretch of 1e6 it takes 25 rounds.
const ROUNDS: usize = 60;

/// Where a group is, relative to where it was placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Way of its middle, in the model's units.
    pub translation: DVec3,
    /// Turns about the world's x, then y, then z.
    pub degrees: DVec3,
    /// Stretch along its own axes; 1 is none.
    pub scale: DVec3,
}

impl Placement {
    /// What the motion of a group says.
    pub fn of(group: &Group) -> Placement {
        let linear = group.motion.matrix3;
        Placement {
            translation: group.center() - group.base_center(),
            degrees: degrees_of(rotation_of(linear).unwrap_or(DMat3::IDENTITY)),
            scale: DVec3::new(linear.x_axis.length(), linear.y_axis.length(), linear.z_axis.length()),
        }
    }

    /// The change that leads a group whose placement reads `self` to one that reads `wanted`.
    pub fn change_to(&self, wanted: &Placement, group: &Group) -> Change {
        let now = group.motion.matrix3;
        let mut linear = DMat3::IDENTITY;
        if wanted.scale != self.scale {
            let stretched = now * DMat3::from_diagonal(wanted.scale / self.scale) * now.inverse();
            linear = if stretched.is_finite() { stretched } else { linear };
        }
        if wanted.degrees != self.degrees {
            let turned_back = rotation_of(now).unwrap_or(DMat3::IDENTITY).transpose();
            linear = rotation_from(wanted.degrees) * turned_back * linear;
        }
        Change { way: wanted.translation - self.translation, linear }
    }
}

/// What a drag, a typed value or a field does to groups; about which point is told when it is applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Displacement, world space.
    pub way: DVec3,
    /// Rotation and stretch about the pivot.
    pub linear: DMat3,
}

impl Change {
    /// Along a way.
    pub fn moved(way: DVec3) -> Change {
        Change { way, linear: DMat3::IDENTITY }
    }

    /// About a unit axis, counterclockwise seen from its tip.
    pub fn turned(axis: DVec3, radians: f64) -> Change {
        Change { way: DVec3::ZERO, linear: DMat3::from_axis_angle(axis, radians) }
    }

    /// By three factors along orthonormal axes.
    pub fn scaled(axes: DMat3, factors: DVec3) -> Change {
        Change { way: DVec3::ZERO, linear: axes * DMat3::from_diagonal(factors) * axes.transpose() }
    }

    /// As a motion of space.
    pub fn about(&self, pivot: DVec3) -> DAffine3 {
        if self.linear == DMat3::IDENTITY {
            return DAffine3::from_translation(self.way);
        }
        DAffine3 { matrix3: self.linear, translation: pivot - self.linear * pivot + self.way }
    }
}

/// The rotation next to a matrix: R of its polar decomposition. `None` for one that flattens or mirrors space.
pub fn rotation_of(matrix: DMat3) -> Option<DMat3> {
    let mut rotation = matrix;
    if !matrix.is_finite() || matrix.determinant() <= 0.0 {
        return None;
    }
    for _ in 0..ROUNDS {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        let step = (next - rotation).to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        rotation = next;
        // The step before this small one has left an error of its square.
        if step < 1e-8 {
            break;
        }
    }
    rotation.is_finite().then_some(rotation)
}

/// About x, then y, then z.
fn rotation_from(degrees: DVec3) -> DMat3 {
    let [x, y, z] = degrees.to_array().map(f64::to_radians);
    DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
}

fn degrees_of(rotation: DMat3) -> DVec3 {
    let (z, y, x) = DQuat::from_mat3(&rotation).normalize().to_euler(EulerRot::ZYX);
    DVec3::new(x, y, z).map(f64::to_degrees)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{GroupColor, GroupId, GroupKind};

    fn group(motion: DAffine3) -> Group {
        Group {
            id: GroupId(1),
            name: "group".into(),
            kind: GroupKind::Handle,
            color: GroupColor::Yellow,
            dots: true,
            vertices: [].into(),
            base: [DVec3::new(1.0, 2.0, 3.0), DVec3::new(3.0, -1.0, 2.0)].into(),
            motion,
        }
    }

    #[test]
    fn what_was_typed_is_what_is_read_and_stays_when_other_numbers_change() {
        let mut group = group(DAffine3::IDENTITY);
        let wanted = [
            Placement { translation: DVec3::new(1.0, -2.0, 0.5), degrees: DVec3::ZERO, scale: DVec3::ONE },
            Placement {
                translation: DVec3::new(1.0, -2.0, 0.5),
                degrees: DVec3::new(30.0, -50.0, 120.0),
                scale: DVec3::ONE,
            },
            Placement {
                translation: DVec3::new(1.0, -2.0, 0.5),
                degrees: DVec3::new(30.0, -50.0, 120.0),
                scale: DVec3::new(0.5, 2.0, 3.0),
            },
            Placement {
                translation: DVec3::new(1.0, -2.0, 0.5),
                degrees: DVec3::new(-10.0, 20.0, 40.0),
                scale: DVec3::new(0.5, 2.0, 3.0),
            },
        ];
        for placement in wanted {
            let change = Placement::of(&group).change_to(&placement, &group);
            group.motion = change.about(group.center()) * group.motion;
            let got = Placement::of(&group);
            for (got, expected) in [
                (got.translation, placement.translation),
                (got.degrees, placement.degrees),
                (got.scale, placement.scale),
            ] {
                // A few roundings of numbers up to 120.
                assert!(got.distance(expected) < 1e-11, "{got}, expected {expected}");
            }
        }
    }

    #[test]
    fn the_rotation_of_a_stretched_turn_is_the_turn() {
        let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.5);
        for stretch in [DVec3::ONE, DVec3::new(1e-3, 1.0, 10.0), DVec3::splat(1e-12)] {
            let got = rotation_of(turn * DMat3::from_diagonal(stretch)).expect("a rotation");
            let error = (got - turn).to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            // The stretch's condition number of 1e4 times the rounding of a double, in some thirty rounds.
            assert!(error < 1e-9, "stretch {stretch}: {error}");
        }
        assert_eq!(rotation_of(DMat3::ZERO), None);
        assert_eq!(rotation_of(DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0))), None);
    }
}
