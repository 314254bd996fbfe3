//! The creature that greets a newcomer: a small friendly dragon, waving.
//!
//! It faces +z and stands on y = 0, two units tall. Its skeleton of limbs gives both the surface and, at its joints, the
//! rigidity of a demonstration: stiff bones, soft joints, a supple tail.

use super::field::{Field, Part, Union, ball, soft_intersection};
use super::handles::turn_and_shift;
use super::polygonize::{Grid, polygonize};
use super::{Handles, Sample, Shape};
use glam::DVec3;

/// The raised hand, which is pulled.
const HAND: DVec3 = DVec3::new(0.80, 1.40, 0.24);
const HEAD: DVec3 = DVec3::new(0.0, 1.50, 0.14);

const fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// The tail, from the back to its tip.
const TAIL: [(DVec3, f64); 6] = [
    (at(0.0, 0.52, -0.18), 0.27),
    (at(-0.06, 0.34, -0.52), 0.195),
    (at(-0.20, 0.24, -0.84), 0.145),
    (at(-0.44, 0.24, -1.10), 0.108),
    (at(-0.72, 0.38, -1.22), 0.082),
    (at(-0.90, 0.62, -1.18), 0.060),
];

struct Creature {
    /// Trunk, head, tail.
    body: Union,
    /// Arms and legs, joined to the body but not to each other.
    limbs: Vec<Union>,
    /// Eyes, horns, plates on the back: joined with a narrow seam, so that they stand out.
    details: Vec<Union>,
    /// Taken away.
    face: Union,
}

impl Creature {
    fn new() -> Creature {
        let mut body = Union::default();
        body.join(Part::Ellipsoid { center: at(0.0, 0.62, 0.02), radii: at(0.37, 0.42, 0.35) }, 0.1);
        body.chain(&[(at(0.0, 0.72, 0.0), 0.30), (at(0.0, 1.02, 0.02), 0.21), (at(0.0, 1.34, 0.08), 0.165)], 0.16);
        body.chain(&TAIL, 0.14);
        body.join(Part::Ellipsoid { center: HEAD, radii: at(0.315, 0.275, 0.30) }, 0.14);
        body.chain(&[(at(0.0, 1.44, 0.28), 0.20), (at(0.0, 1.41, 0.46), 0.165)], 0.14);
        let limbs = vec![raised_arm(), lowered_arm(), leg(1.0), leg(-1.0)];
        Creature { body, limbs, details: details(), face: face() }
    }
}

fn raised_arm() -> Union {
    let mut arm = Union::default();
    arm.chain(&[(at(0.16, 0.97, 0.05), 0.130), (at(0.50, 1.00, 0.12), 0.100), (HAND, 0.085)], 0.05);
    arm.join(ball(HAND, 0.108), 0.06);
    let fingers = [
        (at(0.71, 1.58, 0.26), 0.047),
        (at(0.84, 1.60, 0.27), 0.049),
        (at(0.96, 1.53, 0.28), 0.047),
        (at(0.67, 1.43, 0.36), 0.047),
    ];
    fingers.into_iter().for_each(|finger| _ = arm.chain(&[(HAND, 0.055), finger], 0.03));
    arm
}

fn lowered_arm() -> Union {
    let hand = at(-0.66, 0.74, 0.42);
    let mut arm = Union::default();
    arm.chain(&[(at(-0.16, 0.97, 0.05), 0.130), (at(-0.50, 0.83, 0.10), 0.100), (hand, 0.085)], 0.05);
    arm.join(ball(hand, 0.105), 0.06);
    let fingers = [
        (at(-0.80, 0.66, 0.53), 0.047),
        (at(-0.68, 0.63, 0.60), 0.049),
        (at(-0.55, 0.67, 0.58), 0.047),
        (at(-0.60, 0.87, 0.50), 0.047),
    ];
    fingers.into_iter().for_each(|finger| _ = arm.chain(&[(hand, 0.055), finger], 0.03));
    arm
}

/// The leg on the side `side` (±1) of x.
fn leg(side: f64) -> Union {
    let point = |x: f64, y: f64, z: f64| at(side * x, y, z);
    let mut leg = Union::default();
    leg.chain(
        &[(point(0.20, 0.52, 0.0), 0.20), (point(0.30, 0.30, 0.08), 0.165), (point(0.31, 0.10, 0.02), 0.135)],
        0.08,
    );
    leg.chain(&[(point(0.31, 0.08, -0.02), 0.125), (point(0.34, 0.07, 0.20), 0.125)], 0.08);
    for (x, z) in [(0.24, 0.31), (0.35, 0.345), (0.46, 0.30)] {
        leg.join(ball(point(x, 0.065, z), 0.068), 0.04);
    }
    leg
}

