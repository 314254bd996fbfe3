//! A gecko with thirteen bones, twelve joints and twelve poses.
//!
//! It lies flat as on a wall, seen from +y, its head towards +z. What can be known of a bone depends on how many edges long
//! it is: every bone has vertices more than six edges from all joints.

use super::field::{Field, Part, Union, ball};
use super::polygonize::{Grid, polygonize};
use super::posed::{Pose, PoseSet, Posed};
use super::skeleton::{Joint, Place, Turn};
use super::{Shape, posed};
use glam::DVec3;

/// Of the lengths below: the gecko gets about two units long.
const UNIT: f64 = 0.02;
/// Side of a grid cell: gives 5,954 vertices, a net in which no two sheets meet, and bones just long enough (tested).
const CELL: f64 = 1.17;

const BONES: [&str; 13] = [
    "pelvis",
    "chest",
    "head",
    "tail",
    "tail tip",
    "left upper arm",
    "left forearm",
    "right upper arm",
    "right forearm",
    "left thigh",
    "left shin",
    "right thigh",
    "right shin",
];

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A limb, from inside the body to its toes.
struct Leg {
    /// Points of its middle line up to the hand, with radii.
    bones: [(DVec3, f64); 6],
    /// Pivots of its two joints.
    pivots: [DVec3; 2],
    /// Their tips.
    toes: [DVec3; 3],
}

/// A limb on the side `side` (±1) of x.
fn leg(side: f64, front: bool) -> Leg {
    let turned = if front { 1.0 } else { -1.0 };
    let point = |x: f64, z: f64| at(side * x, 0.0, turned * z);
    let shift = if front { 0.0 } else { 0.6 };
    let bones = [
        (point(1.5, 12.6), 2.6),
        (point(9.5, 13.4), 2.1),
        (point(19.0, 16.8), 2.5 + shift),
        (point(28.2, 21.2), 2.0),
        (point(35.0, 26.2), 2.1),
        (point(39.8, 31.0), 1.8),
    ];
    let hand = bones[5].0;
    let toes = [(6.0, -1.2), (4.2, 4.6), (-1.4, 5.9)].map(|(x, z)| hand + point(x, z));
    Leg { pivots: [bones[1].0, bones[3].0], bones, toes }
}

impl Leg {
    fn field(&self) -> Union {
        let mut leg = Union::default();
        leg.chain(&self.bones, 0.5);
        let hand = self.bones[5].0;
        leg.join(ball(hand, 2.7), 1.0);
        for toe in self.toes {
            leg.join(Part::Limb { from: hand, to: toe, radii: [1.5, 1.3] }, 2.0);
            leg.join(ball(toe, 1.9), 0.8);
        }
        leg
    }
}

struct Gecko {
    body: Union,
    legs: [Union; 4],
    eyes: Union,
}

impl Gecko {
    fn new() -> Gecko {
        let mut body = Union::default();
        let spine = [
            (at(0.0, 0.0, -66.0), 0.8),
            (at(0.0, 0.0, -58.0), 1.7),
            (at(0.0, 0.0, -46.0), 2.6),
            (at(0.0, 0.0, -34.0), 3.3),
            (at(0.0, 0.0, -24.0), 3.3),
            (at(0.0, 0.2, -13.0), 4.5),
            (at(0.0, 0.2, 0.0), 4.3),
            (at(0.0, 0.2, 13.0), 4.7),
            (at(0.0, 0.2, 23.5), 3.2),
            (at(0.0, 0.3, 30.0), 4.0),
        ];
        body.chain(&spine, 0.5);
        body.join(Part::Ellipsoid { center: at(0.0, 0.4, 35.0), radii: at(6.3, 4.2, 6.6) }, 3.0);
        body.join(Part::Ellipsoid { center: at(0.0, 0.0, 41.5), radii: at(4.2, 2.9, 5.0) }, 3.0);
        let legs = [leg(1.0, true), leg(-1.0, true), leg(1.0, false), leg(-1.0, false)].map(|leg| leg.field());
        let mut eyes = Union::default();
        [-1.0, 1.0].into_iter().for_each(|side| _ = eyes.join(ball(at(side * 4.4, 3.3, 37.0), 2.2), 0.5));
        Gecko { body, legs, eyes }
    }

    /// The limb a point of the surface belongs to, if not the body.
    fn leg_at(&self, p: DVec3) -> Option<usize> {
        let body = self.body.at(p);
        (0..4).find(|&leg| self.legs[leg].at(p) < body)
    }
}

impl Field for Gecko {
    fn at(&self, p: DVec3) -> f64 {
        let d = self.legs.iter().fold(self.body.at(p), |d, leg| leg.joined_to(d, p, 2.0));
        self.eyes.joined_to(d, p, 1.0)
    }
}

