//! A cactus: a ribbed trunk with three bent arms, cut flat at the ground.

use super::field::{Field, Part, Union, soft_intersection};
use super::handles::turn_and_shift;
use super::polygonize::{Grid, polygonize};
use super::{Handles, Sample, Shape};
use glam::DVec3;

/// Top of the first arm, which is pulled.
const ARM_TIP: DVec3 = DVec3::new(0.62, 1.50, 0.05);

/// Side of a grid cell: gives 5,574 vertices, and a net in which no two sheets meet (tested).
const CELL: f64 = 0.0393;

struct Cactus {
    trunk: Part,
    arms: Vec<Union>,
}

impl Cactus {
    fn new() -> Cactus {
        let trunk = Part::Ribbed {
            from: DVec3::new(0.0, -0.3, 0.0),
            to: DVec3::new(0.03, 1.75, -0.02),
            radii: [0.27, 0.24],
            n: 9,
            depth: 0.13,
        };
        let first = arm([DVec3::new(0.15, 0.72, 0.0), DVec3::new(0.60, 0.78, 0.03)], ARM_TIP, [0.13, 0.15]);
        let second = arm(
            [DVec3::new(-0.15, 0.98, 0.03), DVec3::new(-0.54, 1.06, 0.10)],
            DVec3::new(-0.58, 1.66, 0.14),
            [0.12, 0.13],
        );
        let third = arm(
            [DVec3::new(-0.02, 0.50, 0.12), DVec3::new(-0.14, 0.55, 0.52)],
            DVec3::new(-0.20, 0.95, 0.60),
            [0.11, 0.115],
        );
        Cactus { trunk, arms: vec![first, second, third] }
    }
}

/// An arm that leaves the trunk, bends, and rises ribbed to its tip.
fn arm([root, bend]: [DVec3; 2], tip: DVec3, [thin, thick]: [f64; 2]) -> Union {
    let mut arm = Union::default();
    arm.join(Part::Limb { from: root, to: bend, radii: [thin, thick] }, 0.1);
    arm.join(Part::Ribbed { from: bend, to: tip, radii: [thick, thick * 0.9], n: 7, depth: 0.12 }, 0.12);
    arm
}

impl Field for Cactus {
    fn at(&self, p: DVec3) -> f64 {
        let whole = self.arms.iter().fold(self.trunk.at(p), |d, arm| arm.joined_to(d, p, 0.12));
        soft_intersection(whole, -p.y, 0.05)
    }
}

/// About two units tall on the ground y = 0. The foot is held, the tip of one arm pulled outwards.
pub(crate) const CACTUS: Sample =
    Sample { name: "cactus", make: surface, handles: |shape| vec![("", pulled(shape))], rigidity: None };

fn surface() -> Shape {
    let grid = Grid { low: DVec3::new(-0.95, -0.11, -0.55), high: DVec3::new(1.0, 2.2, 0.95), cell: CELL };
    polygonize(&Cactus::new(), grid).rounded_to_f32()
}

fn pulled(shape: &Shape) -> Handles {
    let matrix = turn_and_shift(ARM_TIP, DVec3::NEG_Z, 50.0, DVec3::new(0.45, -0.25, 0.1));
    Handles {
        fixed: shape.vertices_where(|p| p.y < 0.06),
        moved: Vec::new(),
        groups: vec![(shape.vertices_where(|p| p.distance(ARM_TIP) < 0.18), matrix)],
    }
}
