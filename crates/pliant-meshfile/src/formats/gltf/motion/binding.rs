//! Bindings: which joints the vertices of a block follow.
//!
//! A primitive gives them in sets of four a vertex, `JOINTS_0` with `WEIGHTS_0`, `JOINTS_1` with `WEIGHTS_1` and so on.
//! Each set is reduced to the weights that count before the next is read: a file can name one list in any number of sets.

use super::super::access::{Accessor, Component, Data};
use super::super::json;
use super::morph::Owner;
use crate::{Fault, budget};
use glam::{DMat4, DVec3};
use serde_json::Value;

/// Joint and weight.
pub(super) type Followed = (u16, f32);

/// Memory that a set takes for each vertex at most: where its joints begin, and four of them.
const SET_BYTES: usize = size_of::<u32>() + 4 * size_of::<Followed>();

/// Which joints the vertices of a block follow, and by how much.
#[derive(Debug)]
pub(super) struct Binding {
    pub(super) skin: usize,
    /// The first joint that each vertex names, which it follows when it is bound to nothing, as most programs show it.
    first: Vec<u16>,
    sets: Vec<Set>,
}

/// What counts of the joints and weights of one number.
#[derive(Debug)]
struct Set {
    /// Where the followed joints of each vertex begin, and the end.
    starts: Vec<u32>,
    /// The weights of a vertex need not add up to 1.
    followed: Vec<Followed>,
}

impl Binding {
    /// The binding of a block of `n` vertices to a skin of `n_joints`; none for a primitive without joints. What it takes
    /// is spent from `purse`, in bytes.
    pub(super) fn new(
        data: Data<'_>,
        owner: &Owner<'_>,
        [skin, n_joints, n]: [usize; 3],
        purse: &mut budget::Purse,
    ) -> Result<Option<Binding>, Fault> {
        let n_sets = n_sets(owner);
        if n_sets == 0 {
            return Ok(None);
        }
        // Empty sets take room too.
        purse.spend(n_sets.saturating_mul(SET_BYTES.saturating_mul(n + 1)))?;
        purse.spend(n.saturating_mul(size_of::<u16>()))?;
        let mut binding = Binding { skin, first: Vec::new(), sets: Vec::with_capacity(n_sets) };
        for number in 0..n_sets {
            let joints = checked(data, owner, (number, "JOINTS"), n)?;
            let weights = checked(data, owner, (number, "WEIGHTS"), n)?.in_fractions();
            let joints: Vec<u16> = joints.numbers().into_iter().map(|joint| joint as u16).collect();
            let weights = weights.numbers().into_iter().map(|weight| weight as f32);
            binding.sets.push(Set::new(&joints, weights, n_joints).map_err(|(vertex, (joint, weight))| {
                let problem = format!("follows joint {joint} by {weight}, skin {skin} has {n_joints} joints");
                Fault::at(format!("{}, vertex {vertex}", owner.place), problem)
            })?);
            if number == 0 {
                binding.first = joints.iter().step_by(4).copied().collect();
            }
        }
        Ok(Some(binding))
    }

    /// Joints that some vertices follow, any number of times.
    pub(super) fn joints(&self) -> impl Iterator<Item = usize> {
        let followed = self.sets.iter().flat_map(|set| &set.followed).map(|&(joint, _)| joint);
        let free = self.first.iter().enumerate().filter(|&(vertex, _)| self.followed(vertex).next().is_none());
        followed.chain(free.map(|(_, &joint)| joint)).map(usize::from)
    }

    /// Steps of computation for one vertex.
    pub(super) fn work(&self) -> usize {
        4 * self.sets.len()
    }

    /// The joints that a vertex follows and their weights, in the order of the file.
    pub(super) fn followed(&self, vertex: usize) -> impl Iterator<Item = Followed> + Clone {
        let of_set = move |set: &'_ Set| set.starts[vertex] as usize..set.starts[vertex + 1] as usize;
        self.sets.iter().flat_map(move |set| set.followed[of_set(set)].iter().copied())
    }

    /// The joint that a vertex follows when it is bound to nothing.
    pub(super) fn first(&self, vertex: usize) -> u16 {
        self.first[vertex]
    }

    /// Moves the vertices to where their joints hold them.
    pub(super) fn apply(&self, matrices: &[DMat4], positions: &mut [DVec3]) {
        for (vertex, position) in positions.iter_mut().enumerate() {
            let total: f64 = self.followed(vertex).map(|(_, weight)| f64::from(weight)).sum();
            let held = |(joint, weight): Followed| {
                f64::from(weight) / total * matrices[usize::from(joint)].transform_point3(*position)
            };
            if total > 0.0 {
                *position = self.followed(vertex).map(held).sum();
            } else if let Some(matrix) = matrices.get(usize::from(self.first[vertex])) {
                *position = matrix.transform_point3(*position);
            }
        }
    }
}

impl Set {
    /// Keeps the weights above 0; a vertex with a joint that is none, or with a weight that is no number, is given back.
    fn new(joints: &[u16], weights: impl Iterator<Item = f32>, n_joints: usize) -> Result<Set, (usize, Followed)> {
        let (mut starts, mut followed) = (vec![0], Vec::new());
        for (k, (&joint, weight)) in joints.iter().zip(weights).enumerate() {
            if weight > 0.0 {
                if usize::from(joint) >= n_joints || !weight.is_finite() {
                    return Err((k / 4, (joint, weight)));
                }
                followed.push((joint, weight));
            }
            if k % 4 == 3 {
                // Four joints of 20 million vertices at most.
                starts.push(followed.len() as u32);
            }
        }
        followed.shrink_to_fit();
        Ok(Set { starts, followed })
    }
}

/// How many sets a primitive names, from the first on without a gap.
fn n_sets(owner: &Owner<'_>) -> usize {
    let named = |name: String| owner.primitive.get("attributes").is_some_and(|all| all.get(name).is_some());
    (0..).take_while(|set| named(format!("JOINTS_{set}")) && named(format!("WEIGHTS_{set}"))).count()
}

/// The joints or weights of a set, four for each of `n` vertices.
fn checked<'a>(data: Data<'a>, owner: &Owner<'_>, set: (usize, &str), n: usize) -> Result<Accessor<'a>, Fault> {
    let name = format!("{}_{}", set.1, set.0);
    let n_accessors = json::list(data.document, "accessors")?.len();
    let attributes = owner.primitive.get("attributes").unwrap_or(&Value::Null);
    let accessor = json::reference(attributes, &name, &owner.place, "accessor", n_accessors)?;
    let accessor = accessor.ok_or_else(|| Fault::at(owner.place.as_str(), format!("has no {name}")))?;
    let checked = data.accessor(accessor)?;
    let whole = matches!(checked.component, Component::U8 | Component::U16);
    let joints = set.1 == "JOINTS";
    if checked.width != 4 || checked.count != n || (joints && !whole) {
        let kind = if joints { "four whole numbers" } else { "four numbers" };
        let problem = format!("{name} is not {kind} for each of {n} vertices");
        return Err(Fault::at(format!("accessor {accessor}"), problem));
    }
    Ok(checked)
}