/// Joint j carries bone j + 1.
fn joints() -> Vec<Joint> {
    let joint = |parent, pivot: DVec3, to: DVec3, half| Joint { parent, pivot, axis: (to - pivot).normalize(), half };
    let mut joints = vec![
        joint(0, at(0.0, 0.2, 0.0), at(0.0, 0.2, 1.0), 2.4),
        joint(1, at(0.0, 0.2, 24.0), at(0.0, 0.2, 25.0), 2.0),
        joint(0, at(0.0, 0.0, -24.0), at(0.0, 0.0, -25.0), 2.0),
        joint(3, at(0.0, 0.0, -45.0), at(0.0, 0.0, -46.0), 2.0),
    ];
    for (i, leg) in [leg(1.0, true), leg(-1.0, true), leg(1.0, false), leg(-1.0, false)].iter().enumerate() {
        let [root, knee] = leg.pivots;
        // The middle line's direction at a point of a Catmull and Rom curve.
        let along = |i: usize| leg.bones[i + 1].0 - leg.bones[i - 1].0;
        joints.push(joint(if i < 2 { 1 } else { 0 }, root, root + along(1), 1.8));
        joints.push(joint(5 + 2 * i, knee, knee + along(3), 1.8));
    }
    joints
}

/// The bone or joint of a point of the surface.
fn place(gecko: &Gecko, joints: &[Joint], p: DVec3) -> Place {
    let leg = gecko.leg_at(p).and_then(|leg| posed::walk(joints, &[4 + 2 * leg, 5 + 2 * leg], p));
    let front = || posed::walk(joints, &[0, 1], p);
    let back = || posed::walk(joints, &[2, 3], p);
    leg.or_else(front).or_else(back).unwrap_or(Place::Bone(0))
}

/// What a pose does at a joint, in degrees: a turn about +y, a lift out of the plane, a twist.
type Angles = [f64; 3];

/// Turns of the four spine joints (spine, neck, tail, tail tip) and of shoulder or hip and elbow or knee of the left and
/// right front and the left and right hind limb, then of the whole.
struct Gesture {
    name: &'static str,
    spine: [Angles; 4],
    limbs: [[Angles; 2]; 4],
    whole: Angles,
}

const STILL: Angles = [0.0; 3];

const fn yaw(degrees: f64) -> Angles {
    [degrees, 0.0, 0.0]
}

const fn lift(degrees: f64) -> Angles {
    [0.0, degrees, 0.0]
}

