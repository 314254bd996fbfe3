//! A bar of five stiff pieces with soft joints between them, and twelve poses.
//!
//! It lies along x, its section a square with round edges, narrower at the joints. Lengths are in grid cells.

use super::field::{Field, soft_intersection};
use super::polygonize::{Grid, polygonize};
use super::posed::{Pose, PoseSet, Posed};
use super::skeleton::{Joint, Place, Turn};
use super::{Shape, posed};
use glam::DVec3;

/// Of a cell: the bar gets about four units long.
const UNIT: f64 = 0.04;
/// Half the thickness of a piece.
const HALF: f64 = 3.6;
/// From joint to joint.
const PIECE: f64 = 21.0;
const N_PIECES: usize = 5;
/// Half the width of a joint's band.
const BAND: f64 = 2.0;

const BONES: [&str; N_PIECES] = ["first", "second", "third", "fourth", "fifth"];

/// Where joint j lies along x.
fn joint_at(j: usize) -> f64 {
    PIECE * (j as f64 + 1.0)
}

struct Bar;

impl Field for Bar {
    fn at(&self, p: DVec3) -> f64 {
        // How near the next joint is: 1 at its middle, 0 from twice its band on.
        let nearest = (0..N_PIECES - 1).map(|j| (p.x - joint_at(j)).abs()).fold(f64::INFINITY, f64::min);
        let near = (1.0 - nearest / (2.0 * BAND)).max(0.0);
        let half = HALF - 1.1 * near * near * (3.0 - 2.0 * near);
        let (y, z) = (p.y / half, p.z / half);
        // A superellipse of the sixth degree, made of operations that are the same everywhere.
        let sixth = y * y * y * y * y * y + z * z * z * z * z * z;
        let side = (libm::pow(sixth, 1.0 / 6.0) - 1.0) * half;
        let length = PIECE * N_PIECES as f64;
        soft_intersection(side, (p.x - 0.5 * length).abs() - 0.5 * length, 1.5)
    }
}

/// Degrees about +y, about +z and about +x, which is a twist.
type Angles = [f64; 3];

/// Name, the turn of each joint, the turn of the whole.
type Gesture = (&'static str, [Angles; N_PIECES - 1], Angles);

const GESTURES: [Gesture; 12] = [
    ("bow", [[0.0, 34.0, 0.0]; 4], [0.0, -60.0, 0.0]),
    ("wave", [[0.0, 42.0, 0.0], [0.0, -44.0, 0.0], [0.0, 44.0, 0.0], [0.0, -42.0, 0.0]], [0.0, 0.0, 0.0]),
    ("hook", [[0.0, 8.0, 0.0], [0.0, 10.0, 0.0], [0.0, 55.0, 0.0], [0.0, 62.0, 0.0]], [0.0, 0.0, 0.0]),
    ("corkscrew", [[38.0, 12.0, 26.0], [34.0, 12.0, 26.0], [34.0, 12.0, 26.0], [38.0, 12.0, 26.0]], [0.0, 0.0, 0.0]),
    ("elbow", [[0.0, 0.0, 0.0], [60.0, 0.0, 0.0], [0.0, 0.0, 0.0], [-30.0, 0.0, 0.0]], [-30.0, 0.0, 0.0]),
    ("twist", [[0.0, 0.0, 44.0]; 4], [0.0, 0.0, -88.0]),
    ("zigzag", [[46.0, 0.0, 0.0], [0.0, 52.0, 0.0], [-46.0, 0.0, 0.0], [0.0, -52.0, 0.0]], [0.0, 0.0, 0.0]),
    ("arch", [[0.0, 56.0, 0.0], [0.0, 6.0, 0.0], [0.0, 6.0, 0.0], [0.0, 56.0, 0.0]], [0.0, -62.0, 0.0]),
    ("cobra", [[0.0, -36.0, 0.0], [0.0, 60.0, 0.0], [0.0, 30.0, 0.0], [0.0, -64.0, 0.0]], [0.0, 0.0, 0.0]),
    ("wring", [[20.0, 0.0, 50.0], [-20.0, 20.0, -54.0], [20.0, -24.0, 54.0], [-20.0, 0.0, -50.0]], [0.0, 0.0, 0.0]),
    ("snake", [[-40.0, 10.0, 0.0], [44.0, 10.0, 0.0], [40.0, -12.0, 0.0], [-48.0, -12.0, 0.0]], [15.0, 10.0, 30.0]),
    ("fold", [[0.0, -62.0, 0.0], [12.0, -58.0, 0.0], [0.0, 20.0, 30.0], [0.0, 60.0, 0.0]], [0.0, 50.0, 0.0]),
];

/// The bar with known joints.
pub(crate) const JOINTED_BAR: PoseSet = PoseSet { name: "jointed-bar", make: bar };

fn bar() -> Posed {
    let length = PIECE * N_PIECES as f64;
    let reach = DVec3::new(2.5, HALF + 2.5, HALF + 2.5);
    // Not a whole number of cells aside, so that no flat side lies within a layer of nodes.
    let aside = DVec3::splat(0.37);
    let grid = Grid { low: aside - reach, high: aside + reach + DVec3::X * length, cell: 1.0 };
    let shape = polygonize(&Bar, grid);
    let joint = |j| Joint { parent: j, pivot: DVec3::X * joint_at(j), axis: DVec3::X, half: BAND };
    let mut joints: Vec<Joint> = (0..N_PIECES - 1).map(joint).collect();
    let chain: Vec<usize> = (0..joints.len()).collect();
    let place = |&p: &DVec3| posed::walk(&joints, &chain, p).unwrap_or(Place::Bone(0));
    let places = shape.positions.iter().map(place).collect();
    joints.iter_mut().for_each(|joint| (joint.pivot, joint.half) = (joint.pivot * UNIT, joint.half * UNIT));
    let positions = shape.positions.into_iter().map(|p| p * UNIT).collect();
    let rest = Shape { positions, triangles: shape.triangles }.rounded_to_f32();
    let turn = |[yaw, pitch, twist]: Angles| Turn::from_vector(DVec3::new(twist, yaw, pitch));
    let pose = |(name, turns, whole): &Gesture| Pose {
        name,
        turns: turns.map(turn).to_vec(),
        root: (turn(*whole), DVec3::ZERO),
    };
    Posed { rest, bones: BONES.to_vec(), joints, places, poses: GESTURES.iter().map(pose).collect() }
}
