//! The vertices of one block: what displaces them, and what carries them.

use super::super::access::Data;
use super::super::nodes::Placement;
use super::super::source::GltfSource;
use super::binding::Binding;
use super::morph::{self, Owner};
use super::rig::State;
use super::skin::Skin;
use crate::{Fault, budget};
use glam::{DMat4, DVec3};
use serde_json::Value;

/// The vertices of one block.
#[derive(Debug)]
pub(super) struct Carried {
    /// The node whose animated weights count.
    node: Option<usize>,
    /// Slot of the node that places them; none for a mesh without a node, for one that a skin places, and for one whose
    /// node flattens it at rest, which is shown without its transform in the frames as it is on opening.
    pub(super) slot: Option<usize>,
    /// Number of the skin among those of the rig.
    pub(super) skin: Option<usize>,
    n: usize,
    /// In coordinates of the mesh.
    at_rest: Vec<DVec3>,
    /// Accessors of the displacements.
    targets: Vec<Option<usize>>,
    /// Weights of the targets where nothing animates them.
    weights: Vec<f64>,
    pub(super) binding: Option<Binding>,
}

impl Carried {
    /// What the document says, without any vertex. `default` are the weights of the node or the mesh.
    pub(super) fn outline(
        source: &GltfSource,
        block: usize,
        owner: &Owner<'_>,
        placement: &Placement,
        default: Option<&Value>,
    ) -> Result<Carried, Fault> {
        let targets = morph::of_block(source, owner)?;
        let default = default.and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
        // Every block of a mesh would copy what is listed beyond its targets.
        let weights = default.iter().take(targets.len()).map(|weight| weight.as_f64().unwrap_or(0.0)).collect();
        Ok(Carried {
            node: placement.node,
            slot: None,
            skin: None,
            n: source.blocks[block].vertices.len(),
            at_rest: Vec::new(),
            targets,
            weights,
            binding: None,
        })
    }

    /// Reads the vertices; `purse` holds the bytes that may be kept.
    pub(super) fn load(
        &mut self,
        source: &GltfSource,
        block: usize,
        owner: &Owner<'_>,
        skins: &[Skin],
        purse: &mut budget::Purse,
    ) -> Result<(), Fault> {
        let data = Data::from(source);
        purse.spend(self.n.saturating_mul(size_of::<DVec3>()))?;
        let checked = data.accessor(source.blocks[block].accessor)?;
        // Checked on opening: three numbers each.
        self.at_rest = checked.numbers().chunks_exact(3).map(|p| DVec3::new(p[0], p[1], p[2])).collect();
        if let Some(skin) = self.skin {
            let counts = [skin, skins[skin].slots().len(), self.n];
            self.binding = Binding::new(data, owner, counts, purse)?;
        }
        Ok(())
    }

    pub(super) fn n_vertices(&self) -> usize {
        self.n
    }

    pub(super) fn n_targets(&self) -> usize {
        self.targets.len()
    }

    /// Steps of computation for one frame.
    pub(super) fn work(&self) -> usize {
        let skin = self.binding.as_ref().map_or(0, Binding::work);
        self.n.saturating_mul(1 + self.targets.len() + skin)
    }

    /// The vertices in coordinates of the mesh, displaced by one accessor.
    pub(super) fn morphed(&self, source: &GltfSource, target: Option<usize>) -> Result<Vec<DVec3>, Fault> {
        let mut positions = self.at_rest.clone();
        if let Some(accessor) = target {
            morph::displace(source.into(), accessor, 1.0, &mut positions)?;
        }
        Ok(positions)
    }

    /// The vertices at one moment; `world` has the transforms of all slots, `matrices` those of the joints of all skins.
    pub(super) fn posed(
        &self,
        source: &GltfSource,
        state: &State,
        world: &[DMat4],
        matrices: &[Vec<DMat4>],
    ) -> Result<Vec<DVec3>, Fault> {
        let mut positions = self.at_rest.clone();
        let animated = self.node.and_then(|node| state.weights.get(&node));
        for (&target, &weight) in self.targets.iter().zip(animated.unwrap_or(&self.weights)) {
            if let Some(accessor) = target.filter(|_| weight != 0.0) {
                morph::displace(source.into(), accessor, weight, &mut positions)?;
            }
        }
        if let Some(binding) = &self.binding {
            binding.apply(&matrices[binding.skin], &mut positions);
        } else if let Some(slot) = self.slot {
            positions.iter_mut().for_each(|p| *p = world[slot].transform_point3(*p));
        }
        Ok(positions)
    }
}
