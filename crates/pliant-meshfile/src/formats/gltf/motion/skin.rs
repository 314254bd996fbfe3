//! Skins: joints, and the matrices that take a mesh from its bind pose along with them.

use super::super::access::{Accessor, Data};
use super::super::json;
use super::super::nodes::affine;
use crate::{Fault, budget};
use glam::{DMat4, DVec3};
use serde_json::Value;

/// How far the last row of an inverse bind matrix may be from [0, 0, 0, 1]: inverses computed in single precision lose
/// some of its seven digits.
const AFFINE: f64 = 1e-4;

/// Joints and their inverse bind matrices.
#[derive(Debug)]
pub(super) struct Skin {
    /// Slots of the joints' nodes.
    joints: Vec<usize>,
    inverse_bind: Vec<DMat4>,
    /// What the skeleton at rest makes of a length of the bind pose.
    pub(super) scale: f64,
}

/// Memory that a joint takes: its slot, its inverse bind matrix and the numbers that is read from, and its matrix in a
/// frame.
const JOINT_BYTES: usize = size_of::<usize>() + 3 * size_of::<DMat4>();

/// The nodes of a skin's joints.
pub(super) fn joints(document: &Value, skin: usize) -> Result<Vec<usize>, Fault> {
    let n_nodes = json::list(document, "nodes")?.len();
    let place = format!("skin {skin}");
    let joints = json::list(document, "skins")?.get(skin).and_then(|skin| skin.get("joints")?.as_array());
    let joints = joints.map_or(&[][..], Vec::as_slice);
    // Every one is another node.
    if joints.len() > n_nodes {
        return Err(Fault::at(place, format!("names {} joints, the file has {n_nodes} nodes", joints.len())));
    }
    let bad = || Fault::at(place.as_str(), "names a joint that is no node");
    let joint = |joint: &Value| joint.as_u64().filter(|&joint| joint < n_nodes as u64).ok_or_else(bad);
    joints.iter().map(|value| joint(value).map(|joint| joint as usize)).collect()
}

impl Skin {
    /// `slots` are those of the skin's joints, `world` the transforms of all slots at rest. What it takes is spent from
    /// `purse`, in bytes.
    pub(super) fn new(
        data: Data<'_>,
        skin: usize,
        slots: Vec<usize>,
        world: &[DMat4],
        purse: &mut budget::Purse,
    ) -> Result<Skin, Fault> {
        purse.spend(slots.len().saturating_mul(JOINT_BYTES))?;
        let place = format!("skin {skin}");
        let n = json::list(data.document, "accessors")?.len();
        let value = &json::list(data.document, "skins")?[skin];
        let inverse_bind = match json::reference(value, "inverseBindMatrices", &place, "accessor", n)? {
            None => vec![DMat4::IDENTITY; slots.len()],
            Some(accessor) => {
                let checked = data.matrices(accessor)?;
                if checked.count < slots.len() {
                    let problem = format!("has {} joints and {} inverse bind matrices", slots.len(), checked.count);
                    return Err(Fault::at(place, problem));
                }
                // A list may be longer, and serve several skins.
                inverse_binds(&checked.first(slots.len()), &place)?
            }
        };
        let mut skin = Skin { joints: slots, inverse_bind, scale: 1.0 };
        skin.scale = scale(&skin.matrices(world));
        Ok(skin)
    }

    /// Slots of the joints' nodes.
    pub(super) fn slots(&self) -> &[usize] {
        &self.joints
    }

    /// What takes a place of the bind pose to where each joint holds it, in units of the bind pose.
    pub(super) fn matrices(&self, world: &[DMat4]) -> Vec<DMat4> {
        let unit = DMat4::from_scale(DVec3::splat(1.0 / self.scale));
        let pair = self.joints.iter().zip(&self.inverse_bind);
        pair.map(|(&slot, &inverse_bind)| unit * world[slot] * inverse_bind).collect()
    }
}

fn inverse_binds(checked: &Accessor<'_>, place: &str) -> Result<Vec<DMat4>, Fault> {
    let numbers = checked.numbers();
    let matrix = |(joint, numbers): (usize, &[f64])| {
        let place = format!("{place}, inverse bind matrix {joint}");
        let mut columns = [0.0; 16];
        columns.copy_from_slice(numbers);
        if columns.iter().any(|x| !x.is_finite()) {
            return Err(Fault::at(place, "is not finite"));
        }
        affine(DMat4::from_cols_array(&columns), AFFINE, &place)
    };
    numbers.chunks_exact(16).enumerate().map(matrix).collect()
}

/// The median of the factors by which matrices change lengths; 1 when there is none.
fn scale(matrices: &[DMat4]) -> f64 {
    let factors = matrices.iter().map(|matrix| matrix.determinant().abs().cbrt());
    let mut factors: Vec<f64> = factors.filter(|factor| factor.is_finite() && *factor > 0.0).collect();
    if factors.is_empty() {
        return 1.0;
    }
    let middle = factors.len() / 2;
    let median = *factors.select_nth_unstable_by(middle, f64::total_cmp).1;
    // Closer than a writer's rounding means the same unit.
    if (median - 1.0).abs() < 1e-4 { 1.0 } else { median }
}