/// Positive yaw turns what points to +z towards +x: the left limbs (x > 0) back, the right ones forward.
const GESTURES: [Gesture; 12] = [
    Gesture {
        name: "step left",
        spine: [yaw(32.0), yaw(-30.0), yaw(34.0), yaw(-38.0)],
        limbs: [[yaw(-38.0), yaw(-30.0)], [yaw(-36.0), yaw(34.0)], [yaw(34.0), yaw(36.0)], [yaw(32.0), yaw(-40.0)]],
        whole: yaw(-14.0),
    },
    Gesture {
        name: "step right",
        spine: [yaw(-32.0), yaw(30.0), yaw(-34.0), yaw(38.0)],
        limbs: [[yaw(36.0), yaw(-34.0)], [yaw(38.0), yaw(30.0)], [yaw(-32.0), yaw(40.0)], [yaw(-34.0), yaw(-36.0)]],
        whole: yaw(14.0),
    },
    Gesture {
        name: "wave",
        spine: [yaw(12.0), [-28.0, 24.0, 0.0], yaw(-20.0), yaw(-35.0)],
        limbs: [[[-16.0, 55.0, 0.0], [-36.0, 24.0, 0.0]], [yaw(16.0), STILL], [STILL, yaw(10.0)], [STILL, yaw(-10.0)]],
        whole: STILL,
    },
    Gesture {
        name: "look up",
        spine: [lift(32.0), lift(40.0), lift(14.0), lift(-20.0)],
        limbs: [[lift(-38.0), lift(-15.0)], [lift(-38.0), lift(-15.0)], [lift(-10.0), STILL], [lift(-10.0), STILL]],
        whole: STILL,
    },
    Gesture {
        name: "stand",
        spine: [lift(-10.0), lift(22.0), lift(25.0), lift(18.0)],
        limbs: [
            [lift(28.0), lift(-66.0)],
            [lift(28.0), lift(-66.0)],
            [lift(28.0), lift(-66.0)],
            [lift(28.0), lift(-66.0)],
        ],
        whole: STILL,
    },
    Gesture {
        name: "scorpion",
        spine: [lift(-15.0), lift(18.0), lift(62.0), lift(66.0)],
        limbs: [[STILL, yaw(-30.0)], [STILL, yaw(30.0)], [yaw(-20.0), STILL], [yaw(20.0), STILL]],
        whole: STILL,
    },
    Gesture {
        name: "curl",
        spine: [yaw(42.0), yaw(44.0), yaw(-48.0), yaw(-66.0)],
        limbs: [[yaw(-10.0), yaw(-42.0)], [yaw(10.0), yaw(18.0)], [yaw(-24.0), yaw(20.0)], [yaw(-8.0), yaw(-20.0)]],
        whole: yaw(-20.0),
    },
    Gesture {
        name: "leap",
        spine: [lift(-18.0), lift(30.0), lift(-22.0), lift(34.0)],
        limbs: [[yaw(-44.0), lift(20.0)], [yaw(44.0), lift(20.0)], [yaw(44.0), lift(-20.0)], [yaw(-44.0), lift(-20.0)]],
        whole: lift(-12.0),
    },
    Gesture {
        name: "embrace",
        spine: [lift(-30.0), lift(-32.0), lift(-30.0), lift(-34.0)],
        limbs: [
            [lift(-44.0), lift(-48.0)],
            [lift(-44.0), lift(-48.0)],
            [lift(-44.0), lift(-48.0)],
            [lift(-44.0), lift(-48.0)],
        ],
        whole: STILL,
    },
    Gesture {
        name: "twist",
        spine: [[0.0, 0.0, 46.0], [0.0, 0.0, -40.0], [0.0, 0.0, 44.0], [0.0, 20.0, 40.0]],
        limbs: [
            [[0.0, 0.0, 40.0], [0.0, -30.0, 30.0]],
            [[0.0, 0.0, 40.0], [0.0, 30.0, 30.0]],
            [[0.0, 10.0, -40.0], [0.0, -30.0, -30.0]],
            [[0.0, -10.0, -40.0], [0.0, 30.0, -30.0]],
        ],
        whole: STILL,
    },
    Gesture {
        name: "turn around",
        spine: [yaw(-38.0), yaw(-46.0), yaw(30.0), yaw(52.0)],
        limbs: [
            [[18.0, 22.0, 0.0], yaw(30.0)],
            [[24.0, 30.0, 0.0], yaw(52.0)],
            [[-22.0, 16.0, 0.0], yaw(-34.0)],
            [[16.0, 34.0, 0.0], yaw(-56.0)],
        ],
        whole: yaw(22.0),
    },
    Gesture {
        name: "shake",
        spine: [[-20.0, 14.0, 30.0], [26.0, 20.0, -22.0], [40.0, 24.0, 0.0], [-48.0, 20.0, 0.0]],
        limbs: [
            [[20.0, -22.0, 18.0], [-40.0, -20.0, 0.0]],
            [[-34.0, 26.0, 0.0], [38.0, -26.0, 0.0]],
            [[30.0, 24.0, -10.0], [40.0, -24.0, 0.0]],
            [[-12.0, -34.0, 16.0], [24.0, -36.0, 0.0]],
        ],
        whole: [30.0, 20.0, -25.0],
    },
];

/// The turn of a joint whose bone points along `axis`.
fn turn(axis: DVec3, [yaw, lift, twist]: Angles) -> Turn {
    let up = axis.cross(DVec3::Y).normalize();
    Turn::from_vector(DVec3::Y * yaw + up * lift + axis * twist)
}

fn pose(joints: &[Joint], gesture: &Gesture) -> Pose {
    let of_limbs = gesture.limbs.iter().flatten();
    let angles = gesture.spine.iter().chain(of_limbs);
    let turns = joints.iter().zip(angles).map(|(joint, &angles)| turn(joint.axis, angles)).collect();
    Pose { name: gesture.name, turns, root: (turn(DVec3::Z, gesture.whole), DVec3::ZERO) }
}

/// The creature with known bones.
pub(crate) const GECKO: PoseSet = PoseSet { name: "gecko", make: gecko };

fn gecko() -> Posed {
    let field = Gecko::new();
    // Aside by as much that no sheet grazes a layer of nodes, which would tear the net (tested).
    let grid = Grid { low: at(-50.5, -6.4, -68.5), high: at(50.5, 8.5, 50.5), cell: CELL };
    let shape = polygonize(&field, grid);
    let mut joints = joints();
    let places = shape.positions.iter().map(|&p| place(&field, &joints, p)).collect();
    joints.iter_mut().for_each(|joint| (joint.pivot, joint.half) = (joint.pivot * UNIT, joint.half * UNIT));
    let positions = shape.positions.into_iter().map(|p| p * UNIT).collect();
    let rest = Shape { positions, triangles: shape.triangles }.rounded_to_f32();
    let poses = GESTURES.iter().map(|gesture| pose(&joints, gesture)).collect();
    Posed { rest, bones: BONES.to_vec(), joints, places, poses }
}
