//! Which vertices a skeleton keeps together.
//!
//! Two vertices of one place stay together in every pose if they are *bound alike*: the same skin carries them, and every
//! joint by the same weight but for what short numbers round off; or no skin carries either. Meshes whose nodes alone are
//! animated count as carried by no skin. A skin that is written twice, with the same joints and the same inverse bind
//! matrices, is one skin: some programs write one for each mesh.

use super::super::json;
use super::super::nodes;
use super::super::source::GltfSource;
use super::binding::{Binding, Followed};
use super::{morph, rig, skin};
use crate::formats::Bindings;
use crate::{Fault, budget};
use serde_json::Value;
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// How far apart the weights of one joint may be that are meant to be one: weights of 8 bits are 1/255 apart, and a step
/// up or down makes their sum 1. Two vertices then part by a hundredth of what their joints part by.
const SAME_WEIGHT: f32 = 0.01;

/// Matrices read to find out which skins are one. Characters have some hundred.
const MOST_MATRICES: usize = 1 << 20;

/// Memory for joints and weights while vertices are welded: four a vertex take 38 bytes. Beyond it the vertices of a skin
/// are told from others, not from each other.
const MOST_BYTES: u64 = 1 << 30;

/// What carries the vertices of each block.
#[derive(Debug)]
struct Bound {
    /// Where each block ends in the file's vertices, ascending.
    ends: Vec<usize>,
    blocks: Vec<Carrier>,
}

#[derive(Debug)]
enum Carrier {
    Nothing,
    /// The skin by its first number, and the weights unless they are broken.
    Skin(usize, Option<Binding>),
}

/// What keeps vertices of one place apart; none in a document without skins.
pub(in super::super) fn bindings(source: &GltfSource) -> Option<Box<dyn Bindings + '_>> {
    // What is broken here keeps the file's animations from being read, which says so; its shape is what it is.
    let bound = Bound::new(source).ok()?;
    let has_skin = bound.blocks.iter().any(|carrier| matches!(carrier, Carrier::Skin(..)));
    has_skin.then(|| Box::new(bound) as Box<dyn Bindings>)
}

impl Bound {
    fn new(source: &GltfSource) -> Result<Bound, Fault> {
        let document = &source.document;
        let mut bound = Bound { ends: Vec::new(), blocks: Vec::new() };
        if json::list(document, "skins")?.is_empty() {
            return Ok(bound);
        }
        let (nodes, meshes) = (json::list(document, "nodes")?, json::list(document, "meshes")?);
        let placements = nodes::placements(document, meshes.len(), &mut Vec::new())?;
        let mut purse = budget::Purse::new("bytes of joints and weights", MOST_BYTES);
        let mut skins = Skins::default();
        for (block, owner) in source.blocks.iter().zip(morph::owners(source)?) {
            let node = placements[owner.mesh].node;
            let skin = node.map_or(Ok(None), |node| rig::skin_of(document, node, nodes))?;
            bound.ends.push(block.vertices.end);
            bound.blocks.push(match skin {
                None => Carrier::Nothing,
                Some(skin) => {
                    let (first, n_joints) = skins.first(source, skin)?;
                    let counts = [skin, n_joints, block.vertices.len()];
                    match Binding::new(source.into(), &owner, counts, &mut purse) {
                        Ok(None) => Carrier::Nothing,
                        Ok(Some(binding)) => Carrier::Skin(first, Some(binding)),
                        Err(_) => Carrier::Skin(first, None),
                    }
                }
            });
        }
        Ok(bound)
    }

    /// What carries a vertex, and its number in its block.
    fn carrier(&self, vertex: usize) -> (&Carrier, usize) {
        let block = self.ends.partition_point(|&end| end <= vertex);
        let start = block.checked_sub(1).map_or(0, |before| self.ends[before]);
        (&self.blocks[block], vertex - start)
    }
}

impl Bindings for Bound {
    fn alike(&self, a: usize, b: usize) -> bool {
        match (self.carrier(a), self.carrier(b)) {
            ((Carrier::Nothing, _), (Carrier::Nothing, _)) => true,
            ((Carrier::Skin(skin_a, of_a), a), (Carrier::Skin(skin_b, of_b), b)) if skin_a == skin_b => {
                match (of_a, of_b) {
                    (Some(of_a), Some(of_b)) => same_weights((of_a, a), (of_b, b)),
                    (None, None) => true,
                    _ => false,
                }
            }
            _ => false,
        }
    }
}

/// Whether two vertices follow the same joints by the same shares.
fn same_weights(a: (&Binding, usize), b: (&Binding, usize)) -> bool {
    let total = |(binding, vertex): (&Binding, usize)| binding.followed(vertex).map(|(_, weight)| weight).sum::<f32>();
    let totals = [total(a), total(b)];
    if totals.iter().any(|total| *total <= 0.0) {
        return totals == [0.0; 2] && a.0.first(a.1) == b.0.first(b.1);
    }
    // A joint may be named several times.
    let share = |(binding, vertex): (&Binding, usize), total: f32, joint: u16| {
        let of_joint = binding.followed(vertex).filter(|followed| followed.0 == joint);
        of_joint.map(|(_, weight)| weight / total).sum::<f32>()
    };
    let joints = a.0.followed(a.1).chain(b.0.followed(b.1));
    let mut same = |(joint, _): Followed| {
        let apart = share(a, totals[0], joint) - share(b, totals[1], joint);
        apart.abs() <= SAME_WEIGHT
    };
    joints.into_iter().all(&mut same)
}

/// Which skins are one.
#[derive(Default)]
struct Skins {
    /// The first skin with the same joints and matrices, and how many joints, of each skin met.
    known: HashMap<usize, (usize, usize)>,
    first_with: HashMap<(Vec<usize>, u64), usize>,
    n_matrices: usize,
}

impl Skins {
    fn first(&mut self, source: &GltfSource, skin: usize) -> Result<(usize, usize), Fault> {
        if let Some(&known) = self.known.get(&skin) {
            return Ok(known);
        }
        let joints = skin::joints(&source.document, skin)?;
        let n_joints = joints.len();
        let matrices = self.matrices(source, skin, n_joints)?;
        let first = *self.first_with.entry((joints, matrices)).or_insert(skin);
        self.known.insert(skin, (first, n_joints));
        Ok((first, n_joints))
    }

    /// A number that tells the inverse bind matrices of skins with as many joints apart.
    fn matrices(&mut self, source: &GltfSource, skin: usize, n_joints: usize) -> Result<u64, Fault> {
        let named = json::list(&source.document, "skins")?[skin].get("inverseBindMatrices").and_then(Value::as_u64);
        let Some(accessor) = named else { return Ok(0) };
        self.n_matrices += n_joints;
        let mut hasher = DefaultHasher::new();
        if self.n_matrices > MOST_MATRICES {
            (1, accessor).hash(&mut hasher);
            return Ok(hasher.finish());
        }
        let checked = crate::formats::gltf::access::Data::from(source).matrices(accessor as usize)?.first(n_joints);
        checked.numbers().iter().for_each(|number| number.to_bits().hash(&mut hasher));
        Ok(hasher.finish())
    }
}
