//! What every pose of a file needs: its vertices at rest, the nodes and joints that carry them.

use super::super::access::Data;
use super::super::json;
use super::super::nodes::{self, Graph, Local};
use super::super::source::GltfSource;
use super::carried::Carried;
use super::morph::{self, Target};
use super::skin::{self, Skin};
use crate::{Fault, Warning, budget};
use glam::{DMat4, DVec3};
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};

/// The moving parts of a document. *Slots* number the nodes that carry a mesh or a joint, parents before children.
#[derive(Debug)]
pub(super) struct Rig {
    nodes: Vec<usize>,
    parents: Vec<Option<usize>>,
    locals: Vec<Local>,
    slot_of: HashMap<usize, usize>,
    blocks: Vec<Carried>,
    /// Numbers of the skins in the document, ascending, with the slots of their joints until they are loaded.
    listed: Vec<(usize, Vec<usize>)>,
    skins: Vec<Skin>,
    /// Slots that vertices follow, ascending.
    followed: Vec<usize>,
    /// Number of targets by the node that places a mesh with targets.
    morphing: HashMap<usize, usize>,
    pub(super) warnings: Vec<Warning>,
}

/// A rig at one moment.
#[derive(Debug)]
pub(super) struct State {
    /// Of each slot.
    pub(super) locals: Vec<Local>,
    /// Animated weights of morph targets by the node of their mesh.
    pub(super) weights: HashMap<usize, Vec<f64>>,
}

impl Rig {
    /// What the document says: enough to tell what is animated, before [`Rig::load`] reads any vertex.
    pub(super) fn outline(source: &GltfSource) -> Result<Rig, Fault> {
        let document = &source.document;
        let (owners, nodes) = (morph::owners(source)?, json::list(document, "nodes")?);
        let meshes = json::list(document, "meshes")?;
        // What there is to warn of was said on opening.
        let placements = nodes::placements(document, meshes.len(), &mut Vec::new())?;
        let mut skin_of_block = Vec::new();
        let mut joints_of = BTreeMap::new();
        let mut carriers = Vec::new();
        for owner in &owners {
            let node = placements[owner.mesh].node;
            carriers.extend(node);
            let skin = node.map_or(Ok(None), |node| skin_of(document, node, nodes))?;
            if let Some(skin) = skin.filter(|skin| !joints_of.contains_key(skin)) {
                joints_of.insert(skin, skin::joints(document, skin)?);
            }
            skin_of_block.push(skin);
        }
        carriers.extend(joints_of.values().flatten());
        let mut rig = Rig::of_nodes(&Graph::new(nodes)?, &carriers)?;
        let place_of: HashMap<usize, usize> = joints_of.keys().enumerate().map(|(at, &skin)| (skin, at)).collect();
        let slots = |joints: Vec<usize>| joints.iter().map(|joint| rig.slot_of[joint]).collect();
        rig.listed = joints_of.into_iter().map(|(skin, joints)| (skin, slots(joints))).collect();
        for (block, (owner, skin)) in owners.iter().zip(skin_of_block).enumerate() {
            let placement = &placements[owner.mesh];
            let own = placement.node.and_then(|node| nodes[node].get("weights"));
            let default = own.or_else(|| meshes[owner.mesh].get("weights"));
            let mut carried = Carried::outline(source, block, owner, placement, default)?;
            carried.skin = skin.map(|skin| place_of[&skin]);
            let placed = placement.node.filter(|_| skin.is_none() && !placement.flattened);
            carried.slot = placed.and_then(|node| rig.slot(node));
            if let Some(node) = placement.node.filter(|_| carried.n_targets() > 0) {
                let most = rig.morphing.entry(node).or_insert(0);
                *most = carried.n_targets().max(*most);
            }
            rig.blocks.push(carried);
        }
        Ok(rig)
    }

    /// Reads the vertices and the skins.
    pub(super) fn load(&mut self, source: &GltfSource) -> Result<(), Fault> {
        // All are read for a frame that mixes all; a file can name one list of displacements any number of times.
        let mut elements = budget::Purse::new("elements read for poses", budget::ELEMENTS);
        for carried in &self.blocks {
            elements.spend(carried.n_vertices().saturating_mul(1 + carried.n_targets()))?;
        }
        let mut bytes = budget::Purse::new("bytes kept for poses", budget::POSE_BYTES);
        self.load_skins(source.into(), &mut bytes)?;
        let mut follows = vec![false; self.nodes.len()];
        for (block, (carried, owner)) in self.blocks.iter_mut().zip(morph::owners(source)?).enumerate() {
            carried.load(source, block, &owner, &self.skins, &mut bytes)?;
            if let Some(binding) = &carried.binding {
                let slots = self.skins[binding.skin].slots();
                binding.joints().filter_map(|joint| slots.get(joint)).for_each(|&slot| follows[slot] = true);
            } else if let Some(slot) = carried.slot {
                follows[slot] = true;
            }
        }
        self.followed = (0..follows.len()).filter(|&slot| follows[slot]).collect();
        Ok(())
    }