/// What stands out from head, back and tail.
fn details() -> Vec<Union> {
    let (mut head, mut plates, mut tip) = (Union::default(), Union::default(), Union::default());
    for side in [-1.0, 1.0] {
        let point = |x: f64, y: f64, z: f64| at(side * x, y, z);
        head.join(ball(point(0.150, 1.635, 0.345), 0.110), 0.02);
        let horn = [
            (point(0.16, 1.70, 0.02), 0.078),
            (point(0.25, 1.81, -0.03), 0.064),
            (point(0.285, 1.90, -0.03), 0.050),
            (point(0.275, 1.965, 0.01), 0.036),
        ];
        head.chain(&horn, 0.03);
    }
    let along_the_back = [
        (at(0.0, 1.71, -0.08), at(0.0, 1.79, -0.17), 0.060),
        (at(0.0, 1.47, -0.10), at(0.0, 1.52, -0.23), 0.066),
        (at(0.0, 1.19, -0.13), at(0.0, 1.24, -0.26), 0.070),
        (at(0.0, 0.90, -0.24), at(0.0, 0.98, -0.36), 0.074),
        (at(-0.02, 0.62, -0.42), at(-0.02, 0.72, -0.50), 0.070),
        (at(-0.10, 0.42, -0.68), at(-0.10, 0.53, -0.73), 0.062),
        (at(-0.29, 0.32, -0.95), at(-0.29, 0.42, -0.98), 0.054),
    ];
    for (from, to, radius) in along_the_back {
        plates.chain(&[(from, radius), (to, radius * 0.6)], 0.03);
    }
    let (end, radius) = TAIL[TAIL.len() - 1];
    tip.chain(&[(end, radius), (end + at(-0.03, 0.10, 0.03), 0.092), (end + at(-0.04, 0.23, 0.05), 0.036)], 0.03);
    vec![head, plates, tip]
}

/// A smile and two nostrils, pressed into the snout.
fn face() -> Union {
    let mut face = Union::default();
    for side in [-1.0, 1.0] {
        let point = |x: f64, y: f64, z: f64| at(side * x, y, z);
        let smile = [
            (point(0.0, 1.325, 0.600), 0.024),
            (point(0.09, 1.338, 0.575), 0.024),
            (point(0.165, 1.375, 0.490), 0.024),
            (point(0.215, 1.435, 0.400), 0.022),
        ];
        face.chain(&smile, 0.02);
        face.join(ball(point(0.062, 1.490, 0.610), 0.026), 0.02);
    }
    face
}

impl Field for Creature {
    fn at(&self, p: DVec3) -> f64 {
        let d = self.limbs.iter().fold(self.body.at(p), |d, limb| limb.joined_to(d, p, 0.08));
        let d = self.details.iter().fold(d, |d, detail| detail.joined_to(d, p, 0.045));
        // Taking away is joining the outside.
        let d = -self.face.joined_to(-d, p, 0.03);
        soft_intersection(d, -p.y, 0.04)
    }
}

/// Where the creature bends: a joint, how far it reaches, r at its middle. Radii are those of the limbs or a little more.
const JOINTS: [(DVec3, f64, f64); 15] = [
    (at(0.0, 1.20, 0.05), 0.24, 1.0),
    (at(0.24, 0.98, 0.06), 0.17, 1.0),
    (at(0.50, 1.00, 0.12), 0.15, 1.0),
    (at(0.76, 1.31, 0.22), 0.12, 1.0),
    (at(-0.24, 0.96, 0.06), 0.17, 1.0),
    (at(-0.50, 0.83, 0.10), 0.15, 1.0),
    (at(-0.62, 0.77, 0.36), 0.12, 1.0),
    (at(0.25, 0.46, 0.02), 0.20, 1.0),
    (at(-0.25, 0.46, 0.02), 0.20, 1.0),
    (at(0.31, 0.18, 0.03), 0.15, 1.0),
    (at(-0.31, 0.18, 0.03), 0.15, 1.0),
    // The tail bends everywhere: its joints overlap.
    (at(-0.03, 0.40, -0.40), 0.30, 1.5),
    (at(-0.14, 0.28, -0.72), 0.32, 1.0),
    (at(-0.34, 0.24, -1.00), 0.32, 1.0),
    (at(-0.66, 0.34, -1.20), 0.34, 1.0),
];
/// r away from all joints: the paper's largest.
const STIFF: f64 = 6.0;

/// r of every vertex: soft at the joints, stiff between them.
fn rigidity(shape: &Shape) -> Vec<u16> {
    let at_vertex = |p: &DVec3| {
        let near = |&(joint, reach, soft): &(DVec3, f64, f64)| {
            // Softest within half of the reach, then evenly stiffer.
            let t = (2.0 * p.distance(joint) / reach - 1.0).clamp(0.0, 1.0);
            soft + (STIFF - soft) * t
        };
        JOINTS.iter().map(near).fold(STIFF, f64::min).round() as u16
    };
    shape.positions.iter().map(at_vertex).collect()
}

/// The soles are held, the raised hand is pulled up and forward, the head tilts.
pub(crate) const CREATURE: Sample =
    Sample { name: "creature", make: surface, handles: |shape| vec![("", waving(shape))], rigidity: Some(rigidity) };

fn surface() -> Shape {
    let grid = Grid { low: at(-1.15, -0.093, -1.42), high: at(1.12, 2.12, 0.80), cell: CELL };
    polygonize(&Creature::new(), grid).rounded_to_f32()
}

fn waving(shape: &Shape) -> Handles {
    let pulled = turn_and_shift(HAND, DVec3::Z, -35.0, at(0.22, 0.30, 0.20));
    let tilted = turn_and_shift(at(0.0, 1.30, 0.08), DVec3::Z, -18.0, at(0.05, 0.03, 0.0));
    let is_head = |p: DVec3| p.y > 1.42 && p.distance(HEAD) < 0.30 && p.z < 0.30;
    Handles {
        fixed: shape.vertices_where(|p| p.y < 0.03),
        moved: Vec::new(),
        groups: vec![
            (shape.vertices_where(|p| p.distance(HAND) < 0.115), pulled),
            (shape.vertices_where(is_head), tilted),
        ],
    }
}

/// Side of a grid cell: gives 12,736 vertices, and a net in which no two sheets meet (tested).
const CELL: f64 = 0.0292;
