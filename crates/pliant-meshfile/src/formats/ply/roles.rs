//! What the properties of a vertex mean, by their names.

use super::header::{Element, Kind};
use super::scalar::Scalar;

/// Name of the property that holds r.
pub(super) const RIGIDITY: &str = "rigidity";

/// Numbers of a vertex that mean something here.
pub(super) const POSITION: usize = 0;
pub(super) const NORMAL: usize = 3;
pub(super) const UV: usize = 6;
pub(super) const COLOR: usize = 8;
pub(super) const R: usize = 12;
/// How many there are.
pub(super) const N_ROLES: usize = 13;

/// Names of the numbers from a role on, of which the first few have to be there together.
const NAMES: &[(usize, usize, &[&str])] = &[
    (POSITION, 3, &["x", "y", "z"]),
    (NORMAL, 3, &["nx", "ny", "nz"]),
    (UV, 2, &["s", "t"]),
    (UV, 2, &["u", "v"]),
    (UV, 2, &["texture_u", "texture_v"]),
    (UV, 2, &["texture_s", "texture_t"]),
    (COLOR, 3, &["red", "green", "blue", "alpha"]),
    (COLOR, 3, &["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"]),
    (COLOR, 3, &["r", "g", "b", "a"]),
    (R, 1, &[RIGIDITY]),
];

/// Which property of a vertex each number is.
#[derive(Debug)]
pub(super) struct Roles {
    /// The property of each role, with its type.
    pub(super) property: [Option<(usize, Scalar)>; N_ROLES],
    /// The role of each property.
    pub(super) role: Vec<Option<usize>>,
}

impl Roles {
    pub(super) fn of(vertex: &Element) -> Roles {
        let mut roles = Roles { property: [None; N_ROLES], role: vec![None; vertex.properties.len()] };
        for &(first, n_needed, names) in NAMES {
            let scalar = |name: &&str| match vertex.property(&[name]).map(|i| (i, vertex.properties[i].kind)) {
                Some((i, Kind::Scalar(scalar))) => Some((i, scalar)),
                _ => None,
            };
            let found: Vec<Option<(usize, Scalar)>> = names.iter().map(scalar).collect();
            let complete = found[..n_needed].iter().all(Option::is_some);
            if !complete || roles.property[first].is_some() {
                continue;
            }
            for (k, &property) in found.iter().enumerate() {
                roles.property[first + k] = property;
                if let Some((i, _)) = property {
                    roles.role[i] = Some(first + k);
                }
            }
        }
        roles
    }

    /// Whether vertices have what begins with a role.
    pub(super) fn has(&self, role: usize) -> bool {
        self.property[role].is_some()
    }

    /// What a color channel is divided by: whole numbers run from 0 to the highest of their type, others to 1.
    pub(super) fn full(&self, role: usize) -> f64 {
        self.property[role].and_then(|(_, scalar)| scalar.whole_range()).map_or(1.0, |[_, high]| high)
    }
}