    /// Slots for some nodes and all above them.
    fn of_nodes(graph: &Graph, carriers: &[usize]) -> Result<Rig, Fault> {
        let mut needed = vec![false; graph.parents.len()];
        let order = graph.order()?;
        for &carrier in carriers {
            let mut node = Some(carrier);
            while let Some(at) = node.filter(|&at| !std::mem::replace(&mut needed[at], true)) {
                node = graph.parents[at];
            }
        }
        let nodes: Vec<usize> = order.into_iter().filter(|&node| needed[node]).collect();
        let slot_of: HashMap<usize, usize> = nodes.iter().enumerate().map(|(slot, &node)| (node, slot)).collect();
        Ok(Rig {
            parents: nodes.iter().map(|&node| graph.parents[node].map(|parent| slot_of[&parent])).collect(),
            locals: nodes.iter().map(|&node| graph.locals[node]).collect(),
            nodes,
            slot_of,
            blocks: Vec::new(),
            listed: Vec::new(),
            skins: Vec::new(),
            followed: Vec::new(),
            morphing: HashMap::new(),
            warnings: Vec::new(),
        })
    }

    fn load_skins(&mut self, data: Data<'_>, purse: &mut budget::Purse) -> Result<(), Fault> {
        let world = self.world(&self.locals);
        for (index, slots) in std::mem::take(&mut self.listed) {
            let skin = Skin::new(data, index, slots, &world, purse)?;
            if skin.scale != 1.0 {
                let factor = skin.scale;
                let text =
                    format!("skin {index} shows its bind pose {factor:.6} times as large: divided out of its poses");
                self.warnings.push(Warning(text));
            }
            self.skins.push(skin);
        }
        Ok(())
    }

    /// The slot of a node that carries something.
    pub(super) fn slot(&self, node: usize) -> Option<usize> {
        self.slot_of.get(&node).copied()
    }

    /// How many targets a node's mesh has, when it places a mesh with targets.
    pub(super) fn n_weights(&self, node: usize) -> Option<usize> {
        self.morphing.get(&node).copied()
    }

    /// Refuses a transform that cannot be animated in parts.
    pub(super) fn animated(&self, slot: usize) -> Result<(), Fault> {
        let place = || format!("node {}", self.nodes[slot]);
        self.locals[slot].parts().map(|_| ()).ok_or_else(|| Fault::at(place(), "is animated and has a flat matrix"))
    }

    pub(super) fn at_rest(&self) -> State {
        State { locals: self.locals.clone(), weights: HashMap::new() }
    }

    /// Vertices of all blocks.
    pub(super) fn n_vertices(&self) -> usize {
        self.blocks.iter().map(Carried::n_vertices).sum()
    }

    /// Steps of computation for one frame.
    pub(super) fn work(&self) -> u64 {
        let joints: usize = self.skins.iter().map(|skin| skin.slots().len()).sum();
        let blocks = self.blocks.iter().map(|carried| carried.work() as u64);
        blocks.fold((self.nodes.len() + joints) as u64, u64::saturating_add)
    }

    /// The transforms of all slots.
    pub(super) fn world(&self, locals: &[Local]) -> Vec<DMat4> {
        let mut world: Vec<DMat4> = Vec::with_capacity(locals.len());
        for (local, parent) in locals.iter().zip(&self.parents) {
            world.push(parent.map_or(DMat4::IDENTITY, |parent| world[parent]) * local.matrix());
        }
        world
    }

    /// The first node that takes the vertices which follow it to a plane, a line or a point.
    pub(super) fn flattening(&self, world: &[DMat4]) -> Option<usize> {
        self.followed.iter().find(|&&slot| nodes::flattens(world[slot])).map(|&slot| self.nodes[slot])
    }

    /// All file vertices with one target at weight 1, placed as on opening.
    pub(super) fn morphed(&self, source: &GltfSource, target: &Target) -> Result<Vec<DVec3>, Fault> {
        let mut all = Vec::with_capacity(self.n_vertices());
        let mut displaced = target.blocks.iter().peekable();
        for (index, (carried, block)) in self.blocks.iter().zip(&source.blocks).enumerate() {
            let accessor = displaced.next_if(|&&(at, _)| at == index).map(|&(_, accessor)| accessor);
            let mut positions = carried.morphed(source, accessor)?;
            if block.world_from_local != DMat4::IDENTITY {
                positions.iter_mut().for_each(|p| *p = block.to_world(*p));
            }
            all.append(&mut positions);
        }
        Ok(all)
    }

    /// All file vertices at one moment, `world` being its transforms.
    pub(super) fn pose(&self, source: &GltfSource, state: &State, world: &[DMat4]) -> Result<Vec<DVec3>, Fault> {
        let matrices: Vec<Vec<DMat4>> = self.skins.iter().map(|skin| skin.matrices(world)).collect();
        let mut all = Vec::with_capacity(self.n_vertices());
        for carried in &self.blocks {
            all.append(&mut carried.posed(source, state, world, &matrices)?);
        }
        Ok(all)
    }
}

/// The skin that a node puts on its mesh.
pub(super) fn skin_of(document: &Value, node: usize, nodes: &[Value]) -> Result<Option<usize>, Fault> {
    let n = json::list(document, "skins")?.len();
    json::reference(&nodes[node], "skin", &format!("node {node}"), "skin", n)
}
